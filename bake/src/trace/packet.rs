//! Traces packets of up to sixteen incoherent rays through a 16-wide BVH.
//!
//! Theory: rays over a hemisphere have little in common, so SIMD over rays wastes its width. Instead, one ray is tested
//! against all children of a wide node at once (Wald, Benthin and Boulos, "Getting rid of packets", *IEEE Symposium on
//! Interactive Ray Tracing*, 2008). Rays of a packet share the traversal: sixteen rays of roughly equal direction meet
//! mostly the same nodes, so each node is loaded, and its children are pushed, once for all of them.
//!
//! Practice: a stack entry is a node and the set of rays that met its box. Each of these rays is tested against the
//! node's children separately, so no work is spent on a ray that did not meet the node.
//!
//! Precision: boxes and triangles are tested in `f32`, conservatively: boxes are enlarged, and a triangle is a
//! candidate if the ray passes close to it (`ray_f32.rs`). Candidates are then tested in `f64`, with the test of
//! [`Tracer`]. So results equal the tracer's, are watertight at shared edges, and do not depend on the SIMD width.

use super::bvh16::{Bvh16, Child, WIDTH, bits, first_bits, push_far_first};
use super::ray_f32::{BOX_PADDING, RayF32, leaf_met, node_met};
use super::{Direction, Hit, Occluder, Tracer};
use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*, u32x16};
use glam::{DMat3, DVec3};

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
        let open = first_bits(queries.len()) & !occluded;
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
                    for child in bits(met) {
                        let bit = u32x16::splat(simd, 1 << child);
                        let met_by = (of_rays & bit).simd_eq(bit).to_bitmask() as u32;
                        shared.push((node.child[child], met_by));
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.bvh.leaves[leaf as usize];
                    for index in bits(asking) {
                        let ray = &rays[index];
                        for triangle in bits(leaf_met(simd, leaf, &ray.ray_f32, f32::INFINITY)) {
                            let id = leaf.ids[triangle];
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
        sorted.push(QueuedChild { child: Child::ROOT, met_by: first_bits(rays.len()), near: 0.0 });
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
                    for child in bits(met) {
                        let bit = u32x16::splat(simd, 1 << child);
                        let met_by = (of_rays & bit).simd_eq(bit).to_bitmask() as u32;
                        push_far_first(
                            sorted,
                            first,
                            QueuedChild { child: node.child[child], met_by, near: near[child] },
                            |pending| pending.near,
                        );
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.bvh.leaves[leaf as usize];
                    for index in bits(asking) {
                        let (ray, reach, found) = (&rays[index], &mut reach[index], &mut found[index]);
                        for triangle in bits(leaf_met(simd, leaf, &ray.ray_f32, *reach as f32 * FAR_SLACK)) {
                            let id = leaf.ids[triangle];
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

#[cfg(test)]
mod tests;
