//! Which spans of neighbouring texels are one track, and the tracks' numbers.
//!
//! Spans of one occluder are matched in order where both texels have as many; else those are left over that make the
//! others match best. (Of the pairs of texels under a fence, 97 to 99 % have as many.) Matches to the right and to the
//! lower texel make sets. Where a set comes round to a texel that it holds already, with another span, that span is cut
//! off. Numbers are 16 bits and need only differ between tracks that meet in four texels.

use super::find::{FoundSpan, FoundSpans};
use super::{PageTracks, TrackSpan};
use crate::atlas::PageSize;
use crate::maps::Bits;
use crate::scene::root;
use smallvec::SmallVec;
use std::collections::HashMap;

/// Numbers of tracks that are used.
const NUMBERS: u32 = u16::MAX as u32;
/// Rounds in which tracks of one number that meet are told apart; more than a few are never needed.
const ROUNDS: usize = 32;

/// Links the spans of a page and numbers their tracks. `is_linked` says whether the ways from a texel to the right and
/// down are open.
pub fn number_tracks(found: &FoundSpans, size: PageSize, is_linked: impl Fn(usize, usize) -> bool) -> PageTracks {
    let (width, height) = (size.width as usize, size.height as usize);
    let mut parent: Vec<u32> = (0..found.spans.len() as u32).collect();
    for texel in 0..width * height {
        let right = (texel % width + 1 < width).then_some((0, texel + 1));
        let lower = (texel / width + 1 < height).then_some((1, texel + width));
        for (way, other) in [right, lower].into_iter().flatten() {
            if !is_linked(texel, way) {
                continue;
            }
            for [a, b] in matches(found.of_texel(texel), found.of_texel(other)) {
                let [a, b] = [found.first[texel] + a, found.first[other] + b].map(|span| root(&mut parent, span));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut track: Vec<u32> = (0..found.spans.len() as u32).map(|span| root(&mut parent, span)).collect();
    cut_off_second_spans(found, &mut track);
    let number = numbers(found, size, &track);
    let code = |t: f64| Bits::Sixteen.encode(t);
    let mut tracks = PageTracks::default();
    for texel in 0..width * height {
        let range = found.first[texel] as usize..found.first[texel + 1] as usize;
        let mut own: SmallVec<[TrackSpan; 16]> = range
            .map(|index| {
                let [start, end] = found.spans[index].shade.map(code);
                TrackSpan { track: number[&track[index]], start, end }
            })
            .collect();
        own.sort_unstable_by_key(|span| span.track);
        tracks.ranges.push([tracks.spans.len() as u32, own.len() as u32]);
        tracks.spans.extend(own);
    }
    tracks
}

/// Pairs of spans of two texels, by index, that are the same occluder's and follow each other.
fn matches(some: &[FoundSpan], others: &[FoundSpan]) -> SmallVec<[[u32; 2]; 16]> {
    let mut pairs = SmallVec::new();
    let (mut a, mut b) = (0, 0);
    while a < some.len() && b < others.len() {
        let (x, y) = (some[a].part, others[b].part);
        let end =
            |spans: &[FoundSpan], from: usize| spans[from..].partition_point(|s| s.part == spans[from].part) + from;
        let (a_end, b_end) = (end(some, a), end(others, b));
        if x == y {
            let own = aligned(&some[a..a_end], &others[b..b_end]);
            pairs.extend(own.into_iter().map(|[i, j]| [a as u32 + i, b as u32 + j]));
        }
        (a, b) = (if x <= y { a_end } else { a }, if y <= x { b_end } else { b });
    }
    pairs
}

/// Pairs in ascending order: all of the shorter list, with the least sum of differences in time.
fn aligned(some: &[FoundSpan], others: &[FoundSpan]) -> SmallVec<[[u32; 2]; 8]> {
    if some.len() > others.len() {
        return aligned(others, some).into_iter().map(|[a, b]| [b, a]).collect();
    }
    if some.len() == others.len() {
        return (0..some.len() as u32).map(|i| [i, i]).collect();
    }
    let cost = |i: usize, j: usize| {
        let ([a, b], [c, d]) = (some[i].shade, others[j].shade);
        (a - c).abs() + (b - d).abs()
    };
    // least[i][j]: of the first i of `some` with the first j of the others.
    let width = others.len() + 1;
    let mut least = vec![f64::INFINITY; (some.len() + 1) * width];
    least[..width].fill(0.0);
    for i in 1..=some.len() {
        for j in i..width {
            let matched = least[(i - 1) * width + j - 1] + cost(i - 1, j - 1);
            least[i * width + j] = matched.min(least[i * width + j - 1]);
        }
    }
    let (mut i, mut j) = (some.len(), others.len());
    let mut pairs = SmallVec::new();
    while i > 0 {
        if least[i * width + j] < least[i * width + j - 1] || j == i {
            pairs.push([i as u32 - 1, j as u32 - 1]);
            i -= 1;
        }
        j -= 1;
    }
    pairs
}

/// A track passes a texel once: a second span of it becomes a track of its own.
fn cut_off_second_spans(found: &FoundSpans, track: &mut [u32]) {
    for range in found.first.windows(2).map(|w| w[0] as usize..w[1] as usize) {
        for index in range.clone() {
            if track[range.start..index].contains(&track[index]) {
                // No set has this number: its root is less.
                track[index] = index as u32;
            }
        }
    }
}

/// The number of each track, so that those that meet within four texels have different ones.
fn numbers(found: &FoundSpans, size: PageSize, track: &[u32]) -> HashMap<u32, u16> {
    let mut number = HashMap::new();
    let mut next = 0u32;
    for own in track {
        number.entry(*own).or_insert_with(|| {
            next += 1;
            ((next - 1) % NUMBERS) as u16
        });
    }
    if next <= NUMBERS {
        return number;
    }
    let (width, height) = (size.width as usize, size.height as usize);
    let of_texel = |texel: usize| &track[found.first[texel] as usize..found.first[texel + 1] as usize];
    for _ in 0..ROUNDS {
        let mut is_settled = true;
        for y in 0..height.saturating_sub(1) {
            for x in 0..width.saturating_sub(1) {
                let corner = y * width + x;
                let mut all: SmallVec<[u32; 64]> = SmallVec::new();
                let four = [corner, corner + 1, corner + width, corner + width + 1];
                four.into_iter().for_each(|texel| all.extend_from_slice(of_texel(texel)));
                all.sort_unstable();
                all.dedup();
                let mut seen: SmallVec<[u16; 64]> = SmallVec::new();
                for own in all {
                    while seen.contains(&number[&own]) {
                        next += 1;
                        is_settled = false;
                        number.insert(own, (next % NUMBERS) as u16);
                    }
                    seen.push(number[&own]);
                }
            }
        }
        if is_settled {
            break;
        }
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(part: u32, shades: &[[f64; 2]]) -> Vec<FoundSpan> {
        shades.iter().map(|&shade| FoundSpan { part, shade }).collect()
    }

    fn page(texels: &[Vec<FoundSpan>]) -> FoundSpans {
        let mut found = FoundSpans { first: vec![0], spans: Vec::new() };
        for own in texels {
            found.spans.extend_from_slice(own);
            found.first.push(found.spans.len() as u32);
        }
        found
    }

    #[test]
    fn spans_of_one_occluder_match_in_order_or_by_their_times() {
        let three = spans(7, &[[0.1, 0.2], [0.4, 0.5], [0.7, 0.8]]);
        let later = spans(7, &[[0.15, 0.25], [0.45, 0.55], [0.75, 0.85]]);
        assert_eq!(matches(&three, &later).as_slice(), [[0, 0], [1, 1], [2, 2]]);
        let two = spans(7, &[[0.39, 0.52], [0.71, 0.8]]);
        let pairs = |a: &[FoundSpan], b: &[FoundSpan]| {
            let mut pairs = matches(a, b).to_vec();
            pairs.sort_unstable();
            pairs
        };
        assert_eq!(pairs(&three, &two), [[1, 0], [2, 1]]);
        assert_eq!(pairs(&two, &three), [[0, 1], [1, 2]]);
        let mixed = [spans(3, &[[0.0, 0.9]]), three.clone()].concat();
        assert_eq!(pairs(&mixed, &two), [[2, 0], [3, 1]]);
        assert!(matches(&spans(3, &[[0.0, 1.0]]), &three).is_empty());
    }

    #[test]
    fn linked_spans_share_a_number_and_others_do_not() {
        let texels = [
            spans(1, &[[0.1, 0.2], [0.4, 0.5]]),
            [spans(1, &[[0.12, 0.22], [0.42, 0.5]]), spans(2, &[[0.3, 0.6]])].concat(),
        ];
        let size = PageSize { width: 2, height: 1 };
        let tracks = number_tracks(&page(&texels), size, |_, _| true);
        let numbers = |texel: usize| tracks.of_texel(texel).iter().map(|span| span.track).collect::<Vec<_>>();
        assert_eq!(numbers(0), numbers(1)[..2]);
        assert!(numbers(1).is_sorted_by(|a, b| a < b));
        let apart = number_tracks(&page(&texels), size, |_, _| false);
        let of = |texel: usize| apart.of_texel(texel).iter().map(|span| span.track).collect::<Vec<_>>();
        assert!(of(0).iter().all(|number| !of(1).contains(number)));
    }

    #[test]
    fn a_track_passes_a_texel_once() {
        // Four texels around a post: each step round leads from one span to the next.
        let two = || spans(1, &[[0.1, 0.2], [0.3, 0.4]]);
        let texels = [two(), spans(1, &[[0.28, 0.4]]), spans(1, &[[0.12, 0.22]]), spans(1, &[[0.2, 0.3]])];
        let tracks = number_tracks(&page(&texels), PageSize { width: 2, height: 2 }, |_, _| true);
        for texel in 0..4 {
            assert!(tracks.of_texel(texel).is_sorted_by(|a, b| a.track < b.track), "{texel}: {tracks:?}");
        }
    }

    #[test]
    fn more_tracks_than_numbers_differ_where_they_meet() {
        let size = PageSize { width: NUMBERS + 1, height: 2 };
        let texels = vec![spans(1, &[[0.1, 0.2]]); 2 * size.width as usize];
        let tracks = number_tracks(&page(&texels), size, |_, _| false);
        let number = |x: usize, y: usize| tracks.of_texel(y * size.width as usize + x)[0].track;
        for x in 0..size.width as usize - 1 {
            let mut four = [number(x, 0), number(x + 1, 0), number(x, 1), number(x + 1, 1)];
            four.sort_unstable();
            assert!(four.windows(2).all(|pair| pair[0] != pair[1]), "at {x}: {four:?}");
        }
    }
}
