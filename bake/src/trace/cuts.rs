//! Which points of which triangles are holes.

use crate::scene::alpha::{blend, image_uvs, nearest_texel, vertex_alphas, wrap_texel};
use crate::scene::{Alpha, Geometry, Scene, Wrap};
use glam::{DVec2, Vec2};

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
    /// Whether the vertices have no alpha of their own.
    is_plain: bool,
    /// Index in [`Cuts::masks`], if the material has a texture.
    mask: Option<u32>,
}

/// The alpha channel of a material's texture.
struct Mask {
    size: [u32; 2],
    wrap: [Wrap; 2],
    alpha: Vec<u8>,
    /// For each texel of a material without corner alphas, whether it is solid ([`SOLID`]), and how many texels the image
    /// goes on like that in every direction: texels of a square of twice that and one.
    reach: Vec<u8>,
}

/// A triangle with holes, for engines that follow the sun across it.
pub(crate) struct CutView<'a> {
    /// Texture coordinates of the corners, in texels.
    pub texel_uvs: [DVec2; 3],
    /// Alpha at the corners, without the texture's.
    pub alphas: [f64; 3],
    /// Least alpha that is solid.
    pub cutoff: f64,
    /// Whether the corners' alphas are the material's own, for which [`Mask::reach`] was made.
    is_plain: bool,
    mask: Option<&'a Mask>,
}

impl CutView<'_> {
    /// Whether alpha changes from texel to texel.
    pub fn has_texture(&self) -> bool {
        self.mask.is_some()
    }

    /// Alpha of the texture in a texel, wherever it lies.
    pub fn alpha_of(&self, [column, row]: [i64; 2]) -> f64 {
        let Some(mask) = self.mask else { return 1.0 };
        let x = wrap_texel(column, mask.size[0], mask.wrap[0]);
        let y = wrap_texel(row, mask.size[1], mask.wrap[1]);
        f64::from(mask.alpha[y as usize * mask.size[0] as usize + x as usize]) / 255.0
    }

    /// A square of texels around one that are all solid or all clear: its borders `[[left, right], [top, bottom]]` and
    /// which it is. Where alpha may pass the cutoff within the texel there is no answer to that.
    #[inline]
    pub fn uniform(&self, texel: [i64; 2]) -> ([[i64; 2]; 2], Option<bool>) {
        let square = |reach: i64| texel.map(|at| [at - reach, at + 1 + reach]);
        let Some(mask) = self.mask else { return (square(0), self.verdict(1.0)) };
        if !self.is_plain || !mask.is_unturned(texel) {
            return (square(0), self.verdict(self.alpha_of(texel)));
        }
        let x = wrap_texel(texel[0], mask.size[0], mask.wrap[0]);
        let y = wrap_texel(texel[1], mask.size[1], mask.wrap[1]);
        let reach = mask.reach[y as usize * mask.size[0] as usize + x as usize];
        (square(i64::from(reach & !SOLID)), Some(reach & SOLID != 0))
    }

    /// Whether all of the triangle is solid, or clear, where the texture's alpha is this.
    fn verdict(&self, alpha: f64) -> Option<bool> {
        let all = self.alphas.iter().all(|own| own * alpha >= self.cutoff);
        let none = self.alphas.iter().all(|own| own * alpha < self.cutoff);
        if all { Some(true) } else { none.then_some(false) }
    }
}

