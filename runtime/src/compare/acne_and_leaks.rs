//! Defects of shadow maps: errors that their resolution does not explain.
//!
//! A map stores one depth per texel. At every shadow's edge it may be wrong by a texel and by its filter's width,
//! whatever the bias. An error elsewhere is a defect:
//!
//! * **Acne**: a fully lit surface with no shadow near it is drawn darker.
//! * **Leak**: a surface in full shadow with no light near it is drawn lighter.
//!
//! *Near* is measured across the light, on the plane of the surface. A shadow is near if any solid triangle above that
//! plane, however thin, comes within reach of the ray to the light. Light is near if one of many rays, spread over
//! everything within reach, hits nothing. With soft light the reach grows along the ray by the disc's angle. Pixels
//! that show another surface than a ray hits, or the end of a surface, are not counted.

use super::agreement::{EDGE_STEP, mean, neighbours, visibility_difference};
use super::score::WRONG;
use crate::image::Raster;
use crate::light::Moment;
use crate::light::disc::GOLDEN_ANGLE_RAD;
use crate::shot::Shot;
use crate::stage::Stage;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use sunbake::trace::{Direction, Hit};

/// Smallest error of a defect.
const DEFECT: f32 = 1.0 / 16.0;
/// Rays that search for light near a point.
const RAYS: u32 = 1024;
/// How far around a pixel's centre its surface must continue, in pixels.
const WITHIN_PX: f32 = 1.0 / 8.0;
/// Least cosine between the normals of two triangles that count as one surface.
const SAME_PLANE: f64 = 0.9999;

/// Errors and defects of a picture of visibility, against truth.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Defects {
    /// Number of pixels compared.
    pub pixels: usize,
    /// Pixels with an error above a half, at least one pixel away from every edge of truth's picture.
    pub wrong: usize,
    /// Sum of all errors.
    pub error: f64,
    /// Pixels with acne: indices in row order, picture after picture.
    pub acne: Vec<usize>,
    /// Pixels with leaks, in the same way.
    pub leaks: Vec<usize>,
}

impl Defects {
    /// Compares a picture with truth. `depths_m` are the depths of the surfaces that the picture shows. `reach_m` is
    /// how far across the light an edge may be from a point to explain an error there. `is_soft` says that truth is of
    /// the sun's disc, not of its centre.
    pub fn new(
        shot: &Shot,
        moment: &Moment,
        is_soft: bool,
        [seen, truth]: [&Raster<f32>; 2],
        depths_m: &[f32],
        reach_m: impl Fn(DVec3) -> f64 + Sync,
    ) -> Self {
        let [width, height] = shot.view.size.map(|edge| edge as usize);
        let difference = visibility_difference(seen, truth);
        let pixels = difference.pixels.len();
        let mut found = Self { pixels, error: mean(&difference) * pixels as f64, ..Self::default() };
        let mut suspects = Vec::new();
        for (i, &off) in difference.pixels.iter().enumerate() {
            // NaN is wrong.
            if off <= DEFECT {
                continue;
            }
            let around = || neighbours(i, width, height).map(|n| truth.pixels[n]);
            let step = around().fold(f32::NEG_INFINITY, f32::max) - around().fold(f32::INFINITY, f32::min);
            found.wrong += usize::from((off > WRONG || off.is_nan()) && step <= EDGE_STEP);
            if let (Some(hit), 0.0 | 1.0) = (shot.hits()[i], truth.pixels[i]) {
                suspects.push((i, hit, truth.pixels[i] == 1.0));
            }
        }
        let is_defect = |(i, hit, is_lit): &(usize, Hit, bool)| {
            let point = ReceiverPoint::new(shot, moment, is_soft, *i, hit);
            let pixel_m = hit.distance_m * f64::from(shot.view.pixel_angle_rad);
            // An edge within a pixel cannot be resolved.
            let reach_m = reach_m(point.point_m).max(pixel_m);
            shows_surface_of(shot, *i, hit, f64::from(depths_m[*i])) && point.is_uniform(*is_lit, reach_m)
        };
        let defects: Vec<_> = suspects.into_par_iter().filter(is_defect).collect();
        for (i, _, is_lit) in defects {
            if is_lit { found.acne.push(i) } else { found.leaks.push(i) }
        }
        found
    }

