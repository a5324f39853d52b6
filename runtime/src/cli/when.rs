//! Times of day, as options name them.

use sunbake::sun::parse_clock;
use sunbake_runtime::light::TimeChoice;

/// Reads `HH:MM` or a fraction.
pub fn parse_when(text: &str) -> Result<TimeChoice, String> {
    let wrong = || format!("`{text}` is not a time: give HH:MM, or a fraction of the path from 0 to 1");
    if text.contains(':') {
        return parse_clock(text).map(TimeChoice::ClockMin).map_err(|_| wrong());
    }
    let t = text.parse().map_err(|_| wrong())?;
    if (0.0..=1.0).contains(&t) { Ok(TimeChoice::Path(t)) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_and_refused() {
        assert_eq!(
            (parse_when("06:30"), parse_when("0.25")),
            (Ok(TimeChoice::ClockMin(390.0)), Ok(TimeChoice::Path(0.25)))
        );
        for bad in ["", "24:01", "12:60", "-1", "1.01", "NaN", "noon", "1:2:3"] {
            assert!(parse_when(bad).is_err(), "{bad}");
        }
    }
}
