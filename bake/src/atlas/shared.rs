//! A file whose meshes all share one light map: their `TEXCOORD_1` becomes the only page, unchanged.

use super::arrange::AtlasInstance;
use super::existing::{self, CROWDED_SHARE};
use super::{Atlas, AtlasSettings, Density, FILE_SET, Layout, PageSize, Placement};
use crate::scene::Scene;
use crate::warning::Warning;
use glam::Vec2;
use rayon::prelude::*;

/// The atlas, if the meshes' `TEXCOORD_1` share one [0, 1] without overlap and their islands are far enough apart at
/// this page size.
pub(super) fn shared_square(scene: &Scene, settings: &AtlasSettings, drawn: &[Vec<AtlasInstance>]) -> Option<Atlas> {
    let meshes: Vec<usize> = (0..drawn.len()).filter(|&m| !drawn[m].is_empty()).collect();
    let has_own_density = drawn.iter().flatten().any(|instance| instance.own_density.is_some());
    if !settings.keeps_existing || meshes.is_empty() || has_own_density || meshes.iter().any(|&m| drawn[m].len() > 1) {
        return None;
    }
    let given: Vec<_> =
        meshes.par_iter().map(|&m| existing::check_layout(&scene.meshes[m]).ok()).collect::<Option<_>>()?;
    if !existing::share_one_square(scene, &meshes) {
        return None;
    }
    let (metres2, uv2) = meshes.iter().zip(&given).fold((0.0, 0.0), |(metres2, uv2), (&m, g)| {
        (metres2 + (g.object_per_uv * drawn[m][0].metres_per_unit).powi(2) * g.uv_area, uv2 + g.uv_area)
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
    let whole_page = Placement { page: 0, scale: Vec2::ONE, offset: Vec2::ZERO };
    let mut placements = vec![Placement::EMPTY; scene.instances.len()];
    drawn.iter().flatten().for_each(|instance| placements[instance.index] = whole_page);
    let layout = |m: usize| {
        if drawn[m].is_empty() {
            Layout::of_mesh(&scene.meshes[m])
        } else {
            Layout::of_file(&scene.meshes[m], FILE_SET)
        }
    };
    let texels_per_metre = f64::from(side) * (uv2 / metres2).sqrt();
    let layouts = (0..scene.meshes.len()).map(layout).collect();
    let warnings = density_warning(settings, texels_per_metre).into_iter().collect();
    Some(Atlas { pages: vec![size], layouts, placements, texels_per_metre, chart_count: meshes.len(), warnings })
}

fn density_warning(settings: &AtlasSettings, reached: f64) -> Option<Warning> {
    let Density::TexelsPerMetre(asked) = settings.density else { return None };
    let warning = Warning::DensityGiven { asked_per_metre: asked, reached_per_metre: reached };
    (reached < 0.99 * asked).then_some(warning)
}
