//! Making an atlas: judge what the file brings, unwrap the rest, find the density, place everything.

use super::arrange::{Arrangement, Form, Item, Plan};
use super::existing::{self, CROWDED_SHARE};
use super::unwrap::{self, Charts};
use super::{Atlas, AtlasSettings, Density, Layout, LayoutOrigin, PageSize, Placement};
use crate::scene::{Alpha, Scene};
use glam::{DVec2, Vec2};
use rayon::prelude::*;
use std::sync::Mutex;
use thiserror::Error;

/// Share of the progress that unwrapping takes.
const UNWRAP_SHARE: f64 = 0.7;
/// How near to the best density the search comes.
const DENSITY_TOLERANCE: f64 = 1.004;
/// Most pages an atlas may have.
const MOST_PAGES: u32 = 256;
/// Least share of the asked density that a mesh too large for a page may get.
const LEAST_SHARE: f64 = 1e-4;

/// Why there is no atlas.
#[derive(Debug, Error, PartialEq)]
pub enum AtlasError {
    /// Page size, padding, density or page count out of range.
    #[error("{name} is {value}, but must be {requirement}")]
    BadSetting {
        /// Which.
        name: &'static str,
        /// What was given.
        value: String,
        /// What would be accepted.
        requirement: &'static str,
    },
    /// The density asked for needs too many texels.
    #[error(
        "{density_per_metre} texels a metre make about {texels} texels, but at most {most} are allowed: lower the density"
    )]
    TooDense {
        /// Asked for.
        density_per_metre: f64,
        /// About what it needs.
        texels: u64,
        /// The limit.
        most: u64,
    },
    /// Charts do not fit at any density.
    #[error(
        "{charts} charts with {padding} texels around each do not fit a page of {page_size} texels at any density: use larger pages"
    )]
    PageTooSmall {
        /// How many charts there are.
        charts: usize,
        /// Around each.
        padding: u32,
        /// Side of a page.
        page_size: u32,
    },
    /// The progress callback returned false.
    #[error("cancelled")]
    Cancelled,
}

/// Reports progress, and remembers that it was told to stop.
struct Meter<'a> {
    callback: &'a (dyn Fn(f64) -> bool + Sync),
    /// Furthest reported, and whether to go on.
    state: Mutex<(f64, bool)>,
}

impl Meter<'_> {
    /// Reports, never going backwards. False: stop.
    fn reach(&self, fraction: f64) -> bool {
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        state.0 = state.0.max(fraction);
        state.1 = state.1 && (self.callback)(state.0);
        state.1
    }
}