    /// Mean absolute error of visibility over the compared pixels.
    pub fn mean_error(&self) -> f64 {
        self.error / self.pixels.max(1) as f64
    }

    /// Share of pixels that are wrong.
    pub fn share_wrong(&self) -> f64 {
        self.wrong as f64 / self.pixels.max(1) as f64
    }

    /// Adds another picture's numbers.
    pub fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.wrong += other.wrong;
        self.error += other.error;
        self.acne.extend(&other.acne);
        self.leaks.extend(&other.leaks);
    }
}

/// Whether a pixel shows the surface that its ray hits, and that surface continues around the pixel's centre.
fn shows_surface_of(shot: &Shot, pixel: usize, hit: &Hit, depth_m: f64) -> bool {
    let (stage, ray) = (shot.stage, shot.ray(pixel));
    let normal = stage.geometry.normal(hit.triangle as usize);
    let length = ray.as_dvec3().length();
    let pixel_m = hit.distance_m * f64::from(shot.view.pixel_angle_rad);
    let slant = (normal.dot(ray.as_dvec3()) / length).abs().max(0.02);
    let sides = stage.sides(hit.triangle as usize);
    let is_front = normal.dot(ray.as_dvec3()) < 0.0;
    let eye_m = shot.view.eye_m.as_dvec3();
    let goes_on = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].into_iter().all(|(x, y)| {
        let step = shot.view.ray_per_column * (x * WITHIN_PX) + shot.view.ray_per_row * (y * WITHIN_PX);
        let beside = stage.primary_hit(eye_m, (ray + step).as_dvec3());
        beside.is_some_and(|beside| stage.geometry.normal(beside.triangle as usize).dot(normal).abs() > SAME_PLANE)
    });
    goes_on
        && (sides.front == is_front || sides.back)
        && (depth_m - hit.distance_m / length).abs() < 0.5 * pixel_m / slant
}

/// A point that a pixel shows, and the light towards it.
struct ReceiverPoint<'a> {
    shot: &'a Shot<'a>,
    triangle: u32,
    point_m: DVec3,
    /// Unit normal on the side that the eye is on.
    geometric_normal: DVec3,
    /// The normal that decides whether the point faces the light, on the same side.
    gate_normal: DVec3,
    /// Unit vector to the sun.
    sun: DVec3,
    /// Unit vectors across the light.
    aside: [DVec3; 2],
    /// How far the disc's rays spread per metre of distance; 0 for hard light.
    spread: f64,
}

impl<'a> ReceiverPoint<'a> {
    fn new(shot: &'a Shot, moment: &Moment, is_soft: bool, pixel: usize, hit: &Hit) -> Self {
        let geometry = &shot.stage.geometry;
        let front = geometry.normal(hit.triangle as usize);
        let sun = moment.sun_direction.as_dvec3().normalize();
        Self {
            shot,
            triangle: hit.triangle,
            point_m: geometry.point(hit.triangle as usize, hit.barycentric),
            gate_normal: shot.stage.gate_normal(hit.triangle as usize, hit.barycentric, shot.ray(pixel)).as_dvec3(),
            geometric_normal: if front.dot(shot.ray(pixel).as_dvec3()) > 0.0 { -front } else { front },
            sun,
            aside: sun.any_orthonormal_pair().into(),
            spread: if is_soft { f64::from(moment.sun_radius_rad).tan() } else { 0.0 },
        }
    }

