//! Directions over the sun's disc.

use glam::DVec3;

/// The angle between successive points of the spiral: a full turn over the square of the golden ratio.
pub const GOLDEN_ANGLE_RAD: f64 = 2.399_963_229_728_653;

/// The sun's disc: directions within an angle of its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunDisc {
    /// Unit vector towards the sun's centre.
    pub centre: DVec3,
    across: [DVec3; 2],
    radius_rad: f64,
}

impl SunDisc {
    /// A disc of this angular radius around a unit vector.
    pub fn new(centre: DVec3, radius_rad: f64) -> Self {
        Self { centre, across: centre.any_orthonormal_pair().into(), radius_rad }
    }

    /// The direction of ray `i` of `count`, even by area over the disc. `turn` rotates the spiral, in radians.
    pub fn direction(&self, i: u32, count: u32, turn: f64) -> DVec3 {
        let share = (f64::from(i) + 0.5) / f64::from(count);
        let from_centre = 1.0 - (1.0 - self.radius_rad.cos()) * share;
        let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE_RAD + turn).sin_cos();
        let across = self.across[0] * cos + self.across[1] * sin;
        (self.centre * from_centre + across * (1.0 - from_centre * from_centre).max(0.0).sqrt()).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_cover_the_disc_evenly_and_no_more() {
        let sun = SunDisc::new(DVec3::new(0.3, 0.8, -0.2).normalize(), 0.1);
        let directions: Vec<DVec3> = (0..4096).map(|i| sun.direction(i, 4096, 0.7)).collect();
        assert!(directions.iter().all(|d| d.angle_between(sun.centre) <= 0.1 + 1e-9));
        let within_half = directions.iter().filter(|d| d.angle_between(sun.centre) < 0.05).count();
        assert!((within_half as f64 / 4096.0 - 0.25).abs() < 0.01);
        let on_one_side = directions.iter().filter(|d| d.dot(sun.across[0]) > 0.0).count();
        assert!((on_one_side as f64 / 4096.0 - 0.5).abs() < 0.01);
    }
}
