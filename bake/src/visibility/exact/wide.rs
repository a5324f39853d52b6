//! An eight-wide hierarchy down to single triangles: eight boxes a node, each side of all eight in one vector.
//!
//! Made from a binary hierarchy by opening, for each node, the largest of its descendants until there are eight (the
//! usual collapse; Wald, Benthin and Boulos, "Getting rid of packets", 2008). Boxes are held as centres and half sizes,
//! since those turn into another frame at the cost of two products of a matrix.
//!
//! There are no leaves of several triangles: to test eight boxes takes a quarter of the time of solving eight triangles, so
//! each triangle has its own box, and those that pass are solved together, wherever in the hierarchy they were met.

use crate::trace::{BinaryNode, Tracer};
use glam::{DMat3, Vec3};

/// Lanes of a node.
pub(super) const WIDTH: usize = 8;

/// The hierarchy. Boxes are along axes of the caller's choice. The first node is the root; there is none without triangles.
pub(super) struct Wide {
    pub nodes: Vec<Node>,
}

/// Up to eight boxes. Lanes from `count` on are not to be used.
pub(super) struct Node {
    pub centre: [[f32; WIDTH]; 3],
    pub half: [[f32; WIDTH]; 3],
    pub child: [Child; WIDTH],
    pub count: usize,
}

/// What is in a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Child {
    /// An index among the nodes.
    Node(u32),
    /// An index among the tracer's triangles.
    Triangle(u32),
}

impl Wide {
    /// Builds over every triangle of the tracer, with boxes along the rows of `box_from_tracer`, each grown by `padding`.
    pub fn new(tracer: &Tracer, box_from_tracer: DMat3, padding: f32) -> Self {
        let bounds = |triangle: &[Vec3; 3]| {
            let [a, b, c] = triangle.map(|v| (box_from_tracer * v.as_dvec3()).as_vec3());
            [a.min(b).min(c) - padding, a.max(b).max(c) + padding]
        };
        let boxes: Vec<[Vec3; 2]> = tracer.corners().iter().map(bounds).collect();
        let (tree, order) = crate::trace::binary_hierarchy(&boxes);
        let mut wide = Self { nodes: Vec::new() };
        wide.collapse(&tree, &order);
        wide
    }

    /// Makes wide nodes of binary ones, parents before children.
    fn collapse(&mut self, tree: &[BinaryNode], order: &[u32]) {
        let mut pending = Vec::new();
        if !tree.is_empty() {
            pending.push((0, None::<(usize, usize)>));
        }
        while let Some((binary, parent)) = pending.pop() {
            let index = self.nodes.len();
            if let Some((parent, lane)) = parent {
                self.nodes[parent].child[lane] = Child::Node(index as u32);
            }
            let members = open(tree, binary);
            let mut node = Node {
                centre: [[0.0; WIDTH]; 3],
                half: [[0.0; WIDTH]; 3],
                child: [Child::Triangle(0); WIDTH],
                count: members.len(),
            };
            for (lane, &member) in members.iter().enumerate() {
                let BinaryNode { bounds: [low, high], count, first } = tree[member as usize];
                for k in 0..3 {
                    node.centre[k][lane] = 0.5 * (low[k] + high[k]);
                    node.half[k][lane] = 0.5 * (high[k] - low[k]);
                }
                match count {
                    0 => pending.push((member, Some((index, lane)))),
                    _ => node.child[lane] = Child::Triangle(order[first as usize]),
                }
            }
            self.nodes.push(node);
        }
    }
}

/// Up to eight descendants that cover a node: the largest are opened first.
fn open(tree: &[BinaryNode], binary: u32) -> Vec<u32> {
    let mut members = vec![binary];
    while members.len() < WIDTH {
        let area = |member: u32| {
            let [low, high] = tree[member as usize].bounds;
            let size = high - low;
            size.x * size.y + size.y * size.z + size.z * size.x
        };
        let inner = members.iter().copied().filter(|&member| tree[member as usize].count == 0);
        let Some(largest) = inner.max_by(|&a, &b| area(a).total_cmp(&area(b))) else { break };
        let first = tree[largest as usize].first;
        members.retain(|&member| member != largest);
        members.extend([first, first + 1]);
    }
    members
}
