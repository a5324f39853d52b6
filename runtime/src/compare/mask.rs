//! How far a hard mask agrees with hard truth.
//!
//! Both test one point per pixel, and say lit or shaded. Where they differ, that is a defect, unless one of these
//! things explains it. Each is counted apart:
//!
//! * **The band.** The pixel lies within one pixel of an edge in truth's picture.
//! * **Fine edges.** Truth itself changes within a fraction of a pixel ([`FINE_PX`]): at an edge of something too thin
//!   for the picture to show, or between surfaces closer together than that along the line of sight.
//! * **Other surfaces.** Rasterising shows another surface than a ray hits (at a silhouette, or through a crack between
//!   triangles that do not share their corners), and the mask is right about that surface.
//! * **Turned facets.** A smooth surface faces the light there and its facet does not. Rays start above the facet,
//!   where a technique that rasterises may not: shadow volumes of open meshes leave it dark.
//!
//! The first three no rasterising technique can avoid.

use super::agreement::neighbours;
use crate::image::Raster;
use crate::light::Moment;
use crate::shade::towards_eye;
use crate::shot::Shot;
use crate::technique::{LightKind, Truth};
use crate::volumes::nearest::nearest;
use glam::{DVec3, Vec3};
use sunbake::trace::Hit;

/// How far from a pixel's centre an edge may pass that no other pixel shows, in pixels. Rasterising moves corners by up
/// to a 512th and volumes are moved by a 128th; slanted surfaces magnify both.
pub const FINE_PX: f32 = 0.25;
/// How far towards the eye a surface may be moved for the same reason, in pixels.
const FINE_DEPTH_PX: f64 = 1.0 / 32.0;
/// How near to a caster's edge a ray may pass, in pixels at the point that it starts from.
const GRAZING_PX: f64 = 1.0 / 64.0;
/// How near another surface may be to the one that the mask shows, in pixels.
const SURFACE_PX: f32 = 1.0 / 16.0;
/// Largest cosine between normal and line of sight of a surface that counts as seen edge on.
const EDGE_ON: f64 = 1.0 / 32.0;
/// Rays on each of three circles around a pixel's centre.
const RAYS_PER_CIRCLE: usize = 16;

/// How far a hard mask agrees with hard truth.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaskAgreement {
    /// Number of pixels compared.
    pub pixels: usize,
    /// Pixels in the band.
    pub in_band: usize,
    /// Other wrong pixels in the band.
    pub wrong_in_band: usize,
    /// Wrong pixels outside of the band, at fine edges.
    pub at_fine_edges: usize,
    /// Wrong pixels outside of the band that show another surface, and are right about it.
    pub of_other_surfaces: usize,
    /// Wrong pixels on facets that turn away from the light where their smooth surface does not.
    pub on_turned_facets: usize,
    /// Other wrong pixels: indices in row order.
    pub unexplained: Vec<usize>,
}

impl MaskAgreement {
    /// Compares a mask with hard truth. `depths_m` are the depths of the surfaces that the mask shows, along the
    /// camera's axis; infinite without a surface.
    pub fn new(
        shot: &Shot,
        moment: &Moment,
        light: LightKind,
        mask: &Raster<f32>,
        truth: &Raster<f32>,
        depths_m: &[f32],
    ) -> Self {
        let [width, height] = shot.view.size.map(|edge| edge as usize);
        let mut found = Self { pixels: truth.pixels.len(), ..Self::default() };
        let reasons = Reasons { shot, moment, light };
        for (i, &depth_m) in depths_m.iter().enumerate() {
            let is_edge = neighbours(i, width, height).any(|n| truth.pixels[n] != truth.pixels[i]);
            // A mask holds only 0 and 1; any other value is wrong, and nothing explains it.
            let is_wrong = mask.pixels[i] != truth.pixels[i];
            let is_lit = mask.pixels[i] == 1.0;
            found.in_band += usize::from(is_edge);
            if !is_wrong {
            } else if !is_lit && mask.pixels[i] != 0.0 {
                found.unexplained.push(i);
            } else if reasons.is_on_turned_facet(i) {
                found.on_turned_facets += 1;
            } else if is_edge {
                found.wrong_in_band += 1;
            } else if reasons.is_at_fine_edge(i, is_lit) || (!is_lit && reasons.grazes_a_caster(i)) {
                found.at_fine_edges += 1;
            } else if reasons.shows_other_surface(i, is_lit, f64::from(depth_m)) {
                found.of_other_surfaces += 1;
            } else {
                found.unexplained.push(i);
            }
        }
        found
    }

