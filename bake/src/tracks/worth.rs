//! What tracks are worth, part by part.

use super::foretell::foretold_gain;
use super::link::Linked;
use super::page::{PageShade, places};
use super::times::between;
use super::{FoundSpan, FoundSpans, MOST_PAGE_SPANS, MOST_SPANS, PageTracks, parts};
use crate::atlas::Around;
use crate::settings::TrackChoice;
use rayon::prelude::*;
use smallvec::SmallVec;

/// Mean visibility by which a span must make its occluder's shade better foretold than blending does.
const LEAST_GAIN: f32 = 1e-4;

/// What the tracks of each part of each texel are worth.
pub(super) struct Worth {
    /// For each texel with tracks, where its parts begin; one more at the end.
    first: Vec<u32>,
    /// For each part, in the order of the texel's spans, the mean visibility that a span of it gains.
    of_part: Vec<f32>,
}

impl Worth {
    pub fn new(shade: &PageShade, linked: &Linked, texels: &[u32], found: &FoundSpans) -> Self {
        let place = places(texels, linked.source.len());
        let mut first = vec![0];
        for index in 0..texels.len() {
            first.push(first[index] + parts(found.of_texel(index)).count() as u32);
        }
        let of_texel = |(index, &texel): (usize, &u32)| {
            let near = linked.neighbours(texel as usize).map(|pair| pair.map(&place));
            let pairs: SmallVec<[[&[FoundSpan]; 2]; 2]> =
                near.filter_map(|[before, after]| Some([found.of_texel(before?), found.of_texel(after?)])).collect();
            let gain = |own: &[FoundSpan]| {
                let gains = pairs.iter().map(|pair| foretold_gain(own, pair.map(|list| of_part(list, own[0].part))));
                gains.sum::<f64>() / (pairs.len().max(1) * own.len()) as f64
            };
            parts(found.of_texel(index)).map(|own| gain(own) as f32).collect::<SmallVec<[f32; 32]>>()
        };
        let own: Vec<f32> = texels.par_iter().with_min_len(64).enumerate().flat_map_iter(of_texel).collect();
        // Whether a part is kept must not change from texel to texel.
        let around = Around::new(shade.size, shade.walls);
        let mean = |(index, &texel): (usize, &u32)| {
            let near: SmallVec<[usize; 8]> = around.texels(texel as usize).filter_map(&place).collect();
            let of_part = |(own_place, spans): (usize, &[FoundSpan])| {
                let part = spans[0].part;
                let (mut sum, mut count) = (own[first[index] as usize + own_place], 1.0);
                for &other in &near {
                    if let Some(at) = parts(found.of_texel(other)).position(|spans| spans[0].part == part) {
                        (sum, count) = (sum + own[first[other] as usize + at], count + 1.0);
                    }
                }
                sum / count
            };
            parts(found.of_texel(index)).enumerate().map(of_part).collect::<SmallVec<[f32; 32]>>()
        };
        let of_part = texels.par_iter().with_min_len(64).enumerate().flat_map_iter(mean).collect();
        Self { first, of_part }
    }

    pub fn of_texel(&self, index: usize) -> &[f32] {
        &self.of_part[self.first[index] as usize..self.first[index + 1] as usize]
    }

    /// What a span must be worth to be kept, so that all of them have room.
    pub fn least(&self, shade: &PageShade, found: &FoundSpans) -> f32 {
        let least = match shade.choice {
            TrackChoice::Auto => LEAST_GAIN,
            TrackChoice::On => f32::NEG_INFINITY,
            TrackChoice::Off => f32::INFINITY,
        };
        // Merged shade has its bytes already; what is left for tracks is counted as if they came on top.
        let texels = shade.source.len();
        let most = shade.most_merged.min(MOST_SPANS);
        let merged = |texel: usize| dark_count(shade.lit.of_texel(texel)).min(most) as u64;
        let has_room = |spans: u64| {
            spans < MOST_PAGE_SPANS as u64 && PageTracks::bytes_of(texels as u64, spans) <= shade.most_bytes
        };
        let is_own_source = |texel: &usize| shade.source[*texel] as usize == *texel;
        let mut spans: u64 = (0..texels).into_par_iter().filter(is_own_source).map(merged).sum();
        let counts = (0..self.first.len() - 1).flat_map(|index| parts(found.of_texel(index)).map(<[_]>::len));
        let mut wanted: Vec<(f32, usize)> = self.of_part.iter().copied().zip(counts).collect();
        wanted.retain(|(worth, _)| *worth > least);
        wanted.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        for (worth, count) in wanted {
            spans += count as u64;
            if !has_room(spans) {
                return worth;
            }
        }
        least
    }
}

/// The spans of one part; none where the texel has none.
fn of_part(spans: &[FoundSpan], part: u32) -> &[FoundSpan] {
    let first = spans.partition_point(|span| span.part < part);
    let count = spans[first..].partition_point(|span| span.part == part);
    &spans[first..first + count]
}

/// How many spans of merged shade a texel has.
fn dark_count(lit: &[FoundSpan]) -> usize {
    between(lit.iter().map(FoundSpan::times)).len()
}
