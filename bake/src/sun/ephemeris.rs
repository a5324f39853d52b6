//! The sun's position at one place around one day.
//!
//! Only this file uses `solar-positioning` (NREL's Solar Position Algorithm: I. Reda and A. Andreas, 2004). Positions
//! are topocentric at sea level (with parallax), without refraction. Times are minutes after local midnight and may lie
//! on the days before and after.

use glam::DVec3;
use solar_positioning::time::JulianDate;
use solar_positioning::{Error, Horizon, Location, SolarEvents, SolarPositions, delta_t};

use super::clock::{DAY_MIN, Date};
use super::compass::Compass;

/// Julian date of 1970-01-01T00:00.
const UNIX_EPOCH_JD: f64 = 2_440_587.5;

/// An error of the ephemeris. Its ranges are checked before, so none is expected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the ephemeris gives no position of the sun: {0}")]
pub struct EphemerisError(String);

impl From<Error> for EphemerisError {
    fn from(error: Error) -> Self {
        Self(error.to_string())
    }
}

/// The ephemeris for a place, a day and the scene's orientation.
pub(super) struct Ephemeris {
    location: Location,
    compass: Compass,
    midnight_jd: f64,
    delta_t_s: f64,
}

impl Ephemeris {
    /// `latitude_deg` in -90..=90, `longitude_deg` in -180..=180.
    pub fn new(
        [latitude, longitude]: [f64; 2],
        date: Date,
        utc_offset_h: f64,
        compass: Compass,
    ) -> Result<Self, EphemerisError> {
        let midnight_jd = UNIX_EPOCH_JD + date.day_number() as f64 - utc_offset_h / 24.0;
        let delta_t_s = delta_t::estimate_from_date(date.year(), date.month())?;
        Ok(Self { location: Location { latitude, longitude }, compass, midnight_jd, delta_t_s })
    }

    /// Azimuth and elevation of the sun's centre, in degrees.
    pub fn azimuth_elevation_deg(&self, minute: f64) -> Result<[f64; 2], EphemerisError> {
        let time = JulianDate::new(self.jd(minute), self.delta_t_s)?;
        let position = SolarPositions::new().at_from_julian(time, self.location, 0.0, None)?;
        Ok([position.azimuth(), position.elevation_angle()])
    }

    /// Elevation of the sun's centre, in degrees.
    pub fn elevation_deg(&self, minute: f64) -> Result<f64, EphemerisError> {
        Ok(self.azimuth_elevation_deg(minute)?[1])
    }

    /// Direction towards the sun's centre, unit length, world space.
    pub fn direction(&self, minute: f64) -> Result<DVec3, EphemerisError> {
        let [azimuth_deg, elevation_deg] = self.azimuth_elevation_deg(minute)?;
        Ok(self.compass.direction(azimuth_deg, elevation_deg))
    }

    /// The sky's right-handed axis of rotation (the south celestial pole), and the direction where the meridian crosses
    /// the celestial equator (hour angle 0).
    pub fn axis_and_zero(&self) -> [DVec3; 2] {
        let (sin, cos) = self.location.latitude.to_radians().sin_cos();
        let north = self.compass.north;
        [-(north * cos + DVec3::Y * sin), DVec3::Y * cos - north * sin]
    }

    /// The minute of the upper transit nearest to local noon. It is up to twelve hours from noon if clocks are far from
    /// solar time.
    pub fn transit_min(&self) -> Result<f64, EphemerisError> {
        // Transits are a day and up to half a minute apart, so a day and twelve minutes contain one or two.
        let [from, to] = [-6.0, DAY_MIN + 6.0];
        let noon = 0.5 * DAY_MIN;
        let mut nearest: Option<f64> = None;
        let mut after = from;
        while let Some(transit) = self.next_transit([after, to])? {
            if nearest.is_none_or(|n| (transit - noon).abs() < (n - noon).abs()) {
                nearest = Some(transit);
            }
            after = transit + 1.0;
            if after >= to {
                break;
            }
        }
        Ok(nearest.unwrap_or(noon))
    }

    fn next_transit(&self, [from, to]: [f64; 2]) -> Result<Option<f64>, EphemerisError> {
        let [start, end] = [self.jd(from), self.jd(to)];
        let transit =
            SolarEvents::new().next_transit_from_julian(start, end, self.location.longitude, self.delta_t_s)?;
        Ok(transit.map(|jd| self.minute(jd)))
    }

    /// Intervals, in minutes, in which the sun's centre is above the geometric horizon: ascending, disjoint.
    pub fn daylight(&self, [from, to]: [f64; 2]) -> Result<Vec<[f64; 2]>, EphemerisError> {
        let [start, end] = [self.jd(from), self.jd(to)];
        let horizon = Horizon::Custom(0.0);
        let events = SolarEvents::new().for_interval_from_julian(start, end, self.location, self.delta_t_s, horizon)?;
        let rises = events.rises.iter().map(|&jd| (self.minute(jd), true));
        let mut crossings: Vec<(f64, bool)> =
            rises.chain(events.sets.iter().map(|&jd| (self.minute(jd), false))).collect();
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let up_at_start = match crossings.first() {
            Some(&(_, is_rise)) => !is_rise,
            None => self.elevation_deg(0.5 * (from + to))? > 0.0,
        };
        let mut rise = up_at_start.then_some(from);
        let mut daylight = Vec::new();
        for (minute, is_rise) in crossings {
            if is_rise {
                rise = rise.or(Some(minute));
            } else if let Some(risen) = rise.take() {
                daylight.push([risen, minute]);
            }
        }
        daylight.extend(rise.map(|risen| [risen, to]));
        daylight.retain(|[rise, set]| rise < set);
        Ok(daylight)
    }

    /// The minute, between two given ones, at which the sun is highest, and its elevation in degrees.
    pub fn highest(&self, [from, to]: [f64; 2]) -> Result<[f64; 2], EphemerisError> {
        const COARSE: u32 = 96;
        let step = (to - from) / f64::from(COARSE);
        let mut best = [from, self.elevation_deg(from)?];
        for i in 1..=COARSE {
            best = self.higher(best, from + step * f64::from(i))?;
        }
        // The elevation has one peak near the best sample: search it with halved steps.
        let mut reach = 0.5 * step;
        while reach > 0.01 {
            let middle = best[0];
            best = self.higher(best, (middle - reach).max(from))?;
            best = self.higher(best, (middle + reach).min(to))?;
            reach *= 0.5;
        }
        Ok(best)
    }

    fn higher(&self, best: [f64; 2], minute: f64) -> Result<[f64; 2], EphemerisError> {
        let elevation = self.elevation_deg(minute)?;
        Ok(if elevation > best[1] { [minute, elevation] } else { best })
    }

    fn jd(&self, minute: f64) -> f64 {
        self.midnight_jd + minute / DAY_MIN
    }

    fn minute(&self, jd: f64) -> f64 {
        (jd - self.midnight_jd) * DAY_MIN
    }
}
