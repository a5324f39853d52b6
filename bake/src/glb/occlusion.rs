//! Ambient occlusion for standard viewers: `occlusionTexture`, on page coordinates in `TEXCOORD_1`.
//!
//! A layout is shared by all instances of a mesh, but a standard texture has no rectangle per instance. So each
//! instance gets its own page coordinates; positions, normals and indices stay shared.

use super::binary::Binary;
use super::materials::{WrittenMaterials, index_of};
use crate::atlas::{Atlas, PageSize};
use crate::maps::{AmbientMaps, in_8_bits};
use crate::scene::Scene;
use glam::Vec2;
use serde_json::json;

/// A page's occlusion texture for viewers: 8 bits, and of two sides the brighter one. Most models whose materials are
/// all double-sided are closed, with dark insides, and cameras are mostly outside.
#[derive(Debug, Clone)]
pub struct OcclusionPage {
    png: Vec<u8>,
}

impl OcclusionPage {
    /// Encodes a page's ambient visibility.
    pub fn new(size: PageSize, maps: &AmbientMaps) -> Self {
        let front = &maps.front.visibility;
        let grey: Vec<u8> = match &maps.back {
            None => front.iter().map(|&code| in_8_bits(code)).collect(),
            Some(back) => front.iter().zip(&back.visibility).map(|(&f, &b)| in_8_bits(f.max(b))).collect(),
        };
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, size.width, size.height);
        encoder.set_color(png::ColorType::Grayscale);
        let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&grey));
        written.expect("a vector takes as many texels as the size says");
        Self { png }
    }
}

/// Occlusion of a scene's instances.
#[derive(Debug, Clone, Copy)]
pub struct Occlusion<'a> {
    /// The instances' layouts and placements.
    pub atlas: &'a Atlas,
    /// Textures, one per page.
    pub pages: &'a [OcclusionPage],
}

impl Occlusion<'_> {
    /// Page coordinates of the vertices of an instance's layout.
    pub(super) fn page_uvs(&self, scene: &Scene, instance: usize) -> Vec<Vec2> {
        let placement = &self.atlas.placements[instance];
        let layout = &self.atlas.layouts[scene.instances[instance].mesh];
        layout.uvs.iter().map(|&uv| uv * placement.scale + placement.offset).collect()
    }

    /// The page of an instance, if it has texels.
    pub(super) fn page(&self, instance: usize) -> Option<usize> {
        let placement = &self.atlas.placements[instance];
        (!placement.is_empty()).then_some(placement.page as usize)
    }

    /// Adds each page's texture to the materials used on the page; a material on several pages is duplicated. Returns
    /// the material index of every instance.
    pub(super) fn add_to(&self, scene: &Scene, written: &mut WrittenMaterials, binary: &mut Binary) -> Vec<usize> {
        // No mip levels: they would blend neighbouring charts.
        let sampler = json!({ "magFilter": 9729, "minFilter": 9729, "wrapS": 33071, "wrapT": 33071 });
        let sampler = index_of(&mut written.samplers, sampler);
        let mut add_page = |page: &OcclusionPage| {
            let view = binary.add_view(page.png.iter().copied());
            written.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
            written.textures.push(json!({ "source": written.images.len() - 1, "sampler": sampler }));
            written.textures.len() - 1
        };
        let textures: Vec<usize> = self.pages.iter().map(&mut add_page).collect();
        let mut known: Vec<(usize, usize, usize)> = Vec::new();
        let mut material = |instance: usize| {
            let material = scene.meshes[scene.instances[instance].mesh].material;
            let Some(page) = self.page(instance) else { return material };
            if let Some(&(_, _, index)) = known.iter().find(|&&(m, p, _)| (m, p) == (material, page)) {
                return index;
            }
            let is_first = known.iter().all(|&(m, _, _)| m != material);
            let index = if is_first { material } else { written.materials.len() };
            if !is_first {
                written.materials.push(written.materials[material].clone());
            }
            written.materials[index]["occlusionTexture"] = json!({ "index": textures[page], "texCoord": 1 });
            known.push((material, page, index));
            index
        };
        (0..scene.instances.len()).map(&mut material).collect()
    }
}
