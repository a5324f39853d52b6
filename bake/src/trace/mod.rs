//! Traces rays against the scene. This is the only file that uses obvhs.
//!
//! The hierarchy is obvhs' eight-wide compressed BVH, traversed in `f32`; triangles are tested in `f64` on their `f32`
//! corners. Three departures from plain obvhs:
//!
//! * **Watertight triangles.** obvhs' own test leaves gaps at shared edges. Ours is "Watertight Ray/Triangle
//!   Intersection" (Woop, Benthin and Wald, *Journal of Computer Graphics Techniques* 2(1), 2013): neighbours compute
//!   the same edge function with opposite signs, and zero counts as a hit for both.
//! * **Padded boxes.** obvhs' slab test rounds in both directions. Boxes are grown by [`BOX_PADDING`] of the scene's
//!   size, which is more than the rounding error of a traversal.
//! * **Tracer space.** obvhs' nodes clamp sizes to an absolute 1e-4. So the scene is scaled by a power of two, which is
//!   exact, until its half size is between 512 and 1024 units. Public methods take and return bake space; the doc of
//!   [`crate::scene`] explains the spaces.
//!
//! # Where shadow rays start
//!
//! Three offsets decide what a surface hides from itself and its neighbours (and smooth surfaces have a fourth,
//! [`Tracer::lift_smooth`]):
//!
//! * The **lift** ([`Tracer::lift`]) moves the origin off the surface along its normal, by a few rounding steps of the
//!   surface's coordinates.
//! * The origin then moves as far away from the triangle's edges.
//! * The **run-up** ([`Tracer::run_up_m`]) moves the start *back* along the ray, by half the least lift. So a
//!   point exactly on the edge between two walls is shaded by both walls, but never by its own surface.

mod alpha_mask;
mod alpha_texture;
pub(crate) mod bvh16;
mod direction;
mod lamp_ray;
mod lift;
mod packet;
mod ray_f32;
#[cfg(test)]
mod tests;

pub use direction::Direction;
pub use packet::{PACKET, PacketScratch, PacketTracer, ShadowQuery};

use crate::scene::{Geometry, Scene};
use alpha_mask::AlphaMasks;
pub(crate) use alpha_mask::MaskedTriangle;
use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh};
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams};

/// Growth of every box, as a share of the scene's largest half size in tracer space.
const BOX_PADDING: f32 = 1.0 / (1 << 20) as f32;
/// A scene prepared for ray tracing. Public methods take and return positions and distances in bake space, in metres.
pub struct Tracer {
    bvh: CwBvh,
    /// Corners in tracer space, in the hierarchy's order.
    corners: Vec<[Vec3; 3]>,
    /// Flat index in [`Geometry`], in the hierarchy's order.
    flat: Vec<u32>,
    alpha_mask: AlphaMasks,
    tracer_from_bake: f64,
    /// Run-up of shadow rays in tracer space: half of the least lift.
    run_up: f64,
    /// For each instance, the lift of its shadow rays.
    lift_m: Vec<f64>,
    /// For each flat triangle, its centroid.
    centroid_m: Vec<Vec3>,
    /// For each flat triangle, its instance.
    instance: Vec<u32>,
}

/// The nearest surface along a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Flat index in [`Geometry`].
    pub triangle: u32,
    /// Distance from the ray's origin, in metres.
    pub distance_m: f64,
    /// Weights of the triangle's second and third corner, 0 to 1.
    pub barycentric: [f64; 2],
}

/// A triangle that occluded a ray. The next ray tests it first, since it is likely occluded by the same triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Occluder(u32);

impl Tracer {
    /// Builds the hierarchy over every triangle that blocks light.
    pub fn new(scene: &Scene, geometry: &Geometry) -> Self {
        Self::over(scene, geometry, |triangle| geometry.casts(scene, triangle))
    }