    /// Whether truth has no edge within reach.
    fn is_uniform(&self, is_lit: bool, reach_m: f64) -> bool {
        let facing = self.gate_normal.dot(self.sun);
        if facing > 0.0 && self.geometric_normal.dot(self.sun) <= 0.0 {
            // The edge of the light crosses the facet.
            return false;
        }
        if facing <= 0.0 {
            // Turned away from the light: dark whatever is near, unless the disc's rim may just reach it.
            return !is_lit && facing < -self.spread;
        }
        if is_lit { !self.has_caster_within(reach_m) } else { !self.has_light_within(reach_m) }
    }

    /// Whether any solid triangle above the surface's plane is within reach of the ray to the light.
    fn has_caster_within(&self, reach_m: f64) -> bool {
        let Stage { geometry, scene, .. } = self.shot.stage;
        // Rounding must not lift a surface above itself.
        let level_m = 1e-3 * reach_m + 1e-6 * self.point_m.length();
        geometry.triangles.iter().enumerate().any(|(i, corners_m)| {
            let from_point = corners_m.map(|corner| corner.as_dvec3() - self.point_m);
            let heights = from_point.map(|v| self.geometric_normal.dot(v) - level_m);
            if heights.iter().all(|&h| h <= 0.0) {
                return false;
            }
            let away_m = from_point.map(|v| self.sun.dot(v)).into_iter().fold(0.0, f64::max);
            let reach_m = reach_m + away_m * self.spread;
            let flat = from_point.map(|v| self.across(v));
            let is_far = |k: usize| {
                let along = flat.map(|p| p[k]);
                along.iter().all(|&x| x > reach_m) || along.iter().all(|&x| x < -reach_m)
            };
            !is_far(0)
                && !is_far(1)
                && geometry.casts(scene, i)
                && distance_to_polygon(&above(&flat, &heights)) <= reach_m
        })
    }

    /// Whether light reaches the surface's plane anywhere within reach.
    fn has_light_within(&self, reach_m: f64) -> bool {
        let tracer = self.shot.stage.tracer();
        let origin_m = tracer.lift(self.point_m, self.geometric_normal, self.triangle);
        let reaches = |origin_m: DVec3, towards: DVec3| {
            towards.y > 0.0
                && self.geometric_normal.dot(towards) > 0.0
                && !tracer.is_occluded(origin_m, &Direction::new(towards.normalize()))
        };
        (0..RAYS).any(|i| {
            let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE_RAD).sin_cos();
            let aside = self.aside[0] * cos + self.aside[1] * sin;
            let shift_m = aside * (reach_m * ((f64::from(i) + 0.5) / f64::from(RAYS)).sqrt());
            // On the plane of the surface, which lies up or down along the light.
            let start_m = origin_m + shift_m
                - self.sun * (self.geometric_normal.dot(shift_m) / self.geometric_normal.dot(self.sun));
            // And beside the start: the plane may continue below another surface.
            [start_m, origin_m + shift_m].into_iter().any(|start_m| {
                reaches(start_m, self.sun) || (self.spread > 0.0 && reaches(start_m, self.sun + aside * self.spread))
            })
        })
    }

    fn across(&self, from_point: DVec3) -> DVec2 {
        DVec2::new(self.aside[0].dot(from_point), self.aside[1].dot(from_point))
    }
}

/// The part of a triangle whose heights are above zero.
fn above(corners: &[DVec2; 3], heights: &[f64; 3]) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(4);
    for i in 0..3 {
        let k = (i + 1) % 3;
        if heights[i] > 0.0 {
            kept.push(corners[i]);
        }
        if (heights[i] > 0.0) != (heights[k] > 0.0) {
            kept.push(corners[i].lerp(corners[k], heights[i] / (heights[i] - heights[k])));
        }
    }
    kept
}

