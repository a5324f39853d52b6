//! Ambient light: how much of the sky each surface point sees, in which direction, and how the sky's light adds up
//! there.
//!
//! Theory. *Ambient visibility* at a point x with normal n is the cosine-weighted free share of its hemisphere,
//! `ao(x) = 1/pi * integral of V(x, w) (n . w) dw`: 1 in the open, 0 in a closed box. The *bent normal* is the mean of
//! the free directions with the same weights. Its length tells how far they spread: 2/3 in the open, 1 at the bottom of
//! a well, 0 where nothing is free. Sky visibility in *spherical harmonics* is
//! `T_i = 1/pi * integral of V (n . w) Y_i dw`, the transfer vector of diffuse light (Sloan, Kautz and Snyder,
//! "Precomputed radiance transfer", *SIGGRAPH* 2002): a sky with coefficients L lights the point as `sum of L_i T_i`,
//! exactly where the sky holds nothing above degree two.
//!
//! A closed room would be black. With a *distance* M only what is nearer occludes, and the less the farther it is: a
//! surface at d occludes `(1 - (d / M)^2)^2` of a ray. That is all of it at contact, nothing at M, and smooth at both
//! ends.
//!
//! Practice.
//!
//! * Directions are Owen-scrambled Sobol points (`directions.rs`), traced on a sixteen-wide hierarchy
//!   ([`crate::trace::PacketTracer`]). Cell by cell of the hemisphere, sixteen neighbouring texels trace rays of nearly
//!   the same direction together, and the occluder that was found last is tested first.
//! * The hemisphere is that of the *shading* normal, so that smooth-shaded surfaces show no facets. Directions behind
//!   the triangle's own plane do not count: a convex solid alone has an ambient visibility of 1.
//! * A point inside a solid is *buried*: all its rays meet the backs of single-sided surfaces (`buried.rs`). It is
//!   never seen, and its value is taken from its neighbours (`fill_buried.rs`).
//! * Where a surface is cut into charts, the texels on the two sides of the seam are made to agree ([`Seams`]).
//! * With an error given, rays are doubled until the two halves of them agree (`estimate.rs`).
//!
//! One bounce of light would be one more estimate from the same rays, fed by the surfaces they hit: see [`Estimate`].

mod buried;
mod directions;
mod estimate;
mod fill_buried;
pub mod harmonics;
mod page;
mod point;
mod seams;
mod vertices;

pub(crate) use buried::back_comes_first;
pub(crate) use directions::hemisphere_directions;
pub use estimate::{AmbientEngine, Estimate, Estimates, solve_ambient};
pub use harmonics::Coefficients;
pub use page::{AmbientPage, AmbientPlanes};
pub use point::AmbientPoint;
pub use seams::{Mismatch, Seams};
pub use vertices::ambient_visibility_of_vertices;

/// How ambient light is estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientSettings {
    /// Rays a texel and side, a power of two from 4 to 65536, usually 64 to 1024. Time grows with the number; the error
    /// falls with its power of -0.6 (foliage) to -0.75 (walls).
    pub rays: u32,
    /// Metres beyond which nothing occludes; none: everything occludes. Rays must then find the nearest surface, not
    /// any, which takes longer, unless the distance is short against the scene.
    pub distance_m: Option<f64>,
    /// Stop earlier, once a texel's error is below this (0.001 to 0.5) with a confidence of 95 %: see `estimate.rs`. Of
    /// texels that see all the sky, or nothing, a few dozen rays are then enough.
    pub error: Option<f64>,
    /// Whether bent normals are wanted. Takes a tenth of the time.
    pub wants_bent: bool,
    /// Whether sky visibility in spherical harmonics is wanted. Takes a fifth of the time.
    pub wants_sky: bool,
    /// Seed of the directions. Estimates with different seeds have independent errors.
    pub seed: u32,
}

/// How much of a ray a surface at a distance occludes, 0 to 1: see the module.
fn occluded_share(distance_m: f64, reach_m: f64) -> f64 {
    let ratio = (distance_m / reach_m).min(1.0);
    (1.0 - ratio * ratio).powi(2)
}