/// Gives every instance texels of its own. `progress` gets the share that is done and returns false to stop.
///
/// The same scene and settings give the same atlas at any number of threads. An empty scene gives an atlas without pages.
pub fn build(
    scene: &Scene,
    settings: &AtlasSettings,
    progress: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Atlas, AtlasError> {
    check(settings)?;
    let meter = Meter { callback: progress, state: Mutex::new((0.0, true)) };
    let drawn = drawn_instances(scene);
    if let Some(atlas) = shared_square(scene, settings, &drawn) {
        return Ok(atlas);
    }
    let mut items = make_items(scene, settings, &drawn, &meter)?;
    let mut warnings = Vec::new();
    loop {
        let plan = find_plan(scene, settings, &mut items, &mut warnings, &meter)?;
        let atlas = assemble(scene, &items, &plan, &warnings);
        let crowded = crowded_items(scene, &items, &atlas);
        if crowded.is_empty() {
            return Ok(atlas);
        }
        for item in crowded {
            let mesh = scene.instances[items[item].instances[0].0].mesh;
            items[item].form = Form::Charts(unwrap_mesh(scene, mesh, &meter)?);
        }
        warnings.clear();
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

/// For each mesh, the instances that get texels, each with metres a unit of object space (the root of the area ratio).
fn drawn_instances(scene: &Scene) -> Vec<Vec<(usize, f64)>> {
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
        .filter(|&i| {
            scene.material(i).alpha != Alpha::Air && scene.meshes[scene.instances[i].mesh].triangle_count() > 0
        })
        .collect();
    let scales: Vec<f64> = solid.par_iter().map(scale).collect();
    let mut drawn = vec![Vec::new(); scene.meshes.len()];
    for (index, scale) in solid.into_iter().zip(scales) {
        drawn[scene.instances[index].mesh].push((index, scale));
    }
    drawn
}

/// The atlas, if all meshes were laid out for light maps in one [0, 1] and that has room enough at this page size.
fn shared_square(scene: &Scene, settings: &AtlasSettings, drawn: &[Vec<(usize, f64)>]) -> Option<Atlas> {
    let meshes: Vec<usize> = (0..drawn.len()).filter(|&m| !drawn[m].is_empty()).collect();
    if !settings.keeps_existing || meshes.is_empty() || meshes.iter().any(|&m| drawn[m].len() > 1) {
        return None;
    }
    let given: Vec<_> = meshes.par_iter().map(|&m| existing::judge(&scene.meshes[m]).ok()).collect::<Option<_>>()?;
    if !existing::share_one_square(scene, &meshes) {
        return None;
    }
    let (metres2, uv2) = meshes.iter().zip(&given).fold((0.0, 0.0), |(metres2, uv2), (&m, g)| {
        (metres2 + (g.object_per_uv * drawn[m][0].1).powi(2) * g.uv_area, uv2 + g.uv_area)
    });
    let side = match settings.density {
        Density::Pages(_) => settings.page_size_texels,
        Density::TexelsPerMetre(d) => {
            (d * (metres2 / uv2).sqrt()).ceil().clamp(16.0, f64::from(settings.page_size_texels)) as u32
        }
    };
    let size = PageSize { width: side, height: side };
    let all: Vec<_> = meshes.iter().map(|&m| &scene.meshes[m]).collect();
    if existing::crowded_share(&all, size, |uv| uv * size.as_dvec2()) > CROWDED_SHARE {
        return None;
    }
    let whole = Placement { page: 0, scale: Vec2::ONE, offset: Vec2::ZERO };
    let mut placements = vec![Placement::EMPTY; scene.instances.len()];
    drawn.iter().flatten().for_each(|&(instance, _)| placements[instance] = whole);
    let layout = |m: usize| if drawn[m].is_empty() { Layout::empty(scene, m) } else { file_layout(scene, m) };
    let texels_per_metre = f64::from(side) * (uv2 / metres2).sqrt();
    let layouts = (0..scene.meshes.len()).map(layout).collect();
    let warnings = density_warning(settings, texels_per_metre).into_iter().collect();
    Some(Atlas { pages: vec![size], layouts, placements, texels_per_metre, chart_count: meshes.len(), warnings })
}

fn density_warning(settings: &AtlasSettings, reached: f64) -> Option<String> {
    let Density::TexelsPerMetre(asked) = settings.density else { return None };
    (reached < 0.99 * asked).then(|| {
        format!("TEXCOORD_1 fills one page, so the density is {reached:.3} texels a metre instead of {asked}: use larger pages")
    })
}

fn file_layout(scene: &Scene, mesh: usize) -> Layout {
    let mut layout = Layout::empty(scene, mesh);
    layout.origin = LayoutOrigin::File;
    if let Some(uvs) = &scene.meshes[mesh].texcoords[1] {
        layout.uvs.clone_from(uvs);
    }
    layout
}

/// Everything that gets texels: the file's own layouts where they serve, else charts.
fn make_items(
    scene: &Scene,
    settings: &AtlasSettings,
    drawn: &[Vec<(usize, f64)>],
    meter: &Meter,
) -> Result<Vec<Item>, AtlasError> {
    let meshes: Vec<usize> = (0..drawn.len()).filter(|&m| !drawn[m].is_empty()).collect();
    let total: usize = meshes.iter().map(|&m| scene.meshes[m].triangle_count()).sum();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let item = |&mesh: &usize| {
        let given = settings.keeps_existing.then(|| existing::judge_alone(&scene.meshes[mesh]).ok()).flatten();
        let form = match given {
            Some(given) => Form::Given(given),
            None => Form::Charts(unwrap_mesh(scene, mesh, meter)?),
        };
        let count = scene.meshes[mesh].triangle_count();
        let done = done.fetch_add(count, std::sync::atomic::Ordering::Relaxed) + count;
        meter.reach(UNWRAP_SHARE * done as f64 / total as f64);
        Ok(Item { form, instances: drawn[mesh].clone(), share: 1.0 })
    };
    meshes.par_iter().map(item).collect()
}

fn unwrap_mesh(scene: &Scene, mesh: usize, meter: &Meter) -> Result<Charts, AtlasError> {
    unwrap::unwrap(&scene.meshes[mesh], &|| meter.reach(0.0)).ok_or(AtlasError::Cancelled)
}

/// Finds the density, and places everything at it.
fn find_plan(
    scene: &Scene,
    settings: &AtlasSettings,
    items: &mut [Item],
    warnings: &mut Vec<String>,
    meter: &Meter,
) -> Result<Plan, AtlasError> {
    match settings.density {
        Density::TexelsPerMetre(density) => plan_at_density(scene, settings, density, items, warnings, meter),
        Density::Pages(pages) => plan_for_pages(settings, pages, items, warnings, meter),
    }
}

fn plan_at_density(
    scene: &Scene,
    settings: &AtlasSettings,
    density: f64,
    items: &mut [Item],
    warnings: &mut Vec<String>,
    meter: &Meter,
) -> Result<Plan, AtlasError> {
    let texels = (items.iter().map(Item::area_m2).sum::<f64>() * density * density) as u64;
    if texels > settings.most_texels {
        return Err(AtlasError::TooDense { density_per_metre: density, texels, most: settings.most_texels });
    }
    let mut shares = vec![1.0; items.len()];
    for (index, share) in shares.iter_mut().enumerate() {
        let arrangement = arrangement(settings, items);
        while !arrangement.fits_alone(index, density * *share) {
            *share *= 0.94;
            if *share < LEAST_SHARE || !meter.reach(UNWRAP_SHARE) {
                return Err(stopped_or_too_small(settings, items, meter));
            }
        }
        if *share < 1.0 {
            let name = scene.meshes[scene.instances[items[index].instances[0].0].mesh]
                .name
                .as_deref()
                .unwrap_or("without a name");
            let reached = density * *share;
            warnings.push(format!(
                "mesh {name} does not fit a page of {} texels: it gets {reached:.3} texels a metre",
                settings.page_size_texels
            ));
        }
    }
    items.iter_mut().zip(shares).for_each(|(item, share)| item.share = share);
    let plan = arrangement(settings, items).compactly(density, MOST_PAGES);
    plan.ok_or_else(|| stopped_or_too_small(settings, items, meter))
}

fn plan_for_pages(
    settings: &AtlasSettings,
    pages: u32,
    items: &[Item],
    warnings: &mut Vec<String>,
    meter: &Meter,
) -> Result<Plan, AtlasError> {
    let mut count = pages;
    loop {
        if let Some(plan) = densest(settings, count, items, meter) {
            if count > pages {
                warnings.push(format!(
                    "the charts take {count} pages of {} texels; a larger --size takes fewer",
                    settings.page_size_texels
                ));
            }
            return Ok(plan);
        }
        count *= 2;
        if count > MOST_PAGES || !meter.reach(UNWRAP_SHARE) {
            return Err(stopped_or_too_small(settings, items, meter));
        }
    }
}

/// The plan of highest density on this many pages. None if they fit at no density worth having.
fn densest(settings: &AtlasSettings, pages: u32, items: &[Item], meter: &Meter) -> Option<Plan> {
    let arrangement = arrangement(settings, items);
    let page = f64::from(settings.page_size_texels);
    let area_m2: f64 = items.iter().map(Item::area_m2).sum();
    let full = if area_m2 > 0.0 { (f64::from(pages) * page * page / area_m2).sqrt() } else { 1.0 };
    let mut high = full;
    let mut low = full * 0.75;
    let mut best = loop {
        if let Some(plan) = arrangement.at_density(low, pages) {
            break plan;
        }
        high = low;
        low *= 0.75;
        if low < full * 0.05 || !meter.reach(UNWRAP_SHARE) {
            return None;
        }
    };
    let mut step = 0;
    while high > low * DENSITY_TOLERANCE && meter.reach(1.0 - (1.0 - UNWRAP_SHARE) * 0.8f64.powi(step)) {
        let middle = (low * high).sqrt();
        match arrangement.at_density(middle, pages) {
            Some(plan) => (low, best) = (middle, plan),
            None => high = middle,
        }
        step += 1;
    }
    meter.reach(UNWRAP_SHARE).then_some(best)
}

fn arrangement<'a>(settings: &AtlasSettings, items: &'a [Item]) -> Arrangement<'a> {
    Arrangement { items, page_size_texels: settings.page_size_texels, padding_texels: settings.padding_texels }
}

fn stopped_or_too_small(settings: &AtlasSettings, items: &[Item], meter: &Meter) -> AtlasError {
    if !meter.reach(0.0) {
        return AtlasError::Cancelled;
    }
    let charts = items.iter().map(Item::chart_count).sum();
    AtlasError::PageTooSmall { charts, padding: settings.padding_texels, page_size: settings.page_size_texels }
}

/// The atlas of a plan.
fn assemble(scene: &Scene, items: &[Item], plan: &Plan, warnings: &[String]) -> Atlas {
    let mut placements = vec![Placement::EMPTY; scene.instances.len()];
    plan.write_placements(items, &mut placements);
    let mut layouts: Vec<Option<Layout>> = vec![None; scene.meshes.len()];
    for (item, uvs) in items.iter().zip(plan.layout_uvs(items)) {
        let mesh = scene.instances[item.instances[0].0].mesh;
        layouts[mesh] = Some(match &item.form {
            Form::Given(_) => file_layout(scene, mesh),
            Form::Charts(charts) => Layout {
                origin: LayoutOrigin::Unwrapped,
                vertices: charts.vertices.clone(),
                uvs,
                indices: charts.indices.clone(),
            },
        });
    }
    let layouts =
        layouts.into_iter().enumerate().map(|(mesh, l)| l.unwrap_or_else(|| Layout::empty(scene, mesh))).collect();
    let mut atlas = Atlas {
        pages: plan.page_sizes(),
        layouts,
        placements,
        texels_per_metre: 0.0,
        chart_count: items.iter().map(Item::chart_count).sum(),
        warnings: warnings.to_vec(),
    };
    let area_m2: f64 = items.iter().map(Item::area_m2).sum();
    atlas.texels_per_metre = if area_m2 > 0.0 { (covered_texels(scene, &atlas) / area_m2).sqrt() } else { 0.0 };
    atlas
}

/// Area of all triangles on all pages.
fn covered_texels(scene: &Scene, atlas: &Atlas) -> f64 {
    let of_instance = |(index, placement): (usize, &Placement)| {
        let layout = &atlas.layouts[scene.instances[index].mesh];
        let page = atlas.pages[placement.page as usize].as_dvec2();
        let triangles = layout.indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| layout.uvs[t[k] as usize].as_dvec2());
            (b - a).perp_dot(c - a).abs() * 0.5
        });
        let scale: DVec2 = placement.scale.as_dvec2() * page;
        triangles.sum::<f64>() * scale.x * scale.y
    };
    atlas.placements.iter().enumerate().filter(|(_, p)| !p.is_empty()).map(of_instance).sum()
}

/// Items with a layout of the file's whose islands lie too close together at the size they got.
fn crowded_items(scene: &Scene, items: &[Item], atlas: &Atlas) -> Vec<usize> {
    let is_crowded = |item: &Item| {
        let smallest = item.instances.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        let Some(&(instance, _)) = smallest.filter(|_| matches!(item.form, Form::Given(_))) else { return false };
        let size = atlas.pages[atlas.placements[instance].page as usize];
        let mesh = &scene.meshes[scene.instances[instance].mesh];
        existing::crowded_share(&[mesh], size, |uv| atlas.texel(instance, uv.as_vec2(), size)) > CROWDED_SHARE
    };
    (0..items.len()).filter(|&i| is_crowded(&items[i])).collect()
}
