//! The projection from bake space to a map, as one homogeneous matrix in `f64`.
//!
//! The sun's rays are parallel, and a map sends each ray to one point. So the rows for x, y and w are constant along
//! the light: every projection is a projective map of the plane across the light, and a depth. An orthographic map's w
//! is one everywhere; a perspective map's w falls towards the eye. The depth's row is free. It is metres along the
//! light, so that moving a receiver along the light shifts its depth, in either kind of map.
//!
//! Each matrix is relative to an origin of its own, which is rounded to `f32` first, so that vertex and fragment
//! shaders subtract the same vector.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use sunbake_shaders::ShadowMapUniform;

/// A frame across the light, right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightAxes {
    /// Unit vector that is the map's right; level, unless the sun is overhead.
    pub right: DVec3,
    /// Unit vector that is the map's top.
    pub up: DVec3,
    /// Unit vector towards the sun.
    pub towards: DVec3,
}

impl LightAxes {
    /// The frame of a direction.
    pub fn new(towards: DVec3) -> Self {
        let towards = towards.normalize();
        let right = DVec3::Y.cross(towards).try_normalize().filter(|_| towards.y.abs() < 1.0 - 1e-9);
        let right = right.unwrap_or_else(|| DVec3::X.reject_from_normalized(towards).normalize());
        Self { right, up: towards.cross(right), towards }
    }

    /// Coordinates along the axes.
    pub fn along(&self, point_m: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(point_m), self.up.dot(point_m), self.towards.dot(point_m))
    }

    /// The point with these coordinates.
    pub fn point(&self, along: DVec3) -> DVec3 {
        self.right * along.x + self.up * along.y + self.towards * along.z
    }
}

/// Least and greatest coordinates along a light's axes; the third is height towards the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightBounds {
    /// Least coordinate along each axis, metres.
    pub low: DVec3,
    /// Greatest coordinate along each axis, metres.
    pub high: DVec3,
}

impl LightBounds {
    /// The bounds of no points.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        !self.low.cmple(self.high).all()
    }

    /// Grows to contain a point.
    pub fn add(&mut self, along: DVec3) {
        (self.low, self.high) = (self.low.min(along), self.high.max(along));
    }

    /// Size along each axis.
    pub fn size(&self) -> DVec3 {
        self.high - self.low
    }
}

/// A map's matrix and size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapProjection {
    /// Axes across the light and towards it.
    pub axes: LightAxes,
    /// The origin that points are relative to, bake space, in metres; representable in `f32`.
    pub origin_m: DVec3,
    /// Rows from a point less the origin to clip space: x and y within -w to w are on the map, depth is z over w.
    pub clip_from_point: DMat4,
    /// Edge of the map.
    pub size_texels: u32,
}

impl MapProjection {
    /// A map whose rows are given as functionals of a point less `origin_m`: vectors of coefficients, the fourth
    /// constant.
    pub fn new(axes: LightAxes, origin_m: DVec3, rows: [DVec4; 4], size_texels: u32) -> Self {
        let [x, y, z, w] = rows;
        Self { axes, origin_m, clip_from_point: DMat4::from_cols(x, y, z, w).transpose(), size_texels }
    }

    /// An orthographic map of what lies within bounds, with `margin_texels` around them on every side. Depth is 0 at
    /// the top and 1 at the bottom. Bounds without extent are grown a little.
    pub fn orthographic(axes: LightAxes, bounds: &LightBounds, size_texels: u32, margin_texels: f64) -> Self {
        let least_m = (bounds.low.abs().max(bounds.high.abs()).max_element() * 1e-6).max(1e-9);
        let size_m = bounds.size().max(DVec3::splat(least_m));
        let middle = 0.5 * (bounds.low + bounds.high);
        let inner = f64::from(size_texels) / (f64::from(size_texels) - 2.0 * margin_texels).max(1.0);
        let origin_m = axes.point(middle).as_vec3().as_dvec3();
        let from_middle = axes.along(origin_m) - middle;
        let row = |axis: DVec3, shift_m: f64, scale: f64| (axis * scale).extend(shift_m * scale);
        let rows = [
            row(axes.right, from_middle.x, 2.0 / (size_m.x * inner)),
            row(axes.up, from_middle.y, 2.0 / (size_m.y * inner)),
            // From the top down.
            row(axes.towards, from_middle.z - 0.5 * size_m.z, -1.0 / size_m.z),
            DVec4::W,
        ];
        Self::new(axes, origin_m, rows, size_texels)
    }

    /// Clip coordinates of a point, bake space.
    pub fn clip(&self, point_m: DVec3) -> DVec4 {
        self.clip_from_point * (point_m - self.origin_m).extend(1.0)
    }

