//! What a frame need not draw. This is decided on the CPU, for whole casters, and does not change any pixel. (One
//! exception: surfaces just below a flat caster's plane. Volumes are moved away from the eye by a small distance, and
//! leaving such a volume out is right where drawing it would be wrong.)
//!
//! * A volume that misses the view.
//! * A volume that contains no surface in view, such as that of a ground with nothing under it.
//! * Caps that are out of view, and dark caps that are out of view.
//! * Pixels that show no surface: a scissor rectangle. wgpu has no depth bounds test.
//!
//! A caster can also do without caps (z-pass) where the eye is surely outside of its volume. That is so where the
//! caster does not reach into the *occlusion pyramid*, the convex hull of the view's near rectangle and the light.

use super::casters::{Caster, Casters, PLANE_TOLERANCE_SHARE};
use super::light::Light;
use crate::View;
use crate::stage::Stage;
use glam::DVec3;

/// A box with least and greatest coordinates, bake space.
pub type Aabb = [DVec3; 2];

/// How much wider than the near rectangle the pyramid is made, to allow for rounding.
const PYRAMID_MARGIN: f64 = 4.0;

/// How far a face may be moved across the line of sight, in pixels: by its bias, and as much again by rounding to the
/// raster.
const MOVED_PX: f64 = 1.0 / 64.0;
/// How far it may also be moved along the line of sight, as a share of its distance.
const MOVED_DEPTH: f64 = 4e-6;

fn corners(bounds: &Aabb) -> [DVec3; 8] {
    let pick = |i: usize, k: usize| bounds[i >> k & 1][k];
    std::array::from_fn(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2)))
}

/// The space that a camera sees.
#[derive(Debug, Clone)]
pub struct Frustum {
    eye_m: DVec3,
    forward: DVec3,
    /// Normals of the sides and of the plane through the eye, pointing out; all of them pass through the eye.
    outwards: [DVec3; 5],
    near_m: f64,
    /// How far from the eye a corner of the near rectangle is.
    near_reach_m: f64,
    /// How far rasterising and the bias may move a face, as a share of its distance from the eye.
    moved_share: f64,
}

impl Frustum {
    /// The frustum of a view.
    pub fn new(view: &View) -> Self {
        let [width, height] = view.size.map(f64::from);
        let (right, down) = (view.ray_per_column.as_dvec3() * width, view.ray_per_row.as_dvec3() * height);
        let first = view.ray_first.as_dvec3();
        let rays = [first, first + right, first + right + down, first + down];
        let forward = view.forward.as_dvec3();
        let side = |k: usize| {
            let normal = rays[k].cross(rays[(k + 1) % 4]).normalize_or_zero();
            let inside = rays[(k + 2) % 4].dot(normal);
            if inside > 0.0 { -normal } else { normal }
        };
        let near_m = f64::from(view.near_m());
        Self {
            eye_m: view.eye_m.as_dvec3(),
            forward,
            outwards: [side(0), side(1), side(2), side(3), -forward],
            near_m,
            near_reach_m: near_m * rays[0].length(),
            moved_share: f64::from(view.pixel_angle_rad) * MOVED_PX + MOVED_DEPTH,
        }
    }

    /// Whether no part of a box is in view.
    pub fn misses(&self, bounds: &Aabb) -> bool {
        let corners = corners(bounds);
        self.outwards.iter().any(|normal| corners.iter().all(|c| (*c - self.eye_m).dot(*normal) > 0.0))
    }

    /// Whether no part of a box and its shadow is in view.
    pub fn misses_volume(&self, bounds: &Aabb, light: &Light) -> bool {
        let corners = corners(bounds);
        self.outwards.iter().any(|normal| {
            let is_out = |c: &DVec3| (*c - self.eye_m).dot(*normal) > 0.0;
            corners.iter().all(is_out) && goes_along(&corners, light, *normal)
        })
    }

    /// Whether no part of the far end of a lamp's shadow is in view. False for a shadow that does not end at infinity.
    pub fn misses_far_end(&self, bounds: &Aabb, light: &Light) -> bool {
        if light.has_range() {
            return false;
        }
        let corners = corners(bounds);
        self.outwards.iter().any(|normal| goes_along(&corners, light, *normal))
    }

