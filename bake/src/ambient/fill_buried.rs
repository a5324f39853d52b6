//! What buried texels show.
//!
//! Nobody sees a texel inside a solid, but a filter at the solid's border reads it: black, it would draw a dark line around
//! every stone that stands in the ground. So a buried texel beside one that can be seen shows what the darkest such
//! neighbour does. The darkest, not the nearest or the mean: where a wall is thinner than a texel, the light before it
//! must not come through to the scratch behind. Texels deeper inside stay 0.

use crate::atlas::PageSize;

/// Which texels are covered, and which of them are buried.
pub(super) struct BuriedTexels {
    size: PageSize,
    texels: Vec<State>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Empty,
    Seen,
    Buried,
}

impl BuriedTexels {
    pub fn new(size: PageSize) -> Self {
        Self { size, texels: vec![State::Empty; size.texel_count()] }
    }

    /// Notes a covered texel.
    pub fn add(&mut self, texel: usize, is_buried: bool) {
        self.texels[texel] = if is_buried { State::Buried } else { State::Seen };
    }

    /// Buried texels that show another, and that other, given how open each is. Charts lie two texels apart at least, so
    /// neighbours that are covered belong to the same.
    pub fn shown_as(&self, open: &[f32]) -> Vec<(usize, usize)> {
        let buried = (0..self.texels.len()).filter(|&texel| self.texels[texel] == State::Buried);
        buried.filter_map(|texel| Some((texel, self.darkest_neighbour(texel, open)?))).collect()
    }

    fn darkest_neighbour(&self, texel: usize, open: &[f32]) -> Option<usize> {
        let (width, height) = (self.size.width as usize, self.size.height as usize);
        let (x, y) = (texel % width, texel / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let around = rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x));
        around.filter(|&t| self.texels[t] == State::Seen).min_by(|&a, &b| open[a].total_cmp(&open[b]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buried_texels_show_their_darkest_seen_neighbour_and_deeper_ones_nothing() {
        let size = PageSize { width: 6, height: 1 };
        let mut buried_texels = BuriedTexels::new(size);
        for (texel, is_buried) in [(0, false), (1, true), (2, true), (3, true), (4, false)] {
            buried_texels.add(texel, is_buried);
        }
        assert_eq!(buried_texels.shown_as(&[0.9, 0.0, 0.0, 0.0, 0.3, 1.0]), [(1, 0), (3, 4)]);
        let mut thin = BuriedTexels::new(size);
        [(0, false), (1, true), (2, false)].iter().for_each(|&(texel, is_buried)| thin.add(texel, is_buried));
        assert_eq!(thin.shown_as(&[0.9, 0.0, 0.2, 1.0, 1.0, 1.0]), [(1, 2)], "light would come through the wall");
    }
}
