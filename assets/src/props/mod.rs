//! Everything around the station that throws a shadow worth looking at.

mod booth;
mod cactus;
mod clutter;
mod fence;
mod lattice;
mod pergola;
mod sign;
mod tank;
mod tarp;
mod tree;
mod wires;

mod layout;

pub(crate) use layout::add;
