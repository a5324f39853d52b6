//! Where shadow rays of a point start, and which lights they go to.
//!
//! On a flat triangle they start on the side that faces the light. A double-sided surface has one start a side.
//!
//! On a facet of something smooth the shading normal says which side that is: so the edge of the light runs across
//! facets, and not along them. Lights that the facet sees as well are met from the facet itself. Others are below its
//! plane: rays to them start on the smooth shape above it ([`crate::scene::SmoothPoint`]), and not at all where that
//! is not above it, since then the facet itself is in the way.
//!
//! Why not from the smooth shape always: a convex mesh shades none of the lights that its facets see, so rays from the
//! facet are right; and what stands on a large facet (grass on a hill of few faces) may be lower than the shape above
//! it, and would lose its shadow. Cycles restricts its offset likewise, to where the light grazes the facet.

use crate::atlas::SurfacePoint;
use crate::trace::Tracer;
use glam::DVec3;
use smallvec::SmallVec;

/// A side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceSide {
    /// That of the front normal.
    Front,
    /// The other.
    Back,
}

/// A start of shadow rays: those to lights that are in front of all its planes. They belong to a [`SurfacePoint`], and
/// a light is in front of at most one start of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayStart {
    /// The side of the point.
    pub side: SurfaceSide,
    /// Unit normal of a plane through the point: the face's, or the shading normal where it is smooth.
    pub normal: DVec3,
    /// Normal of a second plane, on smooth surfaces: the face's on this side, or, of rays from above it, its opposite.
    pub also: Option<DVec3>,
    /// The face's normal on this side.
    face: DVec3,
    /// From the point to the smooth shape, if rays start there.
    lift_m: Option<DVec3>,
}

impl RayStart {
    /// Number of different starts.
    pub(super) const KINDS: usize = 4;

    /// Whether a light in this direction is in front of all planes.
    #[inline]
    pub fn faces(&self, direction: DVec3) -> bool {
        self.normal.dot(direction) > 0.0 && self.also.is_none_or(|also| also.dot(direction) > 0.0)
    }

    /// Whether rays start on the smooth shape above the face.
    pub fn is_lifted(&self) -> bool {
        self.lift_m.is_some()
    }

    /// Where rays start, bake space.
    #[inline]
    pub fn origin_m(&self, tracer: &Tracer, point: &SurfacePoint) -> DVec3 {
        match self.lift_m {
            None => tracer.lift(point.position_m, self.face, point.triangle),
            Some(lift_m) => tracer.lift_smooth(point.position_m, self.face, point.triangle, lift_m),
        }
    }

    /// Which of the different starts this is.
    pub(super) fn kind(&self) -> usize {
        2 * self.side as usize + usize::from(self.is_lifted())
    }
}

/// All starts of a point.
pub fn ray_starts(point: &SurfacePoint) -> SmallVec<[RayStart; RayStart::KINDS]> {
    let sides = [(SurfaceSide::Front, 1.0), (SurfaceSide::Back, -1.0)];
    let mut starts = SmallVec::new();
    for (side, sign) in sides.into_iter().take(if point.is_double_sided { 2 } else { 1 }) {
        let face = if sign > 0.0 { point.normal } else { -point.normal };
        let Some(smooth) = &point.smooth else {
            starts.push(RayStart { side, normal: face, also: None, face, lift_m: None });
            continue;
        };
        let (normal, lift_m) = (smooth.normal * sign, smooth.lift_m[side as usize]);
        starts.push(RayStart { side, normal, also: Some(face), face, lift_m: None });
        if lift_m != DVec3::ZERO {
            starts.push(RayStart { side, normal, also: Some(-face), face, lift_m: Some(lift_m) });
        }
    }
    starts
}
