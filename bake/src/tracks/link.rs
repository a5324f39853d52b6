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
        let end = |spans: &[FoundSpan], from: usize| spans[from..].partition_point(|s| s.part == spans[from].part) + from;
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
