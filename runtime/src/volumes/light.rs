//! Which triangles face the light. That is decided once for each triangle, in `f64`, and used by its edges and caps
//! alike, so that rounding cannot open a volume.

use super::bodies::cross;
use super::casters::{Caster, Casters};
use super::nearest::distance_m;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// A light without size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// Infinitely far away: its rays are parallel.
    Sun {
        /// Unit vector towards it.
        towards: DVec3,
    },
    /// A point in the scene.
    Lamp {
        /// Its position in bake space, in metres.
        position_m: DVec3,
        /// Distance beyond which it gives no light, in metres. None: infinite.
        range_m: Option<f64>,
    },
}

/// Which of the casters' triangles face a light.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Facings {
    /// For each triangle, how its prism counts: 1 where its front faces the light and casts, -1 where its back does and
    /// casts, 0 where it casts nothing.
    pub of_triangle: Vec<i8>,
    /// For each caster, whether its front faces alone cast its whole shadow: it bounds solids, and the light is inside
    /// none of them.
    pub is_solid: Vec<bool>,
    /// For each triangle, whether its own solid is not to shade it: it turns away from the light, and something smooth
    /// rises over it.
    pub is_spared: Vec<bool>,
}

impl Facings {
    /// The same, but that only some triangles cast.
    pub fn within(&self, triangles: &Range<usize>) -> Self {
        let mut within = self.clone();
        for triangle in (0..self.of_triangle.len()).filter(|triangle| !triangles.contains(triangle)) {
            (within.of_triangle[triangle], within.is_spared[triangle]) = (0, false);
        }
        within
    }
}

/// Distance from a triangle below which rounding hides on which side of it a lamp is, in `f32` steps of the largest
/// coordinate.
const TOUCH_STEPS: f64 = 8.0;
/// A step of an `f32`, as a share of its value.
const STEP: f64 = 1.0 / (1 << 23) as f64;

impl Light {
    /// Above zero where a triangle's front faces the light, below zero where its back does, zero where it is edge on. A
    /// lamp that is nearer to the triangle's plane than rounding counts as being in it.
    fn front(&self, corners: &[DVec3; 3]) -> f64 {
        let normal = cross(corners);
        match self {
            Self::Sun { towards } => normal.dot(*towards),
            Self::Lamp { position_m, .. } => {
                let front = normal.dot(*position_m - corners[0]);
                if front.abs() <= normal.length() * touch_m(*position_m, corners[0]) { 0.0 } else { front }
            }
        }
    }

    /// Whether the light has a finite range.
    pub fn has_range(&self) -> bool {
        matches!(self, Self::Lamp { range_m: Some(_), .. })
    }

    fn sees_solid(&self, casters: &Casters, caster: &Caster) -> bool {
        caster.is_solid
            && match self {
                Self::Sun { .. } => true,
                Self::Lamp { position_m, .. } => !is_inside(casters, caster, *position_m),
            }
    }

    /// Which triangles face the light, and how. Back faces of solids cast nothing that front faces do not; with
    /// `omits_back_faces_of_solids` they are left out, and always those of smooth solids, which are to hold each spared
    /// triangle once. Triangles that are edge on have no prism.
    pub fn facings(&self, casters: &Casters, omits_back_faces_of_solids: bool) -> Facings {
        let is_solid: Vec<bool> = casters.all.par_iter().map(|caster| self.sees_solid(casters, caster)).collect();
        let of_caster = |(caster, &is_solid): (&Caster, &bool)| {
            let omits_backs = is_solid && (omits_back_faces_of_solids || caster.is_smooth);
            caster.triangles.clone().into_par_iter().with_min_len(1024).map(move |triangle| {
                let front = self.front(&casters.corners_m(triangle));
                let facing = i8::from(front > 0.0) - i8::from(front < 0.0 && !omits_backs);
                (facing, front < 0.0 && is_solid && casters.is_risen_over[triangle])
            })
        };
        let (of_triangle, is_spared) = casters.all.par_iter().zip(&is_solid).flat_map(of_caster).unzip();
        Facings { of_triangle, is_solid, is_spared }
    }
}

/// Distance below which two points count as one.
fn touch_m(a: DVec3, b: DVec3) -> f64 {
    TOUCH_STEPS * STEP * a.abs().max(b.abs()).max_element()
}

/// Directions to all sides, so irregular that rays through typical models hit no edges.
const DIRECTIONS: [DVec3; 4] = [
    DVec3::new(0.532_1, 0.717_3, 0.449_7),
    DVec3::new(-0.671_9, 0.288_3, -0.682_3),
    DVec3::new(0.193_7, -0.871_1, 0.451_3),
    DVec3::new(-0.247_1, -0.183_9, 0.951_4),
];

/// Whether a point may be inside one of a caster's bodies, or on its surface: some ray from it leaves more often than
/// it enters, or a triangle is too near to decide.
fn is_inside(casters: &Casters, caster: &Caster, point_m: DVec3) -> bool {
    let [low, high] = caster.bounds_m;
    let reach_m = touch_m(point_m, low.abs().max(high.abs()));
    if point_m.cmplt(low - reach_m).any() || point_m.cmpgt(high + reach_m).any() {
        return false;
    }
    let touches = |triangle: usize| distance_m(&casters.corners_m(triangle), point_m) <= reach_m;
    let winding = |direction: &DVec3| -> i32 {
        caster.triangles.clone().map(|triangle| crossing(&casters.corners_m(triangle), point_m, *direction)).sum()
    };
    caster.triangles.clone().any(touches) || DIRECTIONS.iter().any(|direction| winding(direction) != 0)
}

/// +1 where a ray leaves through a triangle's front, -1 where it enters, 0 where it misses.
fn crossing(corners: &[DVec3; 3], from: DVec3, direction: DVec3) -> i32 {
    let [a, b, c] = corners.map(|corner| corner - from);
    let sides = [direction.dot(b.cross(a)), direction.dot(c.cross(b)), direction.dot(a.cross(c))];
    let normal = (b - a).cross(c - a);
    let ahead = a.dot(normal) * direction.dot(normal);
    let leaves = sides.iter().all(|&side| side < 0.0);
    let enters = sides.iter().all(|&side| side > 0.0);
    if ahead > 0.0 { i32::from(leaves) - i32::from(enters) } else { 0 }
}
