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

use super::link::{Linked, aligned, matches};
use super::{
    DEEP, FoundSpan, FoundSpans, MERGED, MOST_PAGE_SPANS, MOST_SPANS, PageTracks, TrackCounts, find_spans,
    number_tracks,
};
use crate::atlas::{Around, PageSize, SurfacePoint, is_open};
use crate::maps::{Bits, SHARP_REACH};
use crate::progress::Progress;
use crate::settings::TrackChoice;
use crate::visibility::{Intervals, OccluderFinder};
use rayon::prelude::*;
use smallvec::SmallVec;

/// Share of the path for which the sharp filter may show light for shade, or shade for light, without tracks.
const MOST_ERROR: f64 = 0.02;
/// Mean visibility by which a span must make its occluder's shade better foretold than blending does.
const LEAST_GAIN: f32 = 1e-4;
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
    /// What stands between texels.
    pub walls: Option<&'a [[u8; 2]]>,
    /// Width of the sun in path time.
    pub width_t: f64,
    /// Where tracks are wanted.
    pub choice: TrackChoice,
    /// Bytes on a GPU that the tracks of the page may take.
    pub most_bytes: u64,
}

/// Finds the tracks of a page: none where no texel has any. Where `progress` is cancelled, they are not all there.
pub fn page_tracks(
    finder: &OccluderFinder,
    shade: &PageShade,
    progress: &dyn Progress,
) -> (Option<PageTracks>, TrackCounts) {
    let is_way_open = |texel: usize, way: usize| shade.walls.is_none_or(|codes| is_open(codes[texel][way]));
    let linked = Linked { size: shade.size, source: shade.source, is_open: &is_way_open };
    let texels = texels_with_tracks(shade, &linked);
    let least_t = LEAST_SPAN * shade.width_t;
    let found = find_spans(finder, &texels, shade.point, shade.size, shade.walls, least_t, progress);
    let worth = Worth::new(shade, &linked, &texels, &found);
    let kept = Kept { shade, texels: &texels, found: &found, worth: &worth, least: worth.least(shade, &found) };
    let (all, counts) = kept.with_merged(&linked);
    ((counts.texels > 0).then(|| number_tracks(&all, &linked)), counts)
}

/// What the tracks of each part of each texel are worth.
struct Worth {
    /// For each texel with tracks, where its parts begin; one more at the end.
    first: Vec<u32>,
    /// For each part, in the order of the texel's spans, the mean visibility that a span of it gains.
    of_part: Vec<f32>,
}

