//! A point that ambient light is asked about.

use crate::atlas::SurfacePoint;
use glam::DVec3;

/// A point of a surface with the normal that it is shaded by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientPoint {
    /// The point and the plane it lies in.
    pub surface: SurfacePoint,
    /// Unit shading normal, bake space, on the surface's front.
    pub shading_normal: DVec3,
}
