//! What a triangle occludes whose plane is within the run-up of the point.
//!
//! Shadow rays start a run-up r before their point (see [`crate::trace`]), so a triangle counts if the sun's line
//! crosses it beyond -r. With N the sum of the edge normals and V the volume `v0 . (v1 x v2)`, the line along `dir`
//! crosses the plane at `V / (N . dir)`. For either orientation s = ±1 the triangle hides where all `s n_i . dir >= 0`
//! and `s N . dir + s V / r >= 0`: four half spaces, one of them moved. Farther triangles meet the last one always or
//! never.

use super::arc::ArcFrame;
use glam::DVec3;

/// Spans of diamond angle that a triangle (corners relative to the point) occludes.
pub(super) fn hidden_near(frame: &ArcFrame, lane: usize, [a, b, c]: [DVec3; 3], run_up: f64) -> Vec<[f64; 2]> {
    let normals = [a.cross(b), b.cross(c), c.cross(a)];
    let area = normals[0] + normals[1] + normals[2];
    let volume = a.dot(normals[1]);
    let one_way = |side: f64| {
        let start = frame.half_space(area * side, side * volume / run_up, lane).as_slice().to_vec();
        normals.iter().fold(start, |spans, &n| meet(&spans, frame.half_space(n * side, 0.0, lane).as_slice()))
    };
    [1.0, -1.0].into_iter().flat_map(one_way).collect()
}

/// The intersection of two lists of spans.
fn meet(some: &[[f64; 2]], others: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = some.iter().flat_map(|a| others.iter().map(move |b| [a[0].max(b[0]), a[1].min(b[1])]));
    pairs.filter(|span| span[0] < span[1]).collect()
}
