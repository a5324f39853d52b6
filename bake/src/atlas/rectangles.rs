//! Packing rectangles into a strip.
//!
//! Theory: the skyline heuristic. The packed part is kept as its upper outline, a list of steps; a rectangle goes where
//! its far edge comes to lie lowest, largest first. Based on: Jukka Jylänki, "A Thousand Ways to Pack the Bin", 2010,
//! section 4 (skyline, bottom-left).
//!
//! Practice: with charts of a lightmap (hundreds to tens of thousands of boxes, most of them small) this fills 90 to 97 %
//! of the strip in milliseconds, so the search for the best density can afford to pack anew for each guess.

/// A rectangle to pack, in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub width: u32,
    pub height: u32,
    /// Whether it may be packed on its side.
    pub may_turn: bool,
}

/// Where a rectangle went.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Spot {
    pub x: u32,
    pub y: u32,
    /// Width and height are swapped.
    pub is_turned: bool,
}

/// All of the rectangles, and the height of strip that they need.
#[derive(Debug, Clone, Default)]
pub(super) struct Packed {
    pub spots: Vec<Spot>,
    pub height: u32,
}

/// One step of the outline: from `x` to the next step's, the strip is full up to `y`.
#[derive(Debug, Clone, Copy)]
struct Step {
    x: u32,
    y: u32,
}

/// A place for a rectangle: where its far edge would be, and which step it starts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Offer {
    far_edge: u32,
    y: u32,
    step: usize,
    is_turned: bool,
}

struct Skyline {
    width: u32,
    height: u32,
    steps: Vec<Step>,
}

impl Skyline {
    /// The lowest place for a box starting at some step, better than `best`.
    fn offer(&self, (width, height): (u32, u32), is_turned: bool, mut best: Option<Offer>) -> Option<Offer> {
        if width > self.width || height > self.height {
            return best;
        }
        for (index, step) in self.steps.iter().enumerate() {
            if step.x + width > self.width {
                break;
            }
            let limit = best.map_or(self.height + 1, |b| b.far_edge);
            if step.y + height >= limit {
                continue;
            }
            let under = self.steps[index..].iter().take_while(|s| s.x < step.x + width);
            let y = under.map(|s| s.y).max().unwrap_or(0);
            if y + height < limit {
                best = Some(Offer { far_edge: y + height, y, step: index, is_turned });
            }
        }
        best
    }

    /// Raises the outline under a placed box.
    fn raise(&mut self, first: usize, width: u32, y: u32) {
        let x = self.steps[first].x;
        let end = x + width;
        let past = first + self.steps[first..].iter().take_while(|s| s.x < end).count();
        let resumes = self.steps[past - 1].y;
        let ends_on_step = self.steps.get(past).map_or(self.width, |s| s.x) == end;
        let tail = (!ends_on_step).then_some(Step { x: end, y: resumes });
        self.steps.splice(first..past, std::iter::once(Step { x, y }).chain(tail));
        self.merge(first);
    }

    /// Joins steps of equal height around `index`.
    fn merge(&mut self, index: usize) {
        if index + 1 < self.steps.len() && self.steps[index + 1].y == self.steps[index].y {
            self.steps.remove(index + 1);
        }
        if index > 0 && self.steps[index - 1].y == self.steps[index].y {
            self.steps.remove(index);
        }
    }
}

/// Packs into a strip of the given width; `None` if that needs more than `height`.
pub(super) fn pack(rectangles: &[Rectangle], width: u32, height: u32) -> Option<Packed> {
    let mut order: Vec<usize> = (0..rectangles.len()).collect();
    order.sort_by_key(|&i| {
        let r = rectangles[i];
        std::cmp::Reverse((r.width.max(r.height), r.width.min(r.height), std::cmp::Reverse(i)))
    });
    let mut skyline = Skyline { width, height, steps: vec![Step { x: 0, y: 0 }] };
    let mut packed = Packed { spots: vec![Spot::default(); rectangles.len()], height: 0 };
    for index in order {
        let Rectangle { width, height, may_turn } = rectangles[index];
        let mut offer = skyline.offer((width, height), false, None);
        if may_turn && width != height {
            offer = skyline.offer((height, width), true, offer);
        }
        let Offer { far_edge, y, step, is_turned } = offer?;
        packed.spots[index] = Spot { x: skyline.steps[step].x, y, is_turned };
        packed.height = packed.height.max(far_edge);
        skyline.raise(step, if is_turned { height } else { width }, far_edge);
    }
    Some(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: u32) -> Vec<Rectangle> {
        let mut state = 1u32;
        let mut next = |limit: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            1 + (state >> 16) % limit
        };
        (0..count).map(|i| Rectangle { width: next(40), height: next(25), may_turn: i % 3 > 0 }).collect()
    }

    #[test]
    fn packed_rectangles_lie_in_the_strip_and_do_not_overlap() {
        let rectangles = scattered(700);
        let packed = pack(&rectangles, 500, 10_000).unwrap();
        let mut taken = vec![false; 500 * packed.height as usize];
        for (r, s) in rectangles.iter().zip(&packed.spots) {
            assert!(r.may_turn || !s.is_turned);
            let (w, h) = if s.is_turned { (r.height, r.width) } else { (r.width, r.height) };
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
        let one = Rectangle { width: 10, height: 4, may_turn: false };
        assert!(pack(&[one], 9, 100).is_none());
        assert!(pack(&[Rectangle { may_turn: true, ..one }], 9, 100).is_some());
        assert!(pack(&[one; 6], 20, 11).is_none());
        assert!(pack(&[one; 6], 20, 12).is_some());
    }
}
