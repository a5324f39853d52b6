//! Traces packets of up to sixteen incoherent rays through a 16-wide BVH.
//!
//! Theory: rays over a hemisphere have little in common, so SIMD over rays wastes lanes. Instead, one ray is tested
//! against all children of a wide node at once (Wald, Benthin and Boulos, "Getting rid of packets", *IEEE Symposium on
//! Interactive Ray Tracing*, 2008). Rays of a packet share the traversal: sixteen rays of roughly equal direction meet
//! mostly the same nodes, so each node is loaded, and its children are pushed, once for all of them.
//!
//! Practice: a stack entry is a node and the set of rays that met its box. Each of these rays is tested against the
//! node's children separately, so no lane is spent on a ray that did not meet the node.
//!
//! Precision: boxes and triangles are tested in `f32`, conservatively: boxes are enlarged, and a triangle is a
//! candidate if the ray passes within [`CORNER_PADDING`] of it. Candidates are then tested in `f64`, with the test of
//! [`Tracer`]. So results equal the tracer's, are watertight at shared edges, and do not depend on the SIMD width.

use super::bvh16::{Bvh16, Bvh16Leaf, Bvh16Node, Child, WIDTH, bits, first_lanes, push_far_first};
use super::{Direction, Hit, Occluder, Tracer};
use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*, u32x16};
use glam::{DMat3, DVec3};

/// Growth of every box in tracer space (whose half size is 512 to 1024): more than the rounding of a ray's start and of
/// its distances.
const BOX_PADDING: f32 = 1.0 / 256.0;
/// Largest distance of a ray from a candidate triangle, in tracer space: sixteen rounding steps of an `f32` at 1024.
/// Start, shear and differences are rounded by a quarter of that, the products of edge functions by another quarter.
const CORNER_PADDING: f32 = 1.0 / 512.0;

/// Traces packets of rays in all directions. Positions and distances in its methods are in bake space, in metres.
pub struct PacketTracer<'a> {
    tracer: &'a Tracer,
    bvh: Bvh16,
    /// For each flat triangle, its index in [`Tracer::corners`]; [`u32::MAX`] if it is not solid.
    id_of_flat: Vec<u32>,
    level: Level,
}

/// Buffers of a traversal, reused by the next one.
#[derive(Debug, Default)]
pub struct PacketScratch {
    near: [f32; WIDTH],
    rays: Vec<ShadowRay>,
    /// Stack for occlusion: a child and the set of rays that met it.
    shared: Vec<(Child, u32)>,
    /// Stack for nearest hits: the same with distances.
    sorted: Vec<QueuedChild>,
    /// For each ray, the set of a node's children that it met.
    children: [u32; PACKET],
}

/// A stack entry of the search for nearest hits.
#[derive(Debug, Clone, Copy)]
struct QueuedChild {
    child: Child,
    met_by: u32,
    /// Least distance along any of the rays that met it, tracer space.
    near: f32,
}

/// A ray rounded to `f32` for the conservative tests, tracer space.
#[derive(Debug)]
struct RayF32 {
    start: [f32; 3],
    inverse: [f32; 3],
    axes: [usize; 3],
    /// Shear along the first two axes, and one over the direction's largest component.
    shear: [f32; 3],
}

impl RayF32 {
    fn new(start: DVec3, direction: &Direction) -> Self {
        // A component of zero would give NaN for a box side that the ray starts on.
        let inverse = |d: f64| 1.0 / if d.abs() < 1e-12 { 1e-12f64.copysign(d) } else { d };
        let unit = direction.unit();
        Self {
            start: start.as_vec3().to_array(),
            inverse: [unit.x, unit.y, unit.z].map(|d| inverse(d) as f32),
            axes: direction.axes,
            shear: direction.shear.as_vec3().to_array(),
        }
    }
}

/// Most rays in a packet.
pub const PACKET: usize = 16;

