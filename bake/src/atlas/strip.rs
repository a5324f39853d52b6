//! Packs shapes into a strip.
//!
//! Theory: a skyline with profiles. The skyline is the upper outline of all packed shapes, one height per column.
//! Shapes, given by their lower and upper outlines, are placed largest first, each where its top is lowest, in the best
//! of four turns. Space below that can no longer be reached is kept as [`FreeSpace`] for smaller shapes. Based on:
//! Nöll and Stricker, "Efficient Packing of Arbitrarily Shaped Charts for Automatic Texture Atlas Generation", 2011,
//! and Jylänki, "A Thousand Ways to Pack the Bin", 2010, section 4.
//!
//! Practice: most positions are rejected by one column that is too high, and with it all positions that cover the
//! column, so the search skips past it. Small shapes are packed as boxes.

use super::free_space::FreeSpace;
use super::outline::Outline;

/// Narrower gaps are not kept, whatever would fit: there are too many of them.
const LEAST_GAP_TEXELS: u32 = 4;

/// A shape to pack, in texels.
#[derive(Debug, Clone, Default)]
pub(super) struct PackShape {
    pub width: u32,
    pub height: u32,
    /// Whether it may be turned by quarters.
    pub may_turn: bool,
    /// Exact extents; none: the whole box is taken.
    pub outline: Option<Outline>,
}

/// Position of a packed shape, in texels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct PackedPosition {
    pub x: u32,
    pub y: u32,
    /// Quarter turns, from +x towards +y.
    pub turns: u8,
}

/// Positions of all shapes, and the size of their bounding box in texels.
#[derive(Debug, Clone, Default)]
pub(super) struct Packed {
    pub positions: Vec<PackedPosition>,
    pub width: u32,
    pub height: u32,
}

impl PackShape {
    /// A shape without gaps, in texels.
    pub fn rectangle(width: u32, height: u32, may_turn: bool) -> Self {
        Self { width, height, may_turn, outline: None }
    }

    /// Approximate area in texels.
    pub fn area(&self) -> f64 {
        let full = f64::from(self.width) * f64::from(self.height);
        self.outline.as_ref().map_or(full, |outline| outline.area())
    }

    fn turns(&self) -> std::ops::Range<u8> {
        match (&self.outline, self.may_turn) {
            (_, false) => 0..1,
            (None, true) if self.width == self.height => 0..1,
            (None, true) => 0..2,
            (Some(_), true) => 0..4,
        }
    }
}

/// A shape after some quarter turns: for each column, its rows as a half-open range.
struct TurnedShape {
    width: u32,
    height: u32,
    columns: Option<Vec<(u16, u16)>>,
}

impl TurnedShape {
    fn new(shape: &PackShape, turns: u8) -> Self {
        let (width, height) =
            if turns.is_multiple_of(2) { (shape.width, shape.height) } else { (shape.height, shape.width) };
        Self { width, height, columns: shape.outline.as_ref().map(|outline| outline.columns(turns)) }
    }

    fn bottom(&self, column: u32) -> u32 {
        self.columns.as_ref().map_or(0, |columns| u32::from(columns[column as usize].0))
    }

    fn top(&self, column: u32) -> u32 {
        self.columns.as_ref().map_or(self.height, |columns| u32::from(columns[column as usize].1))
    }

    /// The lowest position on the skyline at which the shape's top is below `limit`; the leftmost of equally low ones.
    fn lowest(&self, skyline: &[u32], mut limit: u32) -> Option<(u32, u32)> {
        let deepest = (0..self.width).map(|c| self.bottom(c)).max().unwrap_or(0);
        let mut best = None;
        let mut x = 0;
        'positions: while x + self.width <= skyline.len() as u32 {
            let mut y = 0;
            for column in (0..self.width).rev() {
                let high = skyline[(x + column) as usize];
                let rest = high.saturating_sub(self.bottom(column));
                if rest + self.height >= limit {
                    let fails_everywhere = high.saturating_sub(deepest) + self.height >= limit;
                    x += if fails_everywhere { column + 1 } else { 1 };
                    continue 'positions;
                }
                y = y.max(rest);
            }
            best = Some((x, y));
            limit = y + self.height;
            x += 1;
        }
        best
    }

    /// Puts the shape on the skyline; the free space below it is added to `gaps`.
    fn raise(&self, skyline: &mut [u32], gaps: &mut FreeSpace, x: u32, y: u32) {
        let under = &mut skyline[x as usize..][..self.width as usize];
        let free: Vec<_> = (0..).zip(under.iter()).map(|(column, &high)| (high, y + self.bottom(column))).collect();
        gaps.add_region(x, &free);
        for (column, high) in (0..).zip(under) {
            *high = (*high).max(y + self.top(column));
        }
    }
}

