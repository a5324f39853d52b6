//! A sun path from a path file: directions at given times, joined by great circles.
//!
//! ```json
//! { "angular_radius_deg": 0.27, "duration_min": 600,
//!   "keys": [ { "t": 0, "azimuth_deg": 90, "elevation_deg": 5 },
//!             { "t": 0.4, "direction": [0, 1, 0.3] },
//!             { "t": 1, "azimuth_deg": 270, "elevation_deg": 5 } ] }
//! ```
//!
//! Directions point from the scene to the light: either `direction` in world space (any length), or an azimuth (from
//! north towards east) with an elevation. Between two keys the light moves at constant speed along the shorter great
//! circle, which is an arc of declination zero, so every engine for days can bake it. `t` runs from 0 to 1; if no key
//! has a `t`, keys are evenly spaced. The default of `duration_min` is the time in which the real sun turns through the
//! same angle.

use glam::DVec3;
use serde::Deserialize;

use super::keys::{KeyError, key_times};
use super::{Compass, PathError, SUN_ANGULAR_RADIUS_DEG, SunArc, SunPath, duration_min_of_angle};

/// Smallest angle between neighbouring keys, and between a key and the opposite of its neighbour, in degrees.
const MIN_ANGLE_DEG: f64 = 0.001;

/// Why a path file is not a sun path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum KeyedError {
    /// The keys themselves are wrong.
    #[error(transparent)]
    Keys(#[from] KeyError),
    /// A lamp's path where a sun's was asked for.
    #[error("the path file has '{0}', and a sun's path has directions only: a lamp's has a 'position' in every key")]
    Positions(&'static str),
    /// A size out of range.
    #[error("{name} is {value}: give a number {bound}")]
    Size {
        /// The file's name for it.
        name: &'static str,
        /// The value in the file.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// North is turned by an angle that is not finite.
    #[error("north turned by {0} degrees is no direction: give a finite angle")]
    North(f64),
    /// The light never rises above the horizon.
    #[error("the path stays below the horizon (+Y is up), so nothing would be lit: directions must point to the light")]
    BelowHorizon,
    /// The arcs are not a valid path.
    #[error(transparent)]
    Path(#[from] PathError),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SunPathFile {
    angular_radius_deg: Option<f64>,
    duration_min: Option<f64>,
    #[serde(default)]
    keys: Vec<SunPathKey>,
    positions: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SunPathKey {
    t: Option<f64>,
    direction: Option<[f64; 3]>,
    azimuth_deg: Option<f64>,
    elevation_deg: Option<f64>,
    position: Option<serde::de::IgnoredAny>,
}

/// Parses a path file. `north_deg` rotates azimuths as in [`Compass::new`]; `direction` keys are not changed.
pub fn parse_keyed(json: &str, north_deg: f64) -> Result<SunPath, KeyedError> {
    let file: SunPathFile = serde_json::from_str(json).map_err(|error| KeyError::Json(error.to_string()))?;
    if file.positions.is_some() {
        return Err(KeyedError::Positions("positions"));
    }
    if file.keys.iter().any(|key| key.position.is_some()) {
        return Err(KeyedError::Positions("position"));
    }
    let given: Vec<Option<f64>> = file.keys.iter().map(|key| key.t).collect();
    let times = key_times(&given)?;
    let angular_radius_deg = file.angular_radius_deg.unwrap_or(SUN_ANGULAR_RADIUS_DEG);
    if !(0.0..90.0).contains(&angular_radius_deg) {
        let bound = "of at least 0 and under 90";
        return Err(KeyedError::Size { name: "angular_radius_deg", value: angular_radius_deg, bound });
    }
    if let Some(value) = file.duration_min.filter(|minutes| !(*minutes > 0.0 && minutes.is_finite())) {
        return Err(KeyedError::Size { name: "duration_min", value, bound: "above 0" });
    }
    if !north_deg.is_finite() {
        return Err(KeyedError::North(north_deg));
    }
    let arcs = arcs(&directions(&file.keys, &Compass::new(north_deg))?, &times)?;
    let swept_rad: f64 = arcs.iter().map(|arc| arc.hour_angle_rad[1]).sum();
    let duration_min = file.duration_min.unwrap_or(duration_min_of_angle(swept_rad));
    let path = SunPath::new(arcs, angular_radius_deg.to_radians(), duration_min)?;
    if path.above_horizon(DVec3::Y).as_slice().is_empty() {
        return Err(KeyedError::BelowHorizon);
    }
    Ok(path)
}

/// Unit directions of the keys, world space.
fn directions(keys: &[SunPathKey], compass: &Compass) -> Result<Vec<DVec3>, KeyError> {
    let one = |(index, key): (usize, &SunPathKey)| {
        let wrong = |problem: &str| KeyError::Key { index, problem: problem.to_owned() };
        match (key.direction, key.azimuth_deg, key.elevation_deg) {
            (Some(direction), None, None) => DVec3::from_array(direction)
                .try_normalize()
                .ok_or_else(|| wrong("has a direction without length: give one that points to the light")),
            (None, Some(azimuth), Some(elevation)) if (-90.0..=90.0).contains(&elevation) && azimuth.is_finite() => {
                Ok(compass.direction(azimuth, elevation))
            }
            (None, Some(_), Some(elevation)) => {
                Err(wrong(&format!("has an elevation of {elevation} degrees: give -90..=90")))
            }
            _ => Err(wrong("needs either 'direction' or both 'azimuth_deg' and 'elevation_deg'")),
        }
    };
    keys.iter().enumerate().map(one).collect()
}

/// Great circle arcs between neighbouring keys.
fn arcs(directions: &[DVec3], times: &[f64]) -> Result<Vec<SunArc>, KeyError> {
    let one = |(index, pair): (usize, &[DVec3])| {
        let [zero, end] = [pair[0], pair[1]];
        let across = zero.cross(end);
        let angle = across.length().atan2(zero.dot(end));
        let wrong = |problem: String| Err(KeyError::Pair { index, problem });
        if angle.to_degrees() < MIN_ANGLE_DEG {
            let problem = "point in the same direction: a light that does not move has no path; remove one of them";
            return wrong(problem.to_owned());
        }
        if angle.to_degrees() > 180.0 - MIN_ANGLE_DEG {
            return wrong(
                "point in opposite directions, which any great circle joins: put a key between them".to_owned(),
            );
        }
        let axis = across.normalize().reject_from_normalized(zero).normalize();
        let t = [times[index], times[index + 1]];
        Ok(SunArc { axis, zero, declination_rad: 0.0, hour_angle_rad: [0.0, angle], t })
    };
    directions.windows(2).enumerate().map(one).collect()
}
