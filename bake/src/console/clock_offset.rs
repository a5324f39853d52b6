//! How far local clocks are ahead of UTC: as a number of hours, or by the name of a time zone.

use super::Failure;
use crate::sun::{Date, parse_utc_offset};
use jiff::civil;
use jiff::tz::TimeZone;

/// An offset of local clocks.
#[derive(Debug, Clone, PartialEq)]
pub enum ClockOffset {
    /// Hours ahead of UTC.
    Hours(f64),
    /// A time zone with its summer time.
    Zone(TimeZone),
}

/// Reads hours ahead of UTC, or the name of a time zone.
pub fn parse_clock_offset(text: &str) -> Result<ClockOffset, String> {
    let starts_as_name = text.starts_with(|c: char| c.is_alphabetic());
    if !starts_as_name {
        return parse_utc_offset(text).map(ClockOffset::Hours);
    }
    let zone = TimeZone::get(text);
    zone.map(ClockOffset::Zone).map_err(|_| {
        format!("`{text}` is no time zone: give a name as Europe/Vienna, or hours ahead of UTC as -8, 5.75 or 5:45")
    })
}

impl ClockOffset {
    /// Hours ahead of UTC at noon of a day.
    ///
    /// # Errors
    ///
    /// If the day is beyond the years that time zones are known for.
    pub fn hours_on(&self, date: Date) -> Result<f64, Failure> {
        let zone = match self {
            Self::Hours(hours) => return Ok(*hours),
            Self::Zone(zone) => zone,
        };
        let noon: Result<civil::DateTime, _> = format!("{date}T12:00").parse();
        let noon = noon.and_then(|noon| zone.to_timestamp(noon));
        let offset = noon.map(|noon| zone.to_offset(noon));
        let offset = offset.map_err(|_| Failure::usage(format!("no time zone is known on {date}: give hours")))?;
        Ok(f64::from(offset.seconds()) / 3600.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_have_summer_time_and_odd_offsets() {
        for (text, date, hours) in [
            ("Europe/Vienna", "2026-06-21", 2.0),
            ("Europe/Vienna", "2026-12-21", 1.0),
            ("America/Los_Angeles", "2026-06-21", -7.0),
            ("Asia/Kathmandu", "2026-06-21", 5.75),
            ("Australia/Lord_Howe", "2026-06-21", 10.5),
            ("UTC", "2026-06-21", 0.0),
            ("5:45", "2026-06-21", 5.75),
            ("-8", "2026-06-21", -8.0),
        ] {
            let offset = parse_clock_offset(text).unwrap();
            assert_eq!(offset.hours_on(date.parse().unwrap()).ok(), Some(hours), "{text} on {date}");
        }
        for bad in ["Europe/Nowhere", "", "5:99", "CE T"] {
            assert!(parse_clock_offset(bad).is_err_and(|error| error.contains("give")), "{bad}");
        }
    }
}
