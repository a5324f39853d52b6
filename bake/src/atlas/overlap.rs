//! Whether triangles overlap in the plane.
//!
//! Theory: the common area of two triangles is that of one clipped by the other (Sutherland and Hodgman, 1974), exact
//! up to rounding at any size. Neighbours with a common edge have no common area.
//!
//! Practice: a grid finds candidate pairs. A pair is tested only in the cell that holds the lower corner of the
//! intersection of their boxes, so only once. Counting stops at the tolerance, so a hundred thousand triangles in one
//! place cost no more than a valid layout.

use glam::DVec2;

/// A triangle in texture coordinates.
pub(super) type Triangle = [DVec2; 3];

/// Twice the signed area.
pub(super) fn area2([a, b, c]: &Triangle) -> f64 {
    (*b - *a).perp_dot(*c - *a)
}

/// Whether the triangles cover more than `tolerance` of their summed area twice.
pub(super) fn overlap_more_than(triangles: &[Triangle], tolerance: f64) -> bool {
    let allowed = triangles.iter().map(|t| area2(t).abs() * 0.5).sum::<f64>() * tolerance;
    let Some(grid) = Grid::new(triangles) else { return false };
    let mut shared = 0.0;
    for (cell, members) in grid.cells.iter().enumerate() {
        for (k, &a) in members.iter().enumerate() {
            for &b in &members[..k] {
                let (a, b) = (&triangles[a as usize], &triangles[b as usize]);
                if grid.is_cell_of_pair(cell, a, b) {
                    shared += shared_area(a, b);
                }
            }
            if shared > allowed {
                return true;
            }
        }
    }
    false
}

fn bounds(t: &Triangle) -> (DVec2, DVec2) {
    (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]))
}

/// Common area of two triangles.
fn shared_area(a: &Triangle, b: &Triangle) -> f64 {
    let turn = area2(b).signum();
    let mut part = a.to_vec();
    for k in 0..3 {
        let (from, to) = (b[k], b[(k + 1) % 3]);
        let normal = (to - from).perp() * turn;
        part = clip(&part, normal, normal.dot(from));
        if part.len() < 3 {
            return 0.0;
        }
    }
    let fan = part[1..].windows(2).map(|w| (w[0] - part[0]).perp_dot(w[1] - part[0]));
    fan.sum::<f64>().abs() * 0.5
}

/// The part of a convex polygon where `normal . p >= offset`.
pub(super) fn clip(polygon: &[DVec2], normal: DVec2, offset: f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (over_a, over_b) = (normal.dot(a) - offset, normal.dot(b) - offset);
        if over_a >= 0.0 {
            kept.push(a);
        }
        if (over_a < 0.0) != (over_b < 0.0) {
            kept.push(a.lerp(b, over_a / (over_a - over_b)));
        }
    }
    kept
}

/// Triangles by the cells that their boxes touch.
struct Grid {
    low: DVec2,
    cells_per_unit: DVec2,
    side: usize,
    cells: Vec<Vec<u32>>,
}

impl Grid {
    fn new(triangles: &[Triangle]) -> Option<Self> {
        let low = triangles.iter().map(|t| bounds(t).0).reduce(DVec2::min)?;
        let high = triangles.iter().map(|t| bounds(t).1).reduce(DVec2::max)?;
        let side = (triangles.len() as f64).sqrt().ceil().clamp(1.0, 1024.0) as usize;
        let cells_per_unit = side as f64 / (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let mut grid = Self { low, cells_per_unit, side, cells: vec![Vec::new(); side * side] };
        for (index, triangle) in triangles.iter().enumerate() {
            let (low, high) = bounds(triangle);
            let ((x0, y0), (x1, y1)) = (grid.cell(low), grid.cell(high));
            for y in y0..=y1 {
                for x in x0..=x1 {
                    grid.cells[y * side + x].push(index as u32);
                }
            }
        }
        Some(grid)
    }

    fn cell(&self, p: DVec2) -> (usize, usize) {
        let cell = ((p - self.low) * self.cells_per_unit).clamp(DVec2::ZERO, DVec2::splat(self.side as f64 - 1.0));
        (cell.x as usize, cell.y as usize)
    }

    /// Whether the boxes intersect and this cell holds the lower corner of their intersection.
    fn is_cell_of_pair(&self, cell: usize, a: &Triangle, b: &Triangle) -> bool {
        let ((low_a, high_a), (low_b, high_b)) = (bounds(a), bounds(b));
        let low = low_a.max(low_b);
        let (x, y) = self.cell(low);
        low.cmplt(high_a.min(high_b)).all() && y * self.side + x == cell
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(ax: f64, ay: f64, bx: f64, by: f64, cx: f64, cy: f64) -> Triangle {
        [DVec2::new(ax, ay), DVec2::new(bx, by), DVec2::new(cx, cy)]
    }

    #[test]
    fn shared_area_is_exact_for_either_winding() {
        let a = triangle(0.0, 0.0, 2.0, 0.0, 0.0, 2.0);
        let b = triangle(0.0, 0.0, 2.0, 0.0, 2.0, 2.0);
        let turned = [b[0], b[2], b[1]];
        for (p, q) in [(a, b), (b, a), (a, turned), (turned, a)] {
            assert!((shared_area(&p, &q) - 1.0).abs() < 1e-12);
        }
        assert_eq!(shared_area(&a, &triangle(2.0, 0.0, 2.0, 2.0, 0.0, 2.0)), 0.0);
    }

    #[test]
    fn a_grid_of_quads_does_not_overlap_and_one_moved_triangle_does() {
        let mut triangles = Vec::new();
        for y in 0..20 {
            for x in 0..20 {
                let (x, y, n) = (f64::from(x) / 20.0, f64::from(y) / 20.0, 1.0 / 20.0);
                triangles.push(triangle(x, y, x + n, y, x + n, y + n));
                triangles.push(triangle(x, y, x + n, y + n, x, y + n));
            }
        }
        assert!(!overlap_more_than(&triangles, 1e-9));
        triangles[37] = triangles[300];
        assert!(overlap_more_than(&triangles, 1e-3));
    }
}
