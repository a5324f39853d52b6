//! The texels around a texel that no wall parts from it.

use super::PageSize;
use super::reach::is_open;

/// Tells which texels of a page lie side by side.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    size: PageSize,
    walls: Option<&'a [[u8; 2]]>,
}

impl<'a> Around<'a> {
    /// Of a page with these walls ([`super::find_walls`]); without them, all texels side by side count.
    pub fn new(size: PageSize, walls: Option<&'a [[u8; 2]]>) -> Self {
        Self { size, walls }
    }

    /// The up to eight texels around a texel, row by row, without those behind walls. To a texel diagonal to it the way
    /// leads along the row first.
    pub fn texels(self, texel: usize) -> impl Iterator<Item = usize> + 'a {
        let width = self.size.width as usize;
        let (x, y) = (texel % width, texel / width);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        let rows = y.saturating_sub(1)..(y + 2).min(self.size.height as usize);
        let around = rows.flat_map(move |row| columns.clone().map(move |column| [column, row]));
        let reached = around.filter(move |&to| to != [x, y] && self.reaches([x, y], to));
        reached.map(move |[column, row]| row * width + column)
    }

    fn reaches(self, [x, y]: [usize; 2], [to_x, to_y]: [usize; 2]) -> bool {
        let width = self.size.width as usize;
        let is_open = |texel: usize, way: usize| self.walls.is_none_or(|codes| is_open(codes[texel][way]));
        let level = x == to_x || is_open(y * width + x.min(to_x), 0);
        level && (y == to_y || is_open(y.min(to_y) * width + to_x, 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::OPEN;

    #[test]
    fn texels_behind_walls_are_not_around() {
        let size = PageSize { width: 3, height: 2 };
        let all = |walls: Option<&[[u8; 2]]>, texel| Around::new(size, walls).texels(texel).collect::<Vec<_>>();
        assert_eq!(all(None, 1), [0, 2, 3, 4, 5]);
        assert_eq!(all(None, 5), [1, 2, 4]);
        let mut walls = vec![[OPEN; 2]; 6];
        assert_eq!(all(Some(&walls), 1), all(None, 1));
        // Between the texels 1 and 2, and below 0.
        (walls[1][0], walls[0][1]) = (1, 1);
        assert_eq!(all(Some(&walls), 1), [0, 4], "the ways to 3 and 5 lead through 0 and 2");
        assert_eq!(all(Some(&walls), 4), [1, 2, 3, 5]);
    }
}
