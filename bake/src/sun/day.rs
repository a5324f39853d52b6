//! A real day at a real place as a sun path.
//!
//! Theory: a date's daylight is the one around the sun's upper transit nearest to local noon. It may end after local
//! midnight (at high latitudes, or if clocks are far from solar time). Near the poles there are more cases:
//!
//! * Polar day: the sun stays up for a whole turn around the transit. The path is the date's 24 hours from local
//!   midnight.
//! * Polar night: the sun is not up at all. There is no path.
//! * Start or end of a polar day: the sun crosses the horizon once. Daylight is cut twelve hours from the transit.
//! * At a pole the sun may be down at the transit and up later that day: the longest daylight within those 24 hours
//!   counts.
//!
//! Practice: t is linear in clock time and, to well under the fit's error, in the hour angle. Sunrise and sunset are
//! the moments when the *centre* of the sun's disc is on the *geometric* horizon, without refraction. In air the sun
//! appears about 0.6 degrees higher there, and almanacs use the disc's upper edge, so their days are 7 minutes longer
//! at mid latitudes.

use super::SUN_ANGULAR_RADIUS_DEG;
use super::clock::{DAY_MIN, Date, DateError, clock_text};
use super::compass::Compass;
use super::ephemeris::{Ephemeris, EphemerisError};
use super::fit::{EphemerisSample, fit};
use super::path::{Day, PathError, SunPath};

/// Largest error of the path against the ephemeris, in degrees, that needs no further arc. Each arc costs a query of
/// the scene for every texel; 0.01 degrees are 2.4 seconds of the sun's motion.
pub const FIT_ENOUGH_DEG: f64 = 0.01;

/// Shortest path, in minutes: one second, so that ascending times stay distinct in all computations. Shorter daylight
/// counts as polar night.
const SHORTEST_MIN: f64 = 1.0 / 60.0;

/// A day at a place, for which a sun path is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct DayRequest {
    /// Degrees north, in -90..=90.
    pub latitude_deg: f64,
    /// Degrees east, in -180..=180.
    pub longitude_deg: f64,
    /// The local date.
    pub date: Date,
    /// Hours that local clocks are ahead of UTC, in -12..=14, fractions allowed (Nepal: 5.75). `None`: the whole hour
    /// nearest to solar time, `longitude / 15`. Summer time must be included here.
    pub utc_offset_h: Option<f64>,
    /// Degrees that the scene's north is turned from -Z towards +X (clockwise seen from above).
    pub north_deg: f64,
    /// Start and end of the path in minutes of local clock time, each in 0..=1440. An end at or before the start is on
    /// the next day, so equal times are a whole day. `None`: from sunrise to sunset.
    pub window: Option<[f64; 2]>,
}

/// The result of [`day`].
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant)]
pub enum DayOutcome {
    /// The sun's path.
    Path(SunPath),
    /// The sun does not rise (polar night). This is not an error: ambient occlusion can still be baked.
    NoSun {
        /// Highest elevation of the sun's centre within twelve hours of its transit, in degrees. Not positive, up to
        /// rounding.
        highest_elevation_deg: f64,
        /// Time of that elevation, in minutes after local midnight.
        highest_min: f64,
    },
}

/// Default place: degrees north and east.
const DEFAULT_PLACE_DEG: [f64; 2] = [40.0, 0.0];
/// Default date: the northern summer solstice.
const DEFAULT_DATE: (i32, u32, u32) = (2026, 6, 21);

impl DayRequest {
    /// From sunrise to sunset. Default place: 40 degrees north, 0 degrees east; default date: 2026-06-21.
    pub fn new(place_deg: Option<[f64; 2]>, date: Option<Date>) -> Result<Self, DateError> {
        let [latitude_deg, longitude_deg] = place_deg.unwrap_or(DEFAULT_PLACE_DEG);
        let (year, month, day) = DEFAULT_DATE;
        let date = date.map_or_else(|| Date::new(year, month, day), Ok)?;
        Ok(Self { latitude_deg, longitude_deg, date, utc_offset_h: None, north_deg: 0.0, window: None })
    }
}

