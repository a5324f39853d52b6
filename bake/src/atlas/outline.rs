//! The outline of a chart: the extent of each row and column within its bounding box.
//!
//! Practice: the chart is rasterised into its box: the texels that a filter reads at its points. Every row and column
//! keeps the first and last of them, widened by the padding. A row or column of which none is read counts as full.

use super::coverage::{self, TexelTriangle};

/// Extents of a padded chart, as half-open ranges in texels of its padded box.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Outline {
    /// For each column, its rows.
    columns: Vec<(u16, u16)>,
    /// For each row, its columns.
    rows: Vec<(u16, u16)>,
}

/// The empty range: any texel widens it.
const UNTOUCHED: (u16, u16) = (u16::MAX, 0);

impl Outline {
    /// The outline of triangles given in texels of a box of `width` by `height`, which holds all that is read.
    pub fn new(triangles: impl Iterator<Item = TexelTriangle>, (width, height): (u32, u32), padding: u32) -> Self {
        let mut columns = vec![UNTOUCHED; width as usize];
        let mut rows = vec![UNTOUCHED; height as usize];
        for corners in triangles {
            for y in coverage::read_rows(&corners, height) {
                let run = coverage::read_columns(&corners, y, width);
                widen(&mut rows[y as usize], (run.start as u16, run.end as u16));
                for column in &mut columns[run.start as usize..run.end as usize] {
                    widen(column, (y as u16, y as u16 + 1));
                }
            }
        }
        Self { columns: pad(&columns, height, padding), rows: pad(&rows, width, padding) }
    }

    /// Area in texels, counting each column from its first to its last texel.
    pub fn area(&self) -> f64 {
        self.columns.iter().map(|c| f64::from(c.1 - c.0)).sum()
    }

    /// The rows of each column after `turns` quarter turns.
    pub fn columns(&self, turns: u8) -> Vec<(u16, u16)> {
        let (width, height) = (self.columns.len() as u16, self.rows.len() as u16);
        let mirror = |&(low, high): &(u16, u16), side: u16| (side - high, side - low);
        match turns % 4 {
            0 => self.columns.clone(),
            1 => self.rows.iter().rev().copied().collect(),
            2 => self.columns.iter().rev().map(|c| mirror(c, height)).collect(),
            _ => self.rows.iter().map(|r| mirror(r, width)).collect(),
        }
    }
}

fn widen(range: &mut (u16, u16), by: (u16, u16)) {
    *range = (range.0.min(by.0), range.1.max(by.1));
}

/// Widens lines of `length` texels by `padding` in both directions; the padded box is larger by it on every side.
fn pad(lines: &[(u16, u16)], length: u32, padding: u32) -> Vec<(u16, u16)> {
    let around = 2 * padding as usize;
    let padded = |line: usize| {
        let near = &lines[line.saturating_sub(around)..lines.len().min(line + 1)];
        let touched = near.iter().filter(|l| **l != UNTOUCHED).copied();
        let range = touched.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = range.unwrap_or((0, length as u16));
        (low, high + around as u16)
    };
    (0..lines.len() + around).map(padded).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// A triangle in the lower left half of a box of 6 by 3 texels, between the centres of its outermost ones.
    fn wedge(padding: u32) -> Outline {
        let corners = [DVec2::splat(0.5), DVec2::new(5.5, 0.5), DVec2::new(0.5, 2.5)];
        Outline::new(std::iter::once(corners), (6, 3), padding)
    }

    #[test]
    fn outline_follows_the_shape() {
        assert_eq!(wedge(0).columns, [(0, 3), (0, 3), (0, 3), (0, 3), (0, 2), (0, 2)]);
        assert_eq!(wedge(0).rows, [(0, 6), (0, 6), (0, 4)]);
        assert_eq!(wedge(1).rows, [(0, 8), (0, 8), (0, 8), (0, 8), (0, 6)]);
    }

    #[test]
    fn four_quarter_turns_are_none() {
        let wedge = wedge(0);
        assert_eq!(wedge.columns(1), [(0, 4), (0, 6), (0, 6)]);
        assert_eq!(wedge.columns(2), [(1, 3), (1, 3), (0, 3), (0, 3), (0, 3), (0, 3)]);
        assert_eq!(wedge.columns(3), [(0, 6), (0, 6), (2, 6)]);
        assert_eq!(wedge.columns(4), wedge.columns(0));
    }
}
