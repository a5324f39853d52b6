//! Times of day, as asked for and as printed.

use sunbake::sun::{SunPath, clock_text};

/// Minutes in a day.
const DAY_MIN: f64 = 1440.0;
/// Clock times are read in whole minutes: up to half a minute outside of the path still means its end.
const ROUNDING_MIN: f64 = 0.5;

/// A time, as asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeChoice {
    /// Minutes after local midnight.
    ClockMin(f64),
    /// Path time, 0 to 1.
    Path(f64),
}

/// Why a clock time is not on a path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimeError {
    /// Without a sun there are no clock times.
    #[error("there is no sun, so there is no clock")]
    NoSun,
    /// The path is not a day at a place.
    #[error("this set's path is not a day, so it has no clock")]
    NoClock,
    /// The sun is not on its path then.
    #[error(
        "{} is outside the sun's path, which runs from {} to {}",
        clock_text(*clock_min), clock_text(path_min[0]), clock_text(path_min[1])
    )]
    OutsidePath {
        /// The time asked for, in minutes after local midnight.
        clock_min: f64,
        /// Start and end of the path, in minutes after local midnight.
        path_min: [f64; 2],
    },
}

impl TimeChoice {
    /// The path time that is meant, 0 to 1.
    pub fn on(self, path: Option<&SunPath>) -> Result<f64, TimeError> {
        let minutes = match self {
            Self::Path(t) => return Ok(t),
            Self::ClockMin(minutes) => minutes,
        };
        let path = path.ok_or(TimeError::NoSun)?;
        let (Some(start), Some(end)) = (path.clock_min(0.0), path.clock_min(1.0)) else {
            return Err(TimeError::NoClock);
        };
        // A path may start on the day before or end on the day after.
        let candidates = [minutes - DAY_MIN, minutes, minutes + DAY_MIN].map(|m| (m - start) / (end - start));
        let slack = ROUNDING_MIN / (end - start);
        match candidates.into_iter().find(|t| (-slack..=1.0 + slack).contains(t)) {
            Some(t) => Ok(t.clamp(0.0, 1.0)),
            None => Err(TimeError::OutsidePath { clock_min: minutes, path_min: [start, end] }),
        }
    }
}

/// How to print a path time: as clock time or, where there is no clock, as it is.
pub fn clock_label(path: Option<&SunPath>, t: f64) -> String {
    match path.and_then(|path| path.clock_min(t)) {
        Some(minutes) => clock_text(minutes),
        None => format!("t {t:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::equinox;
    use sunbake::sun::Day;

    fn day(start_min: f64) -> SunPath {
        let mut path = equinox(35.0);
        path.day = Some(Day {
            latitude_deg: 35.0,
            longitude_deg: 0.0,
            date: "2026-03-20".into(),
            utc_offset_h: 0.0,
            north_deg: 0.0,
            start_min,
            ephemeris_error_deg: 0.0,
        });
        path
    }

    #[test]
    fn clocks_find_their_place_on_the_path_even_across_midnight() {
        let at = |start, minutes| TimeChoice::ClockMin(minutes).on(Some(&day(start)));
        assert!((at(360.0, 720.0).unwrap() - 0.5).abs() < 1e-9);
        assert!((at(1200.0, 120.0).unwrap() - 0.5).abs() < 1e-9);
        assert!((at(-120.0, 1320.0).unwrap()).abs() < 1e-9);
        let message = at(360.0, 1140.0).unwrap_err().to_string();
        assert!(message.contains("06:00 to 18:00"), "{message}");
    }

    #[test]
    fn without_a_day_there_is_no_clock() {
        assert_eq!(TimeChoice::ClockMin(600.0).on(None), Err(TimeError::NoSun));
        assert_eq!(TimeChoice::ClockMin(600.0).on(Some(&equinox(35.0))), Err(TimeError::NoClock));
        assert_eq!(TimeChoice::Path(0.25).on(None), Ok(0.25));
    }
}
