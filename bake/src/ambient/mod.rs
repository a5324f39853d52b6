//! How much of the sky each surface point sees, from which side, and how the sky's light adds up there.
//!
//! Theory. Openness at a point x with normal n is the cosine-weighted free share of its hemisphere,
//! `ao(x) = 1/pi * integral of V(x, w) (n . w) dw`: 1 in the open, 0 in a closed box. The *bent normal* is the mean of the
//! directions that are free, weighted alike; its length says how far they spread (2/3 in the open, 1 at the bottom of a
//! well, 0 where nothing is free). Sky visibility in *spherical harmonics* is `T_i = 1/pi * integral of V (n . w) Y_i dw`, the
//! transfer vector of diffuse light (Sloan, Kautz and Snyder, "Precomputed radiance transfer", *SIGGRAPH* 2002): a sky with
//! coefficients L lights the point as `sum of L_i T_i`, exactly where the sky holds nothing above degree two.
//!
//! Indoors a closed scratch would be black. With a *distance* M only what is nearer counts, and counts less the farther it is:
//! a surface at d hides `(1 - (d / M)^2)^2`. That is all of it at contact, nothing at M, and smooth at both ends.
//!
//! Practice.
//!
//! * Directions are Owen-scrambled Sobol points (`directions.rs`), traced on a sixteen-wide hierarchy
//!   ([`crate::trace::PacketTracer`]). Cell by cell of the hemisphere, sixteen neighbouring texels ask the same way one after the
//!   other, and what hid the last is asked first.
//! * The hemisphere is that of the *shading* normal, so that a surface that is meant to be round has no facets in its
//!   light. Of it, directions behind the triangle's own plane are left out of the count: a convex thing alone reads 1.
//! * A point inside a solid is *buried*: wherever it looks, it sees the backs of single-sided surfaces (`buried.rs`).
//!   Nobody ever sees it, and what stands for it is taken from its neighbours (`settle.rs`).
//! * Where a surface is cut into charts, the texels beside the cut are made to agree ([`Seams`]).
//! * With an error given, rays are doubled until the two halves of them agree (`estimate.rs`).
//!
//! One bounce of light would be a third estimate of the same rays, fed by what they hit: see [`Estimate`].

mod buried;
mod directions;
mod estimate;
mod fill_buried;
pub mod harmonics;
mod page;
mod seams;
mod vertices;

pub use estimate::{AmbientEngine, AmbientPoint, Estimate, Estimates, solve_ambient};
pub use harmonics::Coefficients;
pub use page::{AmbientPage, Plane, Side};
pub use seams::{Mismatch, Seams};
pub use vertices::ambient_visibility_of_vertices;

/// What is asked of ambient light, and what it may cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmbientSettings {
    /// Rays a texel and side, a power of two from 4 to 65536, usually 64 to 1024. Time grows with the number; the error falls
    /// with its power of -0.6 (foliage) to -0.75 (walls).
    pub rays: u32,
    /// Metres beyond which nothing hides; none: everything counts. Rays must then find the nearest surface, not any, which
    /// takes longer, unless the distance is short against the scene.
    pub distance_m: Option<f64>,
    /// Stop earlier, once a texel's error is below this (0.001 to 0.5) with a confidence of 95 %: see `estimate.rs`. Of
    /// texels that see all the sky, or nothing, a few dozen rays are then enough.
    pub error: Option<f64>,
    /// Whether bent normals are wanted. Takes a tenth of the time.
    pub wants_bent: bool,
    /// Whether sky visibility in spherical harmonics is wanted. Takes a fifth of the time.
    pub wants_sky: bool,
    /// Other numbers, other directions: estimates with different seeds err independently.
    pub seed: u32,
}

/// What hides at a distance, as a share: see the module.
fn hidden_share(distance_m: f64, reach_m: f64) -> f64 {
    let ratio = (distance_m / reach_m).min(1.0);
    (1.0 - ratio * ratio).powi(2)
}
