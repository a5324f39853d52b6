//! Placing charts and tiles on pages.
//!
//! Theory: one density for the whole scene, in texels a metre, so that a shadow's edge is equally sharp everywhere. Given a
//! density, each thing's size in texels is known and pages are packed; given pages instead, the density is found by
//! bisection, packing anew for each guess.
//!
//! Practice:
//! * A mesh under one instance is packed chart by chart among everything else, all of it on one page, because a
//!   [`Placement`] names one page. A mesh under several is packed once, as a [`Tile`], and each instance owns a rectangle.
//! * A chart longer than the page gets the density that fits it. A mesh too large for a page at the density asked for
//!   gets less, down to what fits.
//! * Things are dealt to pages largest first, each to the emptiest page.

use super::strip::{self, Packed, Shape};
use super::tile::{ChartBox, Tile, reference_scale};
use super::unwrap::Charts;
use super::{PageSize, Placement};
use glam::{DVec2, Vec2};
use rayon::prelude::*;

/// A mesh to be placed, and every instance of it.
pub(super) struct AtlasMesh {
    pub form: MeshLayout,
    /// For each instance: its index in the scene, and metres a unit of object space.
    pub instances: Vec<(usize, f64)>,
    /// Share of the scene's density that this mesh gets: 1, or less if it would not fit a page.
    pub share: f64,
}

/// What is known of a mesh's layout.
pub(super) enum MeshLayout {
    /// Charts still to be packed.
    Charts(Charts),
    /// A finished layout of the file's.
    FileLayout(FileLayout),
}

/// A finished layout: the box of [0, 1] that it uses, and its scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FileLayout {
    /// Least coordinates.
    pub low: DVec2,
    /// Extent.
    pub size: DVec2,
    /// Length in object space of one unit of texture coordinates, on average.
    pub object_per_uv: f64,
    /// Area in texture coordinates.
    pub uv_area: f64,
}

/// A shape on a page and what it is for.
#[derive(Clone)]
struct Piece {
    shape: Shape,
    item: usize,
    part: PieceKind,
}

/// Pieces that must share a page.
struct PieceGroup {
    pieces: Vec<Piece>,
    texels: f64,
}

#[derive(Clone, Copy)]
enum PieceKind {
    /// A chart of a mesh that is packed loose.
    Chart(usize, ChartBox),
    /// An instance, the index being into [`AtlasMesh::instances`], and its content in texels.
    Instance(usize, DVec2),
}

/// Everything placed.
pub(super) struct AtlasPlan {
    pages: Vec<PlannedPage>,
    /// One per item that is packed as a tile.
    tiles: Vec<Option<Tile>>,
    padding: u32,
}

struct PlannedPage {
    size: PageSize,
    pieces: Vec<Piece>,
    packed: Packed,
}

/// What is placed, and on what.
pub(super) struct Arrangement<'a> {
    pub items: &'a [AtlasMesh],
    pub page_size_texels: u32,
    pub padding_texels: u32,
}

impl AtlasMesh {
    /// Surface in the scene, over all instances.
    pub fn area_m2(&self) -> f64 {
        let object = match &self.form {
            MeshLayout::Charts(charts) => charts.area(),
            MeshLayout::FileLayout(given) => given.uv_area * given.object_per_uv * given.object_per_uv,
        };
        object * self.instances.iter().map(|(_, k)| k * k).sum::<f64>()
    }

    /// Charts, each counted once however many instances show it. A layout of the file's counts as one.
    pub fn chart_count(&self) -> usize {
        match &self.form {
            MeshLayout::Charts(charts) => charts.sizes.len(),
            MeshLayout::FileLayout(_) => 1,
        }
    }

    fn is_loose(&self) -> bool {
        matches!(self.form, MeshLayout::Charts(_)) && self.instances.len() == 1
    }

    fn scales(&self) -> Vec<f64> {
        self.instances.iter().map(|i| i.1).collect()
    }
}

