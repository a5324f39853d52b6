//! How far casters and receivers reach along a light's axes: what a map has to hold.

use super::ground::Ground;
use super::projection::{LightAxes, LightBounds};
use crate::stage::Stage;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// How many points are sampled on drawn triangles.
const SAMPLES: usize = 4096;

/// Space above the highest receiver, as a share of all heights. It keeps every receiver's depth away from 0, also after
/// the division by a perspective map's `w`.
pub const HEADROOM: f64 = 1.0 / 256.0;

/// Casters and receivers of a stage, gathered once.
#[derive(Debug, Clone)]
pub struct ShadowScene {
    /// The lowest large level plane, which may be absent.
    pub ground: Ground,
    /// Corners of casting triangles.
    casters_m: Vec<Vec3>,
    /// Corners of drawn triangles.
    receivers_m: Vec<Vec3>,
    /// The bounding box of drawn triangles, bake space. None where nothing is drawn.
    pub receiver_box_m: Option<[DVec3; 2]>,
    /// Centres of some drawn triangles, evenly picked.
    pub samples_m: Vec<DVec3>,
    /// Bounding boxes of drawn triangles.
    boxes_m: Vec<[Vec3; 2]>,
}

impl ShadowScene {
    /// Gathers those of a stage.
    pub fn new(stage: &Stage) -> Self {
        let ground = Ground::new(stage);
        let triangles = &stage.geometry.triangles;
        let all = 0..triangles.len();
        let casts = |i: &usize| ground.lets_cast(*i) && stage.geometry.casts(&stage.scene, *i);
        let is_drawn = |i: &usize| !stage.sides(*i).is_none();
        let casters_m = all.clone().filter(casts).flat_map(|i| triangles[i]).collect();
        let receivers_m: Vec<Vec3> = all.filter(is_drawn).flat_map(|i| triangles[i]).collect();
        let bounds_of = |corners: &[Vec3]| {
            let start = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            corners.iter().fold(start, |[low, high], p| [low.min(*p), high.max(*p)])
        };
        let bounds = bounds_of(&receivers_m);
        let step = (receivers_m.len() / 3).div_ceil(SAMPLES).max(1);
        let middle = |corners: &[Vec3]| corners.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / 3.0;
        Self {
            samples_m: receivers_m.chunks_exact(3).step_by(step).map(middle).collect(),
            receiver_box_m: (!receivers_m.is_empty()).then(|| bounds.map(|p| p.as_dvec3())),
            boxes_m: receivers_m.chunks(3).map(bounds_of).collect(),
            ground,
            casters_m,
            receivers_m,
        }
    }

    /// Whether any triangle casts.
    pub fn has_casters(&self) -> bool {
        !self.casters_m.is_empty()
    }

    /// Distance from a point to the nearest drawn triangle's box, in metres; 0 inside one.
    pub fn nearest_m(&self, point_m: DVec3) -> f64 {
        let to_box = |[low, high]: &[Vec3; 2]| point_m.clamp(low.as_dvec3(), high.as_dvec3()).distance(point_m);
        self.boxes_m.iter().map(to_box).fold(f64::INFINITY, f64::min)
    }

    /// How far casters and receivers reach along the axes of a sun.
    pub fn extents(&self, towards: DVec3) -> Extents {
        let axes = LightAxes::new(towards);
        Extents { axes, casters: along(&axes, &self.casters_m), receivers: along(&axes, &self.receivers_m) }
    }
}

fn along(axes: &LightAxes, points_m: &[Vec3]) -> LightBounds {
    let with = |mut bounds: LightBounds, point: &Vec3| {
        bounds.add(axes.along(point.as_dvec3()));
        bounds
    };
    let join = |a: LightBounds, b: LightBounds| LightBounds { low: a.low.min(b.low), high: a.high.max(b.high) };
    let chunks = points_m.par_chunks(1 << 14);
    chunks.map(|chunk| chunk.iter().fold(LightBounds::EMPTY, with)).reduce(|| LightBounds::EMPTY, join)
}

/// How far casters and receivers reach along a light's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extents {
    /// Axes across the light and towards it.
    pub axes: LightAxes,
    /// Bounds of casters along the axes.
    pub casters: LightBounds,
    /// Bounds of drawn triangles.
    pub receivers: LightBounds,
}

/// Where a map's depths begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Near {
    /// At the highest receiver. Casters above it are drawn at depth 0, by depth clamp.
    Receivers,
    /// Above all casters.
    Casters,
}

impl Extents {
    /// Bounds of what can be in shadow: what lies under some caster, seen along the light. None where nothing does.
    pub fn shaded(&self, near: Near) -> Option<LightBounds> {
        if self.casters.is_empty() || self.receivers.is_empty() {
            return None;
        }
        let mut bounds = LightBounds {
            low: self.casters.low.max(self.receivers.low),
            high: self.casters.high.min(self.receivers.high),
        };
        bounds.low.z = self.receivers.low.z;
        bounds.high.z = self.high_m(near);
        (!bounds.is_empty() && self.casters.high.z >= bounds.low.z).then_some(bounds)
    }

    /// The height towards the sun where depths begin. It is a little above the highest receiver (or caster), since
    /// depth 0 is for casters above that.
    pub fn high_m(&self, near: Near) -> f64 {
        let above_m = HEADROOM * self.receivers.size().z;
        match near {
            Near::Receivers => self.receivers.high.z + above_m,
            Near::Casters => self.receivers.high.z.max(self.casters.high.z) + above_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use sunbake::testing::{SceneBuilder, block, floor};

    /// The extents of a roof over a wide ground. Heights are relative to the ground.
    fn extents(roof_at_m: f32, towards: DVec3) -> Extents {
        let roof = block(Vec3::new(-1.0, roof_at_m, -1.0), Vec3::new(1.0, roof_at_m + 0.5, 1.0));
        let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-50.0), Vec2::splat(50.0), 0.0)).soup(&roof).build();
        let middle_m = scene.centre_m.y;
        let mut found = ShadowScene::new(&Stage::plain(scene, None)).extents(towards);
        for bounds in [&mut found.casters, &mut found.receivers] {
            (bounds.low.z, bounds.high.z) = (bounds.low.z + middle_m, bounds.high.z + middle_m);
        }
        found
    }

    #[test]
    fn a_map_holds_what_lies_under_a_caster_and_leaves_out_the_ground_around() {
        let found = extents(3.0, DVec3::Y);
        let bounds = found.shaded(Near::Casters).unwrap();
        assert!(bounds.size().abs_diff_eq(DVec3::new(2.0, 2.0, 3.5 * (1.0 + HEADROOM)), 1e-5), "{bounds:?}");
        assert!((bounds.low.z).abs() < 1e-5 && (bounds.high.z - 3.5).abs() < 0.02);
    }

    #[test]
    fn without_casters_there_is_no_map() {
        let ground = SceneBuilder::new().soup(&floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0)).build();
        let found = ShadowScene::new(&Stage::plain(ground, None)).extents(DVec3::new(0.1, 1.0, 0.3));
        assert_eq!(found.shaded(Near::Receivers), None);
        let empty = ShadowScene::new(&Stage::plain(SceneBuilder::new().build(), None));
        assert_eq!((empty.extents(DVec3::Y).shaded(Near::Casters), empty.receiver_box_m), (None, None));
    }
}
