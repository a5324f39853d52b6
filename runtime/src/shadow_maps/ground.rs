//! The ground: the lowest of the large level planes of a scene that are seen from above, and the triangles that lie in
//! it.
//!
//! Two variants draw shadows on it alone. A ground with nothing below it casts no shadow, since every ray that it
//! blocks would arrive from below. It is left out of every map then.

use crate::stage::Stage;
use std::collections::BTreeMap;

/// Least cosine between the normal of a level triangle and the vertical.
const LEAST_LEVEL_COS: f64 = 0.999_9;
/// Least area of the ground, as a share of the largest level plane's area.
const LEAST_AREA_SHARE: f64 = 0.25;
/// Distance from a plane within which points count as lying in it, as a share of the scene's size: as far as rounding
/// moves them.
const PLANE_TOLERANCE_SHARE: f64 = 1e-6;

/// The ground of a stage.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ground {
    /// Height of the plane, bake space. None where no drawn triangle is level.
    pub height_m: Option<f64>,
    /// For each triangle, whether it lies in the plane and is drawn from above. Empty without a plane.
    holds: Vec<bool>,
    /// Height above which triangles cast on it, bake space. Triangles in the plane do not, on whichever side they are
    /// drawn.
    pub casts_from_m: f64,
    /// Whether the ground can shade something, because something is below it.
    pub casts: bool,
}

impl Ground {
    /// The ground of a stage.
    pub fn new(stage: &Stage) -> Self {
        let triangles = &stage.geometry.triangles;
        let tolerance_m = PLANE_TOLERANCE_SHARE * stage.scene.half_extent_m.max_element().max(1e-30);
        let is_level = |i: usize| {
            let (up, sides) = (stage.geometry.normal(i).y, stage.sides(i));
            (up > LEAST_LEVEL_COS && sides.front) || (up < -LEAST_LEVEL_COS && sides.back)
        };
        let height_of = |i: usize| triangles[i].iter().map(|p| f64::from(p.y)).sum::<f64>() / 3.0;
        // Planes are grouped by heights rounded to that distance. One plane may fall into two groups; the larger one
        // wins.
        let mut areas: BTreeMap<i64, (f64, f64)> = BTreeMap::new();
        for i in (0..triangles.len()).filter(|&i| is_level(i)) {
            let [a, b, c] = triangles[i].map(|p| p.as_dvec3());
            let area = areas.entry((height_of(i) / (4.0 * tolerance_m)).round() as i64).or_default();
            *area = (area.0 + (b - a).cross(c - a).length(), height_of(i));
        }
        // The lowest of the large planes: a roof may be larger than the ground.
        let largest = areas.values().map(|(area, _)| *area).fold(0.0, f64::max);
        let Some(&(_, height_m)) = areas.values().find(|(area, _)| *area >= LEAST_AREA_SHARE * largest) else {
            return Self::default();
        };
        let in_plane = |p: &glam::Vec3| (f64::from(p.y) - height_m).abs() <= 4.0 * tolerance_m;
        let holds = (0..triangles.len()).map(|i| is_level(i) && triangles[i].iter().all(in_plane)).collect();
        let is_below = |p: &glam::Vec3| f64::from(p.y) < height_m - 4.0 * tolerance_m;
        let is_there = |i: &usize| !stage.sides(*i).is_none();
        let casts = (0..triangles.len()).filter(is_there).any(|i| triangles[i].iter().any(is_below));
        Self { height_m: Some(height_m), casts_from_m: height_m + 4.0 * tolerance_m, holds, casts }
    }

    /// Whether a triangle lies in the plane.
    pub fn holds(&self, triangle: usize) -> bool {
        self.holds.get(triangle).is_some_and(|&holds| holds)
    }

    /// Whether a solid triangle may cast: all do, except a ground with nothing below it.
    pub fn lets_cast(&self, triangle: usize) -> bool {
        self.casts || !self.holds(triangle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};
    use sunbake::testing::{SceneBuilder, floor};

    fn ground(builder: SceneBuilder) -> Ground {
        Ground::new(&Stage::plain(builder.build(), None))
    }

    fn level() -> SceneBuilder {
        SceneBuilder::new().soup(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0))
    }

    #[test]
    fn the_largest_level_plane_is_the_ground_and_casts_only_on_what_is_below() {
        let table = || level().block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 1.0, 1.0));
        let found = ground(table());
        assert_eq!((found.holds.iter().filter(|&&h| h).count(), found.casts), (2, false), "{found:?}");
        let found = ground(table().block(Vec3::new(2.0, -1.0, 2.0), Vec3::new(3.0, -0.5, 3.0)));
        assert!(found.casts && found.lets_cast(0));
    }

    #[test]
    fn what_is_not_level_is_no_ground() {
        let slope = [[Vec3::ZERO, Vec3::new(1.0, 0.2, 0.0), Vec3::Z]];
        let found = ground(SceneBuilder::new().soup(&slope));
        assert!(found.height_m.is_none() && found.lets_cast(0) && !found.holds(0));
    }
}
