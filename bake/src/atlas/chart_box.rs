//! A chart at some density: the texels that hold it, and how its points map to them.
//!
//! Theory: a filter of two by two texels reads, beside the texels that a chart covers, some around them: the gutter.
//! But on a line through the centres of a row of texels it reads that row alone. So charts are stretched to a whole
//! number of texels and lie between the centres of their outermost rows and columns: no filter reads beyond these. A
//! chart that fits into half a texel is drawn together into its centre, and one that is half a texel wide to the middle
//! of a row. An atlas may have ten thousands of them, each of which would take 25 texels with gutters of two.
//!
//! Practice: narrow charts are drawn together to [`DRAWN_TEXELS`] rather than to a point, so that triangles keep areas,
//! sides and an order; other texels then count by less than that. Those wider than half a texel are not, although one
//! texel would have room for them: where a strip is nailed to the middle of a board, the middle is dark and both edges
//! are not. Charts end a little within the centres, more on one side than on the other ([`INSETS_TEXELS`]). Wider
//! gutters are for mip levels, which small charts do not survive: with what a filter reads, a gutter is no wider than
//! an eighth of its chart's shorter side.

use super::outline::Outline;
use super::strip::PackShape;
use super::unwrap::Charts;
use glam::DVec2;

/// Charts narrower than this have no outline: they are packed as boxes.
const LEAST_OUTLINED_TEXELS: u32 = 8;
/// Width in texels up to which a chart is drawn together.
const NARROW_TEXELS: f64 = 0.5;
/// Width in texels of what is drawn together: 16 steps of an `f32` coordinate on a page of 4096.
const DRAWN_TEXELS: f64 = 1.0 / 256.0;
/// How far within the centres of its first and last texels a chart ends. Without, a row of texels has its centres
/// exactly in the plane of a wall that stands in the middle of a floor. Of two equal insets the middle would stay
/// where it is, of one and two a third: so they are in the golden ratio.
const INSETS_TEXELS: [f64; 2] = [0.0155, 0.0251];
/// Edge of a block of charts that take one texel each.
const BLOCK_EDGE: usize = 16;
/// The least multiple of its gutter that a chart's shorter side has, where the gutter is wider than a texel.
const SIDES_PER_GUTTER: u32 = 8;

/// Whether a triangle, given by its corners in texels of its page, is of a chart that was drawn together, and so its
/// area says nothing of its density. (Or it is a sliver, whose area says nothing either.)
pub(crate) fn is_drawn_together([a, b, c]: &[DVec2; 3]) -> bool {
    (a.max(*b).max(*c) - a.min(*b).min(*c)).min_element() < 2.0 * DRAWN_TEXELS
}

/// Which gutters charts get.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gutters {
    /// Width in texels on every side of a large chart.
    pub padding_texels: u32,
    /// Whether charts lie between centres of texels: not where texels are scaled afterwards.
    pub is_pinned: bool,
}

impl Gutters {
    /// Width in texels around a chart whose shorter side has so many texels.
    fn around(self, shorter_texels: u32) -> u32 {
        self.padding_texels.min(shorter_texels / SIDES_PER_GUTTER).max(1)
    }

    /// Texels that a chart of this size takes at a density, about.
    pub fn texels(self, size: DVec2, density: f64) -> f64 {
        let ChartBox { cells, gutter, .. } = ChartBox::new(size, density, f64::from(u16::MAX), self);
        let [width, height] = [cells.0, cells.1].map(|side| f64::from(side + 2 * gutter));
        width * height
    }
}

/// A chart at some density: its content box in whole texels.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChartBox {
    /// Texels per unit of object space; lower than requested if the chart would not fit a page.
    pub density: f64,
    /// Whole texels that hold the chart.
    pub cells: (u32, u32),
    /// Width of the gutter around them.
    pub gutter: u32,
    is_pinned: bool,
    /// Texels per unit of object space along either side: less than the density where it is drawn together.
    scale: DVec2,
    /// Where the chart's corner lies in its texels.
    slack: DVec2,
}

impl ChartBox {
    const EMPTY: Self =
        Self { density: 0.0, cells: (1, 1), gutter: 0, is_pinned: false, scale: DVec2::ZERO, slack: DVec2::ZERO };