    /// Builds the hierarchy over every triangle that can be seen, for rays from the eye.
    pub fn of_visible(scene: &Scene, geometry: &Geometry) -> Self {
        Self::over(scene, geometry, |triangle| geometry.is_there(scene, triangle))
    }

    fn over(scene: &Scene, geometry: &Geometry, holds: impl Fn(usize) -> bool) -> Self {
        let tracer_from_bake = scale_to_tracer_space(geometry);
        let solid: Vec<u32> = (0..geometry.triangles.len()).filter(|&i| holds(i)).map(|i| i as u32).collect();
        let scaled = |&i: &u32| geometry.triangles[i as usize].map(|v| (v.as_dvec3() * tracer_from_bake).as_vec3());
        let padding = Vec3A::splat(BOX_PADDING * 1024.0);
        let boxes: Vec<PaddedBox> = solid.iter().map(|i| PaddedBox::new(scaled(i), padding)).collect();
        let bvh = match boxes.is_empty() {
            true => CwBvh::default(),
            false => build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut std::time::Duration::default()),
        };
        let flat: Vec<u32> = bvh.primitive_indices.iter().map(|&i| solid[i as usize]).collect();
        let corners = flat.iter().map(scaled).collect();
        let alpha_mask = AlphaMasks::new(scene, geometry, &flat);
        let lift_m = lift::lifts_m(scene, geometry);
        let run_up = 0.5 * tracer_from_bake * lift_m.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let centroid_m = geometry.triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let instance = geometry.instance.clone();
        Self { bvh, corners, flat, alpha_mask, tracer_from_bake, run_up, lift_m, centroid_m, instance }
    }

    /// The origin of a shadow ray from a point of a triangle: moved along `side` (the unit normal or its opposite) by
    /// more than the corners' rounding and less than any modelled detail, and moved inwards as far from the triangle's
    /// edges, since a point exactly on an edge is as much inside a room as outside.
    pub fn lift(&self, point_m: DVec3, side: DVec3, triangle: u32) -> DVec3 {
        let triangle = triangle as usize;
        let lift_m = self.lift_m[self.instance[triangle] as usize];
        let inwards = self.centroid_m[triangle].as_dvec3() - point_m;
        point_m + side * lift_m + inwards.clamp_length_max(lift_m)
    }

    /// The origin of a shadow ray from a point that shading normals move by `lift_m`: see
    /// [`crate::scene::SmoothPoint`].
    pub fn lift_smooth(&self, point_m: DVec3, side: DVec3, triangle: u32, lift_m: DVec3) -> DVec3 {
        self.lift(point_m, side, triangle) + lift_m * self.free_share(point_m, side, triangle, lift_m)
    }

    /// How much of a lift a point may rise, from 0 to 1: half-way to the next surface at most, so that no light comes
    /// through walls, or from below what lies on the point.
    pub fn free_share(&self, point_m: DVec3, side: DVec3, triangle: u32, lift_m: DVec3) -> f64 {
        let length_m = lift_m.length();
        let Some(along) = lift_m.try_normalize() else { return 0.0 };
        let start_m = self.lift(point_m, side, triangle);
        let free_m = self.nearest_within(start_m, &Direction::new(along), 2.0 * length_m);
        free_m.map_or(1.0, |free_m| (0.5 * free_m / length_m).min(1.0))
    }

    /// Distance of the nearest surface along the direction, if there is one within reach.
    pub fn nearest_within(&self, origin_m: DVec3, direction: &Direction, reach_m: f64) -> Option<f64> {
        let origin = origin_m * self.tracer_from_bake;
        let mut nearest = reach_m * self.tracer_from_bake;
        let mut found = false;
        // The traversal is in `f32`: the margin is more than its rounding.
        let far = |distance: f64| (distance * (1.0 + 1e-6)) as f32;
        let ray = Ray { tmax: far(nearest), ..ray(origin, direction) };
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |_, id| match self.intersect(origin, direction, id) {
            Some((distance, _)) if distance <= nearest => {
                (nearest, found) = (distance, true);
                far(distance)
            }
            _ => f32::INFINITY,
        });
        found.then_some(nearest / self.tracer_from_bake)
    }

    /// Corners in tracer space of every triangle that blocks light. An [`Occluder`] holds an index into this.
    pub(crate) fn corners(&self) -> &[[Vec3; 3]] {
        &self.corners
    }

    /// Flat index in [`Geometry`] of each of these triangles.
    pub(crate) fn flat(&self) -> &[u32] {
        &self.flat
    }

    /// Whether a triangle has an alpha mask.
    #[inline]
    pub(crate) fn has_alpha_mask(&self, id: u32) -> bool {
        self.alpha_mask.has_alpha_mask(id as usize)
    }

    /// A triangle's alpha mask, if it has one.
    pub(crate) fn mask(&self, id: u32) -> Option<MaskedTriangle<'_>> {
        self.alpha_mask.view(id as usize)
    }

    /// Factor from bake to tracer space, a power of two.
    pub(crate) fn tracer_from_bake(&self) -> f64 {
        self.tracer_from_bake
    }

    /// Run-up of shadow rays, in tracer space.
    pub(crate) fn run_up(&self) -> f64 {
        self.run_up
    }

    /// Run-up of shadow rays in metres: how far before its origin a ray starts. Half of the least lift of any instance.
    pub fn run_up_m(&self) -> f64 {
        self.run_up / self.tracer_from_bake
    }

    /// Whether some solid surface lies along the direction.
    pub fn is_occluded(&self, origin_m: DVec3, direction: &Direction) -> bool {
        self.occluder(origin_m, direction).is_some()
    }

    /// A solid triangle along the direction, not necessarily the nearest.
    pub fn occluder(&self, origin_m: DVec3, direction: &Direction) -> Option<Occluder> {
        let origin = self.shadow_start(origin_m, direction);
        self.any(origin, direction, f32::INFINITY, |id| self.intersect(origin, direction, id).is_some())
    }

    /// A triangle for which `hides` holds, among those whose boxes the ray meets within `reach` (origin and reach in
    /// tracer space).
    fn any(&self, origin: DVec3, direction: &Direction, reach: f32, hides: impl Fn(usize) -> bool) -> Option<Occluder> {
        let ray = Ray { tmax: reach, ..ray(origin, direction) };
        let mut found = None;
        self.bvh.ray_traverse_miss(ray, |_, id| match hides(id) {
            true => {
                found = Some(Occluder(id as u32));
                0.0
            }
            false => f32::INFINITY,
        });
        found
    }

    /// Whether one given triangle lies along the direction.
    #[inline]
    pub fn is_occluded_by(&self, occluder: Occluder, origin_m: DVec3, direction: &Direction) -> bool {
        self.intersect(self.shadow_start(origin_m, direction), direction, occluder.0 as usize).is_some()
    }

    /// Start of a shadow ray in tracer space, with the run-up.
    #[inline]
    fn shadow_start(&self, origin_m: DVec3, direction: &Direction) -> DVec3 {
        origin_m * self.tracer_from_bake - direction.unit() * self.run_up
    }

    /// The nearest surface along the direction for which `accept` (given its flat triangle index) holds.
    pub fn closest_hit_where(
        &self,
        origin_m: DVec3,
        direction: &Direction,
        accept: impl Fn(u32) -> bool,
    ) -> Option<Hit> {
        let origin = origin_m * self.tracer_from_bake;
        let ray = ray(origin, direction);
        let mut nearest: Option<(usize, f64, [f64; 2])> = None;
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |_, id| {
            let Some((distance, barycentric)) = self.intersect(origin, direction, id) else { return f32::INFINITY };
            if nearest.is_some_and(|(_, least, _)| distance >= least) || !accept(self.flat[id]) {
                return f32::INFINITY;
            }
            nearest = Some((id, distance, barycentric));
            // The traversal skips boxes beyond this; the margin keeps rounding from hiding a nearer surface.
            (distance * (1.0 + 1e-6)) as f32
        });
        nearest.map(|(id, distance, barycentric)| Hit {
            triangle: self.flat[id],
            distance_m: distance / self.tracer_from_bake,
            barycentric,
        })
    }

    /// The nearest surface along the direction.
    pub fn closest_hit(&self, origin_m: DVec3, direction: &Direction) -> Option<Hit> {
        self.closest_hit_where(origin_m, direction, |_| true)
    }

    /// Calls `visit` with the flat index and the distance in metres of every triangle along the direction, in no order.
    /// Alpha masks are ignored. A ray through an edge meets both of its triangles.
    pub fn for_each_hit(&self, origin_m: DVec3, direction: &Direction, mut visit: impl FnMut(u32, f64)) {
        let origin = origin_m * self.tracer_from_bake;
        self.bvh.ray_traverse(ray(origin, direction), &mut RayHit::none(), |_, id| {
            if let Some((distance, _)) = direction.intersect(origin, &self.corners[id]) {
                visit(self.flat[id], distance / self.tracer_from_bake);
            }
            f32::INFINITY
        });
    }

    #[inline]
    fn intersect(&self, origin: DVec3, direction: &Direction, id: usize) -> Option<(f64, [f64; 2])> {
        let met = direction.intersect(origin, &self.corners[id])?;
        self.alpha_mask.is_solid(id, met.1).then_some(met)
    }
}

