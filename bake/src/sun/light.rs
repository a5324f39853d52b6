//! A scene's own directional light as a sun, if no place is given.
//!
//! Theory: one direction does not determine a latitude or a season. The simplest symmetric path through it is the great
//! circle from horizon to horizon with its highest point in the light's direction.
//!
//! Practice: the light is at t = 0.5. At t = 0 the path is on the horizon a quarter turn to the left of the light's
//! azimuth, at t = 1 a quarter turn to the right. For a light in the south that is from east to west, like the sun on
//! the northern hemisphere. A light straight overhead goes from east (+X) to west. The path lasts twelve hours, as long
//! as the real sun needs for half a turn.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::duration_min_of_angle;
use super::{PathError, SunArc, SunPath};

/// Why a light cannot be used as a sun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LightError {
    /// The direction is zero or not finite.
    #[error("the light's direction {0} is no direction: check its node's matrix")]
    Direction(DVec3),
    /// The light shines upwards or horizontally.
    #[error("the light stands {elevation_deg:.2} degrees above the horizon, so it is no sun: aim it down")]
    BelowHorizon {
        /// Elevation of the direction towards the light, in degrees.
        elevation_deg: f64,
    },
    /// The angular radius is out of range.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// The great circle through a light's direction, as a path. `towards_light` points from the scene to the light, in
/// world space, with any length. (A glTF light shines along its node's -Z, so this is the node's +Z.)
pub fn fixed_light(towards_light: DVec3, angular_radius_rad: f64) -> Result<SunPath, LightError> {
    let Some(zero) = towards_light.try_normalize() else {
        return Err(LightError::Direction(towards_light));
    };
    if zero.y <= 0.0 {
        return Err(LightError::BelowHorizon { elevation_deg: zero.y.asin().to_degrees() });
    }
    let south = DVec3::Z;
    let level = DVec3::new(zero.x, 0.0, zero.z).try_normalize().unwrap_or(south);
    let start = DVec3::Y.cross(level);
    let axis = start.cross(zero).normalize();
    let arc = SunArc { axis, zero, declination_rad: 0.0, hour_angle_rad: [-FRAC_PI_2, FRAC_PI_2], t: [0.0, 1.0] };
    Ok(SunPath::new(vec![arc], angular_radius_rad, duration_min_of_angle(PI))?)
}