    pub fn new(size: DVec2, density: f64, limit_texels: f64, gutters: Gutters) -> Self {
        let longest = size.max_element() * density;
        let density = if longest > limit_texels { density * limit_texels / longest } else { density };
        let texels = size * density;
        let most = limit_texels.ceil();
        let side = |texels: f64| match gutters.is_pinned {
            true if texels <= NARROW_TEXELS => {
                let drawn = texels.min(DRAWN_TEXELS);
                (1.0, drawn, 0.5 - 0.5 * drawn)
            }
            true => {
                let steps = texels.round().max(1.0).min(most);
                (steps + 1.0, steps - INSETS_TEXELS.iter().sum::<f64>(), 0.5 + INSETS_TEXELS[0])
            }
            false => {
                let cells = (texels - 1e-6).ceil().max(1.0).min(most);
                (cells, texels, 0.5 * (cells - texels))
            }
        };
        let sides = texels.to_array().map(side);
        let cells = DVec2::from(sides.map(|(cells, ..)| cells));
        let drawn = DVec2::from(sides.map(|(_, drawn, _)| drawn));
        let gutter = gutters.around(cells.min_element() as u32);
        Self {
            density,
            cells: (cells.x as u32, cells.y as u32),
            gutter: if gutters.is_pinned { gutter - 1 } else { gutter },
            is_pinned: gutters.is_pinned,
            scale: DVec2::from([0, 1].map(|k| if size[k] > 0.0 { drawn[k] / size[k] } else { 0.0 })),
            slack: DVec2::from(sides.map(|(.., slack)| slack)),
        }
    }

    /// The chart's shape with its gutter.
    fn shape(&self, charts: &Charts, chart: usize) -> PackShape {
        let (width, height) = (self.cells.0 + 2 * self.gutter, self.cells.1 + 2 * self.gutter);
        let is_worth_it = self.is_pinned && self.cells.0.min(self.cells.1) >= LEAST_OUTLINED_TEXELS;
        let outline = is_worth_it.then(|| {
            let corners = |t: [u32; 3]| t.map(|v| self.texel(charts.points[v as usize], 0));
            Outline::new(charts.triangles_of(chart).map(corners), self.cells, self.gutter)
        });
        PackShape { width, height, may_turn: true, outline }
    }

    /// Position in texels of a point of the chart, from the corner of the box without its gutter. Turning never
    /// mirrors.
    fn texel(&self, point: DVec2, turns: u8) -> DVec2 {
        let texel = point * self.scale + self.slack;
        let (width, height) = (f64::from(self.cells.0), f64::from(self.cells.1));
        match turns % 4 {
            0 => texel,
            1 => DVec2::new(height - texel.y, texel.x),
            2 => DVec2::new(width - texel.x, height - texel.y),
            _ => DVec2::new(texel.y, width - texel.x),
        }
    }
}

/// A chart within a shape that is packed.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxedChart {
    pub chart: u32,
    pub content: ChartBox,
    /// Where its box without gutter lies in the shape.
    at: (u32, u32),
    /// Quarter turns within the shape.
    turns: u8,
}

impl BoxedChart {
    /// A chart that has no place yet.
    pub const EMPTY: Self = Self { chart: 0, content: ChartBox::EMPTY, at: (0, 0), turns: 0 };

    /// Position in texels of a point of the chart, from the corner of its shape, which is turned by some quarters.
    pub fn texel(&self, point: DVec2, shape_turns: u8) -> DVec2 {
        DVec2::new(f64::from(self.at.0), f64::from(self.at.1)) + self.content.texel(point, self.turns + shape_turns)
    }
}

/// A shape with the charts in it: one, or many that are drawn together.
#[derive(Debug, Clone, Default)]
pub(super) struct ChartShape {
    pub shape: PackShape,
    pub charts: Vec<BoxedChart>,
}

