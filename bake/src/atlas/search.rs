//! Finds the density, or the number of pages.
//!
//! Practice: for a given number of pages, the density is found by bisection; for a given density, pages are added until
//! everything fits. Every guess packs again, which [`super::strip`] makes fast enough.

use super::arrange::{Arrangement, AtlasMesh, AtlasPlan};
use super::error::{AtlasError, Misfit};
use super::meter::{ProgressMeter, UNWRAP_SHARE};
use super::{AtlasSettings, Density};
use crate::warning::Warning;

/// The search stops when the density is known to this factor.
const DENSITY_TOLERANCE: f64 = 1.004;
/// Most pages an atlas may have.
pub(super) const MOST_PAGES: u32 = 256;
/// Least share of the requested density for a mesh that is too large for a page.
const LEAST_SHARE: f64 = 1e-4;

/// Finds the density, and places everything at it.
pub(super) fn find_plan(
    settings: &AtlasSettings,
    items: &mut [AtlasMesh],
    warnings: &mut Vec<Warning>,
    meter: &ProgressMeter,
) -> Result<AtlasPlan, AtlasError> {
    match settings.density {
        Density::TexelsPerMetre(density) => plan_at_density(settings, density, items, meter),
        Density::Pages(pages) => plan_for_pages(settings, pages, items, warnings, meter),
    }
}

fn plan_at_density(
    settings: &AtlasSettings,
    density: f64,
    items: &mut [AtlasMesh],
    meter: &ProgressMeter,
) -> Result<AtlasPlan, AtlasError> {
    check_texels(settings, density, items)?;
    let mut shares = vec![1.0; items.len()];
    for (index, share) in shares.iter_mut().enumerate() {
        let arrangement = arrangement(settings, items);
        while !arrangement.fits_alone(index, density, *share) {
            *share *= 0.94;
            if *share < LEAST_SHARE || !meter.reach(UNWRAP_SHARE) {
                return Err(cancelled_or_too_small(settings, items, meter));
            }
        }
    }
    items.iter_mut().zip(shares).for_each(|(item, share)| item.share = share);
    let plan = arrangement(settings, items).compactly(density, MOST_PAGES);
    plan.ok_or_else(|| cancelled_or_too_small(settings, items, meter))
}

/// Refuses more texels than are allowed, and says which mesh asks for most of them.
fn check_texels(settings: &AtlasSettings, texels_per_metre: f64, items: &[AtlasMesh]) -> Result<(), AtlasError> {
    let texels: f64 = items.iter().map(|item| item.texels(texels_per_metre)).sum();
    if texels as u64 <= settings.most_texels {
        return Ok(());
    }
    let each = items.iter().map(|item| (item.texels(texels_per_metre), item.most_asking(texels_per_metre)));
    let (most_asked, instance) = each.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    Err(AtlasError::TooDense {
        instance,
        of_instance: most_asked as u64,
        texels: texels as u64,
        most: settings.most_texels,
    })
}

fn plan_for_pages(
    settings: &AtlasSettings,
    pages: u32,
    items: &[AtlasMesh],
    warnings: &mut Vec<Warning>,
    meter: &ProgressMeter,
) -> Result<AtlasPlan, AtlasError> {
    check_texels(settings, 0.0, items)?;
    let mut count = pages;
    loop {
        if let Some((plan, density)) = densest(settings, count, items, meter) {
            if count == pages {
                return Ok(plan);
            }
            // One large mesh may have limited the density; the rest may fit on fewer pages.
            let plan = arrangement(settings, items).compactly(density, count).unwrap_or(plan);
            let page_size_texels = settings.page_size_texels;
            warnings.push(Warning::ManyPages { pages: plan.page_sizes().len(), page_size_texels });
            return Ok(plan);
        }
        count *= 2;
        if count > MOST_PAGES || !meter.reach(UNWRAP_SHARE) {
            return Err(cancelled_or_too_small(settings, items, meter));
        }
    }
}

/// The plan of highest density on this many pages, and that density in texels per metre. `None` if nothing fits even at
/// a twentieth of the ideal density.
fn densest(
    settings: &AtlasSettings,
    pages: u32,
    items: &[AtlasMesh],
    meter: &ProgressMeter,
) -> Option<(AtlasPlan, f64)> {
    let arrangement = arrangement(settings, items);
    let page = f64::from(settings.page_size_texels);
    let (area_m2, own_texels) =
        items.iter().map(AtlasMesh::area_and_own_texels).fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
    // What the objects leave that have a density of their own.
    let left_texels = f64::from(pages) * page * page - own_texels;
    if left_texels <= 0.0 {
        return None;
    }
    let full = if area_m2 > 0.0 { (left_texels / area_m2).sqrt() } else { 1.0 };
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
    meter.reach(UNWRAP_SHARE).then_some((best, low))
}

fn arrangement<'a>(settings: &AtlasSettings, items: &'a [AtlasMesh]) -> Arrangement<'a> {
    let AtlasSettings { page_size_texels, padding_texels, .. } = *settings;
    Arrangement { items, page_size_texels, padding_texels, share: 1.0 }
}

fn cancelled_or_too_small(settings: &AtlasSettings, items: &[AtlasMesh], meter: &ProgressMeter) -> AtlasError {
    if !meter.reach(0.0) {
        return AtlasError::Cancelled;
    }
    let (padding, page_size) = (settings.padding_texels, settings.page_size_texels);
    AtlasError::PageTooSmall { misfit: misfit(&arrangement(settings, items), items), padding, page_size }
}

/// What does not fit, although the scene's own density is next to nothing.
fn misfit(arrangement: &Arrangement, items: &[AtlasMesh]) -> Misfit {
    // Texels a metre: everything without a density of its own is as small as can be.
    const NEXT_TO_NOTHING: f64 = 1e-6;
    let fits = |item: usize, share: f64| arrangement.fits_alone(item, NEXT_TO_NOTHING, share);
    let charts = || items.iter().map(AtlasMesh::chart_count);
    match (0..items.len()).find(|&item| !fits(item, 1.0)) {
        None => Misfit::Pages { charts: charts().sum(), pages: MOST_PAGES },
        Some(item) if fits(item, LEAST_SHARE) => Misfit::Density { instance: items[item].most_asking(NEXT_TO_NOTHING) },
        Some(item) => Misfit::Charts { instance: items[item].instances[0].index, charts: items[item].chart_count() },
    }
}
