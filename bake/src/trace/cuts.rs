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
    /// Index in [`Cuts::masks`], if the material has a texture.
    mask: Option<u32>,
}

/// The alpha channel of a material's texture.
struct Mask {
    size: [u32; 2],
    wrap: [Wrap; 2],
    alpha: Vec<u8>,
    /// Least and greatest alpha of squares of 2, 4, 8, ... texels: squares in a row, then the squares row by row.
    ranges: Vec<(usize, Vec<[u8; 2]>)>,
}

/// A triangle with holes, for engines that follow the sun across it.
pub(crate) struct CutView<'a> {
    /// Texture coordinates of the corners, in texels.
    pub texel_uvs: [DVec2; 3],
    /// Alpha at the corners, without the texture's.
    pub alphas: [f64; 3],
    /// Least alpha that is solid.
    pub cutoff: f64,
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

    /// The largest square of texels around one (level n of [`Mask::ranges`] has squares of 2^n) that is solid throughout or
    /// clear throughout: its borders `[[left, right], [top, bottom]]` and which it is. A texel in which alpha passes the
    /// cutoff between the triangle's own alphas has no answer.
    pub fn uniform(&self, texel: [i64; 2]) -> ([[i64; 2]; 2], Option<bool>) {
        let only = [[texel[0], texel[0] + 1], [texel[1], texel[1] + 1]];
        let verdict = |[least, most]: [u8; 2]| {
            let alpha = |value: u8, own: &f64| f64::from(value) / 255.0 * own;
            let all = self.alphas.iter().all(|own| alpha(least, own) >= self.cutoff);
            let none = self.alphas.iter().all(|own| alpha(most, own) < self.cutoff);
            if all { Some(true) } else { none.then_some(false) }
        };
        let Some(mask) = self.mask else { return (only, verdict([255; 2])) };
        let at = [0, 1].map(|k| wrap_texel(texel[k], mask.size[k], mask.wrap[k]));
        let alpha = mask.alpha[at[1] as usize * mask.size[0] as usize + at[0] as usize];
        let mut best = (only, verdict([alpha; 2]));
        if best.1.is_none() || !mask.is_unturned(texel) {
            return best;
        }
        for (level, (width, ranges)) in mask.ranges.iter().enumerate() {
            let edge = 2u32 << level;
            let square = at.map(|x| x / edge);
            if verdict(ranges[square[1] as usize * width + square[0] as usize]) != best.1 {
                break;
            }
            let side = |k: usize| {
                let low = texel[k] - i64::from(at[k] - square[k] * edge);
                [low, low + i64::from(edge.min(mask.size[k] - square[k] * edge))]
            };
            best.0 = [side(0), side(1)];
        }
        best
    }
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

/// Ranges of squares twice as large: squares in a row, then the squares.
fn halved([width, height]: [usize; 2], ranges: &[[u8; 2]]) -> (usize, Vec<[u8; 2]>) {
    let (columns, rows) = (width.div_ceil(2), height.div_ceil(2));
    let mut squares = vec![[255, 0]; columns * rows];
    for (index, range) in ranges.iter().enumerate() {
        let square: &mut [u8; 2] = &mut squares[index / width / 2 * columns + index % width / 2];
        *square = [square[0].min(range[0]), square[1].max(range[1])];
    }
    (columns, squares)
}

impl Mask {
    fn new(image: &crate::scene::Image, wrap: [Wrap; 2]) -> Self {
        let alpha: Vec<u8> = image.rgba.iter().map(|texel| texel[3]).collect();
        let size = [image.width, image.height];
        let single = alpha.iter().map(|&a| [a; 2]).collect::<Vec<_>>();
        let mut ranges = vec![halved(size.map(|n| n as usize), &single)];
        while let Some((width, squares)) = ranges.last().filter(|(_, squares)| squares.len() > 1) {
            let next = halved([*width, squares.len() / width], squares);
            ranges.push(next);
        }
        Self { size, wrap, alpha, ranges }
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
