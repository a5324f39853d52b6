//! Whether a point lies inside a solid.
//!
//! Theory: from inside a closed mesh that faces outwards, every ray first meets the back of one of its triangles. From
//! a visible point, some ray meets a front, a double-sided surface, or nothing.
//!
//! Many files make every surface double-sided, closed meshes too. Without a distance, only points whose ambient
//! visibility is near 0 are tested, and there the backs of double-sided surfaces count as well: at worst a dark corner
//! takes the value of a dark neighbour. With a distance they do not count: a room with double-sided walls would be
//! taken for the inside of a solid.
//!
//! Practice: a few rays over the hemisphere. The first that meets no back decides, which is the first or second for
//! nearly every point. Where a back and a front coincide (doubled faces with both windings), the front counts.

use super::directions::{DirectionSample, FIXED_SEED, NormalFrame, sample_block};
use super::point::AmbientPoint;
use crate::scene::{Geometry, Scene};
use crate::trace::{Direction, PacketScratch, PacketTracer, ShadowQuery, Tracer};
use glam::DVec3;

/// Most rays that are traced.
const RAYS: u32 = 16;
/// A front that is farther than a back by no more than this share of the distance counts as coincident.
const COINCIDENT: f64 = 1e-5;

/// Tests whether points are buried.
pub(super) struct BuriedTest<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    tracer: &'a Tracer,
    directions: Vec<DirectionSample>,
    /// Whether the backs of double-sided surfaces count.
    counts_double_sided: bool,
    /// Whether the scene has any back that counts.
    has_backs: bool,
}

impl<'a> BuriedTest<'a> {
    pub fn new(scene: &'a Scene, geometry: &'a Geometry, tracer: &'a Tracer, counts_double_sided: bool) -> Self {
        let mut directions = vec![DirectionSample::default(); RAYS as usize];
        sample_block(FIXED_SEED, 0, RAYS, &mut directions);
        let has_backs = counts_double_sided || (0..scene.instances.len()).any(|i| !scene.material(i).is_double_sided);
        Self { scene, geometry, tracer, directions, counts_double_sided, has_backs }
    }

    /// Whether rays from a point meet nothing but backs, on each of its sides. Adds the number of rays traced to
    /// `rays`.
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
                self.sees_only_backs(packet_tracer, scratch, point, normal, rays)
            })
    }

    fn sees_only_backs(
        &self,
        packet_tracer: &PacketTracer,
        scratch: &mut PacketScratch,
        point: &AmbientPoint,
        normal: DVec3,
        rays: &mut u64,
    ) -> bool {
        let frame = NormalFrame::new(normal);
        let origin_m = self.tracer.lift(point.surface.position_m, normal, point.surface.triangle);
        self.directions.iter().all(|sample| {
            *rays += 1;
            let ray = ShadowQuery { origin_m, direction: frame.direction(sample), triangle: point.surface.triangle };
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
            (self.counts_double_sided || !self.scene.material(instance).is_double_sided)
                && self.geometry.normal(triangle as usize).dot(direction) > 0.0
        };
        if !is_back(hit.triangle) {
            return false;
        }
        back_comes_first(self.tracer, origin_m, &Direction::new(direction), hit.distance_m, is_back)
    }
}

/// Whether the nearest surface along a ray, a back at this distance, has no front where it lies. Of doubled faces with
/// both windings the front counts.
pub(crate) fn back_comes_first(
    tracer: &Tracer,
    origin_m: DVec3,
    direction: &Direction,
    back_distance_m: f64,
    is_back: impl Fn(u32) -> bool,
) -> bool {
    let front = tracer.closest_hit_where(origin_m, direction, |triangle| !is_back(triangle));
    front.is_none_or(|front| front.distance_m > back_distance_m * (1.0 + COINCIDENT) + tracer.run_up_m())
}