    /// Whether a caster may hide the light from some point of the near rectangle.
    pub fn may_be_shaded_by(&self, casters: &Casters, caster: &Caster, facings: &[i8], light: &Light) -> bool {
        let reach_m = PYRAMID_MARGIN * self.near_reach_m;
        let (direction, length) = match light {
            Light::Sun { towards } => (*towards, f64::INFINITY),
            Light::Lamp { position_m, .. } => (*position_m - self.eye_m, 1.0),
        };
        let meets = |[low, high]: &Aabb| {
            let (mut enters, mut leaves) = (-reach_m / direction.length().max(f64::MIN_POSITIVE), length);
            for k in 0..3 {
                let [a, b] = [low[k] - reach_m - self.eye_m[k], high[k] + reach_m - self.eye_m[k]];
                if direction[k] == 0.0 {
                    if a > 0.0 || b < 0.0 {
                        return false;
                    }
                    continue;
                }
                let [a, b] = [a / direction[k], b / direction[k]];
                (enters, leaves) = (enters.max(a.min(b)), leaves.min(a.max(b)));
            }
            enters <= leaves
        };
        let triangle_meets = |triangle: usize| {
            let [a, b, c] = casters.corners_m(triangle);
            meets(&[a.min(b).min(c), a.max(b).max(c)])
        };
        meets(&caster.bounds_m) && caster.triangles.clone().any(|t| facings[t] != 0 && triangle_meets(t))
    }

    /// The pixels that a box can cover: left, top, width, height. None where it covers none.
    fn pixels(&self, view: &View, bounds: &Aabb) -> Option<[u32; 4]> {
        if self.misses(bounds) {
            return None;
        }
        let whole = [0, 0, view.size[0], view.size[1]];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in corners(bounds) {
            let ray = corner - self.eye_m;
            let depth_m = ray.dot(self.forward);
            if depth_m <= 2.0 * self.near_m {
                return Some(whole);
            }
            let pixel = view.pixel_of(ray / depth_m);
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(pixel[k]), high[k].max(pixel[k]));
            }
        }
        // A pixel more on every side, for what rounding may move.
        let start = [0, 1].map(|k| (low[k].floor() - 1.0).clamp(0.0, f64::from(view.size[k])) as u32);
        let end = [0, 1].map(|k| (high[k].ceil() + 1.0).clamp(0.0, f64::from(view.size[k])) as u32);
        Some([start[0], start[1], end[0].saturating_sub(start[0]), end[1].saturating_sub(start[1])])
    }
}

/// Whether a shadow extends only to the side to which a normal points.
fn goes_along(corners: &[DVec3; 8], light: &Light, normal: DVec3) -> bool {
    match light {
        Light::Sun { towards } => towards.dot(normal) <= 0.0,
        Light::Lamp { position_m, .. } => corners.iter().all(|c| (*c - position_m).dot(normal) >= 0.0),
    }
}

/// Bounding boxes of drawn instances.
#[derive(Debug, Clone)]
pub struct Receivers {
    bounds: Vec<Aabb>,
}

impl Receivers {
    /// The boxes of a stage.
    pub fn new(stage: &Stage) -> Self {
        let of_instance = |window: &[u32]| {
            let drawn = (window[0] as usize..window[1] as usize).filter(|&t| !stage.sides(t).is_none());
            drawn.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |bounds, triangle| {
                let corners = stage.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
                corners.iter().fold(bounds, |[low, high], corner| [low.min(*corner), high.max(*corner)])
            })
        };
        let all = stage.geometry.first_triangle.windows(2).map(of_instance);
        Self { bounds: all.filter(|[low, _]| low.is_finite()).collect() }
    }

    /// The boxes that are in view and in the light's range.
    pub fn in_view(&self, frustum: &Frustum, light: &Light) -> Vec<Aabb> {
        let in_range = |bounds: &&Aabb| range_box(light).is_none_or(|range| overlap(&range, bounds));
        self.bounds.iter().filter(|bounds| !frustum.misses(bounds)).filter(in_range).copied().collect()
    }
}

/// The box around a light's range, if it has one.
fn range_box(light: &Light) -> Option<Aabb> {
    match light {
        Light::Lamp { position_m, range_m: Some(range_m) } => Some([*position_m - *range_m, *position_m + *range_m]),
        _ => None,
    }
}

/// Whether a caster is in a light's range.
pub fn is_in_range(bounds: &Aabb, light: &Light) -> bool {
    range_box(light).is_none_or(|range| overlap(&range, bounds))
}

fn overlap(a: &Aabb, b: &Aabb) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}

