//! Calendar dates and clock times, parsed and printed.
//!
//! Dates are proleptic Gregorian (ISO 8601). Day numbers count from 1970-01-01; based on: Howard Hinnant,
//! "chrono-Compatible Low-Level Date Algorithms", 2013.

use std::fmt;
use std::str::FromStr;

/// First and last year of a date: in this range the difference between clock time and the ephemeris's time is known or
/// estimated (Espenak and Meeus, *Five Millennium Canon*).
pub const YEARS: [i32; 2] = [1, 2999];

/// Minutes in a day.
pub const DAY_MIN: f64 = 1440.0;

/// A valid calendar date in [`YEARS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Date {
    year: i32,
    month: u32,
    day: u32,
}

/// Why a date is invalid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DateError {
    /// Not of the form YYYY-MM-DD.
    #[error("'{0}' is not a date: give YYYY-MM-DD, for instance 2026-06-21")]
    Form(String),
    /// No such month, or no such day in it.
    #[error("{0} does not exist: {1}")]
    Missing(String, String),
    /// Outside [`YEARS`].
    #[error(
        "the year {0} is outside {first}..={last}, the years that the sun's position is known for",
        first = YEARS[0],
        last = YEARS[1]
    )]
    Year(i32),
}

impl Date {
    /// Checks that the day exists.
    pub fn new(year: i32, month: u32, day: u32) -> Result<Self, DateError> {
        let text = || format!("{year:04}-{month:02}-{day:02}");
        if !(YEARS[0]..=YEARS[1]).contains(&year) {
            return Err(DateError::Year(year));
        }
        if !(1..=12).contains(&month) {
            return Err(DateError::Missing(text(), "months run from 01 to 12".to_owned()));
        }
        let length = month_length(year, month);
        if !(1..=length).contains(&day) {
            return Err(DateError::Missing(text(), format!("that month has days 01 to {length}")));
        }
        Ok(Self { year, month, day })
    }

    /// Year of the Gregorian calendar.
    pub fn year(self) -> i32 {
        self.year
    }

    /// Month, from 1.
    pub fn month(self) -> u32 {
        self.month
    }

    /// Day of the month, from 1.
    pub fn day(self) -> u32 {
        self.day
    }

    /// Days since 1970-01-01.
    pub fn day_number(self) -> i64 {
        let year = i64::from(self.year) - i64::from(self.month <= 2);
        let era = year.div_euclid(400);
        let year_of_era = year.rem_euclid(400);
        let day_of_year = (153 * ((i64::from(self.month) + 9) % 12) + 2) / 5 + i64::from(self.day) - 1;
        era * 146_097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719_468
    }
}

fn month_length(year: i32, month: u32) -> u32 {
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Year, month and day of a day number; the inverse of [`Date::day_number`] for any year.
fn civil(day_number: i64) -> (i64, i64, i64) {
    let z = day_number + 719_468;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = (shifted_month + 2) % 12 + 1;
    (era * 400 + year_of_era + i64::from(month <= 2), month, day)
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

impl FromStr for Date {
    type Err = DateError;

    fn from_str(text: &str) -> Result<Self, DateError> {
        let form = || DateError::Form(text.to_owned());
        let fields: Vec<&str> = text.split('-').collect();
        let [year, month, day] = fields[..] else { return Err(form()) };
        if [year.len(), month.len(), day.len()] != [4, 2, 2] || !text.bytes().all(|b| b.is_ascii_digit() || b == b'-') {
            return Err(form());
        }
        let number = |field: &str| field.parse::<u32>().map_err(|_| form());
        Date::new(number(year)? as i32, number(month)?, number(day)?)
    }
}

/// `YYYY-MM-DDTHH:MM:SS` at `minutes` after midnight of `date`, rounded to the second. It may be on another day.
pub fn date_time_text(date: Date, minutes: f64) -> String {
    let seconds = (minutes * 60.0).round() as i64;
    let (year, month, day) = civil(date.day_number().saturating_add(seconds.div_euclid(86_400)));
    let second = seconds.rem_euclid(86_400);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60)
}

/// `HH:MM` at `minutes` after midnight, rounded to the minute, without the day.
pub fn clock_text(minutes: f64) -> String {
    let minute = (minutes.round() as i64).rem_euclid(1440);
    format!("{:02}:{:02}", minute / 60, minute % 60)
}

/// Why a clock time or a window is invalid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ClockError {
    /// Not a time of day.
    #[error("'{0}' is not a time of day: give HH:MM from 00:00 to 24:00")]
    Time(String),
    /// Not `HH:MM-HH:MM`.
    #[error("'{0}' is not a window of time: give HH:MM-HH:MM, for instance 08:00-18:30 (22:00-02:00 crosses midnight)")]
    Window(String),
}

/// Minutes after midnight of `HH:MM`, from 00:00 to 24:00.
pub fn parse_clock(text: &str) -> Result<f64, ClockError> {
    let minutes = || -> Option<u32> {
        let (hours, minutes) = text.split_once(':')?;
        let digits = |s: &str| (1..=2).contains(&s.len()) && s.bytes().all(|b| b.is_ascii_digit());
        if !digits(hours) || !digits(minutes) || minutes.len() != 2 {
            return None;
        }
        let (hours, minutes): (u32, u32) = (hours.parse().ok()?, minutes.parse().ok()?);
        (minutes < 60 && hours * 60 + minutes <= 1440).then_some(hours * 60 + minutes)
    };
    minutes().map(f64::from).ok_or_else(|| ClockError::Time(text.to_owned()))
}

/// Start and end of `HH:MM-HH:MM` in minutes after midnight. An end at or before the start is on the next day, as in
/// [`super::DayRequest::window`].
pub fn parse_window(text: &str) -> Result<[f64; 2], ClockError> {
    let (start, end) = text.split_once('-').ok_or_else(|| ClockError::Window(text.to_owned()))?;
    Ok([parse_clock(start)?, parse_clock(end)?])
}