impl Arrangement<'_> {
    /// Places everything at a density in texels a metre, on at most `pages` pages; `None` if it does not fit.
    pub fn at_density(&self, texels_per_metre: f64, pages: u32) -> Option<AtlasPlan> {
        self.place(texels_per_metre, pages, self.page_size_texels)
    }

    /// Places everything on the smallest page, or as few pages as it takes, up to `most`.
    pub fn compactly(&self, texels_per_metre: f64, most: u32) -> Option<AtlasPlan> {
        let (_, units) = self.units(texels_per_metre);
        let area: f64 = units.iter().map(|u| u.texels).sum();
        let mut side = (area.sqrt() * 1.02).ceil().max(16.0);
        while side < f64::from(self.page_size_texels) {
            if let Some(plan) = self.place(texels_per_metre, 1, (side as u32).next_multiple_of(4)) {
                return Some(plan);
            }
            side = side * 1.05 + 1.0;
        }
        let page = f64::from(self.page_size_texels);
        let least = ((area / (page * page)).floor() as u32).max(1);
        let tries = std::iter::successors(Some(least), |&n| Some(n + 1 + n / 8)).take_while(|&n| n <= most);
        tries.into_iter().find_map(|pages| self.at_density(texels_per_metre, pages))
    }

    /// Whether one item fits a page by itself.
    pub fn fits_alone(&self, item: usize, texels_per_metre: f64) -> bool {
        let alone = Arrangement { items: std::slice::from_ref(&self.items[item]), ..*self };
        let instances = self.items[item].instances.len() as u32;
        alone.at_density(texels_per_metre, instances).is_some()
    }

    fn place(&self, texels_per_metre: f64, pages: u32, side: u32) -> Option<AtlasPlan> {
        let (tiles, units) = self.units(texels_per_metre);
        let dealt = deal(units, pages);
        let place_page = |mut pieces: Vec<Piece>| {
            let shapes: Vec<_> = pieces.iter_mut().map(|p| std::mem::take(&mut p.shape)).collect();
            let packed = strip::pack(&shapes, side, side)?;
            let size = PageSize { width: side, height: packed.height.next_multiple_of(4).min(side) };
            Some(PlannedPage { size, pieces, packed })
        };
        let pages = dealt.into_par_iter().map(place_page).collect::<Option<Vec<_>>>()?;
        Some(AtlasPlan { pages, tiles, padding: self.padding_texels })
    }

    /// Tiles, and what must stay together on a page, with its area in texels.
    fn units(&self, texels_per_metre: f64) -> (Vec<Option<Tile>>, Vec<PieceGroup>) {
        let of_item =
            |(index, item): (usize, &AtlasMesh)| self.units_of_item(index, item, texels_per_metre * item.share);
        let (tiles, units): (Vec<_>, Vec<_>) = self.items.par_iter().enumerate().map(of_item).unzip();
        let measured = |pieces: Vec<Piece>| {
            let texels = pieces.iter().map(|p| p.shape.area()).sum();
            PieceGroup { pieces, texels }
        };
        (tiles, units.into_iter().flatten().map(measured).collect())
    }

    fn units_of_item(&self, item: usize, what: &AtlasMesh, texels_per_metre: f64) -> (Option<Tile>, Vec<Vec<Piece>>) {
        let (padding, scales) = (self.padding_texels, what.scales());
        let room = f64::from(self.page_size_texels.saturating_sub(2 * padding).max(1));
        let rectangles = |contents: Vec<DVec2>| {
            let piece = |(slot, content): (usize, DVec2)| {
                let cells = (content - 1e-6).ceil().max(DVec2::ONE);
                let [width, height] = [cells.x, cells.y].map(|c| (c as u32).saturating_add(2 * padding));
                let shape = Shape::rectangle(width, height, false);
                vec![Piece { shape, item, part: PieceKind::Instance(slot, content) }]
            };
            contents.into_iter().enumerate().map(piece).collect()
        };
        match &what.form {
            MeshLayout::FileLayout(given) => {
                let content = |k: &f64| given.size * given.object_per_uv * k * texels_per_metre;
                (None, rectangles(scales.iter().map(content).collect()))
            }
            MeshLayout::Charts(charts) if what.is_loose() => {
                let piece = |(chart, &size): (usize, &DVec2)| {
                    let chart_box = ChartBox::new(size, texels_per_metre * scales[0], room);
                    let shape = chart_box.shape(charts, chart, padding);
                    Piece { shape, item, part: PieceKind::Chart(chart, chart_box) }
                };
                (None, vec![charts.sizes.iter().enumerate().map(piece).collect()])
            }
            MeshLayout::Charts(charts) => {
                let reference = reference_scale(charts, &scales, texels_per_metre, padding);
                let largest = scales.iter().copied().fold(reference, f64::max);
                let tile = Tile::new(charts, texels_per_metre * reference, padding, room * reference / largest);
                let contents = scales.iter().map(|k| tile.inner * (k.max(reference) / reference)).collect();
                (Some(tile), rectangles(contents))
            }
        }
    }
}

