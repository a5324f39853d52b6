//! Free rectangles under the skyline, for small shapes.
//!
//! Theory: Jylänki's waste map ("A Thousand Ways to Pack the Bin", 2010, section 4.3): space below a placed shape that
//! can no longer be reached from above is cut into rectangles, and later shapes are placed there first. A used
//! rectangle is split in two (guillotine split), along the shorter remaining side.
//!
//! Practice: the space under an outline is irregular. Its largest rectangle is kept, then the largest on either side of
//! it, and so on; rectangles too small for any shape still to come are dropped.

/// A free rectangle, in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FreeRect {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl FreeRect {
    fn area(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    fn holds(&self, width: u32, height: u32) -> bool {
        self.width >= width && self.height >= height
    }
}

/// The free rectangles of a strip.
#[derive(Debug)]
pub(super) struct FreeSpace {
    free: Vec<FreeRect>,
    /// Shorter side of the smallest shape, in texels: narrower rectangles are not kept.
    least: u32,
}

/// How many starts and ends of runs are tried when an irregular region is cut.
const CUTS: usize = 48;

impl FreeSpace {
    pub fn new(least: u32) -> Self {
        Self { free: Vec::new(), least }
    }

    /// Places a box into the rectangle that fits it most tightly; `None` if none does. Returns the box's position and
    /// whether it was turned by a quarter.
    pub fn take(&mut self, width: u32, height: u32, may_turn: bool) -> Option<(u32, u32, bool)> {
        let fit = |gap: &FreeRect, (w, h): (u32, u32)| gap.holds(w, h).then(|| (gap.width - w).min(gap.height - h));
        let offers = self.free.iter().enumerate().flat_map(|(index, gap)| {
            let upright = fit(gap, (width, height)).map(|rest| (rest, index, false));
            let turned = if may_turn { fit(gap, (height, width)).map(|rest| (rest, index, true)) } else { None };
            upright.into_iter().chain(turned)
        });
        let (_, index, is_turned) = offers.min()?;
        let gap = self.free.swap_remove(index);
        let (width, height) = if is_turned { (height, width) } else { (width, height) };
        self.split(gap, width, height);
        Some((gap.x, gap.y, is_turned))
    }

    /// Keeps what is left of a rectangle after a box was put into its corner.
    fn split(&mut self, gap: FreeRect, width: u32, height: u32) {
        let (beside, above) = (gap.width - width, gap.height - height);
        let (right_height, top_width) = if beside < above { (height, gap.width) } else { (gap.height, width) };
        self.keep(FreeRect { x: gap.x + width, y: gap.y, width: beside, height: right_height });
        self.keep(FreeRect { x: gap.x, y: gap.y + height, width: top_width, height: above });
    }

    fn keep(&mut self, gap: FreeRect) {
        if gap.holds(self.least, self.least) {
            self.free.push(gap);
        }
    }

    /// Adds a free region: `columns` gives the free rows, from low to high, of each column from `x` on.
    pub fn add_region(&mut self, x: u32, columns: &[(u32, u32)]) {
        if columns.len() < self.least as usize {
            return;
        }
        let Some((start, end, low, high)) = self.largest(columns) else { return };
        self.keep(FreeRect { x: x + start as u32, y: low, width: (end - start) as u32, height: high - low });
        self.add_region(x, &columns[..start]);
        self.add_region(x + end as u32, &columns[end..]);
    }

    /// The largest rectangle in a region: first and last column (exclusive), low and high row.
    fn largest(&self, columns: &[(u32, u32)]) -> Option<(usize, usize, u32, u32)> {
        let stride = columns.len().div_ceil(CUTS);
        let mut best: Option<(u64, (usize, usize, u32, u32))> = None;
        for start in (0..columns.len()).step_by(stride) {
            let (mut low, mut high) = (0, u32::MAX);
            for (end, part) in columns[start..].chunks(stride).enumerate() {
                low = part.iter().fold(low, |low, c| low.max(c.0));
                high = part.iter().fold(high, |high, c| high.min(c.1));
                if high < low + self.least {
                    break;
                }
                let end = (start + (end + 1) * stride).min(columns.len());
                let gap = FreeRect { x: 0, y: low, width: (end - start) as u32, height: high - low };
                if gap.width >= self.least && best.is_none_or(|(area, _)| gap.area() > area) {
                    best = Some((gap.area(), (start, end, low, high)));
                }
            }
        }
        best.map(|(_, found)| found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_staircase_is_cut_into_rectangles_within_it() {
        let columns: Vec<(u32, u32)> = (0..40).map(|c| (c / 4, 12)).collect();
        let mut gaps = FreeSpace::new(2);
        gaps.add_region(100, &columns);
        assert!(gaps.free.iter().map(|g| g.area()).sum::<u64>() >= 150, "{:?}", gaps.free);
        for gap in &gaps.free {
            for x in gap.x - 100..gap.x - 100 + gap.width {
                assert!(gap.y >= columns[x as usize].0 && gap.y + gap.height <= 12);
            }
        }
    }

    #[test]
    fn a_rectangle_is_filled_without_overlap() {
        let mut gaps = FreeSpace::new(1);
        gaps.add_region(0, &[(0, 10); 10]);
        let mut taken = [[false; 10]; 10];
        let mut count = 0;
        while let Some((x, y, is_turned)) = gaps.take(3, 2, true) {
            let (w, h) = if is_turned { (2, 3) } else { (3, 2) };
            for row in &mut taken[y as usize..(y + h) as usize] {
                for cell in &mut row[x as usize..(x + w) as usize] {
                    assert!(!std::mem::replace(cell, true));
                }
            }
            count += 1;
        }
        assert!(count >= 13, "only {count} of 16");
    }
}
