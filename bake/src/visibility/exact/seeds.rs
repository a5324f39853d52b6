//! The occluders of the previous point, tested first: what occludes the sun at a texel mostly occludes it at the next.

use super::solve::{SIMD_WIDTH, TriangleBatch};
use glam::DVec3;

/// Most batches kept from one point for the next.
const MOST_BATCHES: usize = 16;

/// Triangles in batches, in the order in which they closed gaps.
#[derive(Default)]
pub(super) struct SeedBatches {
    batches: Vec<TriangleBatch>,
    count: usize,
}

impl SeedBatches {
    /// Adds a triangle, given by its corners in the arc's frame; beyond [`MOST_BATCHES`] batches, triangles are
    /// dropped.
    pub fn add(&mut self, id: u32, corners: [DVec3; 3]) {
        let is_full = self.batches[..self.count].last().is_none_or(|batch| batch.count == SIMD_WIDTH);
        if is_full && self.count == MOST_BATCHES {
            return;
        }
        if is_full {
            if self.batches.len() == self.count {
                self.batches.push(TriangleBatch::default());
            }
            self.batches[self.count].count = 0;
            self.count += 1;
        }
        self.batches[self.count - 1].push(id, corners);
    }

    /// Removes all of them.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Batches in the order in which their triangles closed gaps.
    pub fn batches(&self) -> &[TriangleBatch] {
        &self.batches[..self.count]
    }
}
