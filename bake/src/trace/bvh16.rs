//! A 16-wide BVH: sixteen boxes per node, sixteen triangles per leaf, stored as structures of arrays for SIMD.
//!
//! Built by collapsing a binary hierarchy: each node is replaced by its descendants, opening the largest first, until
//! there are sixteen (Wald, Benthin and Boulos, "Getting rid of packets", 2008). Descendants with at most sixteen
//! triangles become leaves. Boxes are stored as centres and half sizes, since these can be rotated into another frame
//! with two matrix products. Leaves store corners, rounded to `f32`, which reject far more triangles than boxes do.

use super::{BinaryNode, Tracer};
use glam::{DMat3, Vec3};

/// Most boxes in a node, and most triangles in a leaf.
pub(crate) const WIDTH: usize = 16;

/// Sixteen points, by axis and index.
pub(crate) type Points = [[f32; WIDTH]; 3];

/// The hierarchy, with boxes along axes chosen by the caller. The first node is the root; empty if there are no
/// triangles.
pub(crate) struct Bvh16 {
    pub nodes: Vec<Bvh16Node>,
    pub leaves: Vec<Bvh16Leaf>,
}

/// Up to sixteen boxes. Those from `count` on are invalid.
#[derive(Default)]
pub(crate) struct Bvh16Node {
    pub centre: Points,
    pub half: Points,
    pub child: [Child; WIDTH],
    pub count: usize,
}

/// Up to sixteen triangles. Those from `count` on are invalid.
#[derive(Default)]
pub(crate) struct Bvh16Leaf {
    pub corners: [Points; 3],
    /// Indices in [`Tracer::corners`].
    pub ids: [u32; WIDTH],
    pub count: usize,
}

/// The content of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Child {
    /// An index among the nodes.
    Node(u32),
    /// An index among the leaves.
    Leaf(u32),
}

impl Child {
    /// Start of every traversal.
    pub const ROOT: Self = Self::Node(0);
}

impl Default for Child {
    fn default() -> Self {
        Self::ROOT
    }
}

/// Indices of the set bits, ascending.
#[inline(always)]
pub(crate) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let index = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        index
    })
}

/// A bit set of the first `count` bits.
#[inline(always)]
pub(crate) fn first_bits(count: usize) -> u32 {
    (1 << count) - 1
}

/// Pushes an entry among its siblings, which start at `first`, so that the nearest one (by `near`) is on top of the
/// stack.
#[inline(always)]
pub(crate) fn push_far_first<T: Copy>(stack: &mut Vec<T>, first: usize, new: T, near: impl Fn(&T) -> f32) {
    let mut at = stack.len();
    stack.push(new);
    while at > first && near(&stack[at - 1]) < near(&new) {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = new;
}

impl Bvh16 {
    /// Builds over every triangle of the tracer, with boxes along the rows of `box_from_tracer`, each grown by
    /// `padding`.
    pub fn new(tracer: &Tracer, box_from_tracer: DMat3, padding: f32) -> Self {
        let all: Vec<u32> = (0..tracer.corners().len() as u32).collect();
        Self::over(tracer, &all, box_from_tracer, padding)
    }

    /// The same over some of the triangles.
    pub fn over(tracer: &Tracer, ids: &[u32], box_from_tracer: DMat3, padding: f32) -> Self {
        let rotated = |id: u32| tracer.corners()[id as usize].map(|v| (box_from_tracer * v.as_dvec3()).as_vec3());
        let bounds = |&id: &u32| {
            let [a, b, c] = rotated(id);
            [a.min(b).min(c) - padding, a.max(b).max(c) + padding]
        };
        let boxes: Vec<[Vec3; 2]> = ids.iter().map(bounds).collect();
        let (tree, order) = super::binary_hierarchy(&boxes);
        let order: Vec<u32> = order.into_iter().map(|place| ids[place as usize]).collect();
        let mut collapse = Collapse {
            triangles: triangles_below(&tree),
            corners: &rotated,
            tree: &tree,
            order: &order,
            bvh: Self { nodes: Vec::new(), leaves: Vec::new() },
        };
        collapse.run();
        collapse.bvh
    }
}

/// Number of triangles below each node of a binary hierarchy.
fn triangles_below(tree: &[BinaryNode]) -> Vec<u32> {
    let mut below: Vec<u32> = tree.iter().map(|node| node.count).collect();
    let mut order = Vec::new();
    let mut pending = if tree.is_empty() { vec![] } else { vec![0] };
    while let Some(index) = pending.pop() {
        let node = &tree[index as usize];
        if node.count == 0 {
            order.push(index as usize);
            pending.extend([node.first, node.first + 1]);
        }
    }
    for index in order.into_iter().rev() {
        let first = tree[index].first as usize;
        below[index] = below[first] + below[first + 1];
    }
    below
}

/// State of the collapse.
struct Collapse<'a> {
    tree: &'a [BinaryNode],
    order: &'a [u32],
    triangles: Vec<u32>,
    corners: &'a dyn Fn(u32) -> [Vec3; 3],
    bvh: Bvh16,
}

