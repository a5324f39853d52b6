//! Brute force in `f64`: which of many suns a point sees, asked of every triangle.
//!
//! Theory: a sun is seen if it is above the horizon and in front of the surface, and no triangle meets the ray towards
//! it. The triangle test is "Fast, Minimum Storage Ray/Triangle Intersection" (Moeller and Trumbore, *Journal of
//! Graphics Tools* 2(1), 1997), on the `f32` corners in bake space. It shares no code and no hierarchy with the tracer,
//! and starts where the tracer says that its shadow rays start: at [`Tracer::lift`], and [`Tracer::run_up_m`] back.
//!
//! Practice: a thousand points, 65,536 suns and 600,000 triangles are too many for each with each. But a triangle
//! lies in a ball, a ball in a cone of directions, and that cone meets an arc of the sun in one window of hour
//! angles; only suns in the window, and not yet dark, are tested. Triangles with wide windows are quartered for
//! tighter ones. Windows are enlarged by more than rounding, so leaving them out changes no answer.
//!
//! On smooth surfaces the side is the shading normal's, blended here from the mesh's own normals, and rays below the
//! face start where it is projected to: see [`Shape`].
//!
//! Departures: the triangle is grown by a part in 10^12, so that no sun slips through a shared edge.
//!
//! [`Tracer::lift`]: sunbake::trace::Tracer::lift
//! [`Tracer::run_up_m`]: sunbake::trace::Tracer::run_up_m

use crate::Traced;
use glam::{DMat3, DVec3, Vec2};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use sunbake::atlas::SurfacePoint;
use sunbake::scene::alpha::{image_uvs, nearest_texel, vertex_alphas};
use sunbake::scene::{Alpha, Scene};
use sunbake::sun::{SunArc, SunPath};

/// Growth of triangles, as a share of their edges.
const GROWTH: f64 = 1e-12;
/// Enlargement of cones, in cosine, and of windows, in radians: far more than rounding.
const SLACK_COS: f64 = 1e-12;
const SLACK_RAD: f64 = 1e-7;
/// Windows wider than this are worth quartering the triangle.
const WIDE_RAD: f64 = 0.02;
/// How often a triangle is quartered at most.
const MOST_HALVINGS: u32 = 5;

/// A scene and evenly spaced suns along a path, the first half a step after t = 0.
pub struct Oracle<'a> {
    here: &'a Traced,
    run_up_m: f64,
    casters: Vec<Caster>,
    suns: Vec<DVec3>,
    arcs: Vec<Arc>,
}

/// A triangle that blocks light.
struct Caster {
    triangle: usize,
    corners: [DVec3; 3],
}

/// An arc in a frame of its own, and which suns are on it.
struct Arc {
    arc: SunArc,
    square: DVec3,
    sin_declination: f64,
    cos_declination: f64,
    suns: Range<usize>,
    count: usize,
}

impl<'a> Oracle<'a> {
    /// Places `count` suns.
    pub fn new(here: &'a Traced, path: &SunPath, count: usize) -> Self {
        let geometry = &here.geometry;
        let caster = |triangle: usize| Caster { triangle, corners: geometry.triangles[triangle].map(|v| v.as_dvec3()) };
        let t = |sun: usize| (sun as f64 + 0.5) / count as f64;
        let mut first = 0;
        let arc = |arc: &SunArc| {
            let start = first;
            first = (start..count).find(|&sun| t(sun) >= arc.t[1]).unwrap_or(count);
            Arc::new(arc, start..first, count)
        };
        Self {
            here,
            run_up_m: here.tracer.run_up_m(),
            casters: (0..geometry.triangles.len()).filter(|&i| geometry.casts(&here.scene, i)).map(caster).collect(),
            arcs: path.arcs().iter().map(arc).collect(),
            suns: (0..count).map(|sun| path.direction(t(sun))).collect(),
        }
    }

    /// For each sun, whether the point sees it.
    pub fn lit(&self, point: &SurfacePoint) -> Vec<bool> {
        let sides: &[f64] = if point.is_double_sided { &[1.0, -1.0] } else { &[1.0] };
        let mut lit = vec![false; self.suns.len()];
        for &sign in sides {
            let face = point.normal * sign;
            let start = self.here.tracer.lift(point.position_m, face, point.triangle);
            let mut seen = vec![self.seen_from(start, face, |sun| sun.dot(face) > 0.0)];
            if point.smooth.is_some() {
                let shape = Shape::at(self.here, point);
                let side = shape.normal * sign;
                seen = vec![self.seen_from(start, face, |sun| sun.dot(side) > 0.0 && sun.dot(face) > 0.0)];
                // Where the shape is hollow the face itself is in the way of what is below its plane.
                let lift = shape.free_lift(self.here, start, face);
                if lift != DVec3::ZERO {
                    let below_face = |sun: DVec3| sun.dot(side) > 0.0 && sun.dot(face) < 0.0;
                    seen.push(self.seen_from(start + lift, side, below_face));
                }
            }
            seen.into_iter().for_each(|seen| lit.iter_mut().zip(seen).for_each(|(lit, seen)| *lit |= seen));
        }
        lit
    }

