//! Times of day, as asked for and as printed.

use super::exit::Failure;
use sunbake::sun::{SunPath, clock_text, parse_clock};

/// A time, as asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// Minutes after local midnight.
    Clock(f64),
    /// Path time.
    Path(f64),
}

/// Reads `HH:MM` or a fraction.
pub fn parse_when(text: &str) -> Result<When, String> {
    let wrong = || format!("`{text}` is not a time: give HH:MM, or a fraction of the path from 0 to 1");
    if text.contains(':') {
        return parse_clock(text).map(When::Clock).map_err(|_| wrong());
    }
    let t = text.parse().map_err(|_| wrong())?;
    if (0.0..=1.0).contains(&t) { Ok(When::Path(t)) } else { Err(wrong()) }
}

/// What to call a moment of a path: its clock time or, where there is no clock, its path time.
pub fn label(path: Option<&SunPath>, t: f64) -> String {
    match path.and_then(|path| path.clock_min(t)) {
        Some(minutes) => clock_text(minutes),
        None => format!("t {t:.2}"),
    }
}

impl When {
    /// The path time that is meant.
    pub fn on(self, path: Option<&SunPath>) -> Result<f64, Failure> {
        let minutes = match self {
            Self::Path(t) => return Ok(t),
            Self::Clock(minutes) => minutes,
        };
        let Some(path) = path else {
            return Err(Failure::usage(
                "there is no sun, so there is no clock: give --at from 0 to 1, or leave it out",
            ));
        };
        let (Some(start), Some(end)) = (path.clock_min(0.0), path.clock_min(1.0)) else {
            return Err(Failure::usage("this set's path is not a day, so it has no clock: give --at from 0 to 1"));
        };
        // A path may start on the day before or end on the day after.
        let candidates = [minutes - 1440.0, minutes, minutes + 1440.0].map(|m| (m - start) / (end - start));
        // Clocks are read in minutes: half a minute outside still means the end.
        let slack = 0.5 / (end - start);
        match candidates.into_iter().find(|t| (-slack..=1.0 + slack).contains(t)) {
            Some(t) => Ok(t.clamp(0.0, 1.0)),
            None => Err(Failure::usage(format!(
                "{} is outside the sun's path, which runs from {} to {}: give a time between",
                clock_text(minutes),
                clock_text(start),
                clock_text(end)
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunbake::sun::Day;
    use sunbake_runtime::testing::equinox;

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
    fn times_are_read_and_refused() {
        assert_eq!((parse_when("06:30"), parse_when("0.25")), (Ok(When::Clock(390.0)), Ok(When::Path(0.25))));
        for bad in ["", "24:01", "12:60", "-1", "1.01", "NaN", "noon", "1:2:3"] {
            assert!(parse_when(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn clocks_find_their_place_on_the_path_even_across_midnight() {
        let at = |start, text| parse_when(text).unwrap().on(Some(&day(start)));
        assert!((at(360.0, "12:00").unwrap() - 0.5).abs() < 1e-9);
        assert!((at(1200.0, "02:00").unwrap() - 0.5).abs() < 1e-9);
        assert!((at(-120.0, "22:00").unwrap()).abs() < 1e-9);
        let message = at(360.0, "19:00").unwrap_err().error.to_string();
        assert!(message.contains("06:00 to 18:00"), "{message}");
    }
}
