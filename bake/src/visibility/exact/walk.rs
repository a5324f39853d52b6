//! The walk of the hierarchy: near things first, past whatever cannot hide anything that is still lit, until nothing is.

use super::boxes::{Seen, Wanted, node_seen};
use super::cover::{Coverer, Query};
use super::wide::{Child, WIDTH, Wide};
use crate::visibility::Work;
use fearless_simd::Simd;

/// Where a walk has yet to go.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pending {
    child: Child,
    span: [f32; 2],
}

/// Closes the query's gaps with whatever lies in the hierarchy. Stops when there is none.
pub(super) fn close_by_walk<S: Simd>(
    simd: S,
    wide: &Wide,
    mut wanted: Wanted,
    coverer: &mut Coverer,
    query: &mut Query,
    stack: &mut Vec<Pending>,
    work: &mut Work,
) {
    stack.clear();
    stack.push(Pending { child: Child::Node(0), span: [-3.0, 3.0] });
    let mut seen = Seen::default();
    while let Some(pending) = stack.pop() {
        if !wanted.wants(pending.span) {
            continue;
        }
        match pending.child {
            Child::Node(index) => {
                work.nodes += 1;
                let node = &wide.nodes[index as usize];
                node_seen(simd, node, &wanted, &mut seen);
                push_far_first(stack, &node.child, &seen.near, seen.mask, &seen.span);
            }
            Child::Leaf(index) => {
                let leaf = &wide.leaves[index as usize];
                work.triangles += leaf.count as u64;
                if coverer.close_with_leaf(simd, leaf, query) {
                    if query.is_done() {
                        return;
                    }
                    wanted.want(query);
                }
            }
        }
    }
}

/// Pushes the children that were met, nearest last.
fn push_far_first(
    stack: &mut Vec<Pending>,
    children: &[Child; WIDTH],
    near: &[f32; WIDTH],
    mut mask: u32,
    span: &[[f32; WIDTH]; 2],
) {
    let first = stack.len();
    let mut distances = [0.0f32; WIDTH];
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let pending = Pending { child: children[lane], span: [span[0][lane], span[1][lane]] };
        // Insertion sort: there are at most eight.
        let mut at = stack.len() - first;
        stack.push(pending);
        while at > 0 && distances[at - 1] < near[lane] {
            distances[at] = distances[at - 1];
            stack[first + at] = stack[first + at - 1];
            at -= 1;
        }
        distances[at] = near[lane];
        stack[first + at] = pending;
    }
}

/// Numbers of the bits that are set.
pub(super) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        lane
    })
}
