//! Truth: rays from the surface at every pixel to the sun, on the CPU.
//!
//! * *Hard* truth traces one ray to the sun's centre, and gives 0 or 1.
//! * *Soft* truth traces many rays over the sun's disc, evenly by area (a spiral of golden angles after Vogel, "A
//!   better way to construct the sunflower head", *Mathematical Biosciences* 44, 1979), turned by a different angle at
//!   each pixel; it gives the share that reaches the sun. Only parts of the disc above the world's horizon and above
//!   the surface's plane count.
//!
//! Where rays start, and what counts as the surface's plane, is as in a bake: [`sunbake::visibility::ray_starts`].
//!
//! For a lamp it is the same: one ray to its centre, or many over the disc that its sphere shows to the point. A ray
//! ends at the lamp.
//!
//! The two are never mixed: a hard technique is compared with hard truth, a soft one with soft truth. Nothing is kept
//! between frames. The error of soft truth is its sampling: with N rays a half-covered disc is right to about 1/N.

use super::{Technique, on_cpu};
use crate::gpu::{GpuError, Output};
use crate::image::Raster;
use crate::light::{LampMoment, Moment, SunDisc, disc};
use crate::plan::DrawPlan;
use crate::shot::Shot;
use crate::stage::Stage;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use sunbake::atlas::SurfacePoint;
use sunbake::scene::SmoothPoint;
use sunbake::sun::SunPath;
use sunbake::trace::{Direction, Hit};
use sunbake::visibility::{RayStart, ray_starts};

/// How many rays are traced, and to where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// One, to the centre.
    Hard,
    /// Many, spread over the disc.
    Soft {
        /// Rays per pixel.
        rays: u32,
    },
}

impl Truth {
    /// Rays per pixel of soft truth, unless told otherwise.
    pub const DEFAULT_RAYS: u32 = 64;

    fn lamp_visibility_from(self, stage: &Stage, from: &ShadowRays, pixel: usize, lamp: &Sphere) -> f32 {
        let point_m = from.point.position_m;
        if point_m.distance(lamp.centre_m) > lamp.range_m {
            return 0.0;
        }
        let tracer = stage.tracer();
        let reaches = |lamp_m: DVec3| {
            let origin_m = from.origin_towards(lamp_m);
            origin_m.is_some_and(|origin_m| from.is_open || tracer.occluder_before(origin_m, lamp_m).is_none())
        };
        match self {
            Self::Hard => f32::from(u8::from(reaches(lamp.centre_m))),
            Self::Soft { rays } => {
                let turn = turn_of_pixel(pixel);
                (0..rays).filter(|&i| reaches(lamp.point(point_m, i, rays, turn))).count() as f32 / rays as f32
            }
        }
    }

    /// Visibility of the centre of the sun or of the lamp, 0 or 1, from the point that a ray has hit, moved back along
    /// the ray by `step_m`.
    pub fn hard_at(stage: &Stage, ray: Vec3, hit: &Hit, step_m: f64, moment: &Moment, light: LightKind) -> f32 {
        let mut from = ShadowRays::new(stage, ray, hit);
        let back_m = ray.as_dvec3().normalize() * step_m;
        from.point.position_m -= back_m;
        from.starts.iter_mut().for_each(|(_, origin_m)| *origin_m -= back_m);
        match (light, &stage.path, &moment.lamp) {
            (LightKind::Sun, Some(path), _) => Self::Hard.sun_visibility_from(stage, &from, 0, &sun_of(path, moment)),
            (LightKind::Lamp, _, Some(lamp)) => Self::Hard.lamp_visibility_from(stage, &from, 0, &sphere_of(lamp)),
            _ => 0.0,
        }
    }

    fn sun_visibility_from(self, stage: &Stage, from: &ShadowRays, pixel: usize, sun: &SunDisc) -> f32 {
        let tracer = stage.tracer();
        let is_hidden = |origin_m, direction| tracer.is_occluded(origin_m, &Direction::new(direction));
        let reaches = |direction: DVec3| {
            let origin_m = from.origin_along(direction).filter(|_| direction.y > 0.0);
            origin_m.is_some_and(|origin_m| from.is_open || !is_hidden(origin_m, direction))
        };
        match self {
            Self::Hard => f32::from(u8::from(reaches(sun.centre))),
            Self::Soft { rays } => {
                let turn = turn_of_pixel(pixel);
                (0..rays).filter(|&i| reaches(sun.direction(i, rays, turn))).count() as f32 / rays as f32
            }
        }
    }
}

/// Where a pixel's rays to the light start.
struct ShadowRays {
    /// The point, with the side that the eye is on as its front.
    point: SurfacePoint,
    /// A corner of the triangle. With it all points of the triangle agree on which side of their plane a lamp is.
    on_plane_m: DVec3,
    /// Each start, and its place.
    starts: Vec<(RayStart, DVec3)>,
    /// Whether nothing shades the surface.
    is_open: bool,
}

