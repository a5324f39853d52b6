//! Packs the charts of one mesh, once for all its instances.
//!
//! Theory: all instances of a mesh use the same layout, each in its own rectangle and at its own scale. The space
//! between charts scales with the rectangle, so the layout must be padded for the smallest instance.
//!
//! Practice: if scales differ widely, padding for the smallest instance wastes most of the largest rectangle; then it
//! is cheaper to enlarge the small instances' rectangles. [`reference_scale`] finds the cheapest choice.

use super::outline::Outline;
use super::strip::{self, PackShape, Packed, PackedPosition};
use super::unwrap::Charts;
use glam::DVec2;

/// Narrower charts are packed as boxes.
const LEAST_OUTLINED_TEXELS: u32 = 8;

/// A chart at some density: its content box in whole texels.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChartBox {
    /// Texels per unit of object space; lower than requested if the chart would not fit a page.
    pub density: f64,
    /// Whole texels that hold the chart.
    pub cells: (u32, u32),
    /// Half of the unused space in these texels: charts are centred in their box.
    pub slack: DVec2,
}

impl ChartBox {
    pub fn new(size: DVec2, density: f64, limit_texels: f64) -> Self {
        let longest = size.max_element() * density;
        let density = if longest > limit_texels { density * limit_texels / longest } else { density };
        let cells = (size * density - 1e-6).ceil().max(DVec2::ONE).min(DVec2::splat(limit_texels.ceil()));
        Self { density, cells: (cells.x as u32, cells.y as u32), slack: (cells - size * density) * 0.5 }
    }

    /// The chart's padded shape.
    pub fn shape(&self, charts: &Charts, chart: usize, padding: u32) -> PackShape {
        let (width, height) = (self.cells.0 + 2 * padding, self.cells.1 + 2 * padding);
        let is_worth_it = self.cells.0.min(self.cells.1) >= LEAST_OUTLINED_TEXELS;
        let outline = is_worth_it.then(|| {
            let corners = |t: [u32; 3]| t.map(|v| self.texel(charts.points[v as usize], 0));
            Outline::new(charts.triangles_of(chart).map(corners), self.cells, padding)
        });
        PackShape { width, height, may_turn: true, outline }
    }

    /// Position in texels of a point of the chart, from the corner of the unpadded box. Turning never mirrors.
    pub fn texel(&self, point: DVec2, turns: u8) -> DVec2 {
        let texel = point * self.density + self.slack;
        let (width, height) = (f64::from(self.cells.0), f64::from(self.cells.1));
        match turns % 4 {
            0 => texel,
            1 => DVec2::new(height - texel.y, texel.x),
            2 => DVec2::new(width - texel.x, height - texel.y),
            _ => DVec2::new(texel.y, width - texel.x),
        }
    }
}

/// A mesh's charts packed into one rectangle.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    pub boxes: Vec<ChartBox>,
    pub positions: Vec<PackedPosition>,
    /// Size in texels without the outer padding, at the reference scale.
    pub inner: DVec2,
}

impl Tile {
    /// Packs at `density` texels per unit of object space. `limit_texels` bounds a chart's longer side.
    pub fn new(charts: &Charts, density: f64, padding: u32, limit_texels: f64) -> Self {
        let boxes: Vec<_> = charts.sizes.iter().map(|&size| ChartBox::new(size, density, limit_texels)).collect();
        let shapes: Vec<_> = boxes.iter().enumerate().map(|(chart, b)| b.shape(charts, chart, padding)).collect();
        let packed = pack_compactly(&shapes);
        let pad = f64::from(2 * padding);
        let inner = DVec2::new(f64::from(packed.width) - pad, f64::from(packed.height) - pad).max(DVec2::ONE);
        Self { boxes, positions: packed.positions, inner }
    }

    /// Position of a chart's point in the unpadded tile, 0 to 1.
    pub fn uv(&self, chart: usize, point: DVec2) -> DVec2 {
        let position = self.positions[chart];
        let corner = DVec2::new(f64::from(position.x), f64::from(position.y));
        ((corner + self.boxes[chart].texel(point, position.turns)) / self.inner).clamp(DVec2::ZERO, DVec2::ONE)
    }
}

/// Tries a few widths around the square and keeps the smallest box.
fn pack_compactly(shapes: &[PackShape]) -> Packed {
    let area: f64 = shapes.iter().map(PackShape::area).sum();
    let widest = shapes.iter().map(|s| s.width.max(s.height)).max().unwrap_or(1);
    let tries = [0.9, 1.0, 1.1, 1.2].map(|k| ((area.sqrt() * k).ceil() as u32).max(widest));
    let fits = tries.iter().filter_map(|&width| strip::pack(shapes, width, u32::MAX / 2));
    fits.min_by_key(|packed| u64::from(packed.width) * u64::from(packed.height)).unwrap_or_default()
}

/// The scale that a mesh's layout is padded for; smaller instances are enlarged to it. `density` is in texels per
/// metre.
pub(super) fn reference_scale(charts: &Charts, scales: &[f64], density: f64, padding: u32) -> f64 {
    let least = scales.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = scales.iter().copied().fold(0.0, f64::max);
    let cost = |reference: f64| {
        let padded = |size: &DVec2| {
            let cells = (*size * density * reference).max(DVec2::ONE) + f64::from(2 * padding);
            cells.x * cells.y
        };
        let tile: f64 = charts.sizes.iter().map(padded).sum();
        tile * scales.iter().map(|k| (k.max(reference) / reference).powi(2)).sum::<f64>()
    };
    let halvings = std::iter::successors(Some(largest), |k| Some(k * 0.5)).take_while(|&k| k > least).take(40);
    let candidates = halvings.chain(std::iter::once(least));
    candidates.min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap_or(1.0)
}
