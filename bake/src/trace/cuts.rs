//! Which points of which triangles are holes.

use crate::scene::alpha::{blend, image_uvs, nearest_texel, vertex_alphas};
use crate::scene::{Alpha, Geometry, Scene, Wrap};
use glam::Vec2;

/// Alpha masks of the triangles that have holes. Empty, and never asked, in a scene without any.
#[derive(Default)]
pub(super) struct Cuts {
    /// In the hierarchy's order: index in `triangles`, or [`Cuts::NONE`]. Empty if no triangle has holes.
    of_triangle: Vec<u32>,
    triangles: Vec<CutTriangle>,
    masks: Vec<Mask>,
}

/// A triangle with holes.
struct CutTriangle {
    image_uvs: [Vec2; 3],
    /// Vertex alpha times the material's factor.
    alphas: [f32; 3],
    cutoff: f32,
    /// Index in [`Cuts::masks`], if the material has a texture.
    mask: Option<u32>,
}

/// The alpha channel of a material's texture.
struct Mask {
    size: [u32; 2],
    wrap: [Wrap; 2],
    alpha: Vec<u8>,
}

impl Cuts {
    const NONE: u32 = u32::MAX;

    pub fn new(scene: &Scene, geometry: &Geometry, flat: &[u32]) -> Self {
        if !scene.has_alpha_cut() {
            return Self::default();
        }
        let mut cuts = Self { of_triangle: vec![Self::NONE; flat.len()], ..Self::default() };
        let mut mask_of_material = vec![None; scene.materials.len()];
        for (id, &triangle) in flat.iter().enumerate() {
            let surface = geometry.surface(triangle as usize);
            let mesh = &scene.meshes[scene.instances[surface.instance].mesh];
            let material = &scene.materials[mesh.material];
            let Alpha::Cut { cutoff } = material.alpha else { continue };
            let texture = material.base_color_texture;
            let mask = texture.map(|texture| {
                *mask_of_material[mesh.material].get_or_insert_with(|| {
                    cuts.masks.push(Mask::new(&scene.images[texture.image], texture.wrap));
                    cuts.masks.len() as u32 - 1
                })
            });
            cuts.of_triangle[id] = cuts.triangles.len() as u32;
            cuts.triangles.push(CutTriangle {
                image_uvs: texture.map_or([Vec2::ZERO; 3], |t| image_uvs(mesh, &t, surface.mesh_triangle)),
                alphas: vertex_alphas(mesh, surface.mesh_triangle).map(|a| a * material.base_color.w),
                cutoff,
                mask,
            });
        }
        cuts
    }

    #[inline]
    pub fn is_solid(&self, id: usize, barycentric: [f64; 2]) -> bool {
        match self.of_triangle.get(id) {
            None | Some(&Self::NONE) => true,
            Some(&cut) => self.is_solid_at(&self.triangles[cut as usize], barycentric.map(|b| b as f32)),
        }
    }

    fn is_solid_at(&self, triangle: &CutTriangle, barycentric: [f32; 2]) -> bool {
        let texel = triangle
            .mask
            .map_or(1.0, |mask| self.masks[mask as usize].alpha_at(blend(triangle.image_uvs, barycentric)));
        blend(triangle.alphas, barycentric) * texel >= triangle.cutoff
    }
}

impl Mask {
    fn new(image: &crate::scene::Image, wrap: [Wrap; 2]) -> Self {
        let alpha = image.rgba.iter().map(|texel| texel[3]).collect();
        Self { size: [image.width, image.height], wrap, alpha }
    }

    fn alpha_at(&self, uv: Vec2) -> f32 {
        let [x, y] = nearest_texel(uv, self.size, self.wrap);
        f32::from(self.alpha[y as usize * self.size[0] as usize + x as usize]) / 255.0
    }
}
