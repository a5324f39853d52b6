//! A scene's own directional light as a sun, where no place is given.
//!
//! Theory: one direction is a moment, not a path, and from a moment nobody can tell the latitude or the season. The
//! simplest path that passes through it, treats both of its sides alike and has the light at its best is the great
//! circle from horizon to horizon with the light's direction highest.
//!
//! Practice: the light is at t = 0.5; t = 0 is on the horizon a quarter turn to the left of its azimuth and t = 1 a
//! quarter turn to the right (seen from the scene: for a light in the south that is east to west, the way of the
//! northern sun). A light straight overhead has no azimuth and goes from east (+X) to west. Half a turn lasts twelve
//! hours, as the real sun would take.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::duration_min_of_angle;
use super::{PathError, SunArc, SunPath};

/// Why a light makes no sun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LightError {
    /// Zero or not finite.
    #[error("the light's direction {0} is no direction: check its node's matrix")]
    Direction(DVec3),
    /// Shines upwards or level.
    #[error("the light stands {elevation_deg:.2} degrees above the horizon, so it is no sun: aim it down")]
    BelowHorizon {
        /// Elevation of the direction towards the light.
        elevation_deg: f64,
    },
    /// The disc is no size.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// The great circle over a light, as a path. `towards_light` points from the scene to the light, world space, any
/// length (a glTF light shines along its node's -Z, so that is the node's +Z).
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
