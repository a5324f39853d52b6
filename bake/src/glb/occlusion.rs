//! Ambient occlusion for standard viewers: `occlusionTexture`, on page coordinates in `TEXCOORD_1`.
//!
//! A layout is shared by all instances of a mesh, but a standard texture has no rectangle per instance. So each
//! instance gets its own page coordinates; positions, normals and indices stay shared.

use super::binary::Binary;
use super::meshes::Written;
use super::{counted, list, materials, references};
use crate::atlas::{Atlas, PageSize};
use crate::maps::{AmbientMaps, in_8_bits};
use crate::scene::Scene;
use glam::Vec2;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

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

    /// Adds each page's texture, and gives it to the materials of what lies on the page. A material that other
    /// primitives use is copied for each page and each set of coordinates but the first.
    pub(super) fn add_to(&self, written: &Written, root: &mut Value, binary: &mut Binary, not_kept: &mut Vec<String>) {
        let textures = self.add_textures(root, binary);
        let mut wanted = BTreeMap::new();
        for (instance, (mesh, place)) in written.mesh_of_instance.iter().zip(&written.places).enumerate() {
            if let (Some(mesh), Some(page)) = (mesh, self.page(instance)) {
                wanted.insert((*mesh, place.primitive), (page, place.uv_set));
            }
        }
        let is_unbaked = |&(mesh, primitive, _): &(usize, usize, &Value)| !wanted.contains_key(&(mesh, primitive));
        let unbaked = references::primitives(root).filter(is_unbaked);
        let mut taken: BTreeSet<usize> = unbaked.flat_map(|(.., value)| materials::materials_of(value)).collect();
        let replaced = references::items(root, "materials").filter(|one| one.get(OCCLUSION).is_some()).count();
        let mut known: BTreeMap<(Option<usize>, usize, u32), usize> = BTreeMap::new();
        let mut all = std::mem::take(list(root, "materials"));
        for ((mesh, primitive), (page, set)) in wanted {
            let primitive = &mut root["meshes"][mesh]["primitives"][primitive];
            materials::map_materials(primitive, |material| {
                let next = all.len();
                let copy = material.map_or_else(|| Some(json!({})), |material| all.get(material).cloned())?;
                let index = *known.entry((material, page, set)).or_insert_with(|| match material {
                    Some(material) if taken.insert(material) => material,
                    _ => next,
                });
                if index == next {
                    all.push(copy);
                }
                all[index][OCCLUSION] = json!({ "index": textures[page], "texCoord": set });
                Some(index)
            });
        }
        *list(root, "materials") = all;
        if replaced > 0 {
            let materials = counted(replaced, "material");
            not_kept.push(format!("the bake's ambient occlusion replaces the occlusion textures of {materials}"));
        }
    }

    /// Adds images, a sampler and textures. Returns each page's texture.
    fn add_textures(&self, root: &mut Value, binary: &mut Binary) -> Vec<usize> {
        // No mip levels: they would blend neighbouring charts.
        let sampler = json!({ "magFilter": 9729, "minFilter": 9729, "wrapS": 33071, "wrapT": 33071 });
        let sampler = push(root, "samplers", sampler);
        let mut add_page = |page: &OcclusionPage| {
            let view = binary.add_view(json!({}), page.png.clone());
            let image = push(root, "images", json!({ "bufferView": view, "mimeType": "image/png" }));
            push(root, "textures", json!({ "source": image, "sampler": sampler }))
        };
        self.pages.iter().map(&mut add_page).collect()
    }
}

const OCCLUSION: &str = "occlusionTexture";

/// Adds to a list at the top level. Returns the index.
fn push(root: &mut Value, name: &str, value: Value) -> usize {
    let all = list(root, name);
    all.push(value);
    all.len() - 1
}