    /// Whether a point lies on the map, `margin_texels` or more from its border.
    pub fn holds(&self, point_m: DVec3, margin_texels: f64) -> bool {
        let clip = self.clip(point_m);
        let most = 1.0 - 2.0 * margin_texels / f64::from(self.size_texels);
        clip.w > 0.0 && clip.x.abs() <= most * clip.w && clip.y.abs() <= most * clip.w
    }

    /// The point in its middle, half way down.
    pub fn middle_m(&self) -> DVec3 {
        let point = self.clip_from_point.inverse() * DVec4::new(0.0, 0.0, 0.5, 1.0);
        self.origin_m + point.truncate() / point.w
    }

    /// At a point, the steps across the light of one texel to the map's right and of one to its bottom.
    pub fn texel_steps_m(&self, point_m: DVec3) -> [DVec3; 2] {
        let clip = self.clip(point_m);
        let ndc = DVec2::new(clip.x, clip.y) / clip.w;
        let [x, y, _, w] = self.rows();
        let du = (x.truncate() - w.truncate() * ndc.x) / clip.w * 0.5;
        let dv = (y.truncate() - w.truncate() * ndc.y) / clip.w * -0.5;
        let towards = self.axes.towards;
        let area = du.cross(dv).dot(towards);
        let texel = 1.0 / (area * f64::from(self.size_texels));
        [dv.cross(towards) * texel, towards.cross(du) * texel]
    }

    /// The longer edge of the texel that a point falls into, in metres.
    pub fn texel_m(&self, point_m: DVec3) -> f64 {
        let [u, v] = self.texel_steps_m(point_m);
        u.length().max(v.length())
    }

    /// The rows of the matrix.
    pub fn rows(&self) -> [DVec4; 4] {
        let rows = self.clip_from_point.transpose();
        [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]
    }

    /// The uniform that shaders read, for an eye in bake space.
    pub fn uniform(&self, eye_m: Vec3) -> ShadowMapUniform {
        ShadowMapUniform {
            clip_from_point: self.clip_from_point.as_mat4().to_cols_array_2d(),
            origin_m: self.origin_m.as_vec3().into(),
            z_per_metre: self.rows()[2].truncate().dot(self.axes.towards) as f32,
            eye_from_origin_m: (eye_m.as_dvec3() - self.origin_m).as_vec3().into(),
            ground_height_m: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_a_right_handed_frame_for_every_sun() {
        for towards in [DVec3::Y, DVec3::X, DVec3::new(0.3, 0.8, -0.2), DVec3::new(1e-12, 1.0, 0.0), DVec3::NEG_Z] {
            let axes = LightAxes::new(towards);
            assert!(axes.right.cross(axes.up).abs_diff_eq(axes.towards, 1e-12), "{towards}");
            let point = DVec3::new(3.0, -2.0, 7.0);
            assert!(axes.point(axes.along(point)).abs_diff_eq(point, 1e-12));
        }
    }

    #[test]
    fn bounds_fill_an_orthographic_map_but_for_its_margin() {
        let axes = LightAxes::new(DVec3::new(0.5, 0.7, 0.1));
        let bounds = LightBounds { low: DVec3::new(-2.0, 1.0, -5.0), high: DVec3::new(6.0, 3.0, 4.0) };
        let map = MapProjection::orthographic(axes, &bounds, 100, 5.0);
        for (corner, depth) in [(bounds.low, 1.0), (bounds.high, 0.0)] {
            let clip = map.clip(axes.point(corner));
            assert!((clip.x.abs() - 0.9).abs() < 1e-6 && (clip.y.abs() - 0.9).abs() < 1e-6, "{clip}");
            assert!((clip.z - depth).abs() < 1e-6 && clip.w == 1.0, "{clip}");
        }
        assert!(map.middle_m().abs_diff_eq(axes.point(0.5 * (bounds.low + bounds.high)), 1e-6));
        let [u, v] = map.texel_steps_m(DVec3::ONE);
        assert!(u.abs_diff_eq(axes.right * (8.0 / 90.0), 1e-9) && v.abs_diff_eq(axes.up * -(2.0 / 90.0), 1e-9));
        assert!(map.holds(axes.point(bounds.low), 4.9) && !map.holds(axes.point(bounds.low), 5.1));
    }

    #[test]
    fn bounds_without_size_are_a_map() {
        let axes = LightAxes::new(DVec3::Y);
        let point = DVec3::new(1.0, 2.0, 3.0);
        let mut bounds = LightBounds::EMPTY;
        assert!(bounds.is_empty());
        bounds.add(axes.along(point));
        let map = MapProjection::orthographic(axes, &bounds, 64, 4.0);
        assert!(map.clip(point).is_finite() && map.holds(point, 4.0) && map.texel_m(point) > 0.0);
    }
}