/// Parses a place: degrees north and east, as `48.2,16.4`.
pub fn parse_place(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("`{text}` is not a place: give degrees north and east, as 48.2,16.4");
    let (latitude, longitude) = text.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong);
    Ok([number(latitude)?, number(longitude)?])
}

/// Parses hours ahead of UTC: `5.75`, `5:45`, `+05:45`, `-3:30`.
pub fn parse_utc_offset(text: &str) -> Result<f64, String> {
    let wrong = || format!("`{text}` is no offset from UTC: give hours, as -8, 5.75 or 5:45");
    let Some((hours, minutes)) = text.split_once(':') else {
        return text.parse().ok().filter(|h: &f64| h.is_finite()).ok_or_else(wrong);
    };
    let (sign, hours) = match hours.strip_prefix('-') {
        Some(hours) => (-1.0, hours),
        None => (1.0, hours.strip_prefix('+').unwrap_or(hours)),
    };
    let digits = |text: &str| text.len() <= 2 && text.bytes().all(|b| b.is_ascii_digit());
    let [hours, minutes] = [hours, minutes].map(|text| text.parse::<u32>().ok().filter(|_| digits(text)));
    let (hours, minutes) = hours.zip(minutes.filter(|&m| m < 60)).ok_or_else(wrong)?;
    Ok(sign * (f64::from(hours) + f64::from(minutes) / 60.0))
}

/// Why a request is invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DayError {
    /// Degrees north that are not in -90..=90.
    #[error("latitude {0} is off the globe: give degrees north in -90..=90")]
    Latitude(f64),
    /// Degrees east that are not in -180..=180.
    #[error("longitude {0} is off the globe: give degrees east in -180..=180")]
    Longitude(f64),
    /// Not a time zone.
    #[error("a UTC offset of {0} hours does not exist: give hours ahead of UTC in -12..=14, for instance 5.75 or 5:45")]
    UtcOffset(f64),
    /// Degrees that are not finite.
    #[error("north turned by {0} degrees is no direction: give a finite angle")]
    North(f64),
    /// Minutes that are not in 0..=1440, or less than a second apart.
    #[error(
        "no window runs from minute {0} to minute {1}: give minutes of local time in 0..=1440, at least a second apart"
    )]
    Window(f64, f64),
    /// The sun is down all through the window.
    #[error(
        "the sun stays below the horizon from {window} on {date}: it is up {sun_up} there; choose a window that meets \
         that"
    )]
    DarkWindow {
        /// `HH:MM to HH:MM`.
        window: String,
        /// The local date that was asked for.
        date: Date,
        /// `from HH:MM to HH:MM`.
        sun_up: String,
    },
    /// The ephemeris failed.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// The fit gave no path.
    #[error("the sun's positions on that day make no path: {0}")]
    Path(#[from] PathError),
}

/// The sun's path over a day at a place.
pub fn day(request: &DayRequest) -> Result<DayOutcome, DayError> {
    let utc_offset_h = check(request)?;
    let place = [request.latitude_deg, request.longitude_deg];
    let ephemeris = Ephemeris::new(place, request.date, utc_offset_h, Compass::new(request.north_deg))?;
    let Some(daylight) = daylight_of_date(&ephemeris)? else {
        return no_sun_unless_in_window(request, utc_offset_h, &ephemeris);
    };
    let Some(window) = request.window.map(unrolled) else {
        return Ok(DayOutcome::Path(path_over(request, utc_offset_h, &ephemeris, daylight)?));
    };
    if ephemeris.daylight(window)?.is_empty() {
        return Err(DayError::DarkWindow {
            window: window.map(clock_text).join(" to "),
            date: request.date,
            sun_up: format!("from {}", daylight.map(clock_text).join(" to ")),
        });
    }
    Ok(DayOutcome::Path(path_over(request, utc_offset_h, &ephemeris, window)?))
}