    /// The same for many points, on all threads.
    pub fn lit_all(&self, points: &[SurfacePoint]) -> Vec<Vec<bool>> {
        points.par_iter().map(|point| self.lit(point)).collect()
    }

    /// Suns that face the surface and that nothing hides from an origin; all of them are in front of the side.
    fn seen_from(&self, origin: DVec3, side: DVec3, faces: impl Fn(DVec3) -> bool) -> Vec<bool> {
        let mut seen: Vec<bool> = self.suns.iter().map(|sun| sun.y > 0.0 && faces(*sun)).collect();
        for caster in &self.casters {
            let relative = caster.corners.map(|corner| corner - origin);
            let is_below = |up: DVec3| relative.iter().all(|corner| up.dot(*corner) < -2.0 * self.run_up_m);
            let windows = self.windows(&relative);
            if !windows.is_empty() && !is_below(side) && !is_below(DVec3::Y) {
                windows.into_iter().for_each(|suns| self.shade(caster, origin, suns, &mut seen));
            }
        }
        seen
    }

    /// Darkens the suns that a triangle hides.
    fn shade(&self, caster: &Caster, origin: DVec3, suns: Range<usize>, seen: &mut [bool]) {
        for sun in suns {
            seen[sun] = seen[sun] && !self.blocks(caster, origin, self.suns[sun]);
        }
    }

    fn blocks(&self, caster: &Caster, origin: DVec3, sun: DVec3) -> bool {
        let Some(barycentric) = met(&caster.corners, origin - sun * self.run_up_m, sun) else { return false };
        let surface = self.here.geometry.surface(caster.triangle);
        is_solid_at(&self.here.scene, surface.instance, surface.mesh_triangle, barycentric)
    }

    /// Suns that a triangle, given relative to the rays' origin, may hide. Windows may overlap.
    fn windows(&self, corners: &[DVec3; 3]) -> Vec<Range<usize>> {
        let mut windows = Vec::new();
        for arc in &self.arcs {
            arc.windows(corners, self.run_up_m, MOST_HALVINGS, &mut windows);
        }
        windows
    }
}

/// The smooth shape at a point, by projecting the point onto the tangent planes of an edge's ends (Hanika, "Hacking the
/// shadow terminator", 2021), edge by edge.
struct Shape {
    normal: DVec3,
    corners: [DVec3; 3],
    normals: [DVec3; 3],
    weights: [f64; 3],
}

impl Shape {
    fn at(here: &Traced, point: &SurfacePoint) -> Self {
        let Traced { scene, geometry, .. } = here;
        let surface = geometry.surface(point.triangle as usize);
        let instance = &scene.instances[surface.instance];
        let mesh = &scene.meshes[instance.mesh];
        let own = mesh.normals.as_ref().expect("a smooth surface has normals");
        let cofactors = DMat3::from_mat4(instance.bake_from_object).inverse().transpose();
        let vertex = |k: usize| mesh.indices[3 * surface.mesh_triangle + k] as usize;
        let normals = [0, 1, 2].map(|k| (cofactors * own[vertex(k)].as_dvec3()).normalize());
        let corners = geometry.triangles[point.triangle as usize].map(|corner| corner.as_dvec3());
        let weights = weights(&corners, point.position_m);
        let normal = (normals[0] * weights[0] + normals[1] * weights[1] + normals[2] * weights[2]).normalize();
        Self { normal, corners, normals, weights }
    }

