//! When each surface point sees the sun.
//!
//! `V(x, t)` is 1 where the sun's centre is above the world horizon, above the surface's plane, and not occluded. An
//! [`Engine`] answers with all lit intervals of a point at once. A double-sided surface is asked about from whichever
//! side the sun is on, so one list serves both of its faces: at any moment the sun stands before just one of them, and
//! the run time knows which.

pub mod intervals;

pub use intervals::Intervals;
