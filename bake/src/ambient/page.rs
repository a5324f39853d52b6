//! A page of ambient light: one plane of numbers for each quantity, made from estimates. [`crate::maps`] encodes it.

use super::estimate::{Estimate, Estimates};
use super::fill_buried::BuriedTexels;
use super::{AmbientSettings, harmonics};
use crate::atlas::{GutterTexel, PageSamples, PageSize};

/// Ambient light of a page, as planes of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct AmbientPage {
    /// Width and height in texels; every plane has as many numbers as their product.
    pub size: PageSize,
    /// What fronts see.
    pub front: AmbientPlanes,
    /// What backs see, where some texel has two sides; single-sided texels hold their front's.
    pub back: Option<AmbientPlanes>,
}

/// One side of a page: planes of numbers in row order, one per quantity. Planes that were not asked for are absent.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AmbientPlanes {
    /// Ambient visibility, 0 to 1.
    pub visibility: Vec<f32>,
    /// Bent normals: x, y, z.
    pub bent: Vec<Vec<f32>>,
    /// Sky visibility: nine coefficients.
    pub sky: Vec<Vec<f32>>,
}

impl AmbientPlanes {
    fn new(texel_count: usize, settings: &AmbientSettings) -> Self {
        let planes = |is_wanted: bool, count: usize| vec![vec![0.0; texel_count]; if is_wanted { count } else { 0 }];
        Self {
            visibility: vec![0.0; texel_count],
            bent: planes(settings.wants_bent, 3),
            sky: planes(settings.wants_sky, harmonics::COUNT),
        }
    }

    fn set(&mut self, texel: usize, estimate: &Estimate) {
        self.visibility[texel] = estimate.visibility;
        self.bent.iter_mut().zip(estimate.bent.to_array()).for_each(|(plane, value)| plane[texel] = value);
        self.sky.iter_mut().zip(estimate.sky).for_each(|(plane, value)| plane[texel] = value);
    }

    fn copy(&mut self, texel: usize, source: usize) {
        self.planes_mut().for_each(|plane| plane[texel] = plane[source]);
    }

    /// Visibility, bent normals and sky coefficients, as far as they were asked for.
    pub fn planes_mut(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        std::iter::once(&mut self.visibility).chain(&mut self.bent).chain(&mut self.sky)
    }
}

impl AmbientPage {
    /// Lays out estimates, which are in the given order of samples, and fills buried texels, but not across `borders`,
    /// which are walls between charts ([`crate::atlas::find_walls`]).
    pub fn new(
        size: PageSize,
        samples: &PageSamples,
        order: &[u32],
        borders: Option<&[[u8; 2]]>,
        runs: &[Estimates],
        settings: &AmbientSettings,
    ) -> Self {
        let texel_count = size.texel_count();
        let mut front = AmbientPlanes::new(texel_count, settings);
        let texel_at = |place: usize| samples.samples[order[place] as usize].texel as usize;
        let mut buried_texels = BuriedTexels::new(size);
        let mut start = 0;
        for run in runs {
            for (k, (estimate, &is_buried)) in run.front.iter().zip(&run.buried).enumerate() {
                buried_texels.add(texel_at(start + k), is_buried);
                if !is_buried {
                    front.set(texel_at(start + k), estimate);
                }
            }
            start += run.front.len();
        }
        let mut back = runs.iter().any(|run| !run.back.is_empty()).then(|| front.clone());
        if let Some(back) = &mut back {
            let mut start = 0;
            for run in runs {
                for (k, estimate) in run.back.iter().filter(|(k, _)| !run.buried[*k as usize]) {
                    back.set(texel_at(start + *k as usize), estimate);
                }
                start += run.front.len();
            }
        }
        for side in std::iter::once(&mut front).chain(&mut back) {
            for (texel, source) in buried_texels.sources(&side.visibility, borders) {
                side.copy(texel, source);
            }
        }
        Self { size, front, back }
    }

    /// Gives texels around charts the values of their sources.
    pub fn fill(&mut self, gutter: &[GutterTexel], samples: &PageSamples) {
        for side in self.sides_mut() {
            for copy in gutter {
                side.copy(copy.texel as usize, samples.samples[copy.sample as usize].texel as usize);
            }
        }
    }

    /// Both sides, or the one.
    pub fn sides_mut(&mut self) -> impl Iterator<Item = &mut AmbientPlanes> {
        std::iter::once(&mut self.front).chain(&mut self.back)
    }
}
