//! The tracks of a page.
//!
//! Texels may have tracks where the sharp filter errs: where what it shows in the middle between two neighbours is not
//! what the texel there sees, for more than [`MOST_ERROR`] of the path. That is known without a ray, and wide shadows,
//! which the filter draws well, need no search.
//!
//! Of such a texel not every occluder has a track. The shade of a picket moves smoothly, that of a leaf comes and goes.
//! So each part's shade is foretold from the neighbours, by blending its times and by blending what they see; parts
//! for which the times are no better, around the texel as a whole, are left to merged shade, and so are the cheapest
//! losses where a texel has more spans than are stored, or the page more than it has bytes for. Merged shade is what
//! is dark and no kept span hides, and a little more beside these. Triangles with alpha masks are always left to it.
//! At last the texel as a whole is foretold from its neighbours' lists and by the sharp filter; where these are no
//! better, around it as a whole, it has no tracks after all.
//!
//! Where occluders abut, one texel may be dark for one of them and the next for the other, and each of the two tracks
//! ends before a point between. That would be light in deep shade. So a texel that is dark for long together with all
//! texels around it says so in a span of its own ([`DEEP`]): the times of four such spans are dark for all four texels,
//! and so are times between them.

use super::foretell::{Halves, between_texels, difference, foretold_error};
use super::link::Linked;
use super::times::{between, both, union};
use super::worth::Worth;
use super::{
    DEEP, FoundSpan, FoundSpans, MERGED, MOST_SPANS, PageTracks, SpanSearch, TrackCounts, find_spans, number_tracks,
    parts,
};
use crate::atlas::{Around, PageSize, SurfacePoint, is_open};
use crate::maps::{Bits, SHARP_REACH};
use crate::progress::Progress;
use crate::settings::TrackChoice;
use crate::visibility::{Intervals, OccluderFinder, OccluderSession};
use rayon::prelude::*;
use smallvec::SmallVec;

/// Share of the path for which the sharp filter may show light for shade, or shade for light, without tracks.
const MOST_ERROR: f64 = 0.02;
/// Sun's widths by which merged shade reaches under the spans beside it, so that between texels no light shines where
/// these end a little sooner.
const OVERLAP: f64 = 2.0;
/// Spans that a texel keeps for what is merged, if it needs as many.
const LEAST_REST: usize = 8;
/// The place of a texel that is not among those with tracks.
const ABSENT: u32 = u32::MAX;
/// Mean visibility by which tracks must foretell texels better than the sharp filter.
const LEAST_TEXEL_GAIN: f64 = 0.003;
/// Sun's widths for which a texel and all around it must be dark together, for the shade to be deep.
const LEAST_DEPTH: f64 = 20.0;
/// Most spans of deep shade at a texel. A day's sun allows no more; a narrower light would.
const MOST_DEEP: usize = 16;
/// Share of the sun's width below which spans are too short to be seen.
const LEAST_SPAN: f64 = 1.0 / 8.0;

/// What is known of a page before it has tracks.
pub struct PageShade<'a> {
    /// In texels.
    pub size: PageSize,
    /// For each texel, the one that it copies: itself, or, in a gutter, another.
    pub source: &'a [u32],
    /// For each texel that copies none, when it sees the sun: each interval as a span. Where nothing is, all the time.
    pub lit: &'a FoundSpans,
    /// Whether a texel's point is one that sees what it shows: not where it shows what its neighbours agree on.
    pub has_point: &'a (dyn Fn(u32) -> bool + Sync),
    /// The point of a texel that has one.
    pub point: &'a (dyn Fn(u32) -> SurfacePoint + Sync),
    /// The parts that hide the sun from a texel that has a point, if they are known.
    pub hiders: Option<&'a (dyn Fn(u32) -> Vec<u32> + Sync)>,
    /// What stands between texels.
    pub walls: Option<&'a [[u8; 2]]>,
    /// Width of the sun in path time.
    pub width_t: f64,
    /// Where tracks are wanted.
    pub choice: TrackChoice,
    /// Bytes on a GPU that the tracks of the page may take.
    pub most_bytes: u64,
    /// Most spans of merged shade at a texel without tracks: as many as the page's layers hold, since plain playback
    /// shows no more.
    pub most_merged: usize,
}

