//! Which spans of neighbouring texels are one track, and the tracks' numbers.
//!
//! Spans of one occluder are matched in order where both texels have as many; else those are left over that make the
//! others match best. (Of the pairs of texels under a fence, 97 to 99 % have as many.) Matches to the right and to the
//! lower texel make sets. Where a set comes round to a texel that it holds already, with another span, that span is cut
//! off. Numbers are 16 bits and need only differ between tracks that meet in four texels.
//!
//! Merged shade is nobody's track: its numbers say which of four texels it is of, and so never meet their own.

use super::{FIRST_MERGED, FoundSpan, FoundSpans, MERGED, MOST_SPANS, PageTracks, TrackSpan};
use crate::atlas::PageSize;
use crate::scene::root;
use smallvec::SmallVec;

/// Rounds in which tracks of one number that meet are told apart; more than a few are never needed.
const ROUNDS: usize = 32;

/// The texels of a page, and whose spans each of them has.
pub struct Linked<'a> {
    /// In texels.
    pub size: PageSize,
    /// For each texel, the one whose spans it has: itself, or, in a gutter, the one that it copies.
    pub source: &'a [u32],
    /// Whether the way from a texel to the right (0) or down (1) is open.
    pub is_open: &'a (dyn Fn(usize, usize) -> bool + Sync),
}

impl Linked<'_> {
    fn width(&self) -> usize {
        self.size.width as usize
    }

    /// Pairs of texels side by side, one above the other, with an open way from the first to the second.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let width = self.width();
        (0..self.source.len()).flat_map(move |texel| {
            let right = (texel % width + 1 < width).then_some((0, texel + 1));
            let lower = (texel + width < self.source.len()).then_some((1, texel + width));
            let open = [right, lower].into_iter().flatten().filter(move |&(way, _)| (self.is_open)(texel, way));
            open.map(move |(_, other)| [texel, other])
        })
    }

    /// The texels left and right of a texel, and those above and below it, where the ways to both are open.
    pub fn neighbours(&self, texel: usize) -> impl Iterator<Item = [usize; 2]> {
        let (width, count) = (self.size.width as usize, self.source.len());
        let pair = |step: usize, way: usize| {
            let is_inside = step != 1 || (1..width - 1).contains(&(texel % width));
            let (before, after) = (texel.checked_sub(step)?, texel + step);
            let is_open = is_inside && after < count && (self.is_open)(before, way) && (self.is_open)(texel, way);
            is_open.then_some([before, after])
        };
        [pair(1, 0), pair(width, 1)].into_iter().flatten()
    }

    /// The four texels of each quad, each by the one whose spans it has.
    fn quads(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let (width, height) = (self.width(), self.size.height as usize);
        let corners = (0..height.saturating_sub(1)).flat_map(move |y| (0..width - 1).map(move |x| y * width + x));
        corners.map(move |corner| {
            [corner, corner + 1, corner + width, corner + width + 1].map(|texel| self.source[texel] as usize)
        })
    }

    /// Which of the four texels of any quad it is.
    fn corner(&self, texel: usize) -> usize {
        texel % self.width() % 2 + 2 * (texel / self.width() % 2)
    }
}

