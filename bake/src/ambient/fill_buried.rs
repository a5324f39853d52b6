//! Values of buried texels.
//!
//! A texel inside a solid is never seen, but a filter at the solid's border reads it. Were it black, there would be a
//! dark line around every stone that stands in the ground. So a buried texel beside a visible one takes the value of
//! its darkest visible neighbour. Not of the nearest, nor the mean: where a wall is thinner than a texel, light from in
//! front of it must not leak into the room behind. Texels deeper inside stay 0.
//!
//! What lies behind a wall ([`crate::atlas::find_walls`]) counts: filters that know walls never read the texel, and for
//! those that do not it is the stone's own face that parts it from the ground outside. (A room without inner faces is a
//! solid here. One sees through its walls from inside.)

use crate::atlas::{Around, PageSize};

/// Which texels are covered, and which of them are buried.
pub(super) struct BuriedTexels {
    size: PageSize,
    texels: Vec<TexelKind>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TexelKind {
    Uncovered,
    Visible,
    Buried,
}

impl BuriedTexels {
    pub fn new(size: PageSize) -> Self {
        Self { size, texels: vec![TexelKind::Uncovered; size.texel_count()] }
    }

    /// Adds a covered texel.
    pub fn add(&mut self, texel: usize, is_buried: bool) {
        self.texels[texel] = if is_buried { TexelKind::Buried } else { TexelKind::Visible };
    }

    /// Buried texels beside a visible one, each with the texel whose value it takes, given the ambient visibility of
    /// all texels and the borders of charts that lie side by side.
    pub fn sources(&self, visibility: &[f32], borders: Option<&[[u8; 2]]>) -> Vec<(usize, usize)> {
        let around = Around::new(self.size, borders);
        let darkest_neighbour = |texel: usize| {
            let visible = around.texels(texel).filter(|&other| self.texels[other] == TexelKind::Visible);
            visible.min_by(|&a, &b| visibility[a].total_cmp(&visibility[b]))
        };
        let buried = (0..self.texels.len()).filter(|&texel| self.texels[texel] == TexelKind::Buried);
        buried.filter_map(|texel| Some((texel, darkest_neighbour(texel)?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::OPEN;

    #[test]
    fn buried_texels_take_their_darkest_visible_neighbour_and_deeper_ones_stay_0() {
        let size = PageSize { width: 6, height: 1 };
        let mut buried_texels = BuriedTexels::new(size);
        for (texel, is_buried) in [(0, false), (1, true), (2, true), (3, true), (4, false)] {
            buried_texels.add(texel, is_buried);
        }
        assert_eq!(buried_texels.sources(&[0.9, 0.0, 0.0, 0.0, 0.3, 1.0], None), [(1, 0), (3, 4)]);
        let mut thin = BuriedTexels::new(size);
        [(0, false), (1, true), (2, false)].iter().for_each(|&(texel, is_buried)| thin.add(texel, is_buried));
        let visibility = [0.9, 0.0, 0.2, 1.0, 1.0, 1.0];
        assert_eq!(thin.sources(&visibility, None), [(1, 2)], "light would come through the wall");
        // Another chart's texel says nothing.
        let mut borders = [[OPEN; 2]; 6];
        borders[1][0] = 0;
        assert_eq!(thin.sources(&visibility, Some(&borders)), [(1, 0)]);
    }
}
