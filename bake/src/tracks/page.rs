//! The tracks of a page.
//!
//! Texels have tracks where blending what they see would err: where neighbours see the sun at other times for more than
//! a hundredth of the path ([`MOST_DIFFERENCE`]). Not all of these are served: where shadows of leaves come and go from
//! texel to texel, no occluder is the same in two of them. So each texel is foretold from those on both sides of it, by
//! tracks and by blending, and compared with what it sees ([`gains`]); where tracks foretell no better, around it as a
//! whole, texels keep their merged shade. So does one with more spans than are stored.
//!
//! Where occluders abut, one texel may be dark for one of them and the next for the other, and each of the two tracks
//! ends before a point between. That would be light in deep shade. So a texel that is dark for long together with all
//! texels around it says so in a span of its own ([`DEEP`]): the times of four such spans are dark for all four texels,
//! and so are times between them.

use super::evaluate::blended;
use super::link::Linked;
use super::{
    DEEP, FoundSpan, FoundSpans, MERGED, MOST_SPANS, PageTracks, TrackCounts, TrackSpan, find_spans, number_tracks,
};
use crate::atlas::{Around, PageSize, SurfacePoint, is_open};
use crate::maps::Bits;
use crate::visibility::{Intervals, OccluderFinder};
use rayon::prelude::*;

/// Path time for which neighbours may differ without tracks.
const MOST_DIFFERENCE: f64 = 0.01;
/// Mean visibility by which tracks must foretell texels better than blending does.
const LEAST_GAIN: f32 = 0.002;
/// Sun's widths for which a texel and all around it must be dark together, for the shade to be deep.
const LEAST_DEPTH: f64 = 20.0;
/// Moments at which a texel is foretold.
const MOMENTS: u32 = 32;
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
}

/// Finds the tracks of a page.
pub fn page_tracks(finder: &OccluderFinder, shade: &PageShade) -> (PageTracks, TrackCounts) {
    let is_way_open = |texel: usize, way: usize| shade.walls.is_none_or(|codes| is_open(codes[texel][way]));
    let linked = Linked { size: shade.size, source: shade.source, is_open: &is_way_open };
    let texels = texels_with_tracks(shade, &linked);
    let found = find_spans(finder, &texels, shade.point, shade.size, shade.walls, LEAST_SPAN * shade.width_t);
    let mut is_kept = vec![true; texels.len()];
    let (all, _) = with_merged(shade, &texels, &found, &is_kept);
    let tracks = number_tracks(&all, &linked);
    let gains = gains(&tracks, &linked, &texels, shade.width_t as f32);
    keep_where_they_gain(&mut is_kept, &gains, shade, &texels);
    let (all, counts) = with_merged(shade, &texels, &found, &is_kept);
    (number_tracks(&all, &linked), counts)
}

/// The spans of a page: those found of the texels that keep them, and merged shade of the others.
fn with_merged(shade: &PageShade, texels: &[u32], found: &FoundSpans, is_kept: &[bool]) -> (FoundSpans, TrackCounts) {
    let around = Around::new(shade.size, shade.walls);
    let mut counts = TrackCounts::default();
    let mut all = FoundSpans::default();
    let mut with_tracks = texels.iter().enumerate().peekable();
    for texel in 0..shade.source.len() {
        let index = with_tracks.next_if(|(_, with)| **with as usize == texel).map(|(index, _)| index);
        let with_depth = |index: usize| {
            let mut spans = found.of_texel(index).to_vec();
            let own_plane = spans.partition_point(|span| span.part < DEEP);
            spans.splice(own_plane..own_plane, deep_shade(shade, around, texel));
            spans
        };
        match index.filter(|&index| is_kept[index]).map(with_depth) {
            Some(spans) if spans.len() <= MOST_SPANS => {
                counts.texels += 1;
                all.push(spans);
            }
            own => {
                counts.crowded_texels += u64::from(own.is_some());
                all.push(merged(shade.lit.of_texel(texel)));
            }
        }
    }
    (all, counts)
}