/// A ray from a surface.
#[derive(Debug, Clone, Copy)]
pub struct ShadowQuery {
    /// Origin in bake space: see [`Tracer::lift`].
    pub origin_m: DVec3,
    /// Unit direction, pointing away from the surface.
    pub direction: DVec3,
    /// The triangle that the ray leaves, which cannot occlude it: flat index in [`crate::scene::Geometry`].
    pub triangle: u32,
}

/// A prepared shadow ray, tracer space.
#[derive(Debug)]
struct ShadowRay {
    ray_f32: RayF32,
    start: DVec3,
    direction: Direction,
    /// The triangle that the ray leaves: index in [`Tracer::corners`].
    own: u32,
}

impl<'a> PacketTracer<'a> {
    /// Builds the hierarchy over every triangle that blocks light.
    pub fn new(tracer: &'a Tracer) -> Self {
        let padding = BOX_PADDING + tracer.run_up as f32;
        let mut id_of_flat = vec![u32::MAX; tracer.instance.len()];
        tracer.flat.iter().enumerate().for_each(|(id, &flat)| id_of_flat[flat as usize] = id as u32);
        Self { tracer, bvh: Bvh16::new(tracer, DMat3::IDENTITY, padding), id_of_flat, level: Level::new() }
    }

    /// The set of occluded rays, as bits, among up to [`PACKET`] shadow rays. Rays of roughly equal direction from
    /// neighbouring points are the fastest. `guess` is tested first, and is set to a triangle that occluded one of the
    /// rays; it only affects speed.
    pub fn occluded(&self, scratch: &mut PacketScratch, queries: &[ShadowQuery], guess: &mut Option<Occluder>) -> u32 {
        scratch.rays.clear();
        scratch.rays.extend(queries.iter().map(|query| self.ray(query)));
        let mut occluded = 0;
        if let Some(Occluder(id)) = *guess {
            // A guess that misses one ray will hardly occlude the next.
            let first =
                scratch.rays.iter().take_while(|ray| ray.own != id && self.intersect(ray, id).is_some()).count();
            occluded = (1u32 << first) - 1;
        }
        let open = first_lanes(queries.len()) & !occluded;
        if open != 0 && !self.bvh.nodes.is_empty() {
            let level = self.level;
            *guess = None;
            occluded |= dispatch!(level, simd => self.find_occluded(simd, scratch, open, guess));
        }
        occluded
    }

    fn ray(&self, query: &ShadowQuery) -> ShadowRay {
        let direction = Direction::new(query.direction);
        let start = self.tracer.shadow_start(query.origin_m, &direction);
        ShadowRay {
            ray_f32: RayF32::new(start, &direction),
            start,
            direction,
            own: self.id_of_flat[query.triangle as usize],
        }
    }

    /// For each of up to [`PACKET`] shadow rays, the nearest surface within `reach_m` metres; `None` for missing rays.
    pub fn nearest(&self, scratch: &mut PacketScratch, queries: &[ShadowQuery], reach_m: f64) -> [Option<Hit>; PACKET] {
        scratch.rays.clear();
        scratch.rays.extend(queries.iter().map(|query| self.ray(query)));
        let mut found = [None; PACKET];
        if !queries.is_empty() && !self.bvh.nodes.is_empty() {
            let reach = reach_m * self.tracer.tracer_from_bake + self.tracer.run_up;
            let level = self.level;
            dispatch!(level, simd => self.find_nearest(simd, scratch, reach, &mut found));
        }
        found.map(|found| found.map(|nearest| self.hit(&nearest)))
    }

    fn hit(&self, nearest: &NearestHit) -> Hit {
        Hit {
            triangle: self.tracer.flat[nearest.id as usize],
            distance_m: (nearest.distance - self.tracer.run_up).max(0.0) / self.tracer.tracer_from_bake,
            barycentric: nearest.barycentric,
        }
    }

    #[inline]
    fn intersect(&self, ray: &ShadowRay, id: u32) -> Option<(f64, [f64; 2])> {
        self.tracer.intersect(ray.start, &ray.direction, id as usize)
    }

