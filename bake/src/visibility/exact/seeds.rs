//! The occluders of the previous point, tested first: what occludes the sun at a texel mostly occludes it at the next.

use super::solve::{LANES, Packet};
use glam::DVec3;

/// Most packets kept from one point for the next.
const MOST_PACKETS: usize = 16;

/// Triangles in packets, in the order in which they closed gaps.
#[derive(Default)]
pub(super) struct SeedPackets {
    packets: Vec<Packet>,
    count: usize,
}

impl SeedPackets {
    /// Adds a triangle, given by its corners in the arc's frame; beyond [`MOST_PACKETS`] packets, triangles are
    /// dropped.
    pub fn add(&mut self, id: u32, corners: [DVec3; 3]) {
        let is_full = self.packets[..self.count].last().is_none_or(|packet| packet.count == LANES);
        if is_full && self.count == MOST_PACKETS {
            return;
        }
        if is_full {
            if self.packets.len() == self.count {
                self.packets.push(Packet::default());
            }
            self.packets[self.count].count = 0;
            self.count += 1;
        }
        self.packets[self.count - 1].push(id, corners);
    }

    /// Removes all of them.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// The triangles.
    pub fn packets(&self) -> &[Packet] {
        &self.packets[..self.count]
    }
}
