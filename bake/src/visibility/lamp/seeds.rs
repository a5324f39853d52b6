//! The occluders of previous points, tested first: what occludes the lamp at a texel mostly occludes it at the next.

/// Most triangles kept; if there are more, those that closed nothing recently are dropped.
const MOST: usize = 64;
/// For how many points a triangle that closes nothing is kept.
const PATIENCE: u32 = 6;

/// Triangles in the order in which they are tested, with the number of the point at which each last closed anything.
#[derive(Debug, Default)]
pub(super) struct SeedTriangles {
    triangles: Vec<(u32, u32)>,
    /// Number of the current point, from 1.
    now: u32,
}

impl SeedTriangles {
    /// Goes on to the next point; drops triangles that have closed nothing for a while.
    pub fn next_point(&mut self) {
        self.now += 1;
        if self.triangles.len() > MOST {
            let now = self.now;
            self.triangles.retain(|(_, last_use)| now - last_use <= PATIENCE);
            self.triangles.truncate(MOST);
        }
    }

    /// Adds a triangle that closed something.
    pub fn add(&mut self, triangle: u32) {
        self.triangles.push((triangle, self.now));
    }

    /// Calls `close` for each triangle until nothing is left to close. It returns whether the triangle closed anything,
    /// and whether nothing is left. Returns how many triangles were tested.
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
