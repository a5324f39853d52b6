//! Rays in all directions against sixteen boxes or sixteen triangles at once.
//!
//! Theory: rays over a hemisphere have little in common, so that packets of them waste lanes; but one ray can be tested
//! against all children of a wide node together (Wald, Benthin and Boulos, "Getting rid of packets", *IEEE Symposium on
//! Interactive Ray Tracing*, 2008). What they can share is the walk itself: sixteen rays that go roughly the same way meet
//! mostly the same nodes, and each node is then fetched, and its children pushed, once for all of them.
//!
//! Practice: a place on the stack holds a node and the set of rays that met its box. Each of these rays is tested against
//! the node's children by itself, so no lane is ever spent on a ray that is not there.
//!
//! Precision: boxes and triangles are tested in `f32`, conservatively: boxes are grown, and a triangle is kept if the ray
//! passes it within [`CORNER_PADDING`]. What is kept is then asked in `f64`, by the very test that [`Tracer`] uses. So
//! answers are the tracer's, watertight at shared edges, and do not depend on the width of SIMD.

use super::wide::{Child, Leaf, Node, WIDTH, Wide};
use super::{Direction, Hit, Occluder, Tracer};
use fearless_simd::{Level, Simd, dispatch, f32x16, prelude::*, u32x16};
use glam::{DMat3, DVec3};

/// Growth of every box, tracer space (whose half size is 512 to 1024): more than the walk's rounding of a ray's start and
/// of its distances can amount to.
const BOX_PADDING: f32 = 1.0 / 256.0;
/// How far beside a triangle a ray may pass and still be asked in `f64`, tracer space: sixteen steps of an `f32` at 1024.
/// Start, shear and differences round by a quarter of that, the products of edge functions by as much again.
const CORNER_PADDING: f32 = 1.0 / 512.0;

/// A hierarchy for rays in all directions. Positions and distances in its methods are bake space, in metres.
pub struct Scatter<'a> {
    tracer: &'a Tracer,
    wide: Wide,
    /// For each flat triangle, its index among the tracer's; [`u32::MAX`] if it is not solid.
    id_of_flat: Vec<u32>,
    level: Level,
}

/// Room that a walk needs, kept from one to the next.
#[derive(Debug, Default)]
pub struct ScatterRoom {
    stack: Vec<Pending>,
    near: [f32; WIDTH],
    rays: Vec<ShadowRay>,
    /// What rays have yet to go to together, and which of them.
    shared: Vec<(Child, u32)>,
    /// For each ray, the children of a node that it met.
    children: [u32; PACKET],
}

/// What a walk has yet to go to.
#[derive(Debug, Clone, Copy)]
struct Pending {
    child: Child,
    /// Least distance along the ray.
    near: f32,
}

/// A ray as the walk has it, tracer space.
#[derive(Debug)]
struct Narrow {
    start: [f32; 3],
    inverse: [f32; 3],
    axes: [usize; 3],
    /// Shear along the first two axes, and one over the direction's largest component.
    shear: [f32; 3],
}

