//! Alpha masks of triangles: which of their points are solid.

use super::alpha_texture::{AlphaTexture, SOLID, is_solid, quadrant};
use crate::scene::alpha::{blend, blend_alphas, image_uvs, vertex_alphas};
use crate::scene::{Alpha, Geometry, Scene};
use glam::{DVec2, Vec2};

/// Alpha masks of all triangles that have one. Empty in a scene without alpha masks.
#[derive(Default)]
pub(super) struct AlphaMasks {
    /// In the hierarchy's order: index in `triangles`, or [`AlphaMasks::NONE`]. Empty if no triangle has a mask.
    of_triangle: Vec<u32>,
    triangles: Vec<TriangleMask>,
    textures: Vec<AlphaTexture>,
}

/// A triangle with an alpha mask.
struct TriangleMask {
    image_uvs: [Vec2; 3],
    /// Vertex alpha times the material's factor.
    alphas: [f32; 3],
    cutoff: f32,
    /// Whether vertices have no alpha, so that all corners have the material's.
    is_plain: bool,
    /// Index in [`AlphaMasks::textures`], if the material has a texture.
    mask: Option<u32>,
}

/// A triangle with an alpha mask, as closed-form engines need it.
pub(crate) struct MaskedTriangle<'a> {
    /// Texture coordinates of the corners, in texels of the image.
    pub texel_uvs: [DVec2; 3],
    /// Alpha at the corners without the texture's, 0 to 1.
    pub alphas: [f64; 3],
    /// Least alpha of a solid point, 0 to 1.
    pub cutoff: f64,
    /// Whether the corners have the material's own alpha, so that [`AlphaTexture::squares`] are valid.
    is_plain: bool,
    mask: Option<&'a AlphaTexture>,
}

impl MaskedTriangle<'_> {
    /// A triangle without a texture.
    #[cfg(test)]
    pub fn of_alphas(alphas: [f64; 3], cutoff: f64) -> Self {
        Self { texel_uvs: [DVec2::ZERO; 3], alphas, cutoff, is_plain: false, mask: None }
    }

    /// Whether the material has a texture.
    pub fn has_texture(&self) -> bool {
        self.mask.is_some()
    }

    /// The texture's alpha in a texel, 0 to 1; any index is wrapped into the image.
    pub fn alpha_of(&self, texel: [i64; 2]) -> f64 {
        let Some(mask) = self.mask else { return 1.0 };
        f64::from(mask.alpha[mask.index(texel)]) / 255.0
    }

    /// A uniform square of texels around one: its borders `[[left, right], [top, bottom]]`, and whether it is solid.
    /// `None` if alpha may cross the cutoff within the texel.
    #[inline]
    pub fn uniform(&self, texel: [i64; 2]) -> ([[i64; 2]; 2], Option<bool>) {
        let (sides, solidity) = self.squares(texel);
        let reach = sides.map(|side| i64::from(side & !SOLID)).into_iter().fold(i64::MAX, i64::min) - 1;
        (texel.map(|at| [at - reach, at + 1 + reach]), solidity)
    }

    /// The same for a square that starts at the texel and extends to where each coordinate grows (or falls).
    #[inline]
    pub fn uniform_ahead(&self, texel: [i64; 2], grows: [bool; 2]) -> ([[i64; 2]; 2], Option<bool>) {
        let (sides, solidity) = self.squares(texel);
        let side = i64::from(sides[quadrant(grows)] & !SOLID);
        let ahead = |k: usize| if grows[k] { [texel[k], texel[k] + side] } else { [texel[k] + 1 - side, texel[k] + 1] };
        ([ahead(0), ahead(1)], solidity)
    }

    #[inline]
    fn squares(&self, texel: [i64; 2]) -> ([u8; 4], Option<bool>) {
        let Some(mask) = self.mask else { return ([1; 4], self.solidity(1.0)) };
        if !self.is_plain || !mask.has_image_order(texel) {
            return ([1; 4], self.solidity(self.alpha_of(texel)));
        }
        let sides = mask.squares[mask.index(texel)];
        (sides, Some(sides[0] & SOLID != 0))
    }

    /// Where the texture has this alpha: whether the whole triangle is solid; `None` if it is so in part.
    fn solidity(&self, alpha: f64) -> Option<bool> {
        let solid = self.alphas.map(|own| is_solid(own as f32, alpha as f32, self.cutoff as f32));
        solid.iter().all(|&corner| corner == solid[0]).then_some(solid[0])
    }
}

impl AlphaMasks {
    const NONE: u32 = u32::MAX;

