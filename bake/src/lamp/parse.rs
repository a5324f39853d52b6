//! A lamp path from a path file: positions at given times, joined by straight lines.
//!
//! ```json
//! { "radius_m": 0.05, "duration_min": 10,
//!   "keys": [ { "t": 0, "position": [0, 2, 0] },
//!             { "t": 0.25, "position": [3, 2, 0] },
//!             { "t": 1, "position": [3, 2, -4] } ] }
//! ```
//!
//! Positions are in world space, in metres. `t` runs from 0 to 1; if no key has a `t`, keys are evenly spaced.
//! Defaults: a radius of 5 cm, a duration of one minute.

use super::{LampError, LampKey, LampPath};
use crate::sun::{KeyError, key_times};
use glam::DVec3;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// Default radius, in metres.
const RADIUS_M: f64 = 0.05;
/// Default duration, in minutes.
const DURATION_MIN: f64 = 1.0;

/// Why a path file is not a lamp path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LampFileError {
    /// The keys themselves are wrong.
    #[error(transparent)]
    Keys(#[from] KeyError),
    /// The file is a sun path.
    #[error("the lamp's path file has {0}")]
    OfSun(&'static str),
    /// The positions are not a valid path.
    #[error(transparent)]
    Path(#[from] LampError),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LampPathFile {
    radius_m: Option<f64>,
    duration_min: Option<f64>,
    #[serde(default)]
    keys: Vec<LampPathKey>,
    angular_radius_deg: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LampPathKey {
    t: Option<f64>,
    position: Option<[f64; 3]>,
    direction: Option<IgnoredAny>,
    azimuth_deg: Option<IgnoredAny>,
    elevation_deg: Option<IgnoredAny>,
}

/// Whether a path file is meant for a lamp: some key has a position, or the file has a radius. [`parse_lamp`] then
/// checks the rest.
pub fn is_lamp(json: &str) -> bool {
    let Ok(file) = serde_json::from_str::<serde_json::Value>(json) else { return false };
    let has_position = |key: &serde_json::Value| key.get("position").is_some();
    file.get("radius_m").is_some() || file["keys"].as_array().is_some_and(|keys| keys.iter().any(has_position))
}

/// Parses a lamp's path file. Positions are in world space.
pub fn parse_lamp(json: &str) -> Result<LampPath, LampFileError> {
    let file: LampPathFile = serde_json::from_str(json).map_err(|error| KeyError::Json(error.to_string()))?;
    if file.angular_radius_deg.is_some() {
        return Err(LampFileError::OfSun("'angular_radius_deg', which a sun has: give a lamp 'radius_m'"));
    }
    let given: Vec<Option<f64>> = file.keys.iter().map(|key| key.t).collect();
    let times = key_times(&given)?;
    let keys: Result<Vec<LampKey>, KeyError> =
        file.keys.iter().enumerate().map(|(index, key)| lamp_key(index, key, times[index])).collect();
    let (radius_m, duration_min) = (file.radius_m.unwrap_or(RADIUS_M), file.duration_min.unwrap_or(DURATION_MIN));
    Ok(LampPath::new(keys?, radius_m, duration_min)?)
}

fn lamp_key(index: usize, key: &LampPathKey, t: f64) -> Result<LampKey, KeyError> {
    let wrong = |problem: &str| KeyError::Key { index, problem: problem.to_owned() };
    if key.direction.is_some() || key.azimuth_deg.is_some() || key.elevation_deg.is_some() {
        return Err(wrong("has a direction, which a lamp does not use: give every key a 'position'"));
    }
    let position = key.position.ok_or_else(|| wrong("has no 'position': give metres of the scene, as [0, 2, 0]"))?;
    Ok(LampKey { t, position_m: DVec3::from_array(position) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = r#"{"keys": [{"position": [0, 1, 2]}, {"position": [3, 1, 2]}]}"#;

    #[test]
    fn keys_make_a_path() {
        let path = parse_lamp(TWO).unwrap();
        assert_eq!((path.radius_m(), path.duration_min()), (RADIUS_M, DURATION_MIN));
        assert_eq!(path.position_m(0.5), DVec3::new(1.5, 1.0, 2.0));
        let timed = r#"{"radius_m": 0, "duration_min": 7, "keys": [
            {"t": 0, "position": [0, 0, 0]}, {"t": 0.25, "position": [1, 0, 0]}, {"t": 1, "position": [1, 3, 0]}]}"#;
        let path = parse_lamp(timed).unwrap();
        assert_eq!((path.radius_m(), path.duration_min(), path.keys()[1].t), (0.0, 7.0, 0.25));
    }

    #[test]
    fn lamp_files_are_told_from_sun_files() {
        assert!(is_lamp(TWO) && is_lamp(r#"{"radius_m": 1}"#));
        for sun in ["", "[]", "{}", "7", r#"{"keys": 3}"#, r#"{"keys": [{"direction": [0, 1, 0]}]}"#] {
            assert!(!is_lamp(sun), "{sun}");
        }
    }

    #[test]
    fn invalid_files_are_refused_and_say_what_to_give() {
        for (json, expected) in [
            (r#"{"keys": [{"position": [0, 1, 2]}]}"#, "give 2 to"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"direction": [0, 1, 0]}]}"#, "give every key a 'position'"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"azimuth_deg": 9, "position": [0, 1, 0]}]}"#, "a direction"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"t": 1}]}"#, "give every key one, or none"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {}]}"#, "has no 'position'"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"position": [0, 1, 2]}]}"#, "does not move"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"position": [0, 1, 1e10]}]}"#, "-1e9 to 1e9"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"position": [0, 1, 1e999]}]}"#, "not understood"),
            (r#"{"keys": [{"position": [0, 1, 2]}, {"position": [0, 1]}]}"#, "not understood"),
            (r#"{"keys": [{"position": [0, 1, 2], "t": 0.5}, {"position": [0, 1, 9], "t": 1}]}"#, "first is at 0"),
            (r#"{"radius_m": -1, "keys": [{"position": [0, 1, 2]}, {"position": [0, 1, 9]}]}"#, "radius_m is -1"),
            (r#"{"duration_min": 0, "keys": [{"position": [0, 1, 2]}, {"position": [0, 1, 9]}]}"#, "above 0"),
            (r#"{"angular_radius_deg": 1, "keys": [{"position": [0, 1, 2]}]}"#, "give a lamp 'radius_m'"),
            (r#"{"positions": [[0, 1, 2], [0, 1, 9]]}"#, "positions"),
        ] {
            let message = parse_lamp(json).unwrap_err().to_string();
            assert!(message.contains(expected), "{json}: {message}");
        }
    }
}
