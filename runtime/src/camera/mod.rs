//! Cameras and views. Cameras are in bake space and in `f64`. What both the GPU and the ray tracer use of them (the
//! eye, the rays) is rounded to `f32` once, here, so that both use the same rays.

mod choice;
pub(crate) mod framing;

pub use choice::{CameraChoice, CameraError};

use glam::{DVec2, DVec3, Mat4, Vec3, Vec4};
use sunbake::scene::Scene;

/// A perspective camera, bake space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position, in metres.
    pub eye_m: DVec3,
    /// Unit vector along which it looks.
    pub forward: DVec3,
    /// Unit vector to the picture's right.
    pub right: DVec3,
    /// Unit vector to the picture's top.
    pub up: DVec3,
    /// Vertical field of view, in radians.
    pub fov_y_rad: f64,
}

impl Camera {
    /// An upright camera that looks from one point to another. None if the points coincide.
    pub fn look_at(eye_m: DVec3, target_m: DVec3, fov_y_rad: f64) -> Option<Self> {
        let forward = (target_m - eye_m).try_normalize()?;
        // Looking straight up or down, north is at the picture's top.
        let right = forward.cross(DVec3::Y).try_normalize().filter(|_| forward.y.abs() < 1.0 - 1e-12);
        let right = right.unwrap_or(DVec3::X);
        Some(Self { eye_m, forward, right, up: right.cross(forward), fov_y_rad })
    }

    /// A camera of the file.
    pub fn from_scene(camera: &sunbake::scene::SceneCamera) -> Self {
        let matrix = camera.bake_from_camera;
        let axis = |v: DVec3| matrix.transform_vector3(v).normalize_or(v);
        Self {
            eye_m: matrix.transform_point3(DVec3::ZERO),
            forward: axis(DVec3::NEG_Z),
            right: axis(DVec3::X),
            up: axis(DVec3::Y),
            fov_y_rad: camera.fov_y_rad,
        }
    }
}

/// A camera with the size of its picture.
///
/// The ray through pixel coordinates (x, y), with pixel centres at halves, is `ray_first + ray_per_column x +
/// ray_per_row y`. Its length along `forward` is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The eye in bake space, in metres.
    pub eye_m: Vec3,
    /// Unit vector along which the camera looks.
    pub forward: Vec3,
    /// Ray through the picture's upper left corner.
    pub ray_first: Vec3,
    /// What one pixel to the right adds to a ray.
    pub ray_per_column: Vec3,
    /// What one pixel down adds to a ray.
    pub ray_per_row: Vec3,
    /// Angle between neighbouring pixels at the picture's centre, in radians.
    pub pixel_angle_rad: f32,
    /// The x and y rows of the matrix to clip space.
    clip_rows: [Vec3; 2],
    /// Depth of the near plane.
    near_m: f32,
}

impl View {
    /// A picture of `size` pixels. The near plane lies at a millionth of the scene's size.
    pub fn new(camera: &Camera, size: [u32; 2], scene: &Scene) -> Self {
        let half_up = (0.5 * camera.fov_y_rad).tan();
        let half = DVec2::new(half_up * f64::from(size[0]) / f64::from(size[1]), half_up);
        let per_column = camera.right * (2.0 * half.x / f64::from(size[0]));
        let per_row = -camera.up * (2.0 * half.y / f64::from(size[1]));
        let first = camera.forward - camera.right * half.x + camera.up * half.y;
        Self {
            size,
            eye_m: camera.eye_m.as_vec3(),
            forward: camera.forward.as_vec3(),
            ray_first: first.as_vec3(),
            ray_per_column: per_column.as_vec3(),
            ray_per_row: per_row.as_vec3(),
            pixel_angle_rad: per_row.length() as f32,
            clip_rows: [(camera.right / half.x).as_vec3(), (camera.up / half.y).as_vec3()],
            near_m: (scene.half_extent_m.max_element() * 1e-6).max(1e-30) as f32,
        }
    }

    /// The projection, with reversed and infinite depth: depth is near over distance, 1 at the near plane and 0 at
    /// infinity, so that `f32` depths are as precise far away as close by.
    pub fn clip_from_eye(&self) -> Mat4 {
        let [x, y] = self.clip_rows;
        Mat4::from_cols(x.extend(0.0), y.extend(0.0), Vec4::new(0.0, 0.0, 0.0, self.near_m), self.forward.extend(0.0))
            .transpose()
    }

    /// The ray through a pixel's centre, with length 1 along `forward`.
    pub fn ray(&self, column: u32, row: u32) -> Vec3 {
        self.ray_first + self.ray_per_column * (column as f32 + 0.5) + self.ray_per_row * (row as f32 + 0.5)
    }

    /// Depth of the near plane, in metres.
    pub fn near_m(&self) -> f32 {
        self.near_m
    }

    /// Where a ray, with length 1 along `forward`, meets the picture: pixels from its upper left corner.
    pub fn pixel_of(&self, ray: DVec3) -> [f64; 2] {
        let along = |k: usize| (ray.dot(self.clip_rows[k].as_dvec3()) * 0.5 + 0.5) * f64::from(self.size[k]);
        [along(0), f64::from(self.size[1]) - along(1)]
    }

    /// Number of pixels.
    pub fn pixel_count(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sunbake::testing::SceneBuilder;

    fn view() -> View {
        let camera = Camera::look_at(DVec3::new(3.0, 2.0, 1.0), DVec3::new(0.0, 0.5, -4.0), 0.8).unwrap();
        View::new(&camera, [40, 30], &SceneBuilder::new().block(Vec3::ZERO, Vec3::ONE).build())
    }

    #[test]
    fn a_point_along_a_pixels_ray_lands_on_that_pixels_centre() {
        let view = view();
        for (column, row) in [(0, 0), (39, 29), (7, 21)] {
            let clip = view.clip_from_eye() * (view.ray(column, row) * 5.0).extend(1.0);
            let x = (clip.x / clip.w + 1.0) * 20.0;
            let y = (1.0 - clip.y / clip.w) * 15.0;
            assert!((x - column as f32 - 0.5).abs() < 1e-4 && (y - row as f32 - 0.5).abs() < 1e-4, "{x} {y}");
            assert!((clip.w - 5.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_direction_without_end_has_depth_zero() {
        let clip = view().clip_from_eye() * view().forward.extend(0.0);
        assert_eq!((clip.z, clip.w > 0.9), (0.0, true));
    }

    #[test]
    fn looking_straight_down_is_a_camera() {
        let camera = Camera::look_at(DVec3::Y * 5.0, DVec3::ZERO, 0.8).unwrap();
        assert!(camera.up.abs_diff_eq(DVec3::NEG_Z, 1e-12) && camera.right.abs_diff_eq(DVec3::X, 1e-12));
        assert!(Camera::look_at(DVec3::ONE, DVec3::ONE, 0.8).is_none());
    }
}