impl PageShade<'_> {
    /// When a texel sees the sun, in path time.
    fn lit_times(&self, texel: usize) -> Intervals {
        let time = |code: u16| Bits::Sixteen.decode(code);
        Intervals::from_unsorted(self.lit.of_texel(texel).iter().map(|span| span.times().map(time)).collect())
    }
}

/// Finds the tracks of a page: none where no texel has any. Where `progress` is cancelled, they are not all there.
pub fn page_tracks(
    finder: &OccluderFinder,
    shade: &PageShade,
    progress: &dyn Progress,
) -> (Option<PageTracks>, TrackCounts) {
    let is_way_open = |texel: usize, way: usize| shade.walls.is_none_or(|codes| is_open(codes[texel][way]));
    let linked = Linked { size: shade.size, source: shade.source, is_open: &is_way_open };
    let (all, counts) = kept_spans(finder, shade, &linked, progress);
    ((counts.texels > 0).then(|| number_tracks(&all, &linked)), counts)
}

/// The spans of all texels of a page.
fn kept_spans(
    finder: &OccluderFinder,
    shade: &PageShade,
    linked: &Linked,
    progress: &dyn Progress,
) -> (FoundSpans, TrackCounts) {
    let texels = texels_with_tracks(shade, linked);
    let least_t = LEAST_SPAN * shade.width_t;
    let hiders = |session: &mut OccluderSession, texel: u32, point: &SurfacePoint| match shade.hiders {
        Some(hiders) => (shade.lit_times(texel as usize), hiders(texel)),
        None => session.find(point),
    };
    let &PageShade { point, size, walls, .. } = shade;
    let found = find_spans(&SpanSearch { finder, point, hiders: &hiders, size, walls, least_t }, &texels, progress);
    let worth = Worth::new(shade, linked, &texels, &found);
    let kept = Kept { shade, texels: &texels, found: &found, worth: &worth, least: worth.least(shade, &found) };
    kept.with_merged(linked)
}

/// The spans that a page stores.
struct Kept<'a> {
    shade: &'a PageShade<'a>,
    /// Those that may have tracks, ascending.
    texels: &'a [u32],
    found: &'a FoundSpans,
    worth: &'a Worth,
    /// What a span must be worth.
    least: f32,
}

