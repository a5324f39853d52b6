//! The occluders of the points before, tried first: what hides the sun from a texel mostly hides it from the next.

use super::solve::{Packet, turned};
use super::wide::WIDTH;
use crate::trace::Tracer;
use glam::DMat3;

/// Most packets kept; more are thinned to those of late use.
const MOST_PACKETS: usize = 12;
/// For how many points a packet is kept that closes nothing.
const PATIENCE: u32 = 6;

/// Triangles ready to be solved, in the order in which they are tried.
#[derive(Default)]
pub(super) struct Seeds {
    pub packets: Vec<Packet>,
    /// Numbers the points.
    pub now: u32,
}

impl Seeds {
    /// Adds a triangle.
    pub fn add(&mut self, tracer: &Tracer, arc_from_tracer: &DMat3, id: u32) {
        if self.packets.last().is_none_or(|packet| packet.count == WIDTH) {
            self.packets.push(Packet::default());
        }
        let now = self.now;
        if let Some(packet) = self.packets.last_mut() {
            packet.push(id, tracer.corners()[id as usize].map(|corner| turned(corner, arc_from_tracer)));
            packet.last_use = now;
        }
    }

    /// Goes on to the next point; drops what has been of no use for a while.
    pub fn next_point(&mut self) {
        self.now += 1;
        let now = self.now;
        if self.packets.len() > MOST_PACKETS {
            self.packets.retain(|packet| now - packet.last_use <= PATIENCE);
            self.packets.truncate(MOST_PACKETS);
        }
    }
}