    /// The way from the point to the shape, but at most half-way to the next triangle.
    fn free_lift(&self, here: &Traced, start: DVec3, face: DVec3) -> DVec3 {
        let mut lift = DVec3::ZERO;
        for [i, k] in [[0, 1], [1, 2], [2, 0]] {
            // The middle of the edge, projected onto the planes of its ends, rises by a quarter of the edge's share.
            let middle = 0.5 * (self.corners[i] + self.corners[k]);
            let projected = [i, k].map(|at| {
                let (corner, n) = (self.corners[at], self.normals[at]);
                middle - n * (middle - corner).dot(n)
            });
            let rise = 0.5 * (projected[0] + projected[1]) - middle;
            if rise.dot(face) > 0.0 {
                lift += rise * (4.0 * self.weights[i] * self.weights[k]);
            }
        }
        let Some(along) = lift.try_normalize() else { return lift };
        let hits = (0..here.geometry.triangles.len()).filter_map(|triangle| {
            let corners = here.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
            let barycentric = met(&corners, start, along)?;
            let surface = here.geometry.surface(triangle);
            is_solid_at(&here.scene, surface.instance, surface.mesh_triangle, barycentric).then_some(())?;
            let plane = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            here.geometry.casts(&here.scene, triangle).then(|| plane.dot(corners[0] - start) / plane.dot(along))
        });
        lift * hits.fold(1.0, |share: f64, distance| share.min(0.5 * distance / lift.length()))
    }
}

/// The weights of a triangle's corners at a point of it.
fn weights([a, b, c]: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let area = (b - a).cross(c - a);
    let share = |p: &DVec3, q: &DVec3| (p - point).cross(q - point).dot(area) / area.length_squared();
    [share(b, c), share(c, a), share(a, b)]
}

/// What [`Scene::is_solid_at`] says, but in `f64`: in `f32` the borders of a mask's texels are off by up to half a
/// second of a day, and rays through their corners see light that is not there.
fn is_solid_at(scene: &Scene, instance: usize, triangle: usize, barycentric: [f64; 2]) -> bool {
    let material = scene.material(instance);
    let Alpha::Mask { cutoff } = material.alpha else { return material.alpha == Alpha::Opaque };
    let mesh = &scene.meshes[scene.instances[instance].mesh];
    let [v, w] = barycentric;
    let blend = |[a, b, c]: [f64; 3]| a * (1.0 - v - w) + b * v + c * w;
    let texel = material.base_color_texture.map_or(1.0, |texture| {
        let image = &scene.images[texture.image];
        let uvs = image_uvs(mesh, &texture, triangle);
        let size = [image.width, image.height];
        let middle = |axis: usize| {
            let position = blend(uvs.map(|uv| f64::from(uv[axis]))) * f64::from(size[axis]);
            ((position.floor() + 0.5) / f64::from(size[axis])) as f32
        };
        let [x, y] = nearest_texel(Vec2::new(middle(0), middle(1)), size, texture.wrap);
        f32::from(image.rgba[(y * image.width + x) as usize][3]) / 255.0
    });
    let vertex = blend(vertex_alphas(mesh, triangle).map(f64::from)) as f32;
    material.base_color.w * vertex * texel >= cutoff
}

/// Where a ray meets a triangle in front of its start: the weights of the second and third corner.
fn met([a, b, c]: &[DVec3; 3], start: DVec3, unit: DVec3) -> Option<[f64; 2]> {
    let (ab, ac, from_a) = (b - a, c - a, start - a);
    let p = unit.cross(ac);
    let q = from_a.cross(ab);
    let inverse = 1.0 / ab.dot(p);
    let [u, v, distance] = [from_a.dot(p) * inverse, unit.dot(q) * inverse, ac.dot(q) * inverse];
    (u >= -GROWTH && v >= -GROWTH && u + v <= 1.0 + GROWTH && distance > 0.0).then_some([u, v])
}

impl Arc {
    fn new(arc: &SunArc, suns: Range<usize>, count: usize) -> Self {
        let (sin_declination, cos_declination) = arc.declination_rad.sin_cos();
        Self { arc: *arc, square: arc.axis.cross(arc.zero), sin_declination, cos_declination, suns, count }
    }

    fn windows(&self, corners: &[DVec3; 3], near_m: f64, halvings: u32, windows: &mut Vec<Range<usize>>) {
        let Some([from_rad, to_rad]) = self.hour_angles(corners, near_m) else { return };
        if halvings > 0 && to_rad - from_rad > WIDE_RAD {
            quarters(corners).iter().for_each(|quarter| self.windows(quarter, near_m, halvings - 1, windows));
        } else {
            self.suns_between(from_rad, to_rad, windows);
        }
    }

