//! Azimuth and elevation to world directions.

use glam::DVec3;

/// North and east in the scene. +Y is up. Without rotation, north is -Z and east is +X.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compass {
    /// Unit vector, horizontal, world space.
    pub north: DVec3,
    /// Unit vector, horizontal, world space.
    pub east: DVec3,
}

impl Compass {
    /// A compass with north turned by `north_deg` from -Z towards +X (clockwise from above): at 90, north is +X and
    /// east +Z.
    pub fn new(north_deg: f64) -> Self {
        let (sin, cos) = north_deg.to_radians().sin_cos();
        Self { north: DVec3::new(sin, 0.0, -cos), east: DVec3::new(cos, 0.0, sin) }
    }

    /// Unit direction at an azimuth (degrees from north towards east) and an elevation (degrees above the horizon).
    pub fn direction(&self, azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
        let (sin_azimuth, cos_azimuth) = azimuth_deg.to_radians().sin_cos();
        let (sin_elevation, cos_elevation) = elevation_deg.to_radians().sin_cos();
        (self.north * cos_azimuth + self.east * sin_azimuth) * cos_elevation + DVec3::Y * sin_elevation
    }

    /// Azimuth in [0, 360) and elevation, in degrees, of a direction of any length. The azimuth of straight up is 0.
    pub fn azimuth_elevation_deg(&self, direction: DVec3) -> [f64; 2] {
        let [north, east] = [direction.dot(self.north), direction.dot(self.east)];
        let azimuth = east.atan2(north).to_degrees().rem_euclid(360.0);
        [if azimuth < 360.0 { azimuth } else { 0.0 }, direction.y.atan2(north.hypot(east)).to_degrees()]
    }
}