impl Narrow {
    fn new(start: DVec3, direction: &Direction) -> Self {
        // A component of zero would make a NaN of a box side that the ray starts on.
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

/// How many shadow rays can be asked about together.
pub const PACKET: usize = 16;

/// A ray from a surface.
#[derive(Debug, Clone, Copy)]
pub struct ShadowQuery {
    /// Where it starts: see [`Tracer::lift`].
    pub origin_m: DVec3,
    /// Unit, and before the surface's plane.
    pub direction: DVec3,
    /// The triangle that it leaves, which cannot stop it: flat index in [`crate::scene::Geometry`].
    pub triangle: u32,
}

/// A shadow ray made ready, tracer space.
#[derive(Debug)]
struct ShadowRay {
    narrow: Narrow,
    start: DVec3,
    direction: Direction,
    /// The triangle that it leaves, among the tracer's.
    own: u32,
}

impl<'a> Scatter<'a> {
    /// Builds over all that blocks light.
    pub fn new(tracer: &'a Tracer) -> Self {
        let padding = BOX_PADDING + tracer.run_up as f32;
        let mut id_of_flat = vec![u32::MAX; tracer.instance.len()];
        tracer.flat.iter().enumerate().for_each(|(id, &flat)| id_of_flat[flat as usize] = id as u32);
        Self { tracer, wide: Wide::new(tracer, DMat3::IDENTITY, padding), id_of_flat, level: Level::new() }
    }

    /// Which of up to [`PACKET`] shadow rays something solid stops: a bit set. Rays that go roughly the same way from
    /// neighbouring points are the fastest. `guess` is asked first, and left at something that stopped one of them: the
    /// answer does not depend on it.
    pub fn occluded(&self, room: &mut ScatterRoom, queries: &[ShadowQuery], guess: &mut Option<Occluder>) -> u32 {
        room.rays.clear();
        room.rays.extend(queries.iter().map(|query| self.ray(query)));
        let mut stopped = 0;
        if let Some(Occluder(id)) = *guess {
            // What does not stop one of them will hardly stop the next.
            let first = room.rays.iter().take_while(|ray| ray.own != id && self.meets(ray, id).is_some()).count();
            stopped = (1u32 << first) - 1;
        }
        let open = all(queries.len()) & !stopped;
        if open != 0 && !self.wide.nodes.is_empty() {
            let level = self.level;
            *guess = None;
            stopped |= dispatch!(level, simd => self.stop_any(simd, room, open, guess));
        }
        stopped
    }

    fn ray(&self, query: &ShadowQuery) -> ShadowRay {
        let direction = Direction::new(query.direction);
        let start = self.tracer.shadow_start(query.origin_m, &direction);
        ShadowRay {
            narrow: Narrow::new(start, &direction),
            start,
            direction,
            own: self.id_of_flat[query.triangle as usize],
        }
    }

    /// The nearest surface along the direction within `reach_m`.
    pub fn nearest(&self, room: &mut ScatterRoom, origin_m: DVec3, direction: DVec3, reach_m: f64) -> Option<Hit> {
        let direction = Direction::new(direction);
        let start = self.tracer.shadow_start(origin_m, &direction);
        let ray = ShadowRay { narrow: Narrow::new(start, &direction), start, direction, own: u32::MAX };
        let reach = reach_m * self.tracer.tracer_from_bake + self.tracer.run_up;
        let level = self.level;
        let (id, distance, barycentric) = dispatch!(level, simd => self.first(simd, room, &ray, reach))?;
        Some(Hit {
            triangle: self.tracer.flat[id as usize],
            distance_m: (distance - self.tracer.run_up).max(0.0) / self.tracer.tracer_from_bake,
            barycentric,
        })
    }

    #[inline]
    fn meets(&self, ray: &ShadowRay, id: u32) -> Option<(f64, [f64; 2])> {
        self.tracer.meet(ray.start, &ray.direction, id as usize)
    }

    /// Walks for the rays of a bit set, and gives back those that something stops.
    #[inline(always)]
    fn stop_any<S: Simd>(&self, simd: S, room: &mut ScatterRoom, open: u32, found: &mut Option<Occluder>) -> u32 {
        let ScatterRoom { rays, shared, children, near, .. } = room;
        let mut active = open;
        shared.clear();
        shared.push((Child::ROOT, open));
        while let Some((child, met_by)) = shared.pop() {
            let mut asking = met_by & active;
            if asking == 0 {
                continue;
            }
            match child {
                Child::Node(node) => {
                    let node = &self.wide.nodes[node as usize];
                    let mut met = 0;
                    children.fill(0);
                    while asking != 0 {
                        let ray = asking.trailing_zeros() as usize;
                        asking &= asking - 1;
                        children[ray] = node_met(simd, node, &rays[ray].narrow, f32::INFINITY, near);
                        met |= children[ray];
                    }
                    let of_rays = u32x16::from_slice(simd, children);
                    while met != 0 {
                        let lane = met.trailing_zeros() as usize;
                        met &= met - 1;
                        let bit = u32x16::splat(simd, 1 << lane);
                        let met_by = (of_rays & bit).simd_eq(bit).to_bitmask() as u32;
                        shared.push((node.child[lane], met_by));
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.wide.leaves[leaf as usize];
                    while asking != 0 {
                        let index = asking.trailing_zeros() as usize;
                        asking &= asking - 1;
                        let ray = &rays[index];
                        let mut met = leaf_met(simd, leaf, &ray.narrow, f32::INFINITY);
                        while met != 0 {
                            let id = leaf.ids[met.trailing_zeros() as usize];
                            met &= met - 1;
                            if id != ray.own && self.meets(ray, id).is_some() {
                                *found = Some(Occluder(id));
                                active &= !(1 << index);
                                met = 0;
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

    #[inline(always)]
    fn first<S: Simd>(
        &self,
        simd: S,
        room: &mut ScatterRoom,
        ray: &ShadowRay,
        mut reach: f64,
    ) -> Option<(u32, f64, [f64; 2])> {
        let mut found = None;
        room.stack.clear();
        if !self.wide.nodes.is_empty() {
            room.stack.push(Pending { child: Child::ROOT, near: 0.0 });
        }
        while let Some(pending) = room.stack.pop() {
            let far = reach as f32 * (1.0 + 1e-6);
            if pending.near > far {
                continue;
            }
            match pending.child {
                Child::Node(node) => {
                    let node = &self.wide.nodes[node as usize];
                    let mut met = node_met(simd, node, &ray.narrow, far, &mut room.near);
                    let first = room.stack.len();
                    while met != 0 {
                        let lane = met.trailing_zeros() as usize;
                        met &= met - 1;
                        push_far_first(
                            &mut room.stack,
                            first,
                            Pending { child: node.child[lane], near: room.near[lane] },
                        );
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &self.wide.leaves[leaf as usize];
                    let mut met = leaf_met(simd, leaf, &ray.narrow, far);
                    while met != 0 {
                        let id = leaf.ids[met.trailing_zeros() as usize];
                        met &= met - 1;
                        if let Some((distance, barycentric)) = self.meets(ray, id)
                            && is_nearer((id, distance), found, reach)
                        {
                            reach = distance;
                            found = Some((id, distance, barycentric));
                        }
                    }
                }
            }
        }
        found
    }
}

/// Of equally near triangles the one with the lowest index counts, whatever the order they are met in.
#[inline]
fn is_nearer((id, distance): (u32, f64), found: Option<(u32, f64, [f64; 2])>, reach: f64) -> bool {
    match found {
        Some((best, least, _)) => distance < least || (distance == least && id < best),
        None => distance <= reach,
    }
}

/// Pushes a child among its siblings, which start at `first`, so that the nearest is last.
#[inline]
fn push_far_first(stack: &mut Vec<Pending>, first: usize, new: Pending) {
    let mut at = stack.len();
    stack.push(new);
    while at > first && stack[at - 1].near < new.near {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = new;
}

/// Which of a node's boxes a ray meets before `far`: a bit set. `near` gets where it enters them.
#[inline(always)]
fn node_met<S: Simd>(simd: S, node: &Node, ray: &Narrow, far: f32, near: &mut [f32; WIDTH]) -> u32 {
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
    met.to_bitmask() as u32 & all(node.count)
}

/// Which triangles of a leaf a ray may meet before `far`: a bit set.
#[inline(always)]
fn leaf_met<S: Simd>(simd: S, leaf: &Leaf, ray: &Narrow, far: f32) -> u32 {
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
    (passed & ahead).to_bitmask() as u32 & all(leaf.count)
}

/// That many bits.
#[inline(always)]
fn all(count: usize) -> u32 {
    (1 << count) - 1
}
