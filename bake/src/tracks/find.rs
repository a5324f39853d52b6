//! The spans of texels: which occluders matter, and when each of them hides the sun.

use super::{FoundSpan, FoundSpans, OWN_PLANE};
use crate::atlas::{Around, PageSize, SurfacePoint};
use crate::intervals::Intervals;
use crate::progress::{BakeStep, Progress};
use crate::visibility::{Alone, OccluderFinder, OccluderSession};
use rayon::prelude::*;
use smallvec::SmallVec;

/// Texels that one session finds in a row.
const RUN: usize = 256;
/// What two ends of shade may be apart and still be one, in path time: rounding.
const TOUCH: f64 = 1e-9;
/// The place of a texel that is not among those asked for.
const ABSENT: u32 = u32::MAX;

/// Shade by parts: each with its spans.
type Shades = Vec<(u32, Intervals)>;

/// Tells when a texel's point sees the sun, and which parts hide it at other times; there may be more than are needed.
pub type FindHiders<'a> = dyn Fn(&mut OccluderSession, u32, &SurfacePoint) -> (Intervals, Vec<u32>) + Sync + 'a;

/// What a search for spans looks at.
pub struct SpanSearch<'a> {
    /// Finds what parts hide.
    pub finder: &'a OccluderFinder<'a>,
    /// The point of each texel that is asked for.
    pub point: &'a (dyn Fn(u32) -> SurfacePoint + Sync),
    /// What may hide the sun from it.
    pub hiders: &'a FindHiders<'a>,
    /// Size of the page in texels.
    pub size: PageSize,
    /// What stands between texels.
    pub walls: Option<&'a [[u8; 2]]>,
    /// Shorter spans are left out, in path time: they are too short to be seen.
    pub least_t: f64,
}

/// Finds the spans of some texels of a page, in their order. What matters at a texel is a minimal cover of its own
/// shade and of that of texels around it, if they are asked for as well and no wall parts them. Where `progress` is
/// cancelled, the rest has no spans.
pub fn find_spans(search: &SpanSearch, texels: &[u32], progress: &dyn Progress) -> FoundSpans {
    let &SpanSearch { finder, point, hiders, size, walls, least_t } = search;
    progress.start(BakeStep::Tracks, 2 * texels.len() as u64);
    let around = Around::new(size, walls);
    let covers = of_texels(finder, texels, progress, |session, index| {
        let texel = texels[index];
        let point = point(texel);
        let (lit, parts) = hiders(session, texel, &point);
        spans_of(&cover(session, &point, &lit, &parts, least_t))
    });
    let mut place = vec![ABSENT; texels.iter().max().map_or(0, |&last| last as usize + 1)];
    texels.iter().zip(0..).for_each(|(&texel, index)| place[texel as usize] = index);
    let cover_of =
        |texel: usize| place.get(texel).filter(|&&index| index != ABSENT).map(|&i| covers.of_texel(i as usize));
    of_texels(finder, texels, progress, |session, index| {
        let mut spans = covers.of_texel(index).to_vec();
        let near = around.texels(texels[index] as usize).filter_map(cover_of).flatten();
        let mut parts: Vec<u32> = near.map(|span| span.part).collect();
        parts.sort_unstable();
        parts.dedup();
        parts.retain(|part| *part != OWN_PLANE && spans.iter().all(|span| span.part != *part));
        if !parts.is_empty() {
            let alone = session.alone(&point(texels[index]), &parts);
            let shades: Shades = shades_of(&alone, &parts, least_t).collect();
            spans.extend(spans_of(&shades));
            spans.sort_by_key(|span| span.part);
        }
        spans
    })
}

/// The spans of each part's shade.
fn spans_of(shades: &Shades) -> Vec<FoundSpan> {
    let of_part = |(part, shade): &(u32, Intervals)| {
        shade.as_slice().iter().map(|&shade| FoundSpan::new(*part, shade)).collect::<SmallVec<[FoundSpan; 8]>>()
    };
    shades.iter().flat_map(of_part).collect()
}

/// The spans that `find` tells of each texel, by its index; none of the rest where `progress` is cancelled.
fn of_texels(
    finder: &OccluderFinder,
    texels: &[u32],
    progress: &dyn Progress,
    find: impl Fn(&mut OccluderSession, usize) -> Vec<FoundSpan> + Sync,
) -> FoundSpans {
    let of_run = |(run, some): (usize, &[u32])| {
        let mut found = FoundSpans::default();
        if progress.is_cancelled() {
            some.iter().for_each(|_| found.push([]));
            return found;
        }
        progress.advance(some.len() as u64);
        let mut session = finder.session();
        (run * RUN..).take(some.len()).for_each(|index| found.push(find(&mut session, index)));
        found
    };
    let runs: Vec<FoundSpans> = texels.par_chunks(RUN).enumerate().map(of_run).collect();
    FoundSpans::joined(runs)
}

