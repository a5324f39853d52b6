//! Measures a finished atlas: covered texels, and warnings about it.

use super::arrange::{AtlasMesh, AtlasPlan, MeshLayout};
use super::existing::{self, CROWDED_SHARE};
use super::{Atlas, AtlasSettings, Density, FILE_SET};
use crate::scene::{Scene, each_once};
use crate::warning::Warning;
use rayon::prelude::*;

/// Area of all triangles on all pages, in texels.
pub(super) fn covered_texels(scene: &Scene, atlas: &Atlas) -> f64 {
    (0..scene.instances.len())
        .into_par_iter()
        .map(|i| texels_of_instance(scene, atlas, i))
        .collect::<Vec<_>>()
        .iter()
        .sum()
}

fn texels_of_instance(scene: &Scene, atlas: &Atlas, instance: usize) -> f64 {
    let placement = &atlas.placements[instance];
    if placement.is_empty() {
        return 0.0;
    }
    let layout = &atlas.layouts[scene.instances[instance].mesh];
    let triangles = layout.indices.chunks_exact(3).map(|t| {
        let [a, b, c] = [0, 1, 2].map(|k| layout.uvs[t[k] as usize].as_dvec2());
        (b - a).perp_dot(c - a).abs() * 0.5
    });
    let scale = placement.scale.as_dvec2() * atlas.pages[placement.page as usize].as_dvec2();
    triangles.sum::<f64>() * scale.x * scale.y
}

impl Atlas {
    /// Width of each instance's texels, metres; huge where it has none.
    pub fn texel_widths_m(&self, scene: &Scene) -> Vec<f64> {
        let density = |instance: usize| self.texels_per_metre_of(scene, instance).max(f64::MIN_POSITIVE);
        (0..scene.instances.len()).into_par_iter().map(|instance| 1.0 / density(instance)).collect()
    }

    /// Density of an instance's texels: the root of its covered texels over its area. 0 for one without texels.
    pub fn texels_per_metre_of(&self, scene: &Scene, instance: usize) -> f64 {
        let place = &scene.instances[instance];
        let mesh = &scene.meshes[place.mesh];
        let corner = |index: u32| place.bake_from_object.transform_vector3(mesh.positions[index as usize].as_dvec3());
        let areas = mesh.indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| corner(t[k]));
            (b - a).cross(c - a).length() * 0.5
        });
        let square_m: f64 = areas.sum();
        if square_m > 0.0 { (texels_of_instance(scene, self, instance) / square_m).sqrt() } else { 0.0 }
    }
}

/// A warning if some mesh did not get the density that was asked for it or for what lies around it.
pub(super) fn cap_warning(
    scene: &Scene,
    settings: &AtlasSettings,
    items: &[AtlasMesh],
    plan: &AtlasPlan,
) -> Option<Warning> {
    let (instance, asked_per_metre, reached_per_metre) = plan.most_capped(items)?;
    Some(Warning::LessDensity {
        meshes: 1,
        page_size_texels: settings.page_size_texels,
        asked_per_metre,
        mesh: scene.meshes[scene.instances[instance].mesh].label(),
        reached_per_metre,
    })
}

/// A warning if some meshes did not get the requested density.
pub(super) fn fit_warning(
    scene: &Scene,
    settings: &AtlasSettings,
    items: &[AtlasMesh],
    atlas: &Atlas,
) -> Option<Warning> {
    let Density::TexelsPerMetre(asked) = settings.density else { return None };
    let reached = |item: &AtlasMesh| {
        let texels: f64 = item.instances.iter().map(|i| texels_of_instance(scene, atlas, i.index)).sum();
        (texels / item.area_m2()).sqrt()
    };
    let is_plain = |item: &&AtlasMesh| item.instances.iter().all(|instance| instance.own_density.is_none());
    let reached = items.iter().filter(is_plain).map(|item| (reached(item), item));
    let short: Vec<_> = reached.filter(|(density, _)| *density < 0.9 * asked).collect();
    let (least, item) = short.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mesh = &scene.meshes[scene.instances[item.instances[0].index].mesh];
    Some(Warning::LessDensity {
        meshes: short.len(),
        page_size_texels: settings.page_size_texels,
        asked_per_metre: asked,
        mesh: mesh.label(),
        reached_per_metre: *least,
    })
}

/// Meshes with the file's own layout whose islands are too close together at their final size.
pub(super) fn crowded_items(scene: &Scene, items: &[AtlasMesh], atlas: &Atlas) -> Vec<usize> {
    let is_crowded = |item: &AtlasMesh| {
        let scale = |index: usize| atlas.placements[index].scale.x;
        let instances = item.instances.iter().map(|instance| instance.index);
        let smallest = instances.min_by(|&a, &b| scale(a).total_cmp(&scale(b)));
        let Some(instance) = smallest.filter(|_| matches!(item.form, MeshLayout::FileLayout(_))) else {
            return false;
        };
        let size = atlas.pages[atlas.placements[instance].page as usize];
        let mesh = &scene.meshes[scene.instances[instance].mesh];
        existing::crowded_share(&[mesh], size, |uv| atlas.texel(instance, uv.as_vec2(), size)) > CROWDED_SHARE
    };
    (0..items.len()).filter(|&i| is_crowded(&items[i])).collect()
}

/// A warning if some meshes have a `TEXCOORD_1` that could not be used.
pub(super) fn refusal_warning(scene: &Scene, settings: &AtlasSettings, items: &[AtlasMesh]) -> Option<Warning> {
    let mesh = |item: &AtlasMesh| &scene.meshes[scene.instances[item.instances[0].index].mesh];
    let is_refused =
        |item: &&AtlasMesh| matches!(item.form, MeshLayout::Charts(_)) && mesh(item).texcoord_set(FILE_SET).is_some();
    let meshes = each_once(items.iter().filter(is_refused).map(|item| mesh(item).label()).collect());
    (settings.keeps_existing && !meshes.is_empty()).then_some(Warning::Unwrapped { meshes })
}
