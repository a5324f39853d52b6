//! The atlas of a bake, within the memory that it may take.

use super::error::{BakeError, in_names, smaller};
use super::memory::{BYTES_PER_SAMPLE, bytes_needed};
use crate::atlas::{self, Atlas, AtlasError, AtlasSettings, Misfit};
use crate::progress::{BakeStep, Progress};
use crate::remedy::Setting;
use crate::scene::Scene;
use crate::settings::BakeSettings;
use crate::warning::Warning;

/// Unwraps as asked or, where a mesh does not fit a page, with less padding or on larger pages. Gives the settings that
/// were used.
pub(crate) fn fitting_atlas(
    scene: &Scene,
    asked: &BakeSettings,
    warnings: &mut Vec<Warning>,
    progress: &dyn Progress,
) -> Result<(Atlas, BakeSettings), BakeError> {
    let mut settings = asked.clone();
    let mut first_misfit = None;
    loop {
        let misfit = match unwrap(scene, &settings, progress) {
            Ok(atlas) => {
                warnings.extend(first_misfit.map(|misfit| changed_settings(&settings, asked, misfit, scene)));
                return Ok((atlas, settings));
            }
            Err(AtlasError::PageTooSmall { misfit, .. }) => *first_misfit.get_or_insert(misfit),
            Err(error) => return Err(BakeError::of_atlas(error, scene)),
        };
        if settings.padding_texels > 1 {
            settings.padding_texels = 1;
        } else {
            settings.padding_texels = asked.padding_texels;
            settings.page_size_texels *= 2;
        }
        let is_possible = settings.page_size_texels <= LARGEST_PAGE_TEXELS;
        if !is_possible || check_memory(scene, &settings, settings.page_size_texels).is_err() {
            let (padding, page_size) = (asked.padding_texels, asked.page_size_texels);
            return Err(BakeError::of_atlas(AtlasError::PageTooSmall { misfit, padding, page_size }, scene));
        }
    }
}

/// Largest page that is tried.
const LARGEST_PAGE_TEXELS: u32 = 16_384;

/// A warning about settings that could not be kept.
fn changed_settings(settings: &BakeSettings, asked: &BakeSettings, misfit: Misfit, scene: &Scene) -> Warning {
    let (asked_texels, used_texels) = (asked.page_size_texels, settings.page_size_texels);
    let smaller = smaller(misfit, scene);
    let misfit = in_names(misfit, scene);
    if asked_texels != used_texels {
        return Warning::PageEnlarged { misfit, smaller, asked_texels, used_texels };
    }
    Warning::PaddingReduced {
        misfit,
        page_size_texels: asked_texels,
        asked_texels: asked.padding_texels,
        used_texels: settings.padding_texels,
    }
}

fn unwrap(scene: &Scene, settings: &BakeSettings, progress: &dyn Progress) -> Result<Atlas, AtlasError> {
    progress.start(BakeStep::Unwrap, 1000);
    let reported = std::sync::atomic::AtomicU64::new(0);
    let atlas_settings = AtlasSettings {
        density: settings.density,
        page_size_texels: settings.page_size_texels,
        padding_texels: settings.padding_texels,
        most_texels: settings.max_memory_bytes / BYTES_PER_SAMPLE,
        ..AtlasSettings::default()
    };
    atlas::build(scene, &atlas_settings, &|share| {
        let now = (share * 1000.0) as u64;
        let before = reported.fetch_max(now, std::sync::atomic::Ordering::Relaxed);
        progress.advance(now.saturating_sub(before));
        !progress.is_cancelled()
    })
}

/// Refuses pages of a size whose bake would need more memory than allowed.
pub(super) fn check_memory(scene: &Scene, settings: &BakeSettings, page_size_texels: u32) -> Result<(), BakeError> {
    let needed = bytes_needed(scene, settings, page_size_texels);
    if needed <= settings.max_memory_bytes {
        return Ok(());
    }
    Err(BakeError::Memory {
        what: match settings.lane_count {
            1 => format!("a page of {page_size_texels} x {page_size_texels} texels"),
            lanes => format!("a page of {page_size_texels} x {page_size_texels} texels in {lanes} lanes"),
        } + if settings.lamp.is_some() { " with a lamp" } else { "" },
        smaller: match (settings.lane_count, settings.ambient.map_or(1, |request| request.supersample)) {
            (2.., _) => vec![Setting::PageSize, Setting::Lanes],
            (_, 2..) => vec![Setting::PageSize, Setting::AoSupersample],
            _ => vec![Setting::PageSize],
        },
        needed_mib: needed >> 20,
        allowed_mib: settings.max_memory_bytes >> 20,
    })
}