/// When each of some parts alone hides the sun from a point that faces it.
fn shades_of<'a>(alone: &'a Alone, parts: &'a [u32], least_t: f64) -> impl Iterator<Item = (u32, Intervals)> + 'a {
    let of_part = move |(&part, lit): (&u32, &Intervals)| (part, alone.facing.without(lit).longer_than(least_t));
    parts.iter().zip(&alone.lit).map(of_part)
}

/// Those of `parts` that together hide the sun from a point whenever it is hidden, none of which can be left out, and
/// when the surface's own plane does.
fn cover(session: &mut OccluderSession, point: &SurfacePoint, lit: &Intervals, parts: &[u32], least_t: f64) -> Shades {
    let alone = session.alone(point, parts);
    let facing = &alone.facing;
    let shade = facing.without(lit);
    let mut shades: Shades = shades_of(&alone, parts, least_t).collect();
    shades.retain(|(_, shade)| !shade.as_slice().is_empty());
    keep_needed(&mut shades, &shade, least_t.max(TOUCH));
    shades.push((OWN_PLANE, Intervals::always().without(facing).longer_than(TOUCH)));
    shades.sort_by_key(|(part, _)| *part);
    shades
}

/// Leaves out parts that hide nothing for longer than `least_t` that others of them do not, the shortest first.
fn keep_needed(shades: &mut Shades, shade: &Intervals, least_t: f64) {
    shades.sort_by(|a, b| a.1.lit_length().total_cmp(&b.1.lit_length()).then(a.0.cmp(&b.0)));
    // Between two bounds, the same parts hide the sun.
    let spans = || shades.iter().flat_map(|(_, own)| own.as_slice());
    let mut bounds: Vec<f64> = spans().chain(shade.as_slice()).flatten().copied().collect();
    bounds.sort_unstable_by(f64::total_cmp);
    bounds.dedup();
    let steps = |span: &[f64; 2]| {
        let [first, end] = span.map(|t| bounds.partition_point(|bound| *bound < t));
        first..end
    };
    let mut is_dark = vec![false; bounds.len()];
    shade.as_slice().iter().flat_map(steps).for_each(|step| is_dark[step] = true);
    let mut hidden_by = vec![0u32; bounds.len()];
    spans().flat_map(steps).for_each(|step| hidden_by[step] += 1);
    shades.retain(|(_, own)| {
        let is_needed = own.as_slice().iter().any(|span| {
            let mut alone = 0.0;
            steps(span).any(|step| {
                let is_alone = is_dark[step] && hidden_by[step] == 1;
                alone = if is_alone { alone + bounds[step + 1] - bounds[step] } else { 0.0 };
                alone > least_t
            })
        });
        if !is_needed {
            own.as_slice().iter().flat_map(steps).for_each(|step| hidden_by[step] -= 1);
        }
        is_needed
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(parts: &[&[[f64; 2]]], shade: &[[f64; 2]]) -> Vec<u32> {
        let intervals = |spans: &[[f64; 2]]| Intervals::from_unsorted(spans.to_vec());
        let mut shades: Shades = (0..).zip(parts).map(|(part, spans)| (part, intervals(spans))).collect();
        keep_needed(&mut shades, &intervals(shade), 0.01);
        let mut kept: Vec<u32> = shades.iter().map(|(part, _)| *part).collect();
        kept.sort_unstable();
        kept
    }

    #[test]
    fn parts_that_others_hide_are_left_out_and_the_rest_hide_as_much() {
        assert_eq!(kept(&[&[[0.1, 0.5]], &[[0.2, 0.3]]], &[[0.1, 0.5]]), [0]);
        assert_eq!(kept(&[&[[0.1, 0.3]], &[[0.2, 0.5]]], &[[0.1, 0.5]]), [0, 1]);
        // The middle one is hidden by both others together, and goes though it is not the shortest on its own.
        assert_eq!(kept(&[&[[0.1, 0.3]], &[[0.2, 0.4]], &[[0.3, 0.6]]], &[[0.1, 0.6]]), [0, 2]);
        // Equal ones: one stays.
        assert_eq!(kept(&[&[[0.1, 0.3]], &[[0.1, 0.3]]], &[[0.1, 0.3]]), [1]);
        // Alone for no longer than is seen; and where it is not dark, which is rounding.
        assert_eq!(kept(&[&[[0.1, 0.3]], &[[0.3, 0.305]]], &[[0.1, 0.305]]), [0]);
        assert_eq!(kept(&[&[[0.1, 0.3]], &[[0.5, 0.6]]], &[[0.1, 0.3]]), [0]);
        // Pieces that touch count as one.
        assert_eq!(kept(&[&[[0.1, 0.108], [0.2, 0.216]], &[[0.11, 0.2], [0.208, 0.3]]], &[[0.1, 0.3]]), [1]);
    }
}
