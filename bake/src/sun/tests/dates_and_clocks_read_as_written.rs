//! Dates, clock times and their texts.

use super::super::clock::{clock_text, date_time_text, parse_clock, parse_window};
use super::super::{Date, DateError};

fn date(text: &str) -> Date {
    text.parse().expect("a date")
}

#[test]
fn days_that_do_not_exist_are_refused_with_the_month_length() {
    for (text, expected) in [("2026-02-30", "01 to 28"), ("2027-02-29", "01 to 28"), ("1900-02-29", "01 to 28")] {
        let message = text.parse::<Date>().expect_err("no such day").to_string();
        assert!(message.contains(&format!("{text} does not exist")) && message.contains(expected), "{message}");
    }
    for text in ["2026-04-31", "2026-13-01", "2026-00-10", "2026-01-00"] {
        assert!(matches!(text.parse::<Date>(), Err(DateError::Missing(..))), "{text}");
    }
    for text in ["2028-02-29", "2000-02-29", "2026-12-31", "0001-01-01", "2999-12-31"] {
        assert_eq!(date(text).to_string(), text);
    }
}

#[test]
fn other_forms_are_refused() {
    for text in ["", "2026", "21-06-2026", "2026-6-21", "2026/06/21", "+026-06-21", "2026-06-21T00", "２０２６-06-21"]
    {
        assert!(matches!(text.parse::<Date>(), Err(DateError::Form(_))), "{text}");
    }
    assert_eq!("0000-01-01".parse::<Date>(), Err(DateError::Year(0)));
    assert_eq!("3000-01-01".parse::<Date>(), Err(DateError::Year(3000)));
}

#[test]
fn day_numbers_count_every_day_once() {
    assert_eq!(date("1970-01-01").day_number(), 0);
    assert_eq!(date("2000-03-01").day_number(), 11_017);
    let mut number = date("1999-01-01").day_number();
    for year in 1999..2405 {
        for month in 1..=12 {
            for day in 1..=31 {
                let Ok(date) = Date::new(year, month, day) else { continue };
                assert_eq!(date.day_number(), number, "{date}");
                assert_eq!(date_time_text(date, 0.0), format!("{date}T00:00:00"));
                number += 1;
            }
        }
    }
}

#[test]
fn times_roll_over_to_other_days() {
    assert_eq!(date_time_text(date("2026-12-31"), 1500.5), "2027-01-01T01:00:30");
    assert_eq!(date_time_text(date("2028-03-01"), -1.0), "2028-02-29T23:59:00");
    assert_eq!(date_time_text(date("2026-06-21"), 59.9999), "2026-06-21T01:00:00");
    assert_eq!(clock_text(1439.7), "00:00");
    assert_eq!(clock_text(-30.0), "23:30");
}

#[test]
fn windows_are_pairs_of_clock_times() {
    assert_eq!(parse_window("08:00-18:30"), Ok([480.0, 1110.0]));
    assert_eq!(parse_window("22:00-02:00"), Ok([1320.0, 120.0]));
    assert_eq!(parse_clock("24:00"), Ok(1440.0));
    for text in ["", "8", "8:5", "08:60", "24:01", "-1:00", "08:00:00", "+8:00"] {
        assert!(parse_clock(text).is_err(), "{text}");
    }
    assert!(parse_window("08:00").is_err() && parse_window("08:00-").is_err());
}