impl ShadowRays {
    fn new(stage: &Stage, ray: Vec3, hit: &Hit) -> Self {
        let (geometry, triangle) = (&stage.geometry, hit.triangle as usize);
        let point = SurfacePoint::of_triangle(&stage.scene, geometry, triangle, hit.barycentric);
        let is_turned = point.normal.dot(ray.as_dvec3()) > 0.0;
        let point = SurfacePoint {
            normal: if is_turned { -point.normal } else { point.normal },
            smooth: if is_turned { point.smooth.map(SmoothPoint::turned) } else { point.smooth },
            is_double_sided: false,
            ..point
        };
        let with_origin = |start: RayStart| (start, start.origin_m(stage.tracer(), &point));
        let starts = ray_starts(&point).into_iter().map(with_origin).collect();
        let is_open = !stage.scene.receives(geometry.instance[triangle] as usize);
        Self { point, on_plane_m: geometry.triangles[triangle][0].as_dvec3(), starts, is_open }
    }

    /// Where a ray along a direction starts; none where the surface faces away.
    fn origin_along(&self, direction: DVec3) -> Option<DVec3> {
        self.starts.iter().find(|(start, _)| start.faces(direction)).map(|(_, origin_m)| *origin_m)
    }

    /// The same for a ray to a lamp. Which side of the face it is on is asked of the whole triangle at once.
    fn origin_towards(&self, lamp_m: DVec3) -> Option<DVec3> {
        let (to_lamp_m, above_face_m) = (lamp_m - self.point.position_m, lamp_m - self.on_plane_m);
        let faces = |start: &RayStart| match start.also {
            None => start.normal.dot(above_face_m) > 0.0,
            Some(also) => start.normal.dot(to_lamp_m) > 0.0 && also.dot(above_face_m) > 0.0,
        };
        self.starts.iter().find(|(start, _)| faces(start)).map(|(_, origin_m)| *origin_m)
    }
}

impl Technique for Truth {
    fn name(&self) -> String {
        match self {
            Self::Hard => "truth:hard".into(),
            Self::Soft { rays } => format!("truth:soft:{rays}"),
        }
    }

    fn draw_plan(&self, shot: &Shot, _output: Output) -> DrawPlan {
        let rays = match self {
            Self::Hard => None,
            Self::Soft { rays } => Some(*rays),
        };
        on_cpu::truth(shot.stage, rays)
    }

    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let sun = shot
            .stage
            .path
            .as_ref()
            .map(|path| SunDisc::new(path.direction(f64::from(moment.t)), path.angular_radius_rad));
        let seen = |(pixel, hit): (usize, &Option<Hit>)| match (hit, &sun) {
            (None, _) => 1.0,
            (Some(_), None) => 0.0,
            (Some(hit), Some(sun)) => {
                self.sun_visibility_from(shot.stage, &ShadowRays::new(shot.stage, shot.ray(pixel), hit), pixel, sun)
            }
        };
        let pixels = shot.hits().par_iter().enumerate().with_min_len(16).map(seen).collect();
        Ok(Raster { size: shot.view.size, pixels })
    }

    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let lamp = moment.lamp.as_ref().map(sphere_of);
        let seen = |(pixel, hit): (usize, &Option<Hit>)| match (hit, &lamp) {
            (None, _) => 1.0,
            (Some(_), None) => 0.0,
            (Some(hit), Some(lamp)) => {
                self.lamp_visibility_from(shot.stage, &ShadowRays::new(shot.stage, shot.ray(pixel), hit), pixel, lamp)
            }
        };
        let pixels = shot.hits().par_iter().enumerate().with_min_len(16).map(seen).collect();
        Ok(Raster { size: shot.view.size, pixels })
    }

    fn bytes(&self) -> u64 {
        0
    }
}

fn sun_of(path: &SunPath, moment: &Moment) -> SunDisc {
    SunDisc::new(path.direction(f64::from(moment.t)), path.angular_radius_rad)
}

fn sphere_of(lamp: &LampMoment) -> Sphere {
    let [radius_m, range_m] = [lamp.radius_m, lamp.range_m].map(f64::from);
    Sphere { centre_m: lamp.position_m.as_dvec3(), radius_m, range_m }
}

/// A light of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightKind {
    /// Far away.
    Sun,
    /// In the scene.
    Lamp,
}

/// A lamp's shape and reach.
struct Sphere {
    centre_m: DVec3,
    radius_m: f64,
    range_m: f64,
}

impl Sphere {
    /// Where ray `i` of `count` goes, the spiral turned by `turn`: even by area over the sphere's disc as seen from a
    /// point.
    fn point(&self, from_m: DVec3, i: u32, count: u32, turn: f64) -> DVec3 {
        let Some(direction) = (self.centre_m - from_m).try_normalize() else { return self.centre_m };
        let (across, up) = direction.any_orthonormal_pair();
        let (sin, cos) = (f64::from(i) * disc::GOLDEN_ANGLE_RAD + turn).sin_cos();
        let from_centre_m = self.radius_m * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        self.centre_m + (across * cos + up * sin) * from_centre_m
    }
}

/// An angle that differs from pixel to pixel (a PCG hash: Jarzynski and Olano, "Hash functions for GPU rendering",
/// 2020).
fn turn_of_pixel(pixel: usize) -> f64 {
    let state = (pixel as u32).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from((word >> 22) ^ word) / f64::from(u32::MAX) * std::f64::consts::TAU
}
