//! Alpha masks: alpha is sampled at the nearest texel of the image's first mip level.
//!
//! It is not filtered, so that all tracers, shaders and closed-form engines agree about where a leaf ends: on the
//! borders of the image's texels. The same formula is in `shaders/src/wgsl/surface/alpha_mask.wgsl`.

use super::{Alpha, Image, Material, Mesh, Scene, TextureRef, Wrap};
use glam::{Vec2, Vec3};

/// Maps any texel index into `0..size`.
pub fn wrap_texel(index: i64, size: u32, wrap: Wrap) -> u32 {
    let size = i64::from(size.max(1));
    if (0..size).contains(&index) {
        return index as u32;
    }
    let wrapped = match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let folded = index.rem_euclid(2 * size);
            folded.min(2 * size - 1 - folded)
        }
    };
    wrapped as u32
}

/// Column and row of the texel that holds an image coordinate (v from the top).
pub fn nearest_texel(image_uv: Vec2, size: [u32; 2], wrap: [Wrap; 2]) -> [u32; 2] {
    let index = |coordinate: f32, size: u32| (coordinate * size as f32).floor().clamp(-1e9, 1e9) as i64;
    [wrap_texel(index(image_uv.x, size[0]), size[0], wrap[0]), wrap_texel(index(image_uv.y, size[1]), size[1], wrap[1])]
}

/// Texture coordinates of a triangle's corners for a texture, in image space; zero where the mesh has none.
pub fn image_uvs(mesh: &Mesh, texture: &TextureRef, triangle: usize) -> [Vec2; 3] {
    let Some(texcoords) = mesh.texcoord_set(texture.texcoord) else { return [Vec2::ZERO; 3] };
    [0, 1, 2].map(|k| {
        let uv = texcoords[mesh.indices[3 * triangle + k] as usize];
        (texture.image_from_texcoord * Vec3::new(uv.x, uv.y, 1.0)).truncate()
    })
}

/// Vertex alphas of a triangle's corners; one where the mesh has no colours.
pub fn vertex_alphas(mesh: &Mesh, triangle: usize) -> [f32; 3] {
    let Some(colors) = &mesh.colors else { return [1.0; 3] };
    [0, 1, 2].map(|k| colors[mesh.indices[3 * triangle + k] as usize].w)
}

/// Blends three corner values with the weights of the second and third.
pub fn blend<T>(corners: [T; 3], [u, v]: [f32; 2]) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c] = corners;
    a * (1.0 - u - v) + b * u + c * v
}

/// Blends the alphas of three corners. Equal alphas are returned unblended: weights add up to one only up to rounding,
/// and with a cutoff of 1 a solid surface would otherwise get holes.
pub fn blend_alphas(corners: [f32; 3], weights: [f32; 2]) -> f32 {
    let [a, b, c] = corners;
    if a == b && b == c { a } else { blend(corners, weights) }
}

impl Scene {
    /// Whether a point of an instance's triangle is solid. `barycentric` are the weights of the second and third
    /// corner.
    pub fn is_solid_at(&self, instance: usize, triangle: usize, barycentric: [f32; 2]) -> bool {
        let material = self.material(instance);
        match material.alpha {
            Alpha::Opaque => true,
            Alpha::Invisible => false,
            Alpha::Mask { cutoff } => {
                let mesh = &self.meshes[self.instances[instance].mesh];
                self.alpha(mesh, material, triangle, barycentric) >= cutoff
            }
        }
    }

    fn alpha(&self, mesh: &Mesh, material: &Material, triangle: usize, barycentric: [f32; 2]) -> f32 {
        let vertex = blend_alphas(vertex_alphas(mesh, triangle), barycentric);
        let texel = material.base_color_texture.map_or(1.0, |texture| {
            let uv = blend(image_uvs(mesh, &texture, triangle), barycentric);
            image_alpha(&self.images[texture.image], uv, texture.wrap)
        });
        material.base_color.w * vertex * texel
    }
}

fn image_alpha(image: &Image, uv: Vec2, wrap: [Wrap; 2]) -> f32 {
    let [x, y] = nearest_texel(uv, [image.width, image.height], wrap);
    let texel = image.rgba[y as usize * image.width as usize + x as usize];
    f32::from(texel[3]) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_maps_every_index_into_the_image() {
        let wrapped = |wrap| (-5..9).map(|i| wrap_texel(i, 4, wrap)).collect::<Vec<_>>();
        assert_eq!(wrapped(Wrap::Repeat), [3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0]);
        assert_eq!(wrapped(Wrap::Clamp), [0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3]);
        assert_eq!(wrapped(Wrap::Mirror), [3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0]);
    }

    #[test]
    fn equal_alphas_blend_to_themselves_whatever_the_weights() {
        let weights = |i: u32| [(i % 97) as f32 / 97.0, (i % 89) as f32 / 89.0 * (1.0 - (i % 97) as f32 / 97.0)];
        assert!((0..10_000).all(|i| blend_alphas([1.0; 3], weights(i)) == 1.0));
        assert!((0..10_000).any(|i| blend([1.0; 3], weights(i)) < 1.0), "without this the test would prove nothing");
    }

    #[test]
    fn coordinates_without_bound_or_number_stay_in_the_image() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30] {
            let [x, y] = nearest_texel(Vec2::splat(bad), [7, 3], [Wrap::Repeat, Wrap::Mirror]);
            assert!(x < 7 && y < 3);
        }
    }
}