impl Worth {
    fn new(shade: &PageShade, linked: &Linked, texels: &[u32], found: &FoundSpans) -> Self {
        let place = places(texels, linked.source.len());
        let mut first = vec![0];
        for index in 0..texels.len() {
            first.push(first[index] + parts(found.of_texel(index)).count() as u32);
        }
        let of_texel = |(index, &texel): (usize, &u32)| {
            let near = neighbours(linked, texel as usize).map(|pair| pair.map(&place));
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

    fn of_texel(&self, index: usize) -> &[f32] {
        &self.of_part[self.first[index] as usize..self.first[index + 1] as usize]
    }

    /// What a span must be worth to be kept, so that all of them have room.
    fn least(&self, shade: &PageShade, found: &FoundSpans) -> f32 {
        let least = match shade.choice {
            TrackChoice::Auto => LEAST_GAIN,
            TrackChoice::On => f32::NEG_INFINITY,
            TrackChoice::Off => f32::INFINITY,
        };
        // Merged shade has its bytes already; what is left for tracks is counted as if they came on top.
        let texels = shade.source.len();
        let merged = |texel: usize| merged_count(shade.lit.of_texel(shade.source[texel] as usize)) as u64;
        let has_room = |spans: u64| {
            spans < MOST_PAGE_SPANS as u64 && PageTracks::bytes_of(texels as u64, spans) <= shade.most_bytes
        };
        let mut spans: u64 = (0..texels).map(merged).sum();
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
                None => all.push(merged(self.shade.lit.of_texel(texel), MOST_SPANS)),
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
            for pair in neighbours(linked, texel as usize) {
                if let (Some(before), Some(after)) = (list(pair[0]), list(pair[1])) {
                    let sharp = difference(&between_texels(pair.map(lit), reach_codes), own);
                    sum += f64::from(sharp) - foretold_error(own, [before, after]);
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
        let hidden = union(spans);
        let codes = |widths: f64| widths * self.shade.width_t * f64::from(Bits::Sixteen.max_code());
        let (least, overlap) = (codes(LEAST_SPAN), codes(OVERLAP) as u16);
        let mut rest = Vec::new();
        for [start, end] in between(&union(self.shade.lit.of_texel(texel).iter())) {
            let inside = hidden.iter().filter(|span| span[1] > start && span[0] < end);
            let clear = between(&inside.copied().collect::<Vec<_>>()).collect::<Vec<_>>();
            for [from, to] in clear.into_iter().map(|span| [span[0].max(start), span[1].min(end)]) {
                if f64::from(to.saturating_sub(from)) >= least {
                    rest.push([from.saturating_sub(overlap).max(start), to.saturating_add(overlap).min(end)]);
                }
            }
        }
        joined(rest)
    }
}

/// Tells the index of a texel among some of a page.
fn places(texels: &[u32], texel_count: usize) -> impl Fn(usize) -> Option<usize> + Sync {
    let mut place = vec![ABSENT; texel_count];
    texels.iter().zip(0..).for_each(|(&texel, index)| place[texel as usize] = index);
    move |texel| Some(place[texel]).filter(|index| *index != ABSENT).map(|index| index as usize)
}

/// Codes beyond which the sharp filter sees no edge.
fn reach_codes(shade: &PageShade) -> i32 {
    (f64::from(SHARP_REACH) * shade.width_t * f64::from(Bits::Sixteen.max_code())) as i32
}

/// The codes for which a texel is foretold wrong by blending its neighbours' spans, for a sun without width. Given are
/// its lit intervals.
fn foretold_error(own: &[FoundSpan], [before, after]: [&[FoundSpan]; 2]) -> f64 {
    // At a code, how much two sums grow: whether the texel is lit, and half shades of the blended times.
    let mut steps: Vec<(u16, [i32; 2])> = vec![(Bits::Sixteen.max_code(), [0; 2])];
    let mut add = |start: u16, end: u16, step: [i32; 2]| {
        steps.push((start, step));
        steps.push((end, step.map(|by| -by)));
    };
    own.iter().for_each(|span| add(span.start, span.end, [1, 0]));
    let mut is_alone = [before, after].map(|spans| vec![true; spans.len()]);
    for [i, j] in matches(before, after) {
        let (a, b) = (before[i as usize], after[j as usize]);
        (is_alone[0][i as usize], is_alone[1][j as usize]) = (false, false);
        add(a.start.midpoint(b.start), a.end.midpoint(b.end), [0, 2]);
    }
    for (spans, is_alone) in [before, after].into_iter().zip(is_alone) {
        let alone = spans.iter().zip(is_alone).filter(|(_, is_alone)| *is_alone);
        alone.for_each(|(span, _)| add(span.start, span.end, [0, 1]));
    }
    steps.sort_unstable_by_key(|(code, _)| *code);
    let (mut at, mut sums, mut halves) = (0, [0i32; 2], 0i64);
    for (code, step) in steps {
        halves += i64::from((2 * sums[0] - (2 - sums[1]).max(0)).abs()) * i64::from(code - at);
        at = code;
        sums.iter_mut().zip(step).for_each(|(sum, by)| *sum += by);
    }
    0.5 * halves as f64
}

/// The spans of each part of a texel.
fn parts(spans: &[FoundSpan]) -> impl Iterator<Item = &[FoundSpan]> {
    spans.chunk_by(|a, b| a.part == b.part)
}

/// The spans of one part; none where the texel has none.
fn of_part(spans: &[FoundSpan], part: u32) -> &[FoundSpan] {
    let first = spans.partition_point(|span| span.part < part);
    let count = spans[first..].partition_point(|span| span.part == part);
    &spans[first..first + count]
}

/// Ascending, disjoint times in which any of these spans hides the sun.
fn union<'a>(spans: impl Iterator<Item = &'a FoundSpan>) -> Vec<[u16; 2]> {
    joined(spans.map(|span| [span.start, span.end]).collect())
}

/// The same of times.
fn joined(mut times: Vec<[u16; 2]>) -> Vec<[u16; 2]> {
    times.sort_unstable();
    let mut joined: Vec<[u16; 2]> = Vec::new();
    for span in times {
        match joined.last_mut().filter(|last| span[0] <= last[1]) {
            Some(last) => last[1] = last[1].max(span[1]),
            None => joined.push(span),
        }
    }
    joined
}

/// The texels left and right of a texel, and those above and below it, where the ways to both are open.
fn neighbours(linked: &Linked, texel: usize) -> impl Iterator<Item = [usize; 2]> {
    let (width, count) = (linked.size.width as usize, linked.source.len());
    let pair = |step: usize, way: usize| {
        let is_inside = step != 1 || (1..width - 1).contains(&(texel % width));
        let (before, after) = (texel.checked_sub(step)?, texel + step);
        let is_open = is_inside && after < count && (linked.is_open)(before, way) && (linked.is_open)(texel, way);
        is_open.then_some([before, after])
    };
    [pair(1, 0), pair(width, 1)].into_iter().flatten()
}

/// By how much the shade of a part at a texel is foretold better by blending its neighbours' times than by blending
/// what they see: the difference of mean errors over the path of a sun without width.
fn foretold_gain(own: &[FoundSpan], [before, after]: [&[FoundSpan]; 2]) -> f64 {
    // At a code, how much each of three sums grows: own shade, neighbours in shade, half shades of the blended times.
    let mut steps: SmallVec<[(u16, [i32; 3]); 16]> = SmallVec::new();
    let mut add = |start: u16, end: u16, sum: usize, by: i32| {
        let mut step = [0; 3];
        step[sum] = by;
        steps.push((start, step));
        steps.push((end, step.map(|by| -by)));
    };
    own.iter().for_each(|span| add(span.start, span.end, 0, 1));
    before.iter().chain(after).for_each(|span| add(span.start, span.end, 1, 1));
    let pairs = if before.is_empty() || after.is_empty() { SmallVec::new() } else { aligned(before, after) };
    for &[i, j] in &pairs {
        let (a, b) = (before[i as usize], after[j as usize]);
        add(a.start.midpoint(b.start), a.end.midpoint(b.end), 2, 2);
    }
    for (side, spans) in [before, after].into_iter().enumerate() {
        let alone = |(index, _): &(u32, &FoundSpan)| pairs.iter().all(|pair| pair[side] != *index);
        (0..).zip(spans).filter(alone).for_each(|(_, span)| add(span.start, span.end, 2, 1));
    }
    steps.sort_unstable_by_key(|(code, _)| *code);
    let (mut at, mut sums, mut halves) = (0, [0; 3], 0i64);
    for (code, step) in steps {
        let [hidden, hidden_beside, blended] = sums;
        let [plain, tracked] = [hidden_beside, blended.min(2)].map(|hides: i32| (hides - 2 * hidden).abs());
        halves += i64::from(plain - tracked) * i64::from(code - at);
        at = code;
        sums.iter_mut().zip(step).for_each(|(sum, by)| *sum += by);
    }
    0.5 * halves as f64 / f64::from(Bits::Sixteen.max_code())
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
        let errors: SmallVec<[u32; 2]> = neighbours(linked, texel)
            .map(|pair| difference(&between_texels(pair.map(lit), reach_codes), own))
            .collect();
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

/// When the sharp filter shows light in the middle between two texels, for a sun without width: the signed distances in
/// time from their nearest edges, at most `reach` codes, have a sum above zero. Given are their lit intervals.
fn between_texels(lit: [&[FoundSpan]; 2], reach: i32) -> Vec<FoundSpan> {
    let max_code = i32::from(Bits::Sixteen.max_code());
    // Edges in ascending order; light and shade take turns. The path's ends are none.
    let edges = lit.map(|lit| {
        let starts_lit = lit.first().is_some_and(|span| span.start == 0);
        let all = lit.iter().flat_map(|span| [i32::from(span.start), i32::from(span.end)]);
        (starts_lit, all.filter(|edge| (1..max_code).contains(edge)).collect::<SmallVec<[i32; 32]>>())
    });
    // Where a distance's slope changes: at edges, midway between them, and where they are out of reach. Doubled, so
    // that all are whole.
    let mut bends: Vec<i32> = vec![0, 2 * max_code];
    for (_, edges) in &edges {
        bends.extend(edges.windows(2).map(|pair| pair[0] + pair[1]));
        bends.extend(edges.iter().flat_map(|edge| [2 * (edge - reach), 2 * edge, 2 * (edge + reach)]));
    }
    bends.retain(|bend| (0..=2 * max_code).contains(bend));
    bends.sort_unstable();
    bends.dedup();
    let mut next = [0; 2];
    let mut sum = |at: i32| {
        let mut sum = 0;
        for ((starts_lit, edges), next) in edges.iter().zip(&mut next) {
            while edges.get(*next).is_some_and(|edge| 2 * edge < at) {
                *next += 1;
            }
            let before = next.checked_sub(1).map_or(2 * reach, |last| at - 2 * edges[last]);
            let after = edges.get(*next).map_or(2 * reach, |edge| 2 * edge - at);
            let distance = before.min(after).min(2 * reach);
            sum += if starts_lit ^ (*next % 2 == 1) { distance } else { -distance };
        }
        sum
    };
    let mut found: Vec<FoundSpan> = Vec::new();
    let sums: Vec<[i32; 2]> = bends.iter().map(|&bend| [bend, sum(bend)]).collect();
    for pair in sums.windows(2) {
        let [[from, a], [to, b]] = [pair[0], pair[1]];
        let crossing = || from + (i64::from(to - from) * i64::from(a) / i64::from(a - b)) as i32;
        let span = match (a > 0, b > 0) {
            (true, true) => [from, to],
            (true, false) => [from, crossing()],
            (false, true) => [crossing(), to],
            (false, false) => continue,
        };
        let [start, end] = span.map(|at| (at / 2) as u16);
        match found.last_mut().filter(|last| last.end >= start) {
            Some(last) => last.end = end,
            None => found.push(FoundSpan { part: MERGED, start, end }),
        }
    }
    found
}

/// For how many codes of time one of two texels sees the sun and the other does not.
fn difference(some: &[FoundSpan], others: &[FoundSpan]) -> u32 {
    let length = |spans: &[FoundSpan]| spans.iter().map(|span| u32::from(span.end - span.start)).sum::<u32>();
    let (mut a, mut b, mut both) = (0, 0, 0);
    while let (Some(one), Some(other)) = (some.get(a), others.get(b)) {
        both += u32::from(one.end.min(other.end).saturating_sub(one.start.max(other.start)));
        if one.end < other.end {
            a += 1;
        } else {
            b += 1;
        }
    }
    length(some) + length(others) - 2 * both
}

/// When a texel and all around it are dark for long.
fn deep_shade(shade: &PageShade, texel: usize) -> Vec<FoundSpan> {
    let max_code = Bits::Sixteen.max_code();
    let least_codes = LEAST_DEPTH * shade.width_t * f64::from(max_code);
    let near = std::iter::once(texel).chain(Around::new(shade.size, shade.walls).texels(texel));
    let lit = union(near.flat_map(|texel| shade.lit.of_texel(shade.source[texel] as usize)));
    let is_long = |[start, end]: &[u16; 2]| f64::from(end - start) >= least_codes;
    let dark = between(&lit).filter(is_long).take(MOST_DEEP);
    dark.map(|[start, end]| FoundSpan { part: DEEP, start, end }).collect()
}

/// The times between ascending, disjoint ones, from the path's start to its end.
fn between(spans: &[[u16; 2]]) -> impl Iterator<Item = [u16; 2]> {
    let starts = std::iter::once(0).chain(spans.iter().map(|span| span[1]));
    let ends = spans.iter().map(|span| span[0]).chain([Bits::Sixteen.max_code()]);
    starts.zip(ends).map(|(start, end)| [start, end]).filter(|[start, end]| start < end)
}

/// How many spans lie between lit intervals.
fn merged_count(lit: &[FoundSpan]) -> usize {
    between(&union(lit.iter())).count().min(MOST_SPANS)
}

/// The shade between lit intervals, at most so many spans.
fn merged(lit: &[FoundSpan], most: usize) -> Vec<FoundSpan> {
    let shade: Vec<[u16; 2]> = between(&union(lit.iter())).collect();
    fitted(&shade, most)
}

/// Merged shade; of more spans than are stored, that which is wrong for the shortest time.
fn fitted(shade: &[[u16; 2]], most: usize) -> Vec<FoundSpan> {
    let time = |code: u16| Bits::Sixteen.decode(code);
    let spans = |spans: &[[f64; 2]]| spans.iter().map(|&span| FoundSpan::new(MERGED, span)).collect();
    let shade = Intervals::from_unsorted(shade.iter().map(|span| span.map(time)).collect());
    let (shade, _) = crate::maps::fit_to_cap(&shade, most);
    spans(shade.as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A post's shadow that moves from texel to texel by more than it is wide: blending has two pale ones where there
    /// is one in the middle, and tracks have that.
    #[test]
    fn tracks_foretell_a_narrow_shadow_and_not_what_only_one_texel_has() {
        let span = |start, end| [FoundSpan { part: 4, start, end }];
        let (own, before, after) = (span(2000, 2500), span(1000, 1500), span(3000, 3500));
        let share = |codes: f64| codes / 65535.0;
        // Blended: the middle shadow is missing (500), and two half ones are there (2 * 250).
        let gain = foretold_gain(&own, [&before, &after]);
        assert!((gain - share(1000.0)).abs() < 1e-12, "{gain}");
        // What only one has is no better than blending.
        assert_eq!(foretold_gain(&own, [&before, &[]]), 0.0);
        // A shadow that does not move is foretold by both.
        assert_eq!(foretold_gain(&own, [&own, &own]), 0.0);
    }

    #[test]
    fn what_is_between_the_union_of_spans_is_the_rest() {
        let span = |start, end| FoundSpan { part: 1, start, end };
        let spans = [span(30, 40), span(5, 10), span(10, 20), span(35, 50)];
        assert_eq!(union(spans.iter()), [[5, 20], [30, 50]]);
        assert_eq!(between(&[[5, 20], [30, 50]]).collect::<Vec<_>>(), [[0, 5], [20, 30], [50, 65535]]);
        assert_eq!(between(&[[0, 20], [30, 65535]]).collect::<Vec<_>>(), [[20, 30]]);
    }

    #[test]
    fn a_difference_is_the_time_that_only_one_of_two_sees_the_sun() {
        let spans = |list: &[[u16; 2]]| -> Vec<FoundSpan> {
            list.iter().map(|&[start, end]| FoundSpan { part: MERGED, start, end }).collect()
        };
        let lists: [&[[u16; 2]]; 5] =
            [&[], &[[0, 10]], &[[5, 8], [9, 20]], &[[0, 3], [4, 9], [10, 12]], &[[7, 30], [40, 50]]];
        for a in lists {
            for b in lists {
                let is_lit = |list: &[[u16; 2]], code: u16| list.iter().any(|&[from, to]| from <= code && code < to);
                let expected = (0..60).filter(|&code| is_lit(a, code) != is_lit(b, code)).count() as u32;
                assert_eq!(difference(&spans(a), &spans(b)), expected, "{a:?} {b:?}");
            }
        }
    }
}
