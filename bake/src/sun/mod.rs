//! Sun paths: the direction to the sun (or to any distant light) at every path time `t` in [0, 1].
//!
//! A path is one or more *arcs* of constant declination (`arc.rs`). Each arc is a rotation about a fixed axis, so
//! visibility along it has closed-form solutions. A real day is fitted by one to three arcs (`day.rs`, `fit.rs`). A
//! keyed path is a chain of great circles, each an arc of declination zero in its own frame (`keyed.rs`). A scene's
//! directional light gets the great circle through its direction (`light.rs`).
//!
//! World frame: +Y up, north -Z, east +X, turned by `north_deg` (`compass.rs`). Angles are radians inside the code and
//! degrees in requests, files and messages; all names say which.

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
pub use day::{DayError, DayOutcome, DayRequest, FIT_ENOUGH_DEG, day, parse_place, parse_utc_offset};
pub use ephemeris::EphemerisError;
pub use keyed::{KeyedError, parse_keyed};
pub(crate) use keys::key_times;
pub use keys::{KeyError, MAX_KEYS};
pub use light::{LightError, fixed_light};
pub use path::{Day, PathError, SunPath};

/// Mean angular radius of the sun seen from Earth, in degrees (semi-diameter 959.63 arc seconds at one astronomical
/// unit; *Explanatory Supplement to the Astronomical Almanac*).
pub const SUN_ANGULAR_RADIUS_DEG: f64 = 959.63 / 3600.0;

/// Minutes in which the real sun turns through an angle (one turn a day): the default duration of a path.
fn duration_min_of_angle(angle_rad: f64) -> f64 {
    angle_rad / std::f64::consts::TAU * DAY_MIN
}