/// The shapes of a mesh's charts, given the texels per unit of object space of each.
pub(super) fn chart_shapes(
    charts: &Charts,
    density: impl Fn(usize) -> f64,
    limit_texels: f64,
    gutters: Gutters,
) -> Vec<ChartShape> {
    let mut shapes = Vec::new();
    let (mut points, mut rows) = (Vec::new(), Vec::new());
    for (chart, &size) in charts.sizes.iter().enumerate() {
        let content = ChartBox::new(size, density(chart), limit_texels, gutters);
        let boxed = BoxedChart { chart: chart as u32, content, at: (content.gutter, content.gutter), turns: 0 };
        match (content.gutter, content.cells) {
            (0, (1, 1)) => points.push(boxed),
            (0, (width, height)) if width.min(height) == 1 => {
                rows.push(BoxedChart { turns: u8::from(height > width), ..boxed });
            }
            _ => shapes.push(ChartShape { shape: content.shape(charts, chart), charts: vec![boxed] }),
        }
    }
    shapes.extend(points.chunks(BLOCK_EDGE * BLOCK_EDGE).map(block_of_points));
    let length = |row: &BoxedChart| row.content.cells.0.max(row.content.cells.1);
    rows.sort_by_key(|row| (std::cmp::Reverse(length(row)), row.chart));
    shapes.extend(rows.chunks(BLOCK_EDGE).map(|rows| {
        let charts = rows.iter().zip(0..).map(|(row, y)| BoxedChart { at: (0, y), ..*row }).collect();
        ChartShape { shape: PackShape::rectangle(length(&rows[0]), rows.len() as u32, false), charts }
    }));
    shapes
}

/// Charts that take one texel each, row by row.
fn block_of_points(points: &[BoxedChart]) -> ChartShape {
    let width = points.len().isqrt().max(1);
    let place = |index: usize| ((index % width) as u32, (index / width) as u32);
    let charts = points.iter().enumerate().map(|(index, point)| BoxedChart { at: place(index), ..*point }).collect();
    let height = points.len().div_ceil(width);
    ChartShape { shape: PackShape::rectangle(width as u32, height as u32, false), charts }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GUTTERS: Gutters = Gutters { padding_texels: 2, is_pinned: true };

    fn boxed(width: f64, height: f64) -> ChartBox {
        ChartBox::new(DVec2::new(width, height), 1.0, 1000.0, GUTTERS)
    }

    #[test]
    fn a_chart_within_half_a_texel_lies_at_its_centre_and_has_no_gutter() {
        for size in [DVec2::new(0.3, 0.5), DVec2::new(0.001, 0.0), DVec2::ZERO] {
            let found = boxed(size.x, size.y);
            assert_eq!((found.cells, found.gutter), ((1, 1), 0));
            for point in [DVec2::ZERO, size, size * 0.3] {
                assert!((found.texel(point, 1) - 0.5).abs().max_element() <= 0.5 * DRAWN_TEXELS);
            }
        }
    }

    #[test]
    fn charts_lie_between_centres_of_their_outermost_texels() {
        for (width, height) in [(0.4, 1.01), (0.4, 999.5), (7.4, 0.9), (1.4, 1.6), (7.3, 250.5), (1000.0, 16.0)] {
            let (size, found) = (DVec2::new(width, height), boxed(width, height));
            for (texels, cells, [low, high]) in [
                (width, found.cells.0, [DVec2::ZERO, size].map(|point| found.texel(point, 0).x)),
                (height, found.cells.1, [DVec2::ZERO, size].map(|point| found.texel(point, 0).y)),
            ] {
                let is_narrow = texels <= 0.5;
                assert_eq!(cells, if is_narrow { 1 } else { texels.round().max(1.0) as u32 + 1 });
                let [first, last] = [low - 0.5, f64::from(cells) - 0.5 - high];
                let off = if is_narrow { [0.0; 2] } else { INSETS_TEXELS };
                let most = if is_narrow { DRAWN_TEXELS } else { 1e-9 };
                let is_there = (first - off[0]).abs() < most && (last - off[1]).abs() < most;
                assert!(is_there, "{width} by {height}: {low} to {high}");
            }
        }
    }

    #[test]
    fn gutters_grow_with_their_charts_up_to_the_padding() {
        for (shorter, expected) in [(1.5, 0), (14.0, 0), (15.0, 1), (300.0, 1)] {
            assert_eq!(boxed(600.0, shorter).gutter, expected, "{shorter}");
        }
        let scaled = ChartBox::new(DVec2::splat(0.5), 1.0, 1000.0, Gutters { is_pinned: false, ..GUTTERS });
        assert_eq!((scaled.cells, scaled.gutter), ((1, 1), 1));
    }
}