impl Kept<'_> {
    /// The spans of all texels: those of parts that are worth it, and merged shade of the others.
    fn with_merged(&self, linked: &Linked) -> (FoundSpans, TrackCounts) {
        let lists: Vec<Option<(Vec<FoundSpan>, bool)>> =
            (0..self.texels.len()).into_par_iter().with_min_len(64).map(|index| self.of_texel(index)).collect();
        let gains = self.gains_around(&self.gains(linked, &lists));
        let is_kept = |gain: f64| self.shade.choice == TrackChoice::On || gain > LEAST_TEXEL_GAIN;
        let mut counts = TrackCounts::default();
        let mut all = FoundSpans::default();
        let mut lists = self.texels.iter().zip(lists).zip(gains).peekable();
        for texel in 0..self.shade.source.len() {
            let own = lists.next_if(|((with, _), _)| **with as usize == texel);
            match own.filter(|(_, gain)| is_kept(*gain)).and_then(|((_, list), _)| list) {
                Some((list, is_crowded)) => {
                    counts.texels += 1;
                    counts.crowded_texels += u64::from(is_crowded);
                    all.push(list);
                }
                None => all.push(merged(self.shade.lit.of_texel(texel), self.shade.most_merged)),
            }
        }
        (all, counts)
    }

    /// For each texel, by how much it is foretold better by its neighbours' tracks than by the sharp filter: the
    /// difference of mean errors over the path. 0 without such neighbours.
    fn gains(&self, linked: &Linked, lists: &[Option<(Vec<FoundSpan>, bool)>]) -> Vec<f64> {
        let place = places(self.texels, linked.source.len());
        let reach_codes = reach_codes(self.shade);
        let lit = |texel: usize| self.shade.lit.of_texel(self.shade.source[texel] as usize);
        let list = |texel: usize| Some(lists[place(texel)?].as_ref()?.0.as_slice());
        let gain = |&texel: &u32| {
            let own = lit(texel as usize);
            let (mut sum, mut count) = (0.0, 0.0f64);
            for pair in linked.neighbours(texel as usize) {
                if let (Some(before), Some(after)) = (list(pair[0]), list(pair[1])) {
                    let sharp = difference(&between_texels(pair.map(lit), reach_codes), own);
                    let dark = between(own.iter().map(FoundSpan::times));
                    sum += f64::from(sharp) - foretold_error(&dark, &Halves::blended([before, after]));
                    count += f64::from(Bits::Sixteen.max_code());
                }
            }
            sum / count.max(1.0)
        };
        self.texels.par_iter().with_min_len(64).map(gain).collect()
    }

    /// For each texel, the mean gain of those around it and of its own: whether tracks are kept must not change from
    /// texel to texel.
    fn gains_around(&self, gains: &[f64]) -> Vec<f64> {
        let place = places(self.texels, self.shade.source.len());
        let around = Around::new(self.shade.size, self.shade.walls);
        let mean = |(index, &texel): (usize, &u32)| {
            let near = around.texels(texel as usize).filter_map(&place).chain([index]);
            let (sum, count) = near.fold((0.0, 0.0), |(sum, count), index| (sum + gains[index], count + 1.0));
            sum / count
        };
        self.texels.par_iter().enumerate().map(mean).collect()
    }

    /// The spans of a texel, and whether there are more than are stored; none where no part is worth its bytes.
    fn of_texel(&self, index: usize) -> Option<(Vec<FoundSpan>, bool)> {
        let worth = self.worth.of_texel(index);
        let mut wanted: Vec<(f32, &[FoundSpan])> =
            worth.iter().copied().zip(parts(self.found.of_texel(index))).collect();
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1[0].part.cmp(&b.1[0].part)));
        let worth_it = wanted.partition_point(|(worth, _)| *worth > self.least);
        if worth_it == 0 {
            return None;
        }
        let depth = deep_shade(self.shade, self.texels[index] as usize);
        // Parts are left out from the least worth on until there is room for the others and what is merged of them.
        let room = MOST_SPANS - depth.len();
        let mut kept_count = worth_it;
        let rest_beside = |kept_count: usize| {
            let kept = wanted[..kept_count].iter().flat_map(|(_, spans)| spans.iter());
            self.rest(self.texels[index] as usize, kept.chain(&depth))
        };
        let mut rest = rest_beside(kept_count);
        let spans = |parts: &[(f32, &[FoundSpan])]| parts.iter().map(|(_, spans)| spans.len()).sum::<usize>();
        while kept_count > 0 && spans(&wanted[..kept_count]) + rest.len().min(LEAST_REST) > room {
            kept_count -= 1;
            rest = rest_beside(kept_count);
        }
        if kept_count == 0 {
            return None;
        }
        let is_crowded = kept_count < worth_it || spans(&wanted[..kept_count]) + rest.len() > room;
        let mut list: Vec<FoundSpan> =
            wanted[..kept_count].iter().flat_map(|(_, spans)| spans.iter().copied()).collect();
        list.extend(fitted(&rest, room - list.len()));
        list.extend(depth);
        list.sort_by_key(|span| (span.part, span.start));
        Some((list, is_crowded))
    }

    /// When a texel is dark and none of its spans hides the sun, and a little more beside these.
    fn rest<'s>(&self, texel: usize, spans: impl Iterator<Item = &'s FoundSpan>) -> Vec<[u16; 2]> {
        let codes = |widths: f64| widths * self.shade.width_t * f64::from(Bits::Sixteen.max_code());
        let (least, overlap) = (codes(LEAST_SPAN), codes(OVERLAP) as u16);
        let dark = between(self.shade.lit.of_texel(texel).iter().map(FoundSpan::times));
        let clear = both(&dark, &between(union(spans.map(FoundSpan::times))));
        let is_seen = |[start, end]: &[u16; 2]| f64::from(end - start) >= least;
        // No further than the dark time that it is a part of.
        let more = |[start, end]: [u16; 2]| {
            let [first, last] = dark[dark.partition_point(|dark| dark[1] < end)];
            [start.saturating_sub(overlap).max(first), end.saturating_add(overlap).min(last)]
        };
        union(clear.into_iter().filter(is_seen).map(more))
    }
}

