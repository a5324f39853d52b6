//! The occluders of the points before, tried first: what hides the lamp from a texel mostly hides it from the next.

/// Most triangles kept; more are thinned to those of late use.
const MOST: usize = 64;
/// For how many points a triangle is kept that closes nothing.
const PATIENCE: u32 = 6;

/// Triangles in the order in which they are tried, with the point at which each was last of use.
#[derive(Debug, Default)]
pub(super) struct Seeds {
    triangles: Vec<(u32, u32)>,
    /// Numbers the points.
    now: u32,
}

impl Seeds {
    /// Goes on to the next point; drops what has been of no use for a while.
    pub fn next_point(&mut self) {
        self.now += 1;
        if self.triangles.len() > MOST {
            let now = self.now;
            self.triangles.retain(|(_, last_use)| now - last_use <= PATIENCE);
            self.triangles.truncate(MOST);
        }
    }

    /// Adds a triangle that was of use.
    pub fn add(&mut self, triangle: u32) {
        self.triangles.push((triangle, self.now));
    }

    /// Tries triangles until one says that nothing is left to do. Each tells whether it was of use, and whether it was
    /// the last. Returns how many were tried.
    pub fn try_all(&mut self, mut close: impl FnMut(u32) -> (bool, bool)) -> u64 {
        let mut tried = 0;
        for (triangle, last_use) in &mut self.triangles {
            tried += 1;
            let (is_useful, is_done) = close(*triangle);
            if is_useful {
                *last_use = self.now;
            }
            if is_done {
                break;
            }
        }
        tried
    }
}
