//! Builds an atlas: check the file's own layouts, unwrap the other meshes, find the density, place everything.

use super::arrange::{AtlasInstance, AtlasMesh, AtlasPlan, MeshLayout};
use super::error::AtlasError;
use super::meter::{ProgressMeter, UNWRAP_SHARE};
use super::search::{MOST_PAGES, find_plan};
use super::unwrap::{self, Charts};
use super::zones::Zones;
use super::{Atlas, AtlasSettings, Density, FILE_SET, Layout, LayoutOrigin, Placement};
use super::{existing, measure, shared};
use crate::scene::Scene;
use rayon::prelude::*;

/// Gives every instance its own texels. `progress` gets the fraction done (0 to 1) and returns false to stop.
///
/// The result does not depend on the number of threads. An empty scene gives an atlas without pages.
pub fn build(
    scene: &Scene,
    settings: &AtlasSettings,
    progress: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Atlas, AtlasError> {
    check(settings)?;
    let meter = ProgressMeter::new(progress);
    let drawn = drawn_instances(scene);
    let zones = Zones::new(scene);
    if zones.is_empty()
        && let Some(atlas) = shared::shared_square(scene, settings, &drawn)
    {
        return Ok(atlas);
    }
    let mut items = make_meshes(scene, settings, &drawn, &zones, &meter)?;
    loop {
        let mut warnings: Vec<_> = measure::refusal_warning(scene, settings, &items).into_iter().collect();
        let plan = find_plan(settings, &mut items, &mut warnings, &meter)?;
        let mut atlas = assemble(scene, &items, &plan);
        warnings.extend(measure::fit_warning(scene, settings, &items, &atlas));
        warnings.extend(measure::cap_warning(scene, settings, &items, &plan));
        atlas.warnings = warnings;
        let crowded = measure::crowded_items(scene, &items, &atlas);
        if crowded.is_empty() {
            return Ok(atlas);
        }
        for item in crowded {
            let mesh = scene.instances[items[item].instances[0].index].mesh;
            items[item].form = MeshLayout::Charts(unwrap_mesh(scene, mesh, &drawn[mesh], &zones, &meter)?);
        }
    }
}

fn check(settings: &AtlasSettings) -> Result<(), AtlasError> {
    let bad = |name, value: String, requirement| Err(AtlasError::BadSetting { name, value, requirement });
    if !(16..=16384).contains(&settings.page_size_texels) {
        return bad("the page size", settings.page_size_texels.to_string(), "from 16 to 16384 texels");
    }
    if !(1..=settings.page_size_texels / 8).contains(&settings.padding_texels) {
        return bad("the padding", settings.padding_texels.to_string(), "from 1 texel to an eighth of the page");
    }
    match settings.density {
        Density::TexelsPerMetre(d) if !(d.is_finite() && d > 0.0) => {
            bad("the density", d.to_string(), "above 0 texels a metre")
        }
        Density::Pages(n) if !(1..=MOST_PAGES).contains(&n) => {
            bad("the number of pages", n.to_string(), "from 1 to 256")
        }
        _ => Ok(()),
    }
}

/// For each mesh, the instances that get texels.
fn drawn_instances(scene: &Scene) -> Vec<Vec<AtlasInstance>> {
    let scale = |&index: &usize| {
        let instance = &scene.instances[index];
        let mesh = &scene.meshes[instance.mesh];
        let cross = |t: &[u32], f: &dyn Fn(usize) -> glam::DVec3| {
            let [a, b, c] = [0, 1, 2].map(|k| f(t[k] as usize));
            (b - a).cross(c - a).length()
        };
        let object = |v: usize| mesh.positions[v].as_dvec3();
        let bake = |v: usize| instance.bake_from_object.transform_vector3(object(v));
        let sum = |f: &dyn Fn(usize) -> glam::DVec3| mesh.indices.chunks_exact(3).map(|t| cross(t, f)).sum::<f64>();
        let ratio = (sum(&bake) / sum(&object)).sqrt();
        if ratio.is_finite() && ratio > 0.0 {
            ratio
        } else {
            instance.bake_from_object.determinant().abs().cbrt().max(1e-30)
        }
    };
    let solid: Vec<usize> = (0..scene.instances.len())
        .filter(|&i| scene.receives(i) && scene.meshes[scene.instances[i].mesh].triangle_count() > 0)
        .collect();
    let scales: Vec<f64> = solid.par_iter().map(scale).collect();
    let mut drawn = vec![Vec::new(); scene.meshes.len()];
    for (index, metres_per_unit) in solid.into_iter().zip(scales) {
        let instance = &scene.instances[index];
        let own_density = instance.role.texels_per_metre;
        drawn[instance.mesh].push(AtlasInstance { index, metres_per_unit, own_density });
    }
    drawn
}

/// All meshes that get texels: with the file's own layout if it can be used, else unwrapped into charts.
fn make_meshes(
    scene: &Scene,
    settings: &AtlasSettings,
    drawn: &[Vec<AtlasInstance>],
    zones: &Zones,
    meter: &ProgressMeter,
) -> Result<Vec<AtlasMesh>, AtlasError> {
    let meshes: Vec<usize> = (0..drawn.len()).filter(|&m| !drawn[m].is_empty()).collect();
    let total: usize = meshes.iter().map(|&m| scene.meshes[m].triangle_count()).sum();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let item = |&mesh: &usize| {
        let given = settings.keeps_existing.then(|| existing::check_own_rectangle(&scene.meshes[mesh]).ok()).flatten();
        let form = match given {
            Some(given) => MeshLayout::FileLayout(given),
            None => MeshLayout::Charts(unwrap_mesh(scene, mesh, &drawn[mesh], zones, meter)?),
        };
        let count = scene.meshes[mesh].triangle_count();
        let done = done.fetch_add(count, std::sync::atomic::Ordering::Relaxed) + count;
        meter.reach(UNWRAP_SHARE * done as f64 / total as f64);
        Ok(AtlasMesh { form, instances: drawn[mesh].clone(), share: 1.0 })
    };
    meshes.par_iter().map(item).collect()
}

/// A mesh that one node draws is unwrapped with the zones that it lies in.
fn unwrap_mesh(
    scene: &Scene,
    mesh: usize,
    drawn: &[AtlasInstance],
    zones: &Zones,
    meter: &ProgressMeter,
) -> Result<Charts, AtlasError> {
    let keep_going = || meter.reach(0.0);
    let densities = match drawn {
        [one] if !zones.is_empty() => zones.densities(scene, one.index),
        _ => Vec::new(),
    };
    let charts = match densities.iter().any(Option::is_some) {
        true => unwrap::unwrap_apart(&scene.meshes[mesh], &densities, &keep_going),
        false => unwrap::unwrap(&scene.meshes[mesh], &keep_going),
    };
    charts.ok_or(AtlasError::Cancelled)
}

/// Turns a plan into the atlas.
fn assemble(scene: &Scene, items: &[AtlasMesh], plan: &AtlasPlan) -> Atlas {
    let mut placements = vec![Placement::EMPTY; scene.instances.len()];
    plan.write_placements(items, &mut placements);
    let mut layouts: Vec<Option<Layout>> = vec![None; scene.meshes.len()];
    for (item, uvs) in items.iter().zip(plan.layout_uvs(items)) {
        let mesh = scene.instances[item.instances[0].index].mesh;
        layouts[mesh] = Some(match &item.form {
            MeshLayout::FileLayout(_) => Layout::of_file(&scene.meshes[mesh], FILE_SET),
            MeshLayout::Charts(charts) => Layout {
                origin: LayoutOrigin::Unwrapped,
                vertices: charts.vertices.clone(),
                uvs,
                indices: charts.indices.clone(),
            },
        });
    }
    let layouts = layouts
        .into_iter()
        .enumerate()
        .map(|(mesh, l)| l.unwrap_or_else(|| Layout::of_mesh(&scene.meshes[mesh])))
        .collect();
    let mut atlas = Atlas {
        pages: plan.page_sizes(),
        layouts,
        placements,
        texels_per_metre: 0.0,
        chart_count: items.iter().map(AtlasMesh::chart_count).sum(),
        warnings: Vec::new(),
    };
    atlas.texels_per_metre = measure::Extent::sum(measure::extents(scene, &atlas)).texels_per_metre();
    atlas
}