/// How far the origin is from a convex polygon.
fn distance_to_polygon(corners: &[DVec2]) -> f64 {
    let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let sides = || edges().map(|(a, b)| a.perp_dot(b));
    if corners.len() > 2 && (sides().all(|s| s > 0.0) || sides().all(|s| s < 0.0)) {
        return 0.0;
    }
    let to_edge = |(a, b): (DVec2, DVec2)| {
        let along = b - a;
        let share = (-a.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (a + along * share).length()
    };
    edges().map(to_edge).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::Stage;
    use crate::technique::{Technique, Truth};
    use crate::testing::{standing_sun, view};
    use glam::{Vec2, Vec3};
    use sunbake::testing::{SceneBuilder, floor};

    /// A block on the ground, from above: its shadow is as long as it is high.
    fn stage() -> Stage {
        let scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
            .block(Vec3::new(-2.0, 0.0, -1.0), Vec3::new(-1.0, 3.0, 1.0))
            .build();
        Stage::plain(scene, Some(standing_sun(DVec3::new(-1.0, 1.0, 0.0), 0.0047)))
    }

    fn found(edit: impl Fn(&mut Raster<f32>), is_soft: bool, reach_m: f64) -> Defects {
        let stage = stage();
        let shot = Shot::new(&stage, view(&stage, DVec3::new(0.1, 9.0, 0.2), DVec3::ZERO, [64, 64]));
        let moment = stage.moment(0.5);
        let mut truth_of = if is_soft { Truth::Soft { rays: 64 } } else { Truth::Hard };
        let truth = truth_of.visibility(&shot, &moment).unwrap();
        let depth = |(i, hit): (usize, &Option<Hit>)| {
            hit.map_or(f32::INFINITY, |hit| (hit.distance_m / f64::from(shot.ray(i).length())) as f32)
        };
        let depths_m: Vec<f32> = shot.hits().iter().enumerate().map(depth).collect();
        let mut seen = truth.clone();
        edit(&mut seen);
        Defects::new(&shot, &moment, is_soft, [&seen, &truth], &depths_m, |_| reach_m)
    }

    /// Pixel of a place on the ground, metres east and south of the middle.
    fn at(x: f64, z: f64) -> usize {
        let stage = stage();
        let view = view(&stage, DVec3::new(0.1, 9.0, 0.2), DVec3::ZERO, [64, 64]);
        let ray = DVec3::new(x, 0.0, z) - stage.scene.centre_m - view.eye_m.as_dvec3();
        let [column, row] = view.pixel_of(ray / ray.dot(view.forward.as_dvec3()));
        row as usize * 64 + column as usize
    }

    #[test]
    fn truth_has_no_defects() {
        for is_soft in [false, true] {
            let found = found(|_| (), is_soft, 0.1);
            assert_eq!((found.wrong, found.acne.len(), found.leaks.len(), found.error), (0, 0, 0, 0.0));
        }
    }

    #[test]
    fn what_is_dark_in_light_is_acne_and_what_is_lit_in_shade_a_leak() {
        let (in_light, in_shade) = (at(0.5, 2.5), at(0.5, 0.0));
        for is_soft in [false, true] {
            let acne = found(|seen| seen.pixels[in_light] = 0.0, is_soft, 0.1);
            assert_eq!((acne.wrong, acne.acne.as_slice(), acne.leaks.len()), (1, &[in_light][..], 0));
            let leak = found(|seen| seen.pixels[in_shade] = 0.2, is_soft, 0.1);
            assert_eq!((leak.wrong, leak.acne.len(), leak.leaks.as_slice()), (0, 0, &[in_shade][..]));
            // NaN is neither light nor shade.
            assert_eq!(found(|seen| seen.pixels[in_light] = f32::NAN, is_soft, 0.1).wrong, 1);
        }
    }

    #[test]
    fn errors_within_reach_of_an_edge_are_no_defects_and_errors_beyond_are() {
        // The shadow's edge along the block's side is at z = 1; the reach is across the light.
        for (z, reach_m, expected) in [(1.3, 0.1, 1), (1.3, 0.6, 0), (2.5, 0.6, 1)] {
            let pixel = at(0.5, z);
            assert_eq!(found(|seen| seen.pixels[pixel] = 0.0, false, reach_m).acne.len(), expected, "{z} {reach_m}");
        }
    }
}