/// Deals units to pages, largest first, each to the page with most room. Empty pages are left out.
fn deal(mut units: Vec<PieceGroup>, pages: u32) -> Vec<Vec<Piece>> {
    units.sort_by(|a, b| b.texels.total_cmp(&a.texels));
    let mut filled = vec![0.0f64; pages.max(1) as usize];
    let mut dealt = vec![Vec::new(); filled.len()];
    for PieceGroup { pieces, texels } in units {
        let emptiest = (0..filled.len()).min_by(|&a, &b| filled[a].total_cmp(&filled[b])).unwrap_or(0);
        filled[emptiest] += texels;
        dealt[emptiest].extend(pieces);
    }
    dealt.retain(|pieces| !pieces.is_empty());
    dealt
}

impl AtlasPlan {
    /// Sizes of the pages.
    pub fn page_sizes(&self) -> Vec<PageSize> {
        self.pages.iter().map(|p| p.size).collect()
    }

    /// Placements by scene instance; those that nothing was planned for stay as they are.
    pub fn write_placements(&self, items: &[AtlasMesh], placements: &mut [Placement]) {
        for (page, planned) in self.pages.iter().enumerate() {
            for (piece, position) in planned.pieces.iter().zip(&planned.packed.positions) {
                let item = &items[piece.item];
                let page_texels = planned.size.as_dvec2();
                let corner = DVec2::new(f64::from(position.x), f64::from(position.y)) + f64::from(self.padding);
                let (slot, scale, offset) = match (piece.part, &item.form) {
                    (PieceKind::Chart(..), _) => (0, DVec2::ONE, DVec2::ZERO),
                    (PieceKind::Instance(slot, content), MeshLayout::FileLayout(given)) => {
                        let scale = content / given.size;
                        (slot, scale / page_texels, (corner - given.low * scale) / page_texels)
                    }
                    (PieceKind::Instance(slot, content), MeshLayout::Charts(_)) => {
                        (slot, content / page_texels, corner / page_texels)
                    }
                };
                placements[item.instances[slot].0] =
                    Placement { page: page as u32, scale: scale.as_vec2(), offset: offset.as_vec2() };
            }
        }
    }

    /// For each item, the layout coordinates of its vertices; none for a layout that was given.
    pub fn layout_uvs(&self, items: &[AtlasMesh]) -> Vec<Vec<Vec2>> {
        let chart_positions = self.chart_positions(items);
        let of_item = |(index, item): (usize, &AtlasMesh)| {
            let MeshLayout::Charts(charts) = &item.form else { return Vec::new() };
            let uv = |(&point, &chart): (&DVec2, &u32)| match &self.tiles[index] {
                Some(tile) => tile.uv(chart as usize, point),
                None => chart_positions[index][chart as usize].uv(point),
            };
            charts.points.iter().zip(&charts.chart_of).map(|vertex| uv(vertex).as_vec2()).collect()
        };
        items.par_iter().enumerate().map(of_item).collect()
    }

    /// For each item, where its charts went; none for one that is not packed loose.
    fn chart_positions(&self, items: &[AtlasMesh]) -> Vec<Vec<ChartPosition>> {
        let count = |item: &AtlasMesh| match &item.form {
            MeshLayout::Charts(charts) if item.is_loose() => charts.sizes.len(),
            _ => 0,
        };
        let mut chart_positions: Vec<_> =
            items.iter().map(|item| vec![ChartPosition::default(); count(item)]).collect();
        for planned in &self.pages {
            for (piece, position) in planned.pieces.iter().zip(&planned.packed.positions) {
                if let PieceKind::Chart(chart, chart_box) = piece.part {
                    let corner = DVec2::new(f64::from(position.x), f64::from(position.y)) + f64::from(self.padding);
                    let page_texels = planned.size.as_dvec2();
                    chart_positions[piece.item][chart] =
                        ChartPosition { corner, chart_box, turns: position.turns, page_texels };
                }
            }
        }
        chart_positions
    }
}

/// Where a chart that is packed loose lies.
#[derive(Clone, Copy)]
struct ChartPosition {
    corner: DVec2,
    chart_box: ChartBox,
    turns: u8,
    page_texels: DVec2,
}

impl ChartPosition {
    fn uv(&self, point: DVec2) -> DVec2 {
        (self.corner + self.chart_box.texel(point, self.turns)) / self.page_texels
    }
}

impl Default for ChartPosition {
    fn default() -> Self {
        let chart_box = ChartBox { density: 0.0, cells: (1, 1), slack: DVec2::ZERO };
        Self { corner: DVec2::ZERO, chart_box, turns: 0, page_texels: DVec2::ONE }
    }
}