    /// Traverses for the rays in the bit set `open`; returns the set of those that are occluded.
    #[inline(always)]
    fn find_occluded<S: Simd>(
        &self,
        simd: S,
        scratch: &mut PacketScratch,
        open: u32,
        found: &mut Option<Occluder>,
    ) -> u32 {
        let PacketScratch { rays, shared, children, near, .. } = scratch;
        let mut active = open;
        shared.clear();
        shared.push((Child::ROOT, open));
        while let Some((child, met_by)) = shared.pop() {
            let asking = met_by & active;
            if asking == 0 {
                continue;
            }
            match child {
                Child::Node(node) => {
                    let node = &self.bvh.nodes[node as usize];
                    let mut met = 0;
                    children.fill(0);
                    for ray in bits(asking) {
                        children[ray] = node_met(simd, node, &rays[ray].ray_f32, f32::INFINITY, near);
                        met |= children[ray];
                    }
                    let of_rays = u32x16::from_slice(simd, children);
                    for lane in bits(met) {
                        let bit = u32x16::splat(simd, 1 << lane);
                        let met_by = (of_rays & bit).simd_eq(bit).to_bitmask() as u32;
                        shared.push((node.child[lane], met_by));
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.bvh.leaves[leaf as usize];
                    for index in bits(asking) {
                        let ray = &rays[index];
                        for lane in bits(leaf_met(simd, leaf, &ray.ray_f32, f32::INFINITY)) {
                            let id = leaf.ids[lane];
                            if id != ray.own && self.intersect(ray, id).is_some() {
                                *found = Some(Occluder(id));
                                active &= !(1 << index);
                                break;
                            }
                        }
                    }
                    if active == 0 {
                        break;
                    }
                }
            }
        }
        open & !active
    }

    /// Traverses for all rays, near nodes first, and finds each ray's nearest hit.
    #[inline(always)]
    fn find_nearest<S: Simd>(
        &self,
        simd: S,
        scratch: &mut PacketScratch,
        reach: f64,
        found: &mut [Option<NearestHit>; PACKET],
    ) {
        let PacketScratch { rays, sorted, children, near, .. } = scratch;
        let mut reach = [reach; PACKET];
        sorted.clear();
        sorted.push(QueuedChild { child: Child::ROOT, met_by: first_lanes(rays.len()), near: 0.0 });
        while let Some(QueuedChild { child, met_by, near: least }) = sorted.pop() {
            let asking = met_by;
            match child {
                Child::Node(node) => {
                    let node = &self.bvh.nodes[node as usize];
                    let mut met = 0;
                    let mut nearest = f32x16::splat(simd, f32::INFINITY);
                    children.fill(0);
                    for ray in bits(asking) {
                        let far = reach[ray] as f32 * FAR_SLACK;
                        if least <= far {
                            children[ray] = node_met(simd, node, &rays[ray].ray_f32, far, near);
                            met |= children[ray];
                            nearest = nearest.min(f32x16::from_slice(simd, near));
                        }
                    }
                    nearest.store_slice(near);
                    let of_rays = u32x16::from_slice(simd, children);
                    let first = sorted.len();
                    for lane in bits(met) {
                        let bit = u32x16::splat(simd, 1 << lane);
                        let met_by = (of_rays & bit).simd_eq(bit).to_bitmask() as u32;
                        push_far_first(
                            sorted,
                            first,
                            QueuedChild { child: node.child[lane], met_by, near: near[lane] },
                            |pending| pending.near,
                        );
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.bvh.leaves[leaf as usize];
                    for index in bits(asking) {
                        let (ray, reach, found) = (&rays[index], &mut reach[index], &mut found[index]);
                        for lane in bits(leaf_met(simd, leaf, &ray.ray_f32, *reach as f32 * FAR_SLACK)) {
                            let id = leaf.ids[lane];
                            if id != ray.own
                                && let Some((distance, barycentric)) = self.intersect(ray, id)
                                && is_nearer((id, distance), found, *reach)
                            {
                                (*reach, *found) = (distance, Some(NearestHit { id, distance, barycentric }));
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Margin for skipping boxes by their distance in `f32`: more than the distance's rounding.
const FAR_SLACK: f32 = 1.0 + 1e-6;

/// A ray's nearest hit so far, tracer space.
#[derive(Debug, Clone, Copy)]
struct NearestHit {
    id: u32,
    distance: f64,
    barycentric: [f64; 2],
}

/// Among equally near triangles the lowest index wins, independent of the traversal's order.
#[inline]
fn is_nearer((id, distance): (u32, f64), found: &Option<NearestHit>, reach: f64) -> bool {
    match found {
        Some(nearest) => distance < nearest.distance || (distance == nearest.distance && id < nearest.id),
        None => distance <= reach,
    }
}

/// The set of a node's boxes that a ray meets before `far`. `near` gets the distances at which it enters them.
#[inline(always)]
fn node_met<S: Simd>(simd: S, node: &Bvh16Node, ray: &RayF32, far: f32, near: &mut [f32; WIDTH]) -> u32 {
    let [x, y, z] = ray.inverse;
    let middle_x = (f32x16::from_slice(simd, &node.centre[0]) - ray.start[0]) * x;
    let middle_y = (f32x16::from_slice(simd, &node.centre[1]) - ray.start[1]) * y;
    let middle_z = (f32x16::from_slice(simd, &node.centre[2]) - ray.start[2]) * z;
    let half_x = f32x16::from_slice(simd, &node.half[0]) * x.abs();
    let half_y = f32x16::from_slice(simd, &node.half[1]) * y.abs();
    let half_z = f32x16::from_slice(simd, &node.half[2]) * z.abs();
    let enters = (middle_x - half_x).max(middle_y - half_y).max(middle_z - half_z);
    let leaves = (middle_x + half_x).min(middle_y + half_y).min(middle_z + half_z);
    let starts = enters.max(f32x16::splat(simd, 0.0));
    let met = starts.simd_le(leaves.min(f32x16::splat(simd, far)));
    starts.store_slice(near);
    met.to_bitmask() as u32 & first_lanes(node.count)
}

/// The set of a leaf's triangles that a ray may hit before `far`.
#[inline(always)]
fn leaf_met<S: Simd>(simd: S, leaf: &Bvh16Leaf, ray: &RayF32, far: f32) -> u32 {
    let [i, j, k] = ray.axes;
    let [shear_x, shear_y, along] = ray.shear;
    let [a, b, c] = &leaf.corners;
    let a_z = f32x16::from_slice(simd, &a[k]) - ray.start[k];
    let b_z = f32x16::from_slice(simd, &b[k]) - ray.start[k];
    let c_z = f32x16::from_slice(simd, &c[k]) - ray.start[k];
    let a_x = f32x16::from_slice(simd, &a[i]) - ray.start[i] - a_z * shear_x;
    let b_x = f32x16::from_slice(simd, &b[i]) - ray.start[i] - b_z * shear_x;
    let c_x = f32x16::from_slice(simd, &c[i]) - ray.start[i] - c_z * shear_x;
    let a_y = f32x16::from_slice(simd, &a[j]) - ray.start[j] - a_z * shear_y;
    let b_y = f32x16::from_slice(simd, &b[j]) - ray.start[j] - b_z * shear_y;
    let c_y = f32x16::from_slice(simd, &c[j]) - ray.start[j] - c_z * shear_y;
    let a_size = (a_x.abs() + a_y.abs()) * CORNER_PADDING;
    let b_size = (b_x.abs() + b_y.abs()) * CORNER_PADDING;
    let c_size = (c_x.abs() + c_y.abs()) * CORNER_PADDING;
    let from_a = c_x * b_y - c_y * b_x;
    let from_b = a_x * c_y - a_y * c_x;
    let from_c = b_x * a_y - b_y * a_x;
    let (pad_a, pad_b, pad_c) = (b_size + c_size, c_size + a_size, a_size + b_size);
    let zero = f32x16::splat(simd, 0.0);
    let least = (from_a + pad_a).min(from_b + pad_b).min(from_c + pad_c);
    let most = (from_a - pad_a).max(from_b - pad_b).max(from_c - pad_c);
    let passed = least.simd_ge(zero) | most.simd_le(zero);
    let (a_z, b_z, c_z) = (a_z * along, b_z * along, c_z * along);
    let farthest = a_z.max(b_z).max(c_z);
    let nearest = a_z.min(b_z).min(c_z);
    let padding = f32x16::splat(simd, BOX_PADDING);
    let ahead = farthest.simd_ge(-padding) & nearest.simd_le(padding + far);
    (passed & ahead).to_bitmask() as u32 & first_lanes(leaf.count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Geometry;
    use crate::testing::{SceneBuilder, block, floor, icosphere, pseudo_random};
    use glam::{Vec2, Vec3};

    /// Spheres, posts and slivers on a floor; rays from all over it in all directions, sixteen at a time.
    fn packets(check: impl Fn(&Tracer, &mut PacketTracer, &[ShadowQuery])) {
        let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0));
        for i in 0..12 {
            let at = Vec3::new((i % 4) as f32 * 2.0 - 3.0, 0.3, (i / 4) as f32 * 2.0 - 2.0);
            let stone: Vec<[Vec3; 3]> = icosphere(2).iter().map(|t| t.map(|v| v * 0.5 + at)).collect();
            builder = builder.soup(&stone).soup(&block(at + Vec3::X, at + Vec3::new(1.004, 2.0, 0.3)));
        }
        let scene = builder.build();
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        let mut packet_tracer = PacketTracer::new(&tracer);
        let mut state = 5;
        let mut random = || pseudo_random(&mut state);
        for _ in 0..400 {
            let spread = random();
            let axis = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
            let mut query = || {
                let triangle = (random() * geometry.triangles.len() as f64) as u32;
                let point = geometry.point(triangle as usize, [random() * 0.5, random() * 0.5]);
                let normal = geometry.normal(triangle as usize);
                let way = (axis + spread * DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5)).normalize();
                let direction = if way.dot(normal) < 0.0 { -way } else { way };
                ShadowQuery { origin_m: tracer.lift(point, normal, triangle), direction, triangle }
            };
            let queries: Vec<ShadowQuery> = (0..PACKET).map(|_| query()).collect();
            check(&tracer, &mut packet_tracer, &queries);
        }
    }

    #[test]
    fn packets_are_occluded_where_single_rays_are() {
        packets(|tracer, packet_tracer, queries| {
            let expected = queries.iter().map(|q| tracer.is_occluded(q.origin_m, &Direction::new(q.direction)));
            let expected =
                expected.enumerate().fold(0, |bits, (i, is_occluded_alone)| bits | u32::from(is_occluded_alone) << i);
            for level in [Level::new(), Level::baseline()] {
                packet_tracer.level = level;
                for count in [PACKET, 5] {
                    let mut guess = None;
                    for _ in 0..2 {
                        let occluded =
                            packet_tracer.occluded(&mut PacketScratch::default(), &queries[..count], &mut guess);
                        assert_eq!(occluded, expected & first_lanes(count));
                    }
                }
            }
        });
    }

    #[test]
    fn packets_find_the_nearest_hits_of_single_rays() {
        packets(|tracer, packet_tracer, queries| {
            for (level, reach_m) in [(Level::new(), f64::INFINITY), (Level::baseline(), 1.5)] {
                packet_tracer.level = level;
                let found = packet_tracer.nearest(&mut PacketScratch::default(), queries, reach_m);
                for (query, found) in queries.iter().zip(found) {
                    let hit = tracer.closest_hit(query.origin_m, &Direction::new(query.direction));
                    let expected = hit.filter(|hit| hit.distance_m <= reach_m).map(|hit| hit.distance_m);
                    let off = expected.zip(found).map(|(expected, found)| (expected - found.distance_m).abs());
                    assert_eq!(expected.is_some(), found.is_some(), "{expected:?} {found:?}");
                    assert!(off.is_none_or(|off| off < 1e-4), "{expected:?} {found:?}");
                }
            }
        });
    }
}
