//! What a texel would see if it were drawn from the texels on both sides of it, and how wrong that is: for a sun
//! without width, in codes of time.

use super::link::matches;
use super::{FoundSpan, MERGED};
use crate::maps::Bits;
use smallvec::SmallVec;

/// Half shades in the middle between two texels: two hide the sun.
pub(super) struct Halves(SmallVec<[(u16, u16, i32); 16]>);

impl Halves {
    /// Of what both texels see, blended.
    pub fn beside(pair: [&[FoundSpan]; 2]) -> Self {
        Self(pair.into_iter().flatten().map(|span| (span.start, span.end, 1)).collect())
    }

    /// Of spans whose times are blended where both texels have them.
    pub fn blended([before, after]: [&[FoundSpan]; 2]) -> Self {
        let pairs = matches(before, after);
        let mut halves: SmallVec<_> = pairs
            .iter()
            .map(|&[i, j]| {
                let (a, b) = (before[i as usize], after[j as usize]);
                (a.start.midpoint(b.start), a.end.midpoint(b.end), 2)
            })
            .collect();
        for (side, spans) in [before, after].into_iter().enumerate() {
            let mut is_alone: SmallVec<[bool; 64]> = SmallVec::from_elem(true, spans.len());
            pairs.iter().for_each(|pair| is_alone[pair[side] as usize] = false);
            let alone = spans.iter().zip(is_alone).filter(|(_, is_alone)| *is_alone);
            halves.extend(alone.map(|(span, _)| (span.start, span.end, 1)));
        }
        Self(halves)
    }
}

/// For how many codes a texel that is dark at these times is foretold wrong. Where half of the sun is seen, half of the
/// time counts.
pub(super) fn foretold_error(dark: &[[u16; 2]], Halves(halves): &Halves) -> f64 {
    // At a code, how much two sums grow: shade and foretold halves of it.
    let mut steps: SmallVec<[(u16, [i32; 2]); 32]> = SmallVec::new();
    let own = dark.iter().map(|&[start, end]| (start, end, [1, 0]));
    for (start, end, step) in own.chain(halves.iter().map(|&(start, end, by)| (start, end, [0, by]))) {
        steps.push((start, step));
        steps.push((end, step.map(|by| -by)));
    }
    steps.sort_unstable_by_key(|(code, _)| *code);
    let (mut at, mut sums, mut wrong) = (0, [0; 2], 0i64);
    for (code, step) in steps {
        let [own, foretold] = sums;
        wrong += i64::from((2 * own - i32::min(foretold, 2)).abs()) * i64::from(code - at);
        at = code;
        sums.iter_mut().zip(step).for_each(|(sum, by)| *sum += by);
    }
    0.5 * wrong as f64
}

/// By how much the shade of a part at a texel is foretold better by blending its times than by blending what the two
/// texels see: the difference of mean errors over the path.
pub(super) fn foretold_gain(own: &[FoundSpan], pair: [&[FoundSpan]; 2]) -> f64 {
    let own: SmallVec<[[u16; 2]; 8]> = own.iter().map(FoundSpan::times).collect();
    let error = |halves: Halves| foretold_error(&own, &halves);
    (error(Halves::beside(pair)) - error(Halves::blended(pair))) / f64::from(Bits::Sixteen.max_code())
}

/// When the sharp filter shows light in the middle between two texels, for a sun without width: the signed distances in
/// time from their nearest edges, at most `reach` codes, have a sum above zero. Given are their lit intervals.
pub(super) fn between_texels(lit: [&[FoundSpan]; 2], reach: i32) -> Vec<FoundSpan> {
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
pub(super) fn difference(some: &[FoundSpan], others: &[FoundSpan]) -> u32 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{PageEncoder, edge_sample, sharpened};
    use crate::visibility::Intervals;

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
    fn an_error_is_what_is_wrong_code_by_code() {
        let span = |part, start, end| FoundSpan { part, start, end };
        let before = [span(1, 0, 10), span(2, 20, 30), span(3, 50, 70)];
        let after = [span(2, 24, 38), span(4, 5, 25)];
        let dark = [[2, 12], [21, 36], [60, 65]];
        let hides = |code: u16, span: FoundSpan| i32::from((span.start..span.end).contains(&code));
        let expected: i32 = (0..100)
            .map(|code| {
                let alone = [before[0], before[2], after[1]].iter().map(|span| hides(code, *span)).sum::<i32>();
                let halves = (alone + 2 * hides(code, span(2, 22, 34))).min(2);
                let own = i32::from(dark.iter().any(|[start, end]| (*start..*end).contains(&code)));
                (2 * own - halves).abs()
            })
            .sum();
        assert_eq!(foretold_error(&dark, &Halves::blended([&before, &after])), 0.5 * f64::from(expected));
    }

    /// The filter itself, for a sun as narrow as a code.
    #[test]
    fn what_is_between_texels_is_what_the_sharp_filter_shows() {
        let code = |code: u16| Bits::Sixteen.decode(code);
        let lists: [&[[u16; 2]]; 6] = [
            &[],
            &[[0, 65535]],
            &[[100, 180], [200, 260]],
            &[[0, 130], [150, 210], [400, 65535]],
            &[[120, 123], [126, 300]],
            &[[90, 500]],
        ];
        let mut encoder = PageEncoder::new(lists.len(), Bits::Sixteen, 1);
        for (texel, list) in lists.iter().enumerate() {
            encoder.set(texel, &Intervals::from_unsorted(list.iter().map(|span| span.map(code)).collect()));
        }
        let layers = encoder.finish();
        let spans = lists.map(|list| -> Vec<FoundSpan> {
            list.iter().map(|&[start, end]| FoundSpan { part: MERGED, start, end }).collect()
        });
        // The filter's reach in codes, for a width of one.
        let reach = crate::maps::SHARP_REACH as i32;
        for a in 0..lists.len() {
            for b in 0..lists.len() {
                let found = between_texels([&spans[a], &spans[b]], reach);
                for at in 1..700u16 {
                    let t = (f64::from(at) / 65535.0) as f32;
                    let sample = |texel| edge_sample(&layers, texel, Bits::Sixteen, t, 1.0 / 65535.0);
                    let seen = sharpened(0.5 * (sample(a) + sample(b)));
                    let is_lit = found.iter().any(|span| span.start < at && at < span.end);
                    let is_dark = found.iter().all(|span| at + 1 < span.start || span.end < at - 1);
                    assert!(!is_lit || seen > 0.49, "{a} {b} at {at}: {seen}");
                    assert!(!is_dark || seen < 0.51, "{a} {b} at {at}: {seen}");
                }
            }
        }
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
