//! The atlas of a bake, within the memory that it may take.

use super::BakeError;
use crate::ambient::Estimate;
use crate::atlas::{self, Atlas, AtlasError, AtlasSettings, Sample};
use crate::progress::{BakeStage, Progress};
use crate::remedy::Setting;
use crate::scene::Scene;
use crate::settings::{AmbientRequest, BakeSettings};
use crate::warning::Warning;

/// Unwraps as asked, or, where a mesh has too many charts for a page, with less around each, or on larger pages. Gives the
/// settings that it came to.
pub(crate) fn unwrap_somehow(
    scene: &Scene,
    asked: &BakeSettings,
    warnings: &mut Vec<Warning>,
    progress: &dyn Progress,
) -> Result<(Atlas, BakeSettings), BakeError> {
    let mut settings = asked.clone();
    loop {
        let error = match unwrap(scene, &settings, progress) {
            Ok(atlas) => {
                if settings != *asked {
                    warnings.push(settled_for(&settings, asked));
                }
                return Ok((atlas, settings));
            }
            Err(error @ AtlasError::PageTooSmall { .. }) => error,
            Err(error) => return Err(error.into()),
        };
        if settings.padding_texels > 1 {
            settings.padding_texels = 1;
        } else {
            settings.padding_texels = asked.padding_texels;
            settings.page_size_texels *= 2;
        }
        let is_possible = settings.page_size_texels <= LARGEST_PAGE_TEXELS;
        if !is_possible || check_memory(scene, &settings, settings.page_size_texels).is_err() {
            return Err(error.into());
        }
    }
}

/// Largest page that is tried.
const LARGEST_PAGE_TEXELS: u32 = 16_384;

/// What was asked for and could not be had.
fn settled_for(settings: &BakeSettings, asked: &BakeSettings) -> Warning {
    let (asked_texels, used_texels) = (asked.page_size_texels, settings.page_size_texels);
    if asked_texels != used_texels {
        return Warning::PageEnlarged { asked_texels, used_texels };
    }
    Warning::PaddingReduced {
        page_size_texels: asked_texels,
        asked_texels: asked.padding_texels,
        used_texels: settings.padding_texels,
    }
}

fn unwrap(scene: &Scene, settings: &BakeSettings, progress: &dyn Progress) -> Result<Atlas, AtlasError> {
    progress.start(BakeStage::Unwrap, 1000);
    let told = std::sync::atomic::AtomicU64::new(0);
    let atlas_settings = AtlasSettings {
        density: settings.density,
        page_size_texels: settings.page_size_texels,
        padding_texels: settings.padding_texels,
        most_texels: settings.max_memory_bytes / BYTES_PER_SAMPLE,
        ..AtlasSettings::default()
    };
    atlas::build(scene, &atlas_settings, &|share| {
        let now = (share * 1000.0) as u64;
        let before = told.fetch_max(now, std::sync::atomic::Ordering::Relaxed);
        progress.advance(now.saturating_sub(before));
        !progress.is_cancelled()
    })
}

/// Bytes a covered texel takes while its page is baked: its sample, its intervals (three, as a town has on average, and
/// the vectors around them) and its share of the loss tally.
pub(super) const BYTES_PER_SAMPLE: u64 = 100;
/// Bytes that each lane more than one adds to that: its intervals.
const BYTES_PER_LANE: u64 = 60;
/// Bytes that a texel of a loss map takes: its numbers, and their copies while they are written.
const BYTES_PER_LOST: u64 = 24;
/// Bytes that a triangle's corners take more while vertices are asked about the sky.
const BYTES_PER_CORNERS: u64 = 300;
/// Bytes a triangle takes: corners in bake space and in the hierarchy, its box, nodes while building, layout and writing.
const BYTES_PER_TRIANGLE: u64 = 600;

/// Bytes a texel takes while ambient light is baked: for each side an estimate, and its numbers as floats, as codes, and as
/// bytes on their way to a file; and the points that its rays are spread on.
fn ambient_bytes(scene: &Scene, request: &AmbientRequest) -> u64 {
    let has_backs = (0..scene.instances.len()).any(|instance| scene.material(instance).is_double_sided);
    let sides = if has_backs { 2 } else { 1 };
    let estimate = &request.estimate;
    let numbers = 1 + if estimate.wants_bent { 3 } else { 0 } + if estimate.wants_sky { 9 } else { 0 };
    let points = if request.supersample > 1 { 2 * u64::from(request.supersample).pow(2) } else { 0 };
    sides * (size_of::<Estimate>() as u64 + 8 * numbers) + points * size_of::<Sample>() as u64
}

/// Refuses pages of a size whose bake would need more memory than allowed.
pub(super) fn check_memory(scene: &Scene, settings: &BakeSettings, page_size_texels: u32) -> Result<(), BakeError> {
    let texels = u64::from(page_size_texels).pow(2);
    // A lamp beside the sun is one lane more; one instead of the sun takes its place.
    let lamps = u64::from(settings.lamp.is_some());
    let lanes = settings.lane_count as u64 + lamps;
    // Codes are held twice while they are written; two layers are what a scene usually needs.
    let layers = if settings.bakes_intervals { settings.layer_cap.min(2) as u64 } else { 0 };
    let codes = texels * 16 * layers * 2 * lanes;
    let at_vertices = settings.ambient.is_some_and(|request| request.vertices.is_some());
    let a_triangle = BYTES_PER_TRIANGLE + if at_vertices { BYTES_PER_CORNERS } else { 0 };
    let triangles = scene.triangle_count() as u64 * a_triangle;
    let a_sample = if settings.bakes_intervals { BYTES_PER_SAMPLE } else { size_of::<Sample>() as u64 + 4 };
    let loss_map = if settings.loss_map { BYTES_PER_LOST } else { 0 };
    let ambient = settings.ambient.as_ref().map_or(0, |request| ambient_bytes(scene, request));
    let needed = codes + texels * (a_sample + BYTES_PER_LANE * (lanes - 1) + loss_map + ambient) + triangles;
    if needed <= settings.max_memory_bytes {
        return Ok(());
    }
    Err(BakeError::Memory {
        what: match settings.lane_count {
            1 => format!("a page of {page_size_texels} x {page_size_texels} texels"),
            lanes => format!("a page of {page_size_texels} x {page_size_texels} texels in {lanes} lanes"),
        } + if lamps > 0 { " with a lamp" } else { "" },
        smaller: match (settings.lane_count, settings.ambient.map_or(1, |request| request.supersample)) {
            (2.., _) => vec![Setting::PageSize, Setting::Lanes],
            (_, 2..) => vec![Setting::PageSize, Setting::AoSupersample],
            _ => vec![Setting::PageSize],
        },
        needed_mib: needed >> 20,
        allowed_mib: settings.max_memory_bytes >> 20,
    })
}
