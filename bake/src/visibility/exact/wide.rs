//! An eight-wide hierarchy: eight boxes a node, up to eight triangles a leaf, each coordinate of all eight in one vector.
//!
//! Made from a binary hierarchy by opening, for each node, the largest of its descendants until there are eight (the
//! usual collapse; Wald, Benthin and Boulos, "Getting rid of packets", 2008). Boxes are held as centres and half sizes,
//! since those turn into another frame at the cost of two products of a matrix.

use crate::trace::{BinaryNode, Tracer};
use glam::{DMat3, Vec3};

/// Lanes of a node and of a leaf.
pub(super) const WIDTH: usize = 8;

/// The hierarchy. Boxes are in axes of the caller's choice, triangles in tracer space.
pub(super) struct Wide {
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
}

/// Up to eight boxes. Lanes from `count` on are not to be used.
pub(super) struct Node {
    pub centre: [[f32; WIDTH]; 3],
    pub half: [[f32; WIDTH]; 3],
    pub child: [Child; WIDTH],
    pub count: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Child {
    Node(u32),
    Leaf(u32),
}

/// Up to eight triangles: their index in the tracer and their corners, tracer space. Lanes from `count` on repeat lane 0.
pub(super) struct Leaf {
    pub ids: [u32; WIDTH],
    pub corners: [[[f32; WIDTH]; 3]; 3],
    pub count: usize,
}

impl Wide {
    /// Builds over every triangle of the tracer, with boxes along the rows of `box_from_tracer`, each grown by `padding`.
    pub fn new(tracer: &Tracer, box_from_tracer: DMat3, padding: f32) -> Self {
        let corners = tracer.corners();
        let boxes: Vec<[Vec3; 2]> = corners
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|v| (box_from_tracer * v.as_dvec3()).as_vec3());
                [a.min(b).min(c) - padding, a.max(b).max(c) + padding]
            })
            .collect();
        let (tree, order) = crate::trace::binary_hierarchy(&boxes);
        let mut wide = Self { nodes: Vec::new(), leaves: Vec::new() };
        if !tree.is_empty() {
            let counts = subtree_counts(&tree);
            Collapse { tree: &tree, order: &order, counts: &counts, corners, wide: &mut wide }.node(0);
        }
        wide
    }
}

/// Triangles under each node.
fn subtree_counts(tree: &[BinaryNode]) -> Vec<u32> {
    let mut counts = vec![0; tree.len()];
    // Depth first, children before parents; no recursion, as trees may be deep.
    let mut stack = vec![(0u32, false)];
    while let Some((index, is_opened)) = stack.pop() {
        let node = &tree[index as usize];
        match (node.count, is_opened) {
            (0, false) => stack.extend([(index, true), (node.first, false), (node.first + 1, false)]),
            (0, true) => counts[index as usize] = counts[node.first as usize] + counts[node.first as usize + 1],
            (count, _) => counts[index as usize] = count,
        }
    }
    counts
}

struct Collapse<'a> {
    tree: &'a [BinaryNode],
    order: &'a [u32],
    counts: &'a [u32],
    corners: &'a [[Vec3; 3]],
    wide: &'a mut Wide,
}

impl Collapse<'_> {
    /// Makes a wide node of a binary one, and its descendants.
    fn node(&mut self, root: u32) -> u32 {
        // (binary node, slot of its parent)
        let mut pending = vec![(root, None::<(u32, usize)>)];
        while let Some((binary, parent)) = pending.pop() {
            let index = self.wide.nodes.len() as u32;
            if let Some((parent, lane)) = parent {
                self.wide.nodes[parent as usize].child[lane] = Child::Node(index);
            }
            let members = self.open(binary);
            let mut node = Node {
                centre: [[0.0; WIDTH]; 3],
                half: [[0.0; WIDTH]; 3],
                child: [Child::Leaf(0); WIDTH],
                count: members.len(),
            };
            for (lane, &member) in members.iter().enumerate() {
                let [low, high] = self.tree[member as usize].bounds;
                for k in 0..3 {
                    node.centre[k][lane] = 0.5 * (low[k] + high[k]);
                    node.half[k][lane] = 0.5 * (high[k] - low[k]);
                }
                if self.is_leaf(member) {
                    node.child[lane] = Child::Leaf(self.leaf(member));
                } else {
                    pending.push((member, Some((index, lane))));
                }
            }
            self.wide.nodes.push(node);
        }
        0
    }

    fn is_leaf(&self, binary: u32) -> bool {
        self.counts[binary as usize] as usize <= WIDTH || self.tree[binary as usize].count > 0
    }

    /// Up to eight descendants that cover a node: the largest are opened first.
    fn open(&self, binary: u32) -> Vec<u32> {
        let mut members = vec![binary];
        while members.len() < WIDTH {
            let area = |&&member: &&u32| {
                let [low, high] = self.tree[member as usize].bounds;
                let size = high - low;
                size.x * size.y + size.y * size.z + size.z * size.x
            };
            let largest = members
                .iter()
                .filter(|&&m| self.tree[m as usize].count == 0 && (m == binary || !self.is_leaf(m)))
                .max_by(|a, b| area(a).total_cmp(&area(b)));
            let Some(&largest) = largest else { break };
            let first = self.tree[largest as usize].first;
            members.retain(|&m| m != largest);
            members.extend([first, first + 1]);
        }
        members
    }

    fn leaf(&mut self, binary: u32) -> u32 {
        let ids = self.triangles(binary);
        let mut leaf = Leaf { ids: [ids[0]; WIDTH], corners: [[[0.0; WIDTH]; 3]; 3], count: ids.len() };
        leaf.ids[..ids.len()].copy_from_slice(&ids);
        for (lane, &id) in leaf.ids.iter().enumerate() {
            for (corner, position) in self.corners[id as usize].iter().enumerate() {
                for k in 0..3 {
                    leaf.corners[corner][k][lane] = position[k];
                }
            }
        }
        self.wide.leaves.push(leaf);
        self.wide.leaves.len() as u32 - 1
    }

    fn triangles(&self, binary: u32) -> Vec<u32> {
        let mut ids = Vec::with_capacity(WIDTH);
        let mut stack = vec![binary];
        while let Some(index) = stack.pop() {
            let node = &self.tree[index as usize];
            match node.count {
                0 => stack.extend([node.first + 1, node.first]),
                count => ids.extend_from_slice(&self.order[node.first as usize..(node.first + count) as usize]),
            }
        }
        ids
    }
}
