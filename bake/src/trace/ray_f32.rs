//! One ray against sixteen boxes or sixteen triangles at once, in `f32`.
//!
//! The tests are conservative: they may accept what the ray misses, but never reject what it hits. Candidates are
//! tested again in `f64`.

use super::Direction;
use super::bvh16::{Bvh16Leaf, Bvh16Node, WIDTH, first_bits};
use fearless_simd::{Simd, f32x16, prelude::*};
use glam::DVec3;

/// Growth of every box in tracer space (whose half size is 512 to 1024): more than the rounding of a ray's start and of
/// its distances.
pub(super) const BOX_PADDING: f32 = 1.0 / 256.0;
/// Largest distance of a ray from a candidate triangle, in tracer space: sixteen rounding steps of an `f32` at 1024.
/// Start, shear and differences are rounded by a quarter of that, the products of edge functions by another quarter.
const CORNER_PADDING: f32 = 1.0 / 512.0;

/// A ray rounded to `f32` for the conservative tests, tracer space.
#[derive(Debug)]
pub(super) struct RayF32 {
    start: [f32; 3],
    inverse: [f32; 3],
    axes: [usize; 3],
    /// Shear along the first two axes, and one over the direction's largest component.
    shear: [f32; 3],
}

impl RayF32 {
    pub fn new(start: DVec3, direction: &Direction) -> Self {
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

/// The set of a node's boxes that a ray meets before `far`. `near` gets the distances at which it enters them.
#[inline(always)]
pub(super) fn node_met<S: Simd>(simd: S, node: &Bvh16Node, ray: &RayF32, far: f32, near: &mut [f32; WIDTH]) -> u32 {
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
    met.to_bitmask() as u32 & first_bits(node.count)
}

/// The set of a leaf's triangles that a ray may hit before `far`.
#[inline(always)]
pub(super) fn leaf_met<S: Simd>(simd: S, leaf: &Bvh16Leaf, ray: &RayF32, far: f32) -> u32 {
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
    (passed & ahead).to_bitmask() as u32 & first_bits(leaf.count)
}