/// A node of a binary hierarchy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BinaryNode {
    /// Low and high corner of its box.
    pub bounds: [Vec3; 2],
    /// Number of primitives of a leaf; 0 for an inner node.
    pub count: u32,
    /// A leaf's first primitive, as an index in the order; or an inner node's first child, which the second follows.
    pub first: u32,
}

/// A binary hierarchy over boxes, root first, with one primitive per leaf, and the order of its primitives.
pub(crate) fn binary_hierarchy(boxes: &[[Vec3; 2]]) -> (Vec<BinaryNode>, Vec<u32>) {
    if boxes.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let boxes: Vec<PaddedBox> =
        boxes.iter().map(|&[low, high]| PaddedBox(Aabb::new(low.into(), high.into()))).collect();
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
    let bvh = build_bvh2(&boxes, params, &mut std::time::Duration::default());
    let node = |node: &obvhs::bvh2::node::Bvh2Node| BinaryNode {
        bounds: [node.aabb().min.into(), node.aabb().max.into()],
        count: node.prim_count,
        first: node.first_index,
    };
    (bvh.nodes.iter().map(node).collect(), bvh.primitive_indices)
}

/// A ray for obvhs. Adding zero removes -0.0, whose sign obvhs treats inconsistently.
fn ray(origin: DVec3, direction: &Direction) -> Ray {
    Ray::new_inf(origin.as_vec3a(), direction.unit().as_vec3a() + Vec3A::ZERO)
}

/// The power of two that scales the largest coordinate to between 512 and 1024.
fn scale_to_tracer_space(geometry: &Geometry) -> f64 {
    let largest = geometry.triangles.iter().flatten().map(|v| v.abs().max_element()).fold(0.0, f32::max);
    match largest > 0.0 {
        true => 2f64.powi(9 - f64::from(largest).log2().floor() as i32),
        false => 1.0,
    }
}

/// A triangle's bounding box, enlarged by the padding.
struct PaddedBox(Aabb);

impl PaddedBox {
    fn new(corners: [Vec3; 3], padding: Vec3A) -> Self {
        let tight = Aabb::from_points(&corners.map(Vec3A::from));
        Self(Aabb::new(tight.min - padding, tight.max + padding))
    }
}

impl Boundable for PaddedBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}
