//! Whether a point lies inside a solid.
//!
//! Theory: from inside a closed, outward-facing mesh every way out leads through the back of one of its triangles. From a
//! point that an eye can see, some ray meets a front, a surface with two sides, or nothing.
//!
//! Many files make every surface two-sided, closed things too. Where nothing is seen at all, which without a distance is
//! what being inside means, their backs count as well: at worst a dark nook takes the value of a dark neighbour. With a
//! distance they do not: a scratch of two-sided walls, seen from within, would be taken for the inside of a solid.
//!
//! Practice: a few rays over the hemisphere, and the first that escapes settles it, which is the first or second for nearly
//! every point. Where a back and a front coincide (doubled faces, both windings), the front is believed.

use super::directions::{DirectionSample, Frame, draw_block};
use super::estimate::AmbientPoint;
use crate::scene::{Geometry, Scene};
use crate::trace::{Direction, PacketScratch, PacketTracer, ShadowQuery, Tracer};
use glam::DVec3;

/// Rays that are asked at most.
const RAYS: u32 = 16;
/// Seed of their directions: the same for all points.
const SEED: u32 = 0x5eed;
/// A front this much farther than a back, as a share of the distance, counts as being at the same place.
const SAME_PLACE: f64 = 1e-5;

/// Tells which points are buried.
pub(super) struct Burial<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    tracer: &'a Tracer,
    draws: Vec<DirectionSample>,
    /// Whether the backs of surfaces with two sides count.
    counts_two_sided: bool,
    /// Whether there is any back that counts.
    has_backs: bool,
}

impl<'a> Burial<'a> {
    pub fn new(scene: &'a Scene, geometry: &'a Geometry, tracer: &'a Tracer, counts_two_sided: bool) -> Self {
        let mut draws = vec![DirectionSample::default(); RAYS as usize];
        draw_block(SEED, 0, RAYS, &mut draws);
        let has_backs = counts_two_sided || (0..scene.instances.len()).any(|i| !scene.material(i).is_double_sided);
        Self { scene, geometry, tracer, draws, counts_two_sided, has_backs }
    }

    /// Whether nothing but backs is seen from a point, on any side of it. Adds the rays that it took.
    pub fn is_buried(
        &self,
        packet_tracer: &PacketTracer,
        scratch: &mut PacketScratch,
        point: &AmbientPoint,
        rays: &mut u64,
    ) -> bool {
        let sides = if point.surface.is_double_sided { 2 } else { 1 };
        self.has_backs
            && [1.0, -1.0].iter().take(sides).all(|side| {
                let normal = point.surface.normal * *side;
                self.sees_backs_alone(packet_tracer, scratch, point, normal, rays)
            })
    }

    fn sees_backs_alone(
        &self,
        packet_tracer: &PacketTracer,
        scratch: &mut PacketScratch,
        point: &AmbientPoint,
        normal: DVec3,
        rays: &mut u64,
    ) -> bool {
        let frame = Frame::new(normal);
        let origin_m = self.tracer.lift(point.surface.position_m, normal, point.surface.triangle);
        self.draws.iter().all(|draw| {
            *rays += 1;
            let ray = ShadowQuery { origin_m, direction: frame.direction(draw), triangle: point.surface.triangle };
            self.meets_back(packet_tracer, scratch, &ray)
        })
    }

    fn meets_back(&self, packet_tracer: &PacketTracer, scratch: &mut PacketScratch, ray: &ShadowQuery) -> bool {
        let &ShadowQuery { origin_m, direction, .. } = ray;
        let Some(hit) = packet_tracer.nearest(scratch, std::slice::from_ref(ray), f64::INFINITY)[0] else {
            return false;
        };
        let is_back = |triangle: u32| {
            let instance = self.geometry.instance[triangle as usize] as usize;
            (self.counts_two_sided || !self.scene.material(instance).is_double_sided)
                && self.geometry.normal(triangle as usize).dot(direction) > 0.0
        };
        if !is_back(hit.triangle) {
            return false;
        }
        let front = self.tracer.closest_hit_where(origin_m, &Direction::new(direction), |t| !is_back(t));
        front.is_none_or(|front| front.distance_m > hit.distance_m * (1.0 + SAME_PLACE) + self.tracer.run_up_m())
    }
}
