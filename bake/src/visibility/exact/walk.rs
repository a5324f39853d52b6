//! The walk of the hierarchy: near things first, past whatever cannot hide anything that is still lit, until nothing is.

use super::boxes::{Seen, Wanted, node_seen};
use super::cover::{Coverer, Query};
use super::solve::Packet;
use super::wide::{Child, WIDTH, Wide};
use crate::visibility::Work;
use fearless_simd::Simd;

/// A node that a walk has yet to go to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pending {
    node: u32,
    near: f32,
    span: [f32; 2],
}

/// Room that walks need, kept from one to the next.
#[derive(Default)]
pub(super) struct Room {
    stack: Vec<Pending>,
    /// Triangles to be solved together: solid ones, and those with holes.
    collected: [Packet; 2],
}

/// Closes the query's gaps with whatever lies in the hierarchy. Stops when there is none.
pub(super) fn close_by_walk<S: Simd>(
    simd: S,
    wide: &Wide,
    mut wanted: Wanted,
    coverer: &mut Coverer,
    query: &mut Query,
    Room { stack, collected }: &mut Room,
) -> Work {
    let mut work = Work::default();
    let mut seen = Seen::default();
    collected.iter_mut().for_each(|packet| packet.count = 0);
    stack.clear();
    stack.push(Pending { node: 0, near: 0.0, span: [-3.0, 3.0] });
    while let Some(pending) = stack.pop() {
        if !wanted.wants(pending.span) {
            continue;
        }
        work.nodes += 1;
        let node = &wide.nodes[pending.node as usize];
        node_seen(simd, node, &wanted, &mut seen);
        let first = stack.len();
        for lane in bits(seen.mask) {
            let id = match node.child[lane] {
                Child::Triangle(id) => id,
                Child::Node(node) => {
                    let span = [seen.span[0][lane], seen.span[1][lane]];
                    push_far_first(stack, first, Pending { node, near: seen.near[lane], span });
                    continue;
                }
            };
            work.triangles += 1;
            let packet = &mut collected[usize::from(coverer.tracer.has_holes(id))];
            coverer.add_to(packet, id);
            if packet.count == WIDTH {
                let closed = coverer.close(simd, packet, query);
                packet.count = 0;
                if closed {
                    if query.is_done() {
                        return work;
                    }
                    wanted.want(query);
                }
            }
        }
    }
    for packet in collected {
        coverer.close(simd, packet, query);
    }
    work
}

/// Pushes a node among its siblings, which start at `first`, so that the nearest is last.
#[inline]
fn push_far_first(stack: &mut Vec<Pending>, first: usize, new: Pending) {
    let mut at = stack.len();
    stack.push(new);
    while at > first && stack[at - 1].near < new.near {
        stack[at] = stack[at - 1];
        at -= 1;
    }
    stack[at] = new;
}

/// Numbers of the bits that are set.
pub(super) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        lane
    })
}