/// For each texel with tracks, by how much they foretell it better than blending does, from its left and right and from
/// its upper and lower neighbour: the mean over moments, 0 where there is no such pair.
fn gains(tracks: &PageTracks, linked: &Linked, texels: &[u32], width_t: f32) -> Vec<f32> {
    let (width, count) = (linked.size.width as usize, linked.source.len());
    let mut has_tracks = vec![false; count];
    texels.iter().for_each(|&texel| has_tracks[texel as usize] = true);
    let pair = |texel: usize, step: usize, way: usize| {
        let is_inside = step != 1 || (1..width - 1).contains(&(texel % width));
        let (before, after) = (texel.checked_sub(step)?, texel + step);
        let is_open = is_inside && after < count && (linked.is_open)(before, way) && (linked.is_open)(texel, way);
        (is_open && has_tracks[before] && has_tracks[after]).then_some([before, after])
    };
    let gain = |&texel: &u32| {
        let texel = texel as usize;
        let own = tracks.of_texel(texel);
        let (mut sum, mut pairs) = (0.0, 0.0f32);
        for [before, after] in [pair(texel, 1, 0), pair(texel, width, 1)].into_iter().flatten() {
            let spans = [before, after].map(|texel| tracks.of_texel(texel));
            let seen = |list: &[TrackSpan], t: f32| blended([list, &[], &[], &[]], [1.0, 0.0, 0.0, 0.0], t, width_t);
            pairs += 1.0;
            for moment in 0..MOMENTS {
                let t = (moment as f32 + (texel as f32 * 0.618_034).fract()) / MOMENTS as f32;
                let truth = seen(own, t);
                let tracked = blended([spans[0], spans[1], &[], &[]], [0.5, 0.5, 0.0, 0.0], t, width_t);
                let plain = 0.5 * (seen(spans[0], t) + seen(spans[1], t));
                sum += (plain - truth).abs() - (tracked - truth).abs();
            }
        }
        sum / (pairs.max(1.0) * MOMENTS as f32)
    };
    texels.par_iter().with_min_len(256).map(gain).collect()
}

/// Lets texels keep their tracks around which these gain something.
fn keep_where_they_gain(is_kept: &mut [bool], gains: &[f32], shade: &PageShade, texels: &[u32]) {
    let mut gain_of = vec![None; shade.source.len()];
    texels.iter().zip(gains).for_each(|(&texel, &gain)| gain_of[texel as usize] = Some(gain));
    let around = Around::new(shade.size, shade.walls);
    for (is_kept, &texel) in is_kept.iter_mut().zip(texels) {
        let near = std::iter::once(texel as usize).chain(around.texels(texel as usize));
        let (sum, count) = near.filter_map(|texel| gain_of[texel]).fold((0.0, 0.0), |(a, b), gain| (a + gain, b + 1.0));
        *is_kept = sum > LEAST_GAIN * count;
    }
}

/// Texels, ascending, in whose quads shade moves.
fn texels_with_tracks(shade: &PageShade, linked: &Linked) -> Vec<u32> {
    let most_codes = (MOST_DIFFERENCE * f64::from(Bits::Sixteen.max_code())) as u32;
    let (width, height) = (shade.size.width as usize, shade.size.height as usize);
    let mut moves = vec![false; shade.source.len()];
    for [texel, other] in linked.pairs() {
        let [a, b] = [texel, other].map(|texel| shade.lit.of_texel(shade.source[texel] as usize));
        if difference(a, b) > most_codes {
            // Both texels, and those that share a quad with them.
            let is_right = other == texel + 1;
            let [column, row] = [texel % width, texel / width];
            let columns = if is_right { column..column + 2 } else { column.saturating_sub(1)..(column + 2).min(width) };
            let rows = if is_right { row.saturating_sub(1)..(row + 2).min(height) } else { row..row + 2 };
            for row in rows {
                for column in columns.clone() {
                    moves[shade.source[row * width + column] as usize] = true;
                }
            }
        }
    }
    (0..shade.source.len() as u32).filter(|&texel| moves[texel as usize] && (shade.has_point)(texel)).collect()
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
fn deep_shade(shade: &PageShade, around: Around, texel: usize) -> Vec<FoundSpan> {
    let max_code = Bits::Sixteen.max_code();
    let least_codes = LEAST_DEPTH * shade.width_t * f64::from(max_code);
    let near = std::iter::once(texel).chain(around.texels(texel));
    let mut lit: Vec<FoundSpan> =
        near.flat_map(|texel| shade.lit.of_texel(shade.source[texel] as usize)).copied().collect();
    lit.sort_unstable_by_key(|span| span.start);
    let mut dark = Vec::new();
    let mut from = 0;
    for span in &lit {
        dark.push([from, span.start.max(from)]);
        from = from.max(span.end);
    }
    dark.push([from, max_code]);
    let is_long = |[start, end]: &[u16; 2]| f64::from(end - start) >= least_codes;
    dark.into_iter().filter(is_long).map(|[start, end]| FoundSpan { part: DEEP, start, end }).collect()
}

/// The shade between lit intervals; of more than are stored, that which is wrong for the shortest time.
fn merged(lit: &[FoundSpan]) -> Vec<FoundSpan> {
    let time = |code: u16| Bits::Sixteen.decode(code);
    let lit = Intervals::from_unsorted(lit.iter().map(|span| [time(span.start), time(span.end)]).collect());
    let shade = Intervals::always().without(&lit);
    let (shade, _) = crate::maps::fit_to_cap(&shade, MOST_SPANS);
    shade.as_slice().iter().map(|&shade| FoundSpan::new(MERGED, shade)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
