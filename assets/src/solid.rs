//! Solids made of the cells of an uneven grid: buildings with openings, closed and without T-junctions by design.

use glam::{DVec3, dvec3};

use crate::material::Material;
use crate::soup::{Crease, Soup};

/// Planes that cut space into cells, ascending, in metres.
pub(crate) struct Planes {
    pub(crate) x_m: Vec<f64>,
    pub(crate) y_m: Vec<f64>,
    pub(crate) z_m: Vec<f64>,
}

impl Planes {
    fn counts(&self) -> [usize; 3] {
        [self.x_m.len() - 1, self.y_m.len() - 1, self.z_m.len() - 1]
    }

    fn corner(&self, k: [usize; 3]) -> DVec3 {
        dvec3(self.x_m[k[0]], self.y_m[k[1]], self.z_m[k[2]])
    }

    fn middle(&self, k: [usize; 3]) -> DVec3 {
        (self.corner(k) + self.corner(k.map(|v| v + 1))) * 0.5
    }
}

/// An axis-aligned box: its least and its greatest corner, in metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    pub(crate) low_m: DVec3,
    pub(crate) high_m: DVec3,
}

/// A block from the ranges of its x, y and z, in metres.
pub(crate) fn block(x_m: [f64; 2], y_m: [f64; 2], z_m: [f64; 2]) -> Block {
    Block { low_m: dvec3(x_m[0], y_m[0], z_m[0]), high_m: dvec3(x_m[1], y_m[1], z_m[1]) }
}

impl Block {
    pub(crate) fn holds(&self, p_m: DVec3) -> bool {
        p_m.cmpge(self.low_m).all() && p_m.cmple(self.high_m).all()
    }
}

/// `solids` less `holes`.
pub(crate) struct Carved {
    pub(crate) solids: Vec<Block>,
    pub(crate) holes: Vec<Block>,
}

impl Carved {
    fn holds(&self, p_m: DVec3) -> bool {
        let inside = |blocks: &[Block]| blocks.iter().any(|b| b.holds(p_m));
        inside(&self.solids) && !inside(&self.holes)
    }

    /// Cuts at every face of every block; no cell is longer than `longest_m`.
    fn planes(&self, longest_m: f64) -> Planes {
        let blocks = || self.solids.iter().chain(&self.holes);
        let cut = |axis: usize| subdivide(blocks().flat_map(|b| [b.low_m[axis], b.high_m[axis]]).collect(), longest_m);
        Planes { x_m: cut(0), y_m: cut(1), z_m: cut(2) }
    }
}

fn subdivide(mut cuts_m: Vec<f64>, longest_m: f64) -> Vec<f64> {
    cuts_m.sort_by(f64::total_cmp);
    cuts_m.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let mut all = vec![cuts_m[0]];
    for pair in cuts_m.windows(2) {
        let parts = ((pair[1] - pair[0]) / longest_m - 1e-9).ceil().max(1.0);
        all.extend((1..=parts as usize).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts));
    }
    all
}

impl Soup {
    /// The skin of a carved solid. `look` chooses the material from a face's middle (metres) and outward normal.
    pub(crate) fn carved(
        &mut self,
        solid: &Carved,
        longest_m: f64,
        look: impl Fn(DVec3, DVec3) -> Material,
    ) -> &mut Self {
        let planes = solid.planes(longest_m);
        let counts = planes.counts();
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                for k in 0..counts[2] {
                    if solid.holds(planes.middle([i, j, k])) {
                        self.cell_skin(solid, &planes, [i, j, k], &look);
                    }
                }
            }
        }
        self
    }

    fn cell_skin(
        &mut self,
        solid: &Carved,
        planes: &Planes,
        cell: [usize; 3],
        look: &dyn Fn(DVec3, DVec3) -> Material,
    ) {
        for axis in 0..3 {
            for side in 0..2 {
                let on_rim = if side == 0 { cell[axis] == 0 } else { cell[axis] + 1 == planes.counts()[axis] };
                let mut next = cell;
                next[axis] = if side == 0 { cell[axis].wrapping_sub(1) } else { cell[axis] + 1 };
                if on_rim || !solid.holds(planes.middle(next)) {
                    self.cell_face(planes, cell, axis, side, look);
                }
            }
        }
    }

    fn cell_face(
        &mut self,
        planes: &Planes,
        cell: [usize; 3],
        axis: usize,
        side: usize,
        look: &dyn Fn(DVec3, DVec3) -> Material,
    ) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let at = |du: usize, dv: usize| {
            let mut k = cell;
            k[axis] += side;
            k[u] += du;
            k[v] += dv;
            planes.corner(k)
        };
        let mut face = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
        if side == 0 {
            face.reverse();
        }
        let mut normal = DVec3::ZERO;
        normal[axis] = if side == 0 { -1.0 } else { 1.0 };
        let middle = (face[0] + face[2]) * 0.5;
        self.patch(look(middle, normal), Crease::Flat).polygon(&face);
    }
}
