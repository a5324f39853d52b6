//! Packs the charts of one mesh, once for all its instances.
//!
//! Theory: all instances of a mesh use the same layout, each in its own rectangle and at its own scale. The space
//! between charts scales with the rectangle, so the layout must be padded for the smallest instance.
//!
//! Practice: if scales differ widely, padding for the smallest instance wastes most of the largest rectangle; then it
//! is cheaper to enlarge the small instances' rectangles. [`reference_scale`] finds the cheapest choice.

use super::chart_box::{BoxedChart, ChartShape, Gutters, chart_shapes};
use super::strip::{self, PackShape, Packed, PackedPosition};
use super::unwrap::Charts;
use glam::DVec2;

/// A mesh's charts packed into one rectangle.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    /// For each chart, its box, and the position of the shape that it lies in.
    charts: Vec<(BoxedChart, PackedPosition)>,
    /// Size in texels, gutters included, at the reference scale.
    pub size: DVec2,
}

impl Tile {
    /// Packs at `density` texels per unit of object space. `limit_texels` bounds a chart's longer side.
    pub fn new(charts: &Charts, density: f64, limit_texels: f64, gutters: Gutters) -> Self {
        let shapes = chart_shapes(charts, |_| density, limit_texels, gutters);
        let (shapes, contents): (Vec<_>, Vec<_>) =
            shapes.into_iter().map(|ChartShape { shape, charts }| (shape, charts)).unzip();
        let packed = pack_compactly(&shapes);
        let nowhere = (BoxedChart::EMPTY, PackedPosition::default());
        let mut places = vec![nowhere; charts.sizes.len()];
        for (position, contents) in packed.positions.iter().zip(contents) {
            contents.into_iter().for_each(|boxed| places[boxed.chart as usize] = (boxed, *position));
        }
        let size = DVec2::new(f64::from(packed.width), f64::from(packed.height)).max(DVec2::ONE);
        Self { charts: places, size }
    }

    /// Position of a chart's point in the tile, 0 to 1.
    pub fn uv(&self, chart: usize, point: DVec2) -> DVec2 {
        let (boxed, position) = &self.charts[chart];
        let corner = DVec2::new(f64::from(position.x), f64::from(position.y));
        ((corner + boxed.texel(point, position.turns)) / self.size).clamp(DVec2::ZERO, DVec2::ONE)
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

/// The scale that a mesh's layout is made for, and its gutters; smaller instances are enlarged to it. `density` is in
/// texels per metre. Where all instances have that scale, texels stay texels, and charts lie between their centres.
pub(super) fn reference_scale(charts: &Charts, scales: &[f64], density: f64, padding_texels: u32) -> (f64, Gutters) {
    let least = scales.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = scales.iter().copied().fold(0.0, f64::max);
    let gutters = |reference: f64| Gutters { padding_texels, is_pinned: reference >= largest };
    let cost = |reference: f64| {
        let tile: f64 = charts.sizes.iter().map(|&size| gutters(reference).texels(size, density * reference)).sum();
        tile * scales.iter().map(|k| (k.max(reference) / reference).powi(2)).sum::<f64>()
    };
    let halvings = std::iter::successors(Some(largest), |k| Some(k * 0.5)).take_while(|&k| k > least).take(40);
    let candidates = halvings.chain(std::iter::once(least));
    let reference = candidates.min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap_or(1.0);
    (reference, gutters(reference))
}