/// Receivers in a light's frame, to find which of them a caster's shadow can fall on.
pub struct Targets {
    /// In bake space.
    bounds: Vec<Aabb>,
    /// The same boxes in the sun's frame: two axes across its rays, and one towards the sun. Empty for lamps.
    in_light_frame: Vec<Aabb>,
}

impl Targets {
    /// Puts receivers in view into a light's frame.
    pub fn new(bounds: Vec<Aabb>, frustum: &Frustum, light: &Light) -> Self {
        let in_light_frame = match light {
            Light::Sun { towards } => {
                let grown = |bounds: &Aabb| {
                    let furthest_m = corners(bounds).map(|c| c.distance(frustum.eye_m)).into_iter().fold(0.0, f64::max);
                    let growth_m = frustum.moved_share * furthest_m;
                    in_sun_frame(&[bounds[0] - growth_m, bounds[1] + growth_m], *towards)
                };
                bounds.iter().map(grown).collect()
            }
            Light::Lamp { .. } => Vec::new(),
        };
        Self { bounds, in_light_frame }
    }

    /// Whether a caster's shadow can fall on any of them.
    pub fn any_behind(&self, caster: &Caster, light: &Light) -> bool {
        let own = match light {
            Light::Sun { towards } => Some(in_sun_frame(&caster.bounds_m, *towards)),
            Light::Lamp { .. } => None,
        };
        (0..self.bounds.len()).any(|i| {
            let is_across = own.as_ref().is_none_or(|[low, high]| {
                let [target_low, target_high] = &self.in_light_frame[i];
                let overlaps = |k: usize| target_low[k] <= high[k] && low[k] <= target_high[k];
                overlaps(0) && overlaps(1) && target_low.z <= high.z
            });
            is_across && !is_in_front_of_plane(caster, &self.bounds[i], light)
        })
    }

    /// The pixels that surfaces in the light's range can cover: left, top, width, height.
    pub fn pixels(&self, frustum: &Frustum, view: &View, light: &Light) -> [u32; 4] {
        let union = |a: [u32; 4], b: [u32; 4]| {
            let start = [a[0].min(b[0]), a[1].min(b[1])];
            let end = [(a[0] + a[2]).max(b[0] + b[2]), (a[1] + a[3]).max(b[1] + b[3])];
            [start[0], start[1], end[0] - start[0], end[1] - start[1]]
        };
        let covered = self.bounds.iter().filter_map(|bounds| frustum.pixels(view, bounds)).reduce(union);
        let mut pixels = covered.unwrap_or([0; 4]);
        if let Some(range) = range_box(light) {
            let range = frustum.pixels(view, &range).unwrap_or([0; 4]);
            let start = [pixels[0].max(range[0]), pixels[1].max(range[1])];
            let end =
                [(pixels[0] + pixels[2]).min(range[0] + range[2]), (pixels[1] + pixels[3]).min(range[1] + range[3])];
            pixels = [start[0], start[1], end[0].saturating_sub(start[0]), end[1].saturating_sub(start[1])];
        }
        if pixels[2] == 0 || pixels[3] == 0 { [0; 4] } else { pixels }
    }
}

/// A box in the sun's frame, grown to allow for rounding.
fn in_sun_frame(bounds: &Aabb, towards: DVec3) -> Aabb {
    let (right, up) = towards.any_orthonormal_pair();
    let seen = corners(bounds).map(|c| DVec3::new(c.dot(right), c.dot(up), c.dot(towards)));
    let (low, high) = (seen.iter().fold(seen[0], |a, b| a.min(*b)), seen.iter().fold(seen[0], |a, b| a.max(*b)));
    let growth_m = 1e-9 * low.abs().max(high.abs()).max_element();
    [low - growth_m, high + growth_m]
}

/// Whether a box lies on the plane of a flat caster or on the light's side of it, where the caster casts no shadow.
fn is_in_front_of_plane(caster: &Caster, bounds: &Aabb, light: &Light) -> bool {
    let Some((normal, offset_m)) = caster.plane else { return false };
    let side = match light {
        Light::Sun { towards } => towards.dot(normal),
        Light::Lamp { position_m, .. } => position_m.dot(normal) - offset_m,
    };
    let size_m = (caster.bounds_m[1] - caster.bounds_m[0]).max_element();
    let height_m = |corner: &DVec3| (corner.dot(normal) - offset_m) * side.signum();
    side != 0.0 && corners(bounds).iter().all(|corner| height_m(corner) >= -PLANE_TOLERANCE_SHARE * size_m)
}