/// Tells the index of a texel among some of a page.
pub(super) fn places(texels: &[u32], texel_count: usize) -> impl Fn(usize) -> Option<usize> + Sync {
    let mut place = vec![ABSENT; texel_count];
    texels.iter().zip(0..).for_each(|(&texel, index)| place[texel as usize] = index);
    move |texel| Some(place[texel]).filter(|index| *index != ABSENT).map(|index| index as usize)
}

/// Codes beyond which the sharp filter sees no edge.
fn reach_codes(shade: &PageShade) -> i32 {
    (f64::from(SHARP_REACH) * shade.width_t * f64::from(Bits::Sixteen.max_code())) as i32
}

/// Texels, ascending, at which the sharp filter errs, and those around them, with which they share quads.
fn texels_with_tracks(shade: &PageShade, linked: &Linked) -> Vec<u32> {
    let around = Around::new(shade.size, shade.walls);
    let lit = |texel: usize| shade.lit.of_texel(shade.source[texel] as usize);
    let reach_codes = reach_codes(shade);
    let most_codes = MOST_ERROR * f64::from(Bits::Sixteen.max_code());
    let errs = |texel: usize| {
        if !(shade.has_point)(texel as u32) {
            return false;
        }
        let own = lit(texel);
        if around.texels(texel).all(|other| difference(lit(other), own) <= most_codes as u32) {
            return false;
        }
        let errors: SmallVec<[u32; 2]> =
            linked.neighbours(texel).map(|pair| difference(&between_texels(pair.map(lit), reach_codes), own)).collect();
        // At the border of a chart nothing foretells a texel.
        errors.is_empty() || f64::from(errors.iter().sum::<u32>()) > most_codes * errors.len() as f64
    };
    let errs: Vec<bool> = (0..shade.source.len()).into_par_iter().with_min_len(256).map(errs).collect();
    let is_near = |texel: &u32| {
        let texel = *texel as usize;
        (shade.has_point)(texel as u32) && (errs[texel] || around.texels(texel).any(|other| errs[other]))
    };
    (0..shade.source.len() as u32).into_par_iter().with_min_len(256).filter(is_near).collect()
}

/// When a texel and all around it are dark for long.
fn deep_shade(shade: &PageShade, texel: usize) -> Vec<FoundSpan> {
    let max_code = Bits::Sixteen.max_code();
    let least_codes = LEAST_DEPTH * shade.width_t * f64::from(max_code);
    let near = std::iter::once(texel).chain(Around::new(shade.size, shade.walls).texels(texel));
    let lit = near.flat_map(|texel| shade.lit.of_texel(shade.source[texel] as usize));
    let is_long = |[start, end]: &[u16; 2]| f64::from(end - start) >= least_codes;
    let dark = between(union(lit.map(FoundSpan::times))).into_iter().filter(is_long).take(MOST_DEEP);
    dark.map(|[start, end]| FoundSpan { part: DEEP, start, end }).collect()
}

/// The shade between a texel's lit intervals.
fn merged(lit: &[FoundSpan], most: usize) -> Vec<FoundSpan> {
    fitted(&between(lit.iter().map(FoundSpan::times)), most.min(MOST_SPANS))
}

/// Merged shade; of more spans than are stored, that which is wrong for the shortest time.
fn fitted(shade: &[[u16; 2]], most: usize) -> Vec<FoundSpan> {
    if shade.len() <= most {
        return shade.iter().map(|&[start, end]| FoundSpan { part: MERGED, start, end }).collect();
    }
    let time = |code: u16| Bits::Sixteen.decode(code);
    let shade = Intervals::from_unsorted(shade.iter().map(|span| span.map(time)).collect());
    let (shade, _) = crate::maps::fit_to_cap(&shade, most);
    shade.as_slice().iter().map(|&shade| FoundSpan::new(MERGED, shade)).collect()
}
