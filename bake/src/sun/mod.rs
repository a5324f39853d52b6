//! Sun paths: where the sun (or a lamp far away) stands at every moment `t` in [0, 1].
//!
//! A path is one or more *arcs* of constant declination ([`arc`]), each a turn about a fixed axis, so that visibility
//! along it has closed-form answers. A real day is fitted by one to three arcs ([`day`], [`fit`]); a keyed path is a
//! chain of great circles, each an arc of declination zero in a frame of its own.
//!
//! World frame: +Y up, north -Z, east +X, turned by `north_deg` ([`compass`]). Angles in the code are radians and say
//! so; at the edges (requests, manifests, messages) they are degrees and say so.

pub mod arc;
pub mod clock;
pub mod compass;
pub mod day;
mod ephemeris;
mod fit;
pub mod path;

#[cfg(test)]
mod tests;

pub use arc::SunArc;
pub use clock::{ClockError, Date, DateError, parse_clock, parse_window};
pub use compass::Compass;
pub use day::{DayError, DayOutcome, DayRequest, day};
pub use path::{Day, PathError, SunPath};

/// Mean angular radius of the sun seen from Earth, in degrees (semi-diameter 959.63 arc seconds at one astronomical
/// unit; *Explanatory Supplement to the Astronomical Almanac*).
pub const SUN_ANGULAR_RADIUS_DEG: f64 = 959.63 / 3600.0;