/// Packs into a strip of the given width; `None` if that needs more than `height`.
pub(super) fn pack(shapes: &[PackShape], width: u32, height: u32) -> Option<Packed> {
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by_key(|&i| {
        let shape = &shapes[i];
        (std::cmp::Reverse((shape.width.max(shape.height), shape.width.min(shape.height))), i)
    });
    let mut skyline = vec![0; width as usize];
    let least = shapes.iter().map(|s| s.width.min(s.height)).min().unwrap_or(1);
    let mut gaps = FreeSpace::new(least.max(LEAST_GAP_TEXELS));
    let mut packed = Packed { positions: vec![PackedPosition::default(); shapes.len()], ..Packed::default() };
    for index in order {
        let PackShape { width: across, height: along, may_turn, .. } = shapes[index];
        if let Some((x, y, is_turned)) = gaps.take(across, along, may_turn) {
            packed.positions[index] = PackedPosition { x, y, turns: u8::from(is_turned) };
            continue;
        }
        let mut best: Option<(PackedPosition, TurnedShape)> = None;
        for turns in shapes[index].turns() {
            let turned = TurnedShape::new(&shapes[index], turns);
            let limit = best.as_ref().map_or(height + 1, |(position, best)| position.y + best.height);
            if let Some((x, y)) = turned.lowest(&skyline, limit) {
                best = Some((PackedPosition { x, y, turns }, turned));
            }
        }
        let (position, turned) = best?;
        turned.raise(&mut skyline, &mut gaps, position.x, position.y);
        packed.positions[index] = position;
        packed.width = packed.width.max(position.x + turned.width);
        packed.height = packed.height.max(position.y + turned.height);
    }
    Some(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: u32) -> Vec<PackShape> {
        let mut state = 1u32;
        let mut next = |limit: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            1 + (state >> 16) % limit
        };
        (0..count).map(|i| PackShape::rectangle(next(40), next(25), i % 3 > 0)).collect()
    }

    #[test]
    fn packed_rectangles_lie_in_the_strip_and_do_not_overlap() {
        let shapes = scattered(700);
        let packed = pack(&shapes, 500, 10_000).unwrap();
        let mut taken = vec![false; 500 * packed.height as usize];
        for (r, s) in shapes.iter().zip(&packed.positions) {
            assert!(r.may_turn || s.turns == 0);
            let (w, h) = if s.turns == 1 { (r.height, r.width) } else { (r.width, r.height) };
            for y in s.y..s.y + h {
                for x in s.x..s.x + w {
                    assert!(x < 500 && !std::mem::replace(&mut taken[(y * 500 + x) as usize], true));
                }
            }
        }
        let fill = taken.iter().filter(|&&t| t).count() as f64 / taken.len() as f64;
        assert!(fill > 0.9, "only {fill:.3} of the strip is used");
    }

    #[test]
    fn too_much_for_the_strip_is_refused() {
        let fixed = PackShape::rectangle(10, 4, false);
        assert!(pack(std::slice::from_ref(&fixed), 9, 100).is_none());
        assert!(pack(&[PackShape { may_turn: true, ..fixed.clone() }], 9, 100).is_some());
        let six = vec![fixed; 6];
        assert!(pack(&six, 20, 11).is_none());
        assert!(pack(&six, 20, 12).is_some());
    }
}