/// Links the spans of a page and numbers their tracks. `found` has spans of every texel that is its own source, at most
/// [`MOST_SPANS`] of each.
pub fn number_tracks(found: &FoundSpans, page: &Linked) -> PageTracks {
    let mut parent: Vec<u32> = (0..found.spans.len() as u32).collect();
    for [texel, other] in page.pairs().map(|pair| pair.map(|texel| page.source[texel] as usize)) {
        for [a, b] in matches(found.of_texel(texel), found.of_texel(other)) {
            let [a, b] = [found.first[texel] + a, found.first[other] + b].map(|span| root(&mut parent, span));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut track: Vec<u32> = (0..found.spans.len() as u32).map(|span| root(&mut parent, span)).collect();
    cut_off_second_spans(found, &mut track);
    let number = numbers(found, page, &track);
    let mut tracks = PageTracks::default();
    for (texel, source) in page.source.iter().map(|&source| source as usize).enumerate() {
        let range = found.first[source] as usize..found.first[source + 1] as usize;
        let is_copy = source < texel && !found.of_texel(source).iter().any(|span| span.part == MERGED);
        if let Some(own) = tracks.ranges.get(source).copied().filter(|_| is_copy) {
            tracks.ranges.push(own);
            continue;
        }
        let merged = FIRST_MERGED + (page.corner(texel) * MOST_SPANS) as u32;
        let mut own: SmallVec<[TrackSpan; 16]> = range
            .zip(merged..)
            .map(|(index, merged)| {
                let FoundSpan { part, start, end } = found.spans[index];
                let track = if part == MERGED { merged as u16 } else { number[track[index] as usize] };
                TrackSpan { track, start, end }
            })
            .collect();
        own.sort_unstable_by_key(|span| span.track);
        tracks.ranges.push([tracks.spans.len() as u32, own.len() as u32]);
        tracks.spans.extend(own);
    }
    tracks
}

/// Pairs of spans of two texels, by index, that are the same occluder's and follow each other.
pub(super) fn matches(some: &[FoundSpan], others: &[FoundSpan]) -> SmallVec<[[u32; 2]; 16]> {
    let mut pairs = SmallVec::new();
    let (mut a, mut b) = (0, 0);
    while a < some.len() && b < others.len() {
        let (x, y) = (some[a].part, others[b].part);
        let end =
            |spans: &[FoundSpan], from: usize| spans[from..].partition_point(|s| s.part == spans[from].part) + from;
        let (a_end, b_end) = (end(some, a), end(others, b));
        if x == y && x != MERGED {
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
        let (one, other) = (some[i], others[j]);
        u32::from(one.start.abs_diff(other.start)) + u32::from(one.end.abs_diff(other.end))
    };
    // least[i][j]: of the first i of `some` with the first j of the others.
    let width = others.len() + 1;
    let mut least = vec![u32::MAX; (some.len() + 1) * width];
    least[..width].fill(0);
    for i in 1..=some.len() {
        for j in i..width {
            let matched = least[(i - 1) * width + j - 1].saturating_add(cost(i - 1, j - 1));
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

/// For each span that is the first of its track, the track's number: those that meet within four texels differ.
fn numbers(found: &FoundSpans, page: &Linked, track: &[u32]) -> Vec<u16> {
    let mut number = vec![0u16; track.len()];
    let mut next = 0u32;
    let is_track = |index: usize| found.spans[index].part != MERGED;
    for index in (0..track.len()).filter(|&index| track[index] as usize == index && is_track(index)) {
        number[index] = (next % FIRST_MERGED) as u16;
        next += 1;
    }
    if next <= FIRST_MERGED {
        return number;
    }
    let of_texel = |texel: usize| &track[found.first[texel] as usize..found.first[texel + 1] as usize];
    let (mut all, mut seen): (SmallVec<[u32; 64]>, SmallVec<[u16; 64]>) = Default::default();
    for _ in 0..ROUNDS {
        let mut is_settled = true;
        for four in page.quads() {
            all.clear();
            seen.clear();
            four.into_iter().for_each(|texel| all.extend_from_slice(of_texel(texel)));
            all.retain(|own| is_track(*own as usize));
            all.sort_unstable();
            all.dedup();
            for own in all.iter().map(|&own| own as usize) {
                while seen.contains(&number[own]) {
                    next += 1;
                    is_settled = false;
                    number[own] = (next % FIRST_MERGED) as u16;
                }
                seen.push(number[own]);
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
        shades.iter().map(|&shade| FoundSpan::new(part, shade)).collect()
    }

    fn tracks_of(found: &FoundSpans, size: PageSize, are_open: bool) -> PageTracks {
        let source: Vec<u32> = (0..size.width * size.height).collect();
        number_tracks(found, &Linked { size, source: &source, is_open: &|_, _| are_open })
    }

    fn page(texels: &[Vec<FoundSpan>]) -> FoundSpans {
        let mut found = FoundSpans::default();
        texels.iter().for_each(|own| found.push(own.iter().copied()));
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
        let tracks = tracks_of(&page(&texels), size, true);
        let numbers = |texel: usize| tracks.of_texel(texel).iter().map(|span| span.track).collect::<Vec<_>>();
        assert_eq!(numbers(0), numbers(1)[..2]);
        assert!(numbers(1).is_sorted_by(|a, b| a < b));
        let apart = tracks_of(&page(&texels), size, false);
        let of = |texel: usize| apart.of_texel(texel).iter().map(|span| span.track).collect::<Vec<_>>();
        assert!(of(0).iter().all(|number| !of(1).contains(number)));
    }

    #[test]
    fn a_track_passes_a_texel_once() {
        // Four texels around a post: each step round leads from one span to the next.
        let two = || spans(1, &[[0.1, 0.2], [0.3, 0.4]]);
        let texels = [two(), spans(1, &[[0.28, 0.4]]), spans(1, &[[0.12, 0.22]]), spans(1, &[[0.2, 0.3]])];
        let tracks = tracks_of(&page(&texels), PageSize { width: 2, height: 2 }, true);
        for texel in 0..4 {
            assert!(tracks.of_texel(texel).is_sorted_by(|a, b| a.track < b.track), "{texel}: {tracks:?}");
        }
    }

    #[test]
    fn more_tracks_than_numbers_differ_where_they_meet() {
        let size = PageSize { width: FIRST_MERGED + 1, height: 2 };
        let texels = vec![spans(1, &[[0.1, 0.2]]); 2 * size.width as usize];
        let tracks = tracks_of(&page(&texels), size, false);
        let number = |x: usize, y: usize| tracks.of_texel(y * size.width as usize + x)[0].track;
        for x in 0..size.width as usize - 1 {
            let mut four = [number(x, 0), number(x + 1, 0), number(x, 1), number(x + 1, 1)];
            four.sort_unstable();
            assert!(four.windows(2).all(|pair| pair[0] != pair[1]), "at {x}: {four:?}");
        }
    }

    #[test]
    fn merged_shade_has_other_numbers_than_its_neighbours_and_gutters_share_tracks() {
        let merged = spans(MERGED, &[[0.1, 0.2], [0.5, 0.6]]);
        let size = PageSize { width: 3, height: 3 };
        let tracks = tracks_of(&page(&vec![merged.clone(); 9]), size, true);
        let numbers = |texel: usize| tracks.of_texel(texel).iter().map(|span| span.track).collect::<Vec<_>>();
        for corner in [0, 1, 3, 4] {
            let mut four: Vec<u16> = [0, 1, 3, 4].iter().flat_map(|way| numbers(corner + way)).collect();
            four.sort_unstable();
            assert!(four.windows(2).all(|pair| pair[0] != pair[1]), "{four:?}");
        }
        // The right texels of two rows copy those left of them: one has a track, the other merged shade.
        let own = [spans(1, &[[0.1, 0.2]]), Vec::new(), merged, Vec::new()];
        let found = page(&own);
        let page = Linked { size: PageSize { width: 2, height: 2 }, source: &[0, 0, 2, 2], is_open: &|_, _| true };
        let tracks = number_tracks(&found, &page);
        assert_eq!(tracks.ranges[0], tracks.ranges[1]);
        assert_ne!(tracks.of_texel(2)[0].track, tracks.of_texel(3)[0].track);
        assert_eq!(tracks.of_texel(2)[0].start, tracks.of_texel(3)[0].start);
    }
}
