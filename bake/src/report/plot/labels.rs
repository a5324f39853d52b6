//! Placing the names of points: beside each point, without covering another name or point; a name without a place is
//! left out.
//!
//! Greedy: in the order of the points, each takes the first of eight positions that is free and on no line, or else the
//! first that is free.

/// Pixels from a point's middle to its name.
const GAP: f64 = 9.0;
/// Half the edge of the square that a point keeps free around itself.
const POINT: f64 = 5.0;

/// A rectangle: least x and y, greatest x and y, in pixels.
pub(super) type LabelRect = [f64; 4];

/// Where a name starts (its left end) and where its middle line is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LabelAnchor {
    pub left: f64,
    pub middle: f64,
}

/// Approximate width of a text: fonts differ.
pub(super) fn width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}

/// An anchor for the name of each point, if there is a free one within the frame; `lines` are pixels that lines pass.
pub(super) fn anchors(
    points: &[([f64; 2], &str)],
    lines: &[[f64; 2]],
    size: f64,
    frame: LabelRect,
) -> Vec<Option<LabelAnchor>> {
    let mut taken: Vec<LabelRect> =
        points.iter().map(|([x, y], _)| [x - POINT, y - POINT, x + POINT, y + POINT]).collect();
    let mut anchor = |&([x, y], text): &([f64; 2], &str)| {
        let (wide, half) = (width(text, size), 0.6 * size);
        let rects = around(x, y, wide).map(|anchor| (anchor, rect(&anchor, wide, half)));
        let is_free = |rect: &LabelRect| within(rect, &frame) && !taken.iter().any(|other| overlap(rect, other));
        let is_clear = |rect: &LabelRect| !lines.iter().any(|[x, y]| overlap(rect, &[*x, *y, *x, *y]));
        let free = || rects.into_iter().filter(|(_, rect)| is_free(rect));
        let (anchor, rect) = free().find(|(_, rect)| is_clear(rect)).or_else(|| free().next())?;
        taken.push(rect);
        Some(anchor)
    };
    points.iter().map(|point| if point.1.is_empty() { None } else { anchor(point) }).collect()
}

/// The positions around a point, best first: curves of error against time fall to the right, so that up and right is
/// free.
fn around(x: f64, y: f64, wide: f64) -> [LabelAnchor; 8] {
    let (right, left, middle) = (x + GAP, x - GAP - wide, x - 0.5 * wide);
    let (above, below) = (y - 1.5 * GAP, y + 1.5 * GAP);
    let near = 0.6 * GAP;
    [
        (x + near, y - 1.2 * GAP),
        (right, y),
        (middle, above),
        (left, y),
        (x - near - wide, y + 1.2 * GAP),
        (middle, below),
        (x - near - wide, y - 1.2 * GAP),
        (x + near, y + 1.2 * GAP),
    ]
    .map(|(left, middle)| LabelAnchor { left, middle })
}

fn rect(anchor: &LabelAnchor, wide: f64, half: f64) -> LabelRect {
    [anchor.left, anchor.middle - half, anchor.left + wide, anchor.middle + half]
}

fn overlap(a: &LabelRect, b: &LabelRect) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn within(a: &LabelRect, frame: &LabelRect) -> bool {
    a[0] >= frame[0] && a[1] >= frame[1] && a[2] <= frame[2] && a[3] <= frame[3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::pseudo_random;

    #[test]
    fn names_cover_neither_each_other_nor_a_point() {
        let mut state = 3;
        let frame = [0.0, 0.0, 300.0, 200.0];
        let places: Vec<[f64; 2]> =
            (0..60).map(|_| [300.0 * pseudo_random(&mut state), 200.0 * pseudo_random(&mut state)]).collect();
        let points: Vec<([f64; 2], &str)> = places.iter().map(|&at| (at, "rays:16")).collect();
        let anchors = anchors(&points, &[], 12.0, frame);
        let rects: Vec<LabelRect> =
            anchors.iter().flatten().map(|anchor| rect(anchor, width("rays:16", 12.0), 7.2)).collect();
        assert!(rects.len() > 10, "{}", rects.len());
        for (k, a) in rects.iter().enumerate() {
            assert!(within(a, &frame) && rects[..k].iter().all(|b| !overlap(a, b)));
            assert!(places.iter().all(|[x, y]| !overlap(a, &[*x, *y, *x, *y])));
        }
    }

    #[test]
    fn a_lone_point_has_its_name() {
        assert!(anchors(&[([50.0, 50.0], "one")], &[], 12.0, [0.0, 0.0, 100.0, 100.0])[0].is_some());
        assert_eq!(anchors(&[], &[], 12.0, [0.0; 4]), []);
    }
}