    /// Hour angles whose directions meet the ball around a triangle, or pass within `near_m` of it on either side of
    /// the origin; up to whole turns.
    fn hour_angles(&self, corners: &[DVec3; 3], near_m: f64) -> Option<[f64; 2]> {
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
        let distance = centre.length();
        if distance <= (radius + near_m) * 1.001 {
            return Some([-PI, PI]);
        }
        let unit = centre / distance;
        let height = self.arc.axis.dot(unit);
        let [x, y] = [self.arc.zero.dot(unit), self.square.dot(unit)];
        let across = x.hypot(y);
        let least_cos = (1.0 - (radius / distance).powi(2)).sqrt() - SLACK_COS;
        let (level, steep) = (height * self.sin_declination, across * self.cos_declination);
        if level + steep < least_cos {
            return None;
        }
        let half_rad = ((least_cos - level) / steep).clamp(-1.0, 1.0).acos() + SLACK_RAD;
        // At the axis itself there is no quotient, and no telling the hour angle.
        let half_rad = if half_rad.is_nan() { PI } else { half_rad };
        let middle_rad = y.atan2(x);
        Some([middle_rad - half_rad, middle_rad + half_rad])
    }

    /// Adds the suns of this arc between two hour angles, of every turn.
    fn suns_between(&self, from_rad: f64, to_rad: f64, windows: &mut Vec<Range<usize>>) {
        let [start_rad, end_rad] = self.arc.hour_angle_rad;
        let first = ((start_rad - to_rad) / TAU).ceil() as i64;
        let last = ((end_rad - from_rad) / TAU).floor() as i64;
        for turn in first..=last {
            let sun = |rad: f64| self.sun_at(rad + turn as f64 * TAU);
            let from = (sun(from_rad).floor() - 1.0).max(self.suns.start as f64) as usize;
            let to = (sun(to_rad).ceil() + 2.0).clamp(0.0, self.suns.end as f64) as usize;
            windows.push(from..to);
        }
    }

    /// Where among the suns an hour angle lies.
    fn sun_at(&self, hour_angle_rad: f64) -> f64 {
        let [start_rad, end_rad] = self.arc.hour_angle_rad;
        let [start_t, end_t] = self.arc.t;
        let t = start_t + (end_t - start_t) * (hour_angle_rad - start_rad) / (end_rad - start_rad);
        t * self.count as f64 - 0.5
    }
}

fn quarters(&[a, b, c]: &[DVec3; 3]) -> [[DVec3; 3]; 4] {
    let [ab, bc, ca] = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::Random;
    use sunbake::testing::SceneBuilder;

    /// Windows are a short cut: without them every answer is the same.
    #[test]
    fn windows_leave_out_no_sun_that_a_triangle_hides() {
        let mut random = Random::new(21);
        let mut hidden = 0;
        for case in 0..300 {
            let middle = random.cube() * 3.0;
            let size = 10f64.powf(random.range(-2.0, 1.0));
            let triangle = [0; 3].map(|_| (middle + random.cube() * size).as_vec3());
            let here = Traced::new(SceneBuilder::new().soup(&[triangle]).build());
            let oracle = Oracle::new(&here, &random.path(), 512);
            let origin = random.cube() * 0.5;
            let caster = &oracle.casters[0];
            let mut in_windows = vec![true; 512];
            for suns in oracle.windows(&caster.corners.map(|corner| corner - origin)) {
                oracle.shade(caster, origin, suns, &mut in_windows);
            }
            let everywhere: Vec<bool> = oracle.suns.iter().map(|sun| !oracle.blocks(caster, origin, *sun)).collect();
            assert_eq!(in_windows, everywhere, "case {case}");
            hidden += everywhere.iter().filter(|seen| !**seen).count();
        }
        assert!(hidden > 5_000, "the triangles hide only {hidden} suns");
    }

    /// One wall, one sun that rises behind it: trigonometry says when it comes into sight.
    #[test]
    fn a_wall_hides_the_sun_as_trigonometry_says() {
        let floor = sunbake::testing::floor(Vec2::splat(-9.0), Vec2::splat(9.0), 0.0);
        let wall = [[-2.0, 0.0, -9.0], [-2.0, 0.0, 9.0], [-2.0, 4.0, 0.0f32]].map(glam::Vec3::from);
        let here = Traced::new(SceneBuilder::new().soup(&floor).soup(&[wall]).build());
        let lit = Oracle::new(&here, &crate::over_the_top(-DVec3::X), 1000).lit(&here.point_at(DVec3::ZERO, 0));
        let first = lit.iter().position(|lit| *lit).expect("the afternoon is sunny");
        assert_eq!(first, (2f64.atan2(1.0) / PI * 1000.0).round() as usize);
        assert!(lit[first..].iter().all(|lit| *lit));
    }
}
