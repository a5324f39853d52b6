//! The hierarchy against the triangle that a point and a segment span: all rays to the lamp lie in its plane.
//!
//! A box is entered only if it meets the triangle's own box and plane, if it does not lie beyond the segment, and if
//! rays to a part of it that is still open may meet it: with n the triangle's normal, what is pierced later than s has
//! a product with `n x l(s)` that is not negative. All are bounds of linear functions over a box. Boxes are grown by
//! far more than rounding amounts to, and by the run-up of shadow rays.
//!
//! Where point and segment are in one line there is no plane, and the triangle's box alone decides.

use super::hide::SegmentFromPoint;
use super::open::OpenSpans;
use crate::trace::{Tracer, binary_hierarchy};
use glam::{DVec3, Vec3};
use smallvec::SmallVec;

/// Growth of every box beyond the run-up, tracer space (whose half size is 512 to 1024).
const BOX_PADDING: f64 = 1.0 / 256.0;
/// Sine of the angle between the ends of a segment below which they count as in one line.
const LEAST_SINE: f64 = 1e-7;
/// Most open spans that are kept apart; more are joined.
const MOST_SPANS: usize = 6;

/// A binary hierarchy over every triangle of the tracer, root first.
pub(super) struct Tree {
    nodes: Vec<TreeBox>,
    /// Triangles of leaves.
    order: Vec<u32>,
}

/// A box with what it holds.
struct TreeBox {
    centre: DVec3,
    half: DVec3,
    /// Number of triangles; none if it has children.
    count: u32,
    /// Place of the first triangle, or index of the first of two consecutive children.
    first: u32,
}

/// The next step of a walk.
pub(super) enum NextLeaf<'a> {
    /// Nothing is left to visit.
    Done,
    /// A leaf with its triangles.
    Leaf(&'a [u32]),
}

impl Tree {
    pub fn new(tracer: &Tracer) -> Self {
        let padding = (BOX_PADDING + tracer.run_up()) as f32;
        let grown = |[a, b, c]: &[Vec3; 3]| [a.min(*b).min(*c) - padding, a.max(*b).max(*c) + padding];
        let boxes: Vec<[Vec3; 2]> = tracer.corners().iter().map(grown).collect();
        let (nodes, order) = binary_hierarchy(&boxes);
        let node = |node: &crate::trace::BinaryNode| {
            let [low, high] = node.bounds.map(|corner| corner.as_dvec3());
            TreeBox { centre: 0.5 * (low + high), half: 0.5 * (high - low), count: node.count, first: node.first }
        };
        Self { nodes: nodes.iter().map(node).collect(), order }
    }

    /// The root, to start a walk with; nothing if there is no triangle.
    pub fn start(&self, stack: &mut Vec<u32>) {
        stack.clear();
        stack.extend((!self.nodes.is_empty()).then_some(0));
    }

    /// Goes on to the next leaf that the triangle may meet, near ones first. Counts the nodes met.
    pub fn next_leaf(&self, triangle: &PointSegmentTriangle, stack: &mut Vec<u32>, nodes: &mut u64) -> NextLeaf<'_> {
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            *nodes += 1;
            if !triangle.meets(node) {
                continue;
            }
            if node.count > 0 {
                return NextLeaf::Leaf(&self.order[node.first as usize..(node.first + node.count) as usize]);
            }
            let children = [node.first, node.first + 1];
            let [left, right] = children.map(|child| triangle.distance2(&self.nodes[child as usize]));
            stack.extend(if left < right { [children[1], children[0]] } else { children });
        }
        NextLeaf::Done
    }
}

/// The triangle that a point and a segment span, and which part of it is open.
pub(super) struct PointSegmentTriangle {
    /// The point, tracer space.
    origin: DVec3,
    ends: [DVec3; 2],
    /// Box of the triangle, relative to the point.
    low: DVec3,
    high: DVec3,
    plane: Option<TrianglePlane>,
}

/// The triangle's plane. None of it is needed where the point is in line with the segment.
struct TrianglePlane {
    /// Unit normal.
    normal: DVec3,
    /// What lies beyond the segment has a larger product with the first than the second.
    far: (DVec3, f64),
    /// For each open span, bounds of what may hide it: not negative with the first, not positive with the second.
    open: SmallVec<[[DVec3; 2]; MOST_SPANS]>,
}

impl PointSegmentTriangle {
    /// The triangle from `origin` to a segment.
    pub fn new(origin: DVec3, segment: &SegmentFromPoint, open: &OpenSpans) -> Self {
        let [first, last] = segment.ends;
        let zero = DVec3::ZERO;
        let (low, high) = (first.min(last).min(zero), first.max(last).max(zero));
        let across = first.cross(last);
        let area = across.length();
        let plane = (area > LEAST_SINE * first.length() * last.length()).then(|| {
            let normal = across / area;
            TrianglePlane { normal, far: (normal.cross(first - last), area), open: SmallVec::new() }
        });
        let mut triangle = Self { origin, ends: segment.ends, low, high, plane };
        triangle.update(open);
        triangle
    }

    /// Takes the spans that are open now.
    pub fn update(&mut self, open: &OpenSpans) {
        let Some(plane) = &mut self.plane else { return };
        let [first, last] = self.ends;
        let bound = |s: f64| plane.normal.cross(first + (last - first) * s);
        let mut spans: SmallVec<[[f64; 2]; MOST_SPANS]> = open.as_slice().iter().take(MOST_SPANS).copied().collect();
        if let (Some(joined), Some(end)) = (spans.last_mut(), open.as_slice().last()) {
            joined[1] = end[1];
        }
        plane.open = spans.iter().map(|span| span.map(bound)).collect();
    }

    fn meets(&self, node: &TreeBox) -> bool {
        let centre = node.centre - self.origin;
        let overlaps = (centre + node.half).cmpge(self.low) & (centre - node.half).cmple(self.high);
        overlaps.all() && self.plane.as_ref().is_none_or(|plane| plane.meets(centre, node.half))
    }

    /// Squared distance of a box from the point.
    fn distance2(&self, node: &TreeBox) -> f64 {
        ((node.centre - self.origin).abs() - node.half).max(DVec3::ZERO).length_squared()
    }
}

impl TrianglePlane {
    fn meets(&self, centre: DVec3, half: DVec3) -> bool {
        let reach = |n: DVec3| n.abs().dot(half);
        let (far, limit) = self.far;
        self.normal.dot(centre).abs() <= reach(self.normal)
            && far.dot(centre) - reach(far) <= limit
            && self
                .open
                .iter()
                .any(|[from, to]| from.dot(centre) + reach(*from) >= 0.0 && to.dot(centre) - reach(*to) <= 0.0)
    }
}
