//! Truth: rays from every pixel's surface to the sun.
//!
//! * *Hard* truth asks one ray to the sun's centre, and answers 0 or 1.
//! * *Soft* truth asks many rays over the sun's disc, evenly by area (a spiral of golden angles after Vogel, "A better
//!   way to construct the sunflower head", *Mathematical Biosciences* 44, 1979), turned by a different angle at each
//!   pixel; it answers with the share that reaches the sun. Only parts of the disc above the world's horizon and before
//!   the surface's plane count.
//!
//! A lamp is asked alike: one ray to its centre, or many over the disc that its ball shows to the point, and a ray ends at
//! the lamp.
//!
//! The two are never mixed: a hard technique is right or wrong about the one, a soft technique about the other. Nothing is
//! kept between frames. Soft truth is wrong by its sampling: with N rays a half-covered disc reads right to about 1/N.

use super::Technique;
use crate::gpu::GpuError;
use crate::image::Raster;
use crate::light::Moment;
use crate::shot::Shot;
use glam::DVec3;
use rayon::prelude::*;
use sunbake::trace::{Direction, Hit};

/// The angle between neighbours of the spiral: a full turn over the square of the golden ratio.
const GOLDEN_ANGLE_RAD: f64 = 2.399_963_229_728_653;

/// Rays to the sun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// One, to the centre.
    Hard,
    /// Many, over the disc.
    Soft {
        /// How many.
        rays: u32,
    },
}

impl Truth {
    /// Rays over the disc, unless told otherwise.
    pub const DEFAULT_RAYS: u32 = 64;

    fn lamp_seen(self, shot: &Shot, pixel: usize, hit: &Hit, lamp: &Ball) -> f32 {
        let tracer = shot.stage.tracer();
        let Seat { face, point_m, origin_m } = Seat::new(shot, pixel, hit);
        let reaches =
            |lamp_m: DVec3| face.dot(lamp_m - point_m) > 0.0 && tracer.occluder_before(origin_m, lamp_m).is_none();
        match self {
            Self::Hard => f32::from(u8::from(reaches(lamp.centre_m))),
            Self::Soft { rays } => {
                let turn = turn_of_pixel(pixel);
                (0..rays).filter(|&i| reaches(lamp.point(point_m, i, rays, turn))).count() as f32 / rays as f32
            }
        }
    }

    fn seen(self, shot: &Shot, pixel: usize, hit: &Hit, sun: &Sun) -> f32 {
        let tracer = shot.stage.tracer();
        let Seat { face, origin_m, .. } = Seat::new(shot, pixel, hit);
        let reaches = |direction: DVec3| {
            direction.y > 0.0 && face.dot(direction) > 0.0 && !tracer.is_occluded(origin_m, &Direction::new(direction))
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

/// What a pixel shows, as the start of rays: the side that the eye is on.
struct Seat {
    face: DVec3,
    point_m: DVec3,
    origin_m: DVec3,
}

impl Seat {
    fn new(shot: &Shot, pixel: usize, hit: &Hit) -> Self {
        let triangle = hit.triangle as usize;
        let front = shot.stage.geometry.normal(triangle);
        let face = if front.dot(shot.ray(pixel).as_dvec3()) > 0.0 { -front } else { front };
        let point_m = shot.stage.geometry.point(triangle, hit.barycentric);
        Self { face, point_m, origin_m: shot.stage.tracer().lift(point_m, face, hit.triangle) }
    }
}

impl Technique for Truth {
    fn name(&self) -> String {
        match self {
            Self::Hard => "truth:hard".into(),
            Self::Soft { rays } => format!("truth:soft:{rays}"),
        }
    }

    fn visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let sun =
            shot.stage.path.as_ref().map(|path| Sun::new(path.direction(f64::from(moment.t)), path.angular_radius_rad));
        let seen = |(pixel, hit): (usize, &Option<Hit>)| match (hit, &sun) {
            (None, _) => 1.0,
            (Some(_), None) => 0.0,
            (Some(hit), Some(sun)) => self.seen(shot, pixel, hit, sun),
        };
        let pixels = shot.hits().par_iter().enumerate().with_min_len(16).map(seen).collect();
        Ok(Raster { size: shot.view.size, pixels })
    }

    fn lamp_visibility(&mut self, shot: &Shot, moment: &Moment) -> Result<Raster<f32>, GpuError> {
        let lamp =
            moment.lamp.map(|lamp| Ball { centre_m: lamp.position_m.as_dvec3(), radius_m: f64::from(lamp.radius_m) });
        let seen = |(pixel, hit): (usize, &Option<Hit>)| match (hit, &lamp) {
            (None, _) => 1.0,
            (Some(_), None) => 0.0,
            (Some(hit), Some(lamp)) => self.lamp_seen(shot, pixel, hit, lamp),
        };
        let pixels = shot.hits().par_iter().enumerate().with_min_len(16).map(seen).collect();
        Ok(Raster { size: shot.view.size, pixels })
    }

    fn bytes(&self) -> u64 {
        0
    }
}

/// The sun's disc.
struct Sun {
    centre: DVec3,
    across: [DVec3; 2],
    radius_rad: f64,
}

impl Sun {
    fn new(centre: DVec3, radius_rad: f64) -> Self {
        Self { centre, across: centre.any_orthonormal_pair().into(), radius_rad }
    }

    /// The direction of ray `i` of `count`, the spiral turned by `turn`: even by area over the disc.
    fn direction(&self, i: u32, count: u32, turn: f64) -> DVec3 {
        let share = (f64::from(i) + 0.5) / f64::from(count);
        let from_centre = 1.0 - (1.0 - self.radius_rad.cos()) * share;
        let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE_RAD + turn).sin_cos();
        let across = self.across[0] * cos + self.across[1] * sin;
        (self.centre * from_centre + across * (1.0 - from_centre * from_centre).max(0.0).sqrt()).normalize()
    }
}

/// A lamp.
struct Ball {
    centre_m: DVec3,
    radius_m: f64,
}

impl Ball {
    /// Where ray `i` of `count` goes, the spiral turned by `turn`: even by area over the ball's disc as seen from a point.
    fn point(&self, from_m: DVec3, i: u32, count: u32, turn: f64) -> DVec3 {
        let Some(way) = (self.centre_m - from_m).try_normalize() else { return self.centre_m };
        let (across, up) = way.any_orthonormal_pair();
        let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE_RAD + turn).sin_cos();
        let from_centre_m = self.radius_m * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        self.centre_m + (across * cos + up * sin) * from_centre_m
    }
}

/// An angle that differs from pixel to pixel (a PCG hash: Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
fn turn_of_pixel(pixel: usize) -> f64 {
    let state = (pixel as u32).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from((word >> 22) ^ word) / f64::from(u32::MAX) * std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_cover_the_disc_evenly_and_no_more() {
        let sun = Sun::new(DVec3::new(0.3, 0.8, -0.2).normalize(), 0.1);
        let directions: Vec<DVec3> = (0..4096).map(|i| sun.direction(i, 4096, 0.7)).collect();
        assert!(directions.iter().all(|d| d.angle_between(sun.centre) <= 0.1 + 1e-9));
        let within_half = directions.iter().filter(|d| d.angle_between(sun.centre) < 0.05).count();
        assert!((within_half as f64 / 4096.0 - 0.25).abs() < 0.01);
        let on_one_side = directions.iter().filter(|d| d.dot(sun.across[0]) > 0.0).count();
        assert!((on_one_side as f64 / 4096.0 - 0.5).abs() < 0.01);
    }
}
