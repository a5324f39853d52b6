//! What loading and writing promise, each on a scene built for it.

mod builder;
mod look;
mod pose;
mod read;
mod refuse;
mod roles;
mod survive;
mod write;

pub(crate) use builder::Builder;