    /// The numbers as a sentence.
    pub fn sentence(&self) -> String {
        format!(
            "{} pixels compared, {} wrong on turned facets; {} in the band ({} wrong there); elsewhere wrong: {} at \
             fine edges, {} of other surfaces, {} unexplained",
            self.pixels,
            self.on_turned_facets,
            self.in_band,
            self.wrong_in_band,
            self.at_fine_edges,
            self.of_other_surfaces,
            self.unexplained.len()
        )
    }

    /// Adds another picture's numbers.
    pub fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.in_band += other.in_band;
        self.wrong_in_band += other.wrong_in_band;
        self.at_fine_edges += other.at_fine_edges;
        self.of_other_surfaces += other.of_other_surfaces;
        self.on_turned_facets += other.on_turned_facets;
        self.unexplained.extend(&other.unexplained);
    }
}

/// Reasons why a pixel's mask, lit or not, may differ from truth.
struct Reasons<'a> {
    shot: &'a Shot<'a>,
    moment: &'a Moment,
    light: LightKind,
}

impl Reasons<'_> {
    /// Rays through a pixel's centre and on three circles around it, the widest [`FINE_PX`] away.
    fn rays(&self, pixel: usize) -> impl Iterator<Item = Vec3> {
        let (centre, view) = (self.shot.ray(pixel), self.shot.view);
        std::iter::once(centre).chain((0..3 * RAYS_PER_CIRCLE).map(move |i| {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / RAYS_PER_CIRCLE as f32).sin_cos();
            let reach_px = [FINE_PX / 16.0, FINE_PX / 4.0, FINE_PX][i / RAYS_PER_CIRCLE];
            centre + (view.ray_per_column * cos + view.ray_per_row * sin) * reach_px
        }))
    }

    /// Whether a pixel's smooth surface faces the light, and its facet does not.
    fn is_on_turned_facet(&self, pixel: usize) -> bool {
        let stage = self.shot.stage;
        let Some(hit) = self.shot.hits()[pixel] else { return false };
        let (triangle, ray) = (hit.triangle as usize, self.shot.ray(pixel));
        let face = stage.geometry.normal(triangle).as_vec3();
        let gate = stage.gate_normal(triangle, hit.barycentric, ray);
        let to_light = match (self.light, &self.moment.lamp) {
            (LightKind::Lamp, Some(lamp)) => {
                lamp.position_m - stage.geometry.point(triangle, hit.barycentric).as_vec3()
            }
            _ => self.moment.sun_direction,
        };
        gate.dot(to_light) > 0.0 && towards_eye(face, face, ray).dot(to_light) <= 0.0
    }

    /// Whether truth equals the mask somewhere within a fraction of a pixel, or a fraction of a pixel before the
    /// surface.
    fn is_at_fine_edge(&self, pixel: usize, is_lit: bool) -> bool {
        let stage = self.shot.stage;
        let nearer = |ray: Vec3, hit: &Hit| {
            let step_m = hit.distance_m * f64::from(self.shot.view.pixel_angle_rad) * FINE_DEPTH_PX;
            Truth::hard_at(stage, ray, hit, step_m, self.moment, self.light)
        };
        self.rays(pixel).any(|ray| {
            let Some(hit) = stage.primary_hit(self.eye_m(), ray.as_dvec3()) else { return is_lit };
            let seen = Truth::hard_at(stage, ray, &hit, 0.0, self.moment, self.light);
            (seen == 1.0) == is_lit || (nearer(ray, &hit) == 1.0) == is_lit
        })
    }

    /// Whether a pixel's ray to the light passes a caster by less than a fraction of a pixel. The caster's shadow may
    /// be too thin for the circles to find. Casters at the surface itself do not count.
    fn grazes_a_caster(&self, pixel: usize) -> bool {
        let stage = self.shot.stage;
        let Some(hit) = self.shot.hits()[pixel] else { return false };
        let point_m = stage.geometry.point(hit.triangle as usize, hit.barycentric);
        let pixel_m = hit.distance_m * f64::from(self.shot.view.pixel_angle_rad);
        let (direction, length_m) = match (self.light, &self.moment.lamp) {
            (LightKind::Lamp, Some(lamp)) => {
                let to_lamp_m = lamp.position_m.as_dvec3() - point_m;
                (to_lamp_m.normalize(), to_lamp_m.length())
            }
            _ => (self.moment.sun_direction.as_dvec3(), 4.0 * stage.scene.half_extent_m.length()),
        };
        let segment = [point_m + direction * (pixel_m * f64::from(FINE_PX)), point_m + direction * length_m];
        let passes = |[a, b]: [DVec3; 2]| between(segment, [a, b]) < pixel_m * GRAZING_PX;
        let casts = |triangle: &usize| stage.geometry.casts(&stage.scene, *triangle);
        (0..stage.geometry.triangles.len()).filter(casts).any(|triangle| {
            let [a, b, c] = stage.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
            passes([a, b]) || passes([b, c]) || passes([c, a])
        })
    }

    /// Whether the mask is right about another surface at the depth that it shows, though a ray hits a different one
    /// first. Of a surface seen edge on, rasterising may show either side.
    fn shows_other_surface(&self, pixel: usize, is_lit: bool, depth_m: f64) -> bool {
        let stage = self.shot.stage;
        if depth_m.is_infinite() {
            return is_lit && self.rays(pixel).any(|ray| stage.primary_hit(self.eye_m(), ray.as_dvec3()).is_none());
        }
        let ray = self.shot.ray(pixel);
        let direction = ray.as_dvec3().normalize();
        let shown_m = self.eye_m() + ray.as_dvec3() * depth_m;
        let distance_m = depth_m * ray.as_dvec3().length();
        let near_m = distance_m * f64::from(self.shot.view.pixel_angle_rad * SURFACE_PX);
        let says = |triangle: usize, ray: Vec3, barycentric: [f64; 2]| {
            let hit = Hit { triangle: triangle as u32, distance_m, barycentric };
            (Truth::hard_at(stage, ray, &hit, 0.0, self.moment, self.light) == 1.0) == is_lit
        };
        (0..stage.geometry.triangles.len()).filter(|&triangle| !stage.sides(triangle).is_none()).any(|triangle| {
            let corners_m = stage.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
            let slant = stage.geometry.normal(triangle).dot(direction);
            // Rasterising moves surfaces sideways; on slanted ones that changes the depth.
            let along_m = (near_m / slant.abs().max(f64::MIN_POSITIVE)).min(near_m / f64::from(SURFACE_PX));
            let place = [0.0, 0.5, -0.5, 1.0, -1.0].into_iter().find_map(|share| {
                let place_m = shown_m + direction * (along_m * share);
                let barycentric = nearest(&corners_m, place_m);
                let is_near = stage.geometry.point(triangle, barycentric).distance(place_m) <= near_m;
                is_near.then_some(barycentric)
            });
            let Some(barycentric) = place else { return false };
            let sides = stage.sides(triangle);
            let is_drawn = if slant < 0.0 { sides.front } else { sides.back };
            // Moving the corners may turn over a triangle that is seen edge on, or is thinner than they move.
            let [a, b, c] = corners_m;
            let longest_m = (b - a).length().max((c - b).length()).max((a - c).length());
            let thin_m = (b - a).cross(c - a).length() * slant.abs() / longest_m.max(f64::MIN_POSITIVE);
            let turns = slant.abs() < EDGE_ON || thin_m < near_m;
            ((is_drawn || turns) && says(triangle, ray, barycentric)) || (turns && says(triangle, -ray, barycentric))
        })
    }

    fn eye_m(&self) -> DVec3 {
        self.shot.view.eye_m.as_dvec3()
    }
}

/// Distance between two segments (Ericson, *Real-Time Collision Detection*, 5.1.9).
fn between([p, p_end]: [DVec3; 2], [q, q_end]: [DVec3; 2]) -> f64 {
    let (d1, d2, r) = (p_end - p, q_end - q, p - q);
    let (a, e, f) = (d1.length_squared().max(f64::MIN_POSITIVE), d2.length_squared(), d2.dot(r));
    let (b, c) = (d1.dot(d2), d1.dot(r));
    let determinant = a * e - b * b;
    let s = if determinant > 0.0 { ((b * f - c * e) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let t = if e > 0.0 { ((b * s + f) / e).clamp(0.0, 1.0) } else { 0.0 };
    let s = ((b * t - c) / a).clamp(0.0, 1.0);
    (p + d1 * s).distance(q + d2 * t)
}