/// On a date without daylight, a window across midnight may still contain the next day's.
fn no_sun_unless_in_window(
    request: &DayRequest,
    utc_offset_h: f64,
    ephemeris: &Ephemeris,
) -> Result<DayOutcome, DayError> {
    if let Some(window) = request.window.map(unrolled)
        && !ephemeris.daylight(window)?.is_empty()
    {
        return Ok(DayOutcome::Path(path_over(request, utc_offset_h, ephemeris, window)?));
    }
    let transit = ephemeris.transit_min()?;
    let [highest_min, highest_elevation_deg] = ephemeris.highest([transit - 0.5 * DAY_MIN, transit + 0.5 * DAY_MIN])?;
    Ok(DayOutcome::NoSun { highest_elevation_deg, highest_min })
}

/// Checks every number of a request. Returns the UTC offset in hours.
fn check(request: &DayRequest) -> Result<f64, DayError> {
    if !(-90.0..=90.0).contains(&request.latitude_deg) {
        return Err(DayError::Latitude(request.latitude_deg));
    }
    if !(-180.0..=180.0).contains(&request.longitude_deg) {
        return Err(DayError::Longitude(request.longitude_deg));
    }
    if !request.north_deg.is_finite() {
        return Err(DayError::North(request.north_deg));
    }
    if let Some(window @ [start, end]) = request.window {
        let within_day = window.iter().all(|minute| (0.0..=DAY_MIN).contains(minute));
        if !within_day || length(&unrolled(window)) < SHORTEST_MIN {
            return Err(DayError::Window(start, end));
        }
    }
    let utc_offset_h = request.utc_offset_h.unwrap_or_else(|| (request.longitude_deg / 15.0).round());
    if !(-12.0..=14.0).contains(&utc_offset_h) {
        return Err(DayError::UtcOffset(utc_offset_h));
    }
    Ok(utc_offset_h)
}

/// The window with its end after its start: an end on the next day gets 1440 minutes added.
fn unrolled([start, end]: [f64; 2]) -> [f64; 2] {
    [start, if end <= start { end + DAY_MIN } else { end }]
}

fn length([start, end]: &[f64; 2]) -> f64 {
    end - start
}

/// Sunrise and sunset of the date in minutes after local midnight, by the rules in this file's header.
fn daylight_of_date(ephemeris: &Ephemeris) -> Result<Option<[f64; 2]>, EphemerisError> {
    let transit = ephemeris.transit_min()?;
    let around = [transit - 0.5 * DAY_MIN, transit + 0.5 * DAY_MIN];
    let mut daylight = ephemeris.daylight(around)?;
    if daylight == [around] {
        return Ok(Some([0.0, DAY_MIN]));
    }
    daylight.retain(|span| length(span) >= SHORTEST_MIN);
    let at_transit = daylight.iter().find(|[rise, set]| (*rise..=*set).contains(&transit));
    let longest = daylight.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
    Ok(at_transit.or(longest).copied())
}

/// The path from `start` to `end`, in minutes after local midnight.
fn path_over(
    request: &DayRequest,
    utc_offset_h: f64,
    ephemeris: &Ephemeris,
    [start, end]: [f64; 2],
) -> Result<SunPath, DayError> {
    let duration_min = end - start;
    // At most a minute apart, and a multiple of six, so that halves and thirds of the path are samples.
    let steps = 6 * ((duration_min / 6.0).ceil() as u32).max(4);
    let sample = |i: u32| -> Result<EphemerisSample, EphemerisError> {
        let t = f64::from(i) / f64::from(steps);
        Ok(EphemerisSample { t, direction: ephemeris.direction(start + t * duration_min)? })
    };
    let samples = (0..=steps).map(sample).collect::<Result<Vec<EphemerisSample>, _>>()?;
    let fitted = fit(&samples, ephemeris.axis_and_zero(), FIT_ENOUGH_DEG);
    let mut path = SunPath::new(fitted.arcs, SUN_ANGULAR_RADIUS_DEG.to_radians(), duration_min)?;
    path.day = Some(Day {
        latitude_deg: request.latitude_deg,
        longitude_deg: request.longitude_deg,
        date: request.date.to_string(),
        utc_offset_h,
        north_deg: request.north_deg,
        start_min: start,
        ephemeris_error_deg: fitted.error_deg,
    });
    Ok(path)
}
