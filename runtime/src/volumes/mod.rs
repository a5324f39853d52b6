//! Shadow volumes: the space that casters shade, as closed bodies whose faces are counted in a stencil buffer (Crow,
//! "Shadow algorithms for computer graphics", SIGGRAPH 1977; McGuire, "Efficient shadow volume rendering", *GPU Gems*
//! chapter 9).
//!
//! This module is geometry on the CPU; the passes are in [`crate::gpu`]. Read it in this order:
//!
//! ```text
//! weld      corners with equal coordinates become one point, with edges
//! bodies    connected triangles, and which of them bound solids
//! casters   bodies, grouped and sorted: once per stage
//! light     which triangles face the light                       } once per
//! silhouettes   walls and caps, as indices                       } light
//! overlap   how many volumes may overlap at one pixel            }
//! culling, plan     what to draw of each caster, and how: once per view
//! ```
//!
//! **Why it is right.** Each triangle that blocks light shades a prism. A volume is a sum of prisms, without the walls
//! that cancel because two prisms share them with opposite signs. So it is closed for any mesh, and the count at a
//! pixel is the number of prisms that contain its surface. Solids leave out prisms that shade nothing new. One thing is
//! added: every face is moved away from the eye by a little more than rasterising can misplace it, so that surfaces do
//! not shade themselves, nor the surfaces on which they lie.
//!
//! **Smooth solids.** Light ends on a smooth surface where its shading normals say ([`sunbake::scene::SmoothPoint`]),
//! and not face by face. But the volume of a solid holds all its facets that turn away, each of them once: a ray from
//! there to the light leaves the solid through a front face. Such facets are *spared*: after the faces they are drawn
//! themselves, and where they are what is seen, one is taken from the count. What is left is what others cast; and the
//! shading normal alone tells whether the facet faces the light. Facets stay dark where nothing smooth rises over them
//! (in a hollow), and on open meshes, which have no inside.
//!
//! **What it does not do.** Alpha masks are ignored: a leaf casts the shadow of its whole card. Lights have no size:
//! soft edges take many lights.

pub mod bodies;
pub mod casters;
pub mod culling;
pub mod light;
pub mod nearest;
pub mod overlap;
pub mod plan;
pub mod silhouettes;
pub mod weld;

pub use casters::{CasterCounts, Casters};
pub use light::{Facings, Light};
pub use plan::{FramePlan, PlanCounts};
pub use silhouettes::{Extrusion, Part, Parts, Sharing, Volumes};

use std::fmt;

/// How volumes are made and counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// Silhouettes from the CPU; each caster is counted in front of the surface (z-pass) where that is right, else
    /// behind it (z-fail).
    #[default]
    Planned,
    /// Silhouettes from the CPU, all counted behind the surface.
    ZFail,
    /// Silhouettes from the CPU, counted in front of the surface wherever that is right.
    ZPass,
    /// A prism for each triangle, counted behind the surface.
    Triangles,
    /// Silhouettes found by the vertex shader.
    Gpu,
}

impl Mode {
    /// Every mode.
    pub const ALL: [Self; 5] = [Self::Planned, Self::ZFail, Self::ZPass, Self::Triangles, Self::Gpu];
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Planned => "volumes",
            Self::ZFail => "volumes:zfail",
            Self::ZPass => "volumes:zpass",
            Self::Triangles => "volumes:triangles",
            Self::Gpu => "volumes:gpu",
        })
    }
}

/// Optimizations of shadow volumes: work that a frame leaves out without changing the picture. All are on by
/// default; measurements turn some off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VolumeOptimizations {
    /// Casters whose volumes miss the view.
    pub view_culling: bool,
    /// Casters whose volumes hold no surface that is in view.
    pub receiver_culling: bool,
    /// Caps, where the eye is outside of the volume.
    pub z_pass: bool,
    /// Caps that are out of view.
    pub cap_culling: bool,
    /// Pixels without surfaces.
    pub scissor: bool,
    /// Prisms of a solid's back faces.
    pub solids: bool,
    /// Volumes of the last frame, if the light has not moved.
    pub cache: bool,
}

impl Default for VolumeOptimizations {
    fn default() -> Self {
        Self {
            view_culling: true,
            receiver_culling: true,
            z_pass: true,
            cap_culling: true,
            scissor: true,
            solids: true,
            cache: true,
        }
    }
}

impl VolumeOptimizations {
    /// Everything is drawn, and nothing is kept.
    pub const NONE: Self = Self {
        view_culling: false,
        receiver_culling: false,
        z_pass: false,
        cap_culling: false,
        scissor: false,
        solids: false,
        cache: false,
    };
}

/// Most overlapping prisms that the eight bits of a stencil buffer can count.
pub const MOST_COUNTED: usize = 255;
/// Most that seven bits can count, where the eighth keeps the result of earlier runs.
pub const MOST_COUNTED_BY_RUN: usize = 127;