impl Collapse<'_> {
    /// Collapses all nodes, parents before children.
    fn run(&mut self) {
        let mut pending = Vec::new();
        if !self.tree.is_empty() {
            pending.push((0, None::<(usize, usize)>));
        }
        while let Some((binary, parent)) = pending.pop() {
            let index = self.bvh.nodes.len();
            if let Some((parent, child)) = parent {
                self.bvh.nodes[parent].child[child] = Child::Node(index as u32);
            }
            let members = self.open(binary);
            let mut node = Bvh16Node { count: members.len(), ..Bvh16Node::default() };
            for (child, &member) in members.iter().enumerate() {
                let BinaryNode { bounds: [low, high], .. } = self.tree[member as usize];
                for k in 0..3 {
                    node.centre[k][child] = 0.5 * (low[k] + high[k]);
                    node.half[k][child] = 0.5 * (high[k] - low[k]);
                }
                match self.is_leaf(member) {
                    true => node.child[child] = self.leaf(member),
                    false => pending.push((member, Some((index, child)))),
                }
            }
            self.bvh.nodes.push(node);
        }
    }

    fn is_leaf(&self, member: u32) -> bool {
        self.triangles[member as usize] as usize <= WIDTH
    }

    /// Makes a leaf of all triangles below a binary node.
    fn leaf(&mut self, member: u32) -> Child {
        let mut leaf = Bvh16Leaf::default();
        let mut pending = vec![member];
        while let Some(member) = pending.pop() {
            let BinaryNode { count, first, .. } = self.tree[member as usize];
            if count == 0 {
                pending.extend([first + 1, first]);
                continue;
            }
            for &id in &self.order[first as usize..][..count as usize] {
                for (points, corner) in leaf.corners.iter_mut().zip((self.corners)(id)) {
                    (0..3).for_each(|k| points[k][leaf.count] = corner[k]);
                }
                leaf.ids[leaf.count] = id;
                leaf.count += 1;
            }
        }
        self.bvh.leaves.push(leaf);
        Child::Leaf(self.bvh.leaves.len() as u32 - 1)
    }

    /// Up to sixteen descendants that together replace a node; the largest are opened first.
    fn open(&self, binary: u32) -> Vec<u32> {
        let mut members = vec![binary];
        while members.len() < WIDTH {
            let area = |member: u32| {
                let [low, high] = self.tree[member as usize].bounds;
                let size = high - low;
                size.x * size.y + size.y * size.z + size.z * size.x
            };
            let inner = members.iter().copied().filter(|&member| !self.is_leaf(member));
            let Some(largest) = inner.max_by(|&a, &b| area(a).total_cmp(&area(b))) else { break };
            let first = self.tree[largest as usize].first;
            members.retain(|&member| member != largest);
            members.extend([first, first + 1]);
        }
        members
    }
}
