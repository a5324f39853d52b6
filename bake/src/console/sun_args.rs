//! The options that choose a sun by place and day.

use super::Failure;
use super::clock_offset::{ClockOffset, parse_clock_offset};
use crate::settings::SunRequest;
use crate::sun::{Date, DayRequest, parse_place};
use clap::Args;

fn parse_north(text: &str) -> Result<f64, String> {
    let valid = |degrees: &f64| degrees.abs() <= 360.0;
    text.parse().ok().filter(valid).ok_or_else(|| format!("`{text}` is no direction: give degrees from -360 to 360"))
}

/// The sun over a scene.
#[derive(Debug, Clone, Args)]
pub struct SunArgs {
    /// Degrees north and east, as 48.2,16.4. [default: the scene's directional light, or else 40,0]
    #[arg(long, value_name = "LAT,LON", value_parser = parse_place, allow_hyphen_values = true)]
    pub place: Option<[f64; 2]>,
    /// Local date, of a day at --place instead of the scene's directional light. [default: 2026-06-21]
    ///
    /// The path runs from sunrise to sunset of that day, unless a window is given. Sunrise and sunset are those of the
    /// centre of the sun's disc on a level horizon, without refraction.
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub date: Option<Date>,
    /// Hours that local clocks are ahead of UTC, -12 to 14, as -8, 5.75 or 5:45; or a time zone by name, as
    /// Europe/Vienna, with its summer time. [default: the whole hour nearest to the place]
    #[arg(long, value_name = "H|ZONE", value_parser = parse_clock_offset, allow_hyphen_values = true)]
    pub utc_offset: Option<ClockOffset>,
    /// Degrees that north is turned from -Z towards +X, -360 to 360. [default: 0]
    #[arg(long, value_name = "DEG", value_parser = parse_north, allow_hyphen_values = true)]
    pub north: Option<f64>,
}

impl SunArgs {
    /// Whether any of it is given.
    pub fn is_given(&self) -> bool {
        self.names_a_day() || self.north.is_some()
    }

    fn names_a_day(&self) -> bool {
        self.place.is_some() || self.date.is_some() || self.utc_offset.is_some()
    }

    /// Degrees that north is turned from -Z towards +X.
    pub fn north_deg(&self) -> f64 {
        self.north.unwrap_or(0.0)
    }

    /// The sun that is asked for: this day, or, where nothing names one, the scene's own light. `window` is minutes
    /// after local midnight.
    pub fn request(&self, window: Option<[f64; 2]>) -> Result<SunRequest, Failure> {
        let day = DayRequest::new(self.place, self.date)?;
        let utc_offset_h = self.utc_offset.as_ref().map(|offset| offset.hours_on(day.date)).transpose()?;
        let day = DayRequest { utc_offset_h, north_deg: self.north_deg(), window, ..day };
        let is_day = self.names_a_day() || window.is_some();
        Ok(if is_day { SunRequest::Day(day) } else { SunRequest::SceneOr(day) })
    }
}
