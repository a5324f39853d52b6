//! Sun paths: where the sun (or a lamp far away) stands at every moment `t` in [0, 1].
//!
//! A path is one or more *arcs* of constant declination (`arc.rs`), each a turn about a fixed axis, so that visibility
//! along it has closed-form answers. A real day is fitted by one to three arcs (`day.rs`, `fit.rs`); a keyed path is a
//! chain of great circles, each an arc of declination zero in a frame of its own (`keyed.rs`); a scene that brings only
//! a directional light gets the great circle over it (`light.rs`).
//!
//! World frame: +Y up, north -Z, east +X, turned by `north_deg` (`compass.rs`). Angles in the code are radians and say
//! so; at the edges (requests, files, messages) they are degrees and say so.

mod arc;
mod clock;
mod compass;
mod day;
mod ephemeris;
mod fit;
mod keyed;
mod keys;
mod light;
mod path;

#[cfg(test)]
mod tests;

pub use arc::{HalfSpaceIntervals, SunArc};
pub use clock::{ClockError, DAY_MIN, Date, DateError, YEARS, clock_text, parse_clock, parse_window};
pub use compass::Compass;
pub use day::{DayError, DayOutcome, DayRequest, FIT_ENOUGH_DEG, day, parse_place};
pub use ephemeris::EphemerisError;
pub use keyed::{KeyedError, parse_keyed};
pub(crate) use keys::key_times;
pub use keys::{KeyError, MAX_KEYS};
pub use light::{LightError, fixed_light};
pub use path::{Day, PathError, SunPath};

/// Mean angular radius of the sun seen from Earth, in degrees (semi-diameter 959.63 arc seconds at one astronomical
/// unit; *Explanatory Supplement to the Astronomical Almanac*).
pub const SUN_ANGULAR_RADIUS_DEG: f64 = 959.63 / 3600.0;

/// Minutes that the real sun takes for an angle (a turn a day): how long a path lasts that does not say.
fn duration_min_of_angle(angle_rad: f64) -> f64 {
    angle_rad / std::f64::consts::TAU * DAY_MIN
}
