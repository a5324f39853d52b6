//! The walk of the hierarchy: near things first, past whatever cannot hide anything that is still lit, until nothing is.

use super::boxes::{Frames, Wanted, leaf_met, node_met};
use super::cover::{Coverer, Query};
use super::solve::{LANES, Packet};
use crate::trace::bvh16::{Bvh16, Child, WIDTH, bits, push_far_first};
use crate::visibility::Work;
use fearless_simd::Simd;

/// What a walk has yet to go to.
#[derive(Debug, Clone, Copy)]
struct Pending {
    child: Child,
    /// Least squared distance from the axis.
    near2: f32,
}

/// A walk from one point, and the room that it needs, kept from one to the next.
#[derive(Default)]
pub(super) struct Walk {
    wanted: Wanted,
    pub work: Work,
    stack: Vec<Pending>,
    /// Triangles to be solved together: solid ones, and those with holes.
    collected: [Packet; 2],
}

impl Walk {
    /// Closes the query's gaps with whatever lies in the hierarchy. Stops when there is none.
    pub fn close<S: Simd>(&mut self, simd: S, bvh: &Bvh16, frames: &Frames, coverer: &mut Coverer, query: &mut Query) {
        self.wanted.look_from(frames, query);
        self.collected.iter_mut().for_each(|packet| packet.count = 0);
        self.stack.clear();
        self.stack.push(Pending { child: Child::ROOT, near2: 0.0 });
        let mut near2 = [0.0; WIDTH];
        while let Some(pending) = self.stack.pop() {
            self.work.nodes += 1;
            match pending.child {
                Child::Node(node) => {
                    let node = &bvh.nodes[node as usize];
                    let first = self.stack.len();
                    for lane in bits(node_met(simd, node, &self.wanted, &mut near2)) {
                        let pending = Pending { child: node.child[lane], near2: near2[lane] };
                        push_far_first(&mut self.stack, first, pending, |pending| pending.near2);
                    }
                }
                Child::Leaf(leaf) => {
                    let leaf = &bvh.leaves[leaf as usize];
                    for lane in bits(leaf_met(simd, leaf, &self.wanted)) {
                        self.take(simd, leaf.ids[lane], coverer, query);
                    }
                    if query.is_done() {
                        return;
                    }
                }
            }
        }
        for packet in self.collected.iter_mut().filter(|packet| packet.count > 0) {
            coverer.turn_and_close(simd, packet, query);
        }
    }

    /// Takes a triangle, and solves those taken once there are enough.
    #[inline]
    fn take<S: Simd>(&mut self, simd: S, id: u32, coverer: &mut Coverer, query: &mut Query) {
        self.work.triangles += 1;
        let packet = &mut self.collected[usize::from(coverer.tracer.has_alpha_mask(id))];
        packet.push_unturned(id, &coverer.tracer.corners()[id as usize]);
        if packet.count == LANES {
            let closed = coverer.turn_and_close(simd, packet, query);
            packet.count = 0;
            if closed {
                self.wanted.want(query);
            }
        }
    }
}