    pub fn new(scene: &Scene, geometry: &Geometry, flat: &[u32]) -> Self {
        if !scene.has_alpha_mask() {
            return Self::default();
        }
        let mut alpha_mask = Self { of_triangle: vec![Self::NONE; flat.len()], ..Self::default() };
        let mut mask_of_material = vec![None; scene.materials.len()];
        for (id, &triangle) in flat.iter().enumerate() {
            let surface = geometry.surface(triangle as usize);
            let mesh = &scene.meshes[scene.instances[surface.instance].mesh];
            let material = &scene.materials[mesh.material];
            let Alpha::Mask { cutoff } = material.alpha else { continue };
            let texture = material.base_color_texture;
            let mask = texture.map(|texture| {
                *mask_of_material[mesh.material].get_or_insert_with(|| {
                    alpha_mask.textures.push(AlphaTexture::new(
                        &scene.images[texture.image],
                        texture.wrap,
                        material.base_color.w,
                        cutoff,
                    ));
                    alpha_mask.textures.len() as u32 - 1
                })
            });
            alpha_mask.of_triangle[id] = alpha_mask.triangles.len() as u32;
            alpha_mask.triangles.push(TriangleMask {
                image_uvs: texture.map_or([Vec2::ZERO; 3], |t| image_uvs(mesh, &t, surface.mesh_triangle)),
                alphas: vertex_alphas(mesh, surface.mesh_triangle).map(|a| a * material.base_color.w),
                cutoff,
                is_plain: mesh.colors.is_none(),
                mask,
            });
        }
        alpha_mask
    }

    #[inline]
    pub fn has_alpha_mask(&self, id: usize) -> bool {
        self.of_triangle.get(id).is_some_and(|&index| index != Self::NONE)
    }

    /// A triangle's mask for closed-form engines, if it has one.
    pub fn view(&self, id: usize) -> Option<MaskedTriangle<'_>> {
        let &index = self.of_triangle.get(id)?;
        let triangle = self.triangles.get(index as usize)?;
        let mask = triangle.mask.map(|mask| &self.textures[mask as usize]);
        let size = mask.map_or(DVec2::ONE, |mask| DVec2::new(f64::from(mask.size[0]), f64::from(mask.size[1])));
        Some(MaskedTriangle {
            texel_uvs: triangle.image_uvs.map(|uv| uv.as_dvec2() * size),
            alphas: triangle.alphas.map(f64::from),
            cutoff: f64::from(triangle.cutoff),
            is_plain: triangle.is_plain,
            mask,
        })
    }

    #[inline]
    pub fn is_solid(&self, id: usize, barycentric: [f64; 2]) -> bool {
        match self.of_triangle.get(id) {
            None | Some(&Self::NONE) => true,
            Some(&index) => self.is_solid_at(&self.triangles[index as usize], barycentric.map(|b| b as f32)),
        }
    }

    fn is_solid_at(&self, triangle: &TriangleMask, barycentric: [f32; 2]) -> bool {
        let texel = triangle
            .mask
            .map_or(1.0, |mask| self.textures[mask as usize].alpha_at(blend(triangle.image_uvs, barycentric)));
        is_solid(blend_alphas(triangle.alphas, barycentric), texel, triangle.cutoff)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Wrap;
    use crate::testing::SceneBuilder;

    /// Alpha equal to the cutoff is solid, as for rays: 51 / 255 equals 0.2 in `f32`, but is less in `f64`.
    #[test]
    fn an_alpha_at_the_cutoff_is_solid() {
        for (alpha, cutoff) in [(51, 0.2), (102, 0.4), (153, 0.6), (204, 0.8)] {
            for (alpha, is_solid) in [(alpha, true), (alpha - 1, false)] {
                let (builder, image) = SceneBuilder::new().image(1, 1, vec![[0, 0, 0, alpha]]);
                let mask = AlphaTexture::new(&builder.build().images[image], [Wrap::Repeat; 2], 1.0, cutoff);
                let texel_uvs = [DVec2::ZERO; 3];
                let cutoff = f64::from(cutoff);
                let plain = MaskedTriangle { texel_uvs, alphas: [1.0; 3], cutoff, is_plain: true, mask: Some(&mask) };
                let by_corners = MaskedTriangle { is_plain: false, ..plain };
                assert_eq!(plain.uniform([0, 0]).1, Some(is_solid), "{alpha} of {cutoff}");
                assert_eq!(by_corners.uniform([0, 0]).1, Some(is_solid), "{alpha} of {cutoff}");
            }
        }
    }
}