/// Bit of [`Mask::reach`] that says that a texel is solid.
const SOLID: u8 = 0x80;

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
                    cuts.masks.push(Mask::new(
                        &scene.images[texture.image],
                        texture.wrap,
                        f64::from(material.base_color.w),
                        f64::from(cutoff),
                    ));
                    cuts.masks.len() as u32 - 1
                })
            });
            cuts.of_triangle[id] = cuts.triangles.len() as u32;
            cuts.triangles.push(CutTriangle {
                image_uvs: texture.map_or([Vec2::ZERO; 3], |t| image_uvs(mesh, &t, surface.mesh_triangle)),
                alphas: vertex_alphas(mesh, surface.mesh_triangle).map(|a| a * material.base_color.w),
                cutoff,
                is_plain: mesh.colors.is_none(),
                mask,
            });
        }
        cuts
    }

    #[inline]
    pub fn has_holes(&self, id: usize) -> bool {
        self.of_triangle.get(id).is_some_and(|&cut| cut != Self::NONE)
    }

    /// What a closed-form engine needs of a triangle with holes.
    pub fn view(&self, id: usize) -> Option<CutView<'_>> {
        let &cut = self.of_triangle.get(id)?;
        let triangle = self.triangles.get(cut as usize)?;
        let mask = triangle.mask.map(|mask| &self.masks[mask as usize]);
        let size = mask.map_or(DVec2::ONE, |mask| DVec2::new(f64::from(mask.size[0]), f64::from(mask.size[1])));
        Some(CutView {
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

/// For each texel, whether it is solid and how far around it nothing changes, within the image: the distance to the nearest
/// texel that differs, counted along the longer axis, less one. Two sweeps over the image suffice for that distance
/// (Rosenfeld and Pfaltz, "Sequential operations in digital picture processing", 1966).
fn reaches(solid: &[bool], [width, height]: [usize; 2]) -> Vec<u8> {
    let differs = |a: usize, b: usize| solid[a] != solid[b];
    let mut steps: Vec<u8> = (0..solid.len())
        .map(|i| {
            let (x, y) = (i % width, i / width);
            let border = x.min(y).min(width - 1 - x).min(height - 1 - y);
            border.min(usize::from(!SOLID)) as u8
        })
        .collect();
    let mut relax = |i: usize, dx: isize, dy: isize| {
        let (x, y) = ((i % width) as isize + dx, (i / width) as isize + dy);
        if (0..width as isize).contains(&x) && (0..height as isize).contains(&y) {
            let neighbour = y as usize * width + x as usize;
            let most = if differs(i, neighbour) { 0 } else { steps[neighbour].saturating_add(1) };
            steps[i] = steps[i].min(most);
        }
    };
    let before = [(-1, 0), (-1, -1), (0, -1), (1, -1)];
    (0..solid.len()).for_each(|i| before.iter().for_each(|&(dx, dy)| relax(i, dx, dy)));
    (0..solid.len()).rev().for_each(|i| before.iter().for_each(|&(dx, dy)| relax(i, -dx, -dy)));
    steps.iter().zip(solid).map(|(&reach, &solid)| if solid { reach | SOLID } else { reach }).collect()
}

impl Mask {
    /// For a material's factor of alpha and its cutoff.
    fn new(image: &crate::scene::Image, wrap: [Wrap; 2], factor: f64, cutoff: f64) -> Self {
        let alpha: Vec<u8> = image.rgba.iter().map(|texel| texel[3]).collect();
        let size = [image.width, image.height];
        let solid: Vec<bool> = alpha.iter().map(|&a| f64::from(a) / 255.0 * factor >= cutoff).collect();
        let reach = reaches(&solid, size.map(|n| n as usize));
        Self { size, wrap, alpha, reach }
    }

    /// Whether texels run the same way around a texel as in the image itself, so that squares may be used.
    fn is_unturned(&self, texel: [i64; 2]) -> bool {
        [0, 1].iter().all(|&k| {
            let size = i64::from(self.size[k]);
            match self.wrap[k] {
                Wrap::Repeat => true,
                Wrap::Clamp => (0..size).contains(&texel[k]),
                Wrap::Mirror => texel[k].rem_euclid(2 * size) < size,
            }
        })
    }

    fn alpha_at(&self, uv: Vec2) -> f32 {
        let [x, y] = nearest_texel(uv, self.size, self.wrap);
        f32::from(self.alpha[y as usize * self.size[0] as usize + x as usize]) / 255.0
    }
}
