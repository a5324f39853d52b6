//! The walk of the hierarchy: near boxes first, skipping what cannot occlude anything still lit, until nothing is lit.

use super::boxes::{BoxFrames, LitSpans, leaf_met, node_met};
use super::cover::{GapCloser, Query};
use super::solve::{SIMD_WIDTH, TriangleBatch};
use crate::trace::bvh16::{Bvh16, Child, WIDTH, bits, push_far_first};
use crate::visibility::Work;
use fearless_simd::Simd;

/// A child that is still to be visited.
#[derive(Debug, Clone, Copy)]
struct Pending {
    child: Child,
    /// Least squared distance from the axis.
    near2: f32,
}

/// A walk from one point. Its memory is reused for the next point.
#[derive(Default)]
pub(super) struct Walk {
    lit: LitSpans,
    pub work: Work,
    stack: Vec<Pending>,
    /// Triangles to be solved together: solid ones, and alpha-masked ones.
    collected: [TriangleBatch; 2],
}

impl Walk {
    /// Closes the query's gaps with the triangles of the hierarchy. Stops when no gap is left.
    pub fn close<S: Simd>(
        &mut self,
        simd: S,
        bvh: &Bvh16,
        frames: &BoxFrames,
        closer: &mut GapCloser,
        query: &mut Query,
    ) {
        self.lit.start(frames, query);
        self.collected.iter_mut().for_each(|batch| batch.count = 0);
        self.stack.clear();
        self.stack.push(Pending { child: Child::ROOT, near2: 0.0 });
        let mut near2 = [0.0; WIDTH];
        while let Some(pending) = self.stack.pop() {
            self.work.nodes += 1;
            match pending.child {
                Child::Node(node) => {
                    let node = &bvh.nodes[node as usize];
                    let first = self.stack.len();
                    for child in bits(node_met(simd, node, &self.lit, &mut near2)) {
                        let pending = Pending { child: node.child[child], near2: near2[child] };
                        push_far_first(&mut self.stack, first, pending, |pending| pending.near2);
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &bvh.leaves[leaf as usize];
                    for triangle in bits(leaf_met(simd, leaf, &self.lit)) {
                        self.take(simd, leaf.ids[triangle], closer, query);
                    }
                    if query.is_done() {
                        return;
                    }
                }
            }
        }
        for batch in self.collected.iter_mut().filter(|batch| batch.count > 0) {
            closer.rotate_and_close(simd, batch, query);
        }
    }

    /// Collects a triangle, and solves the collected ones once there are eight.
    #[inline]
    fn take<S: Simd>(&mut self, simd: S, id: u32, closer: &mut GapCloser, query: &mut Query) {
        self.work.triangles += 1;
        let batch = &mut self.collected[usize::from(closer.tracer.has_alpha_mask(id))];
        batch.push_unrotated(id, &closer.tracer.corners()[id as usize]);
        if batch.count == SIMD_WIDTH {
            let closed = closer.rotate_and_close(simd, batch, query);
            batch.count = 0;
            if closed {
                self.lit.update(query);
            }
        }
    }
}
