//! Measures a finished atlas: covered texels, and warnings about it.

use super::arrange::{AtlasMesh, AtlasPlan, MeshLayout};
use super::chart_box::is_drawn_together;
use super::existing::{self, CROWDED_SHARE};
use super::{Atlas, AtlasSettings, Density, FILE_SET};
use crate::scene::{Scene, each_once};
use crate::warning::Warning;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::HashSet;

/// Area of a surface in texels and in square metres.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    texels: f64,
    square_m: f64,
}

impl Extent {
    /// The root of texels over area; 0 without area.
    pub fn texels_per_metre(self) -> f64 {
        if self.square_m > 0.0 { (self.texels / self.square_m).sqrt() } else { 0.0 }
    }

    pub fn sum(all: impl IntoIterator<Item = Self>) -> Self {
        let add = |a: Self, b: Self| Self { texels: a.texels + b.texels, square_m: a.square_m + b.square_m };
        all.into_iter().fold(Self::default(), add)
    }
}

/// The extent of each instance. Charts that were drawn together do not count, unless there are no others: then each of
/// their texels counts as one.
pub(super) fn extents(scene: &Scene, atlas: &Atlas) -> Vec<Extent> {
    (0..scene.instances.len()).into_par_iter().map(|instance| extent(scene, atlas, instance)).collect()
}

fn extent(scene: &Scene, atlas: &Atlas, instance: usize) -> Extent {
    let placement = &atlas.placements[instance];
    if placement.is_empty() {
        return Extent::default();
    }
    let place = &scene.instances[instance];
    let (mesh, layout) = (&scene.meshes[place.mesh], &atlas.layouts[place.mesh]);
    let page = atlas.pages[placement.page as usize];
    let corner = |index: u32| place.bake_from_object.transform_vector3(mesh.positions[index as usize].as_dvec3());
    let of_triangle = |(corners, own): (&[u32], &[u32])| {
        let [a, b, c] = [0, 1, 2].map(|k| corner(corners[k]));
        let on_page = [0, 1, 2].map(|k| atlas.texel(instance, layout.uvs[own[k] as usize], page));
        let [p, q, r] = on_page;
        let texels = (q - p).perp_dot(r - p).abs() * 0.5;
        (on_page, Extent { texels, square_m: (b - a).cross(c - a).length() * 0.5 })
    };
    let triangles = || mesh.indices.chunks_exact(3).zip(layout.indices.chunks_exact(3)).map(of_triangle);
    let flat = triangles().filter(|(on_page, _)| !is_drawn_together(on_page)).map(|(_, extent)| extent);
    let flat = Extent::sum(flat);
    if flat.texels > 0.0 {
        return flat;
    }
    let cells = |[a, b, c]: [DVec2; 3]| {
        let low = a.min(b).min(c).floor().as_i64vec2();
        let high = a.max(b).max(c).floor().as_i64vec2();
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| [x, y]))
    };
    let texels: HashSet<[i64; 2]> = triangles().flat_map(|(on_page, _)| cells(on_page)).collect();
    Extent { texels: texels.len() as f64, ..Extent::sum(triangles().map(|(_, extent)| extent)) }
}

impl Atlas {
    /// Width of each instance's texels, metres; huge where it has none.
    pub fn texel_widths_m(&self, scene: &Scene) -> Vec<f64> {
        let width_m = |extent: Extent| 1.0 / extent.texels_per_metre().max(f64::MIN_POSITIVE);
        extents(scene, self).into_iter().map(width_m).collect()
    }

    /// Density of an instance's texels: the root of its covered texels over its area. 0 for one without texels.
    pub fn texels_per_metre_of(&self, scene: &Scene, instance: usize) -> f64 {
        extent(scene, self, instance).texels_per_metre()
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
    let reached =
        |item: &AtlasMesh| Extent::sum(item.instances.iter().map(|i| extent(scene, atlas, i.index))).texels_per_metre();
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
