//! The occluders of the point before, tried first: what hides the sun from a texel mostly hides it from the next.

use super::solve::{LANES, Packet};
use glam::DVec3;

/// Most packets kept from one point for the next.
const MOST_PACKETS: usize = 16;

/// Triangles ready to be solved, in the order in which they were of use.
#[derive(Default)]
pub(super) struct Seeds {
    packets: Vec<Packet>,
    count: usize,
}

impl Seeds {
    /// Adds a triangle, given by its corners in the arc's frame; of very many, the last are forgotten.
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

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// The triangles.
    pub fn packets(&self) -> &[Packet] {
        &self.packets[..self.count]
    }
}
