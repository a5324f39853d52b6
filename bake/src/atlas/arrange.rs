//! Placing charts and tiles on pages.
//!
//! Theory: one density for the whole scene, in texels per metre, so that shadow edges are equally sharp everywhere. A
//! given density determines all sizes in texels, and pages are packed. If the number of pages is given instead, the
//! density is found by bisection, which packs again for each guess.
//!
//! Practice:
//! * A mesh with one instance is packed chart by chart among the others' charts, all on one page, because a
//!   [`Placement`] names one page. A mesh with several instances is packed once, as a [`Tile`], and each instance has a
//!   rectangle.
//! * A chart longer than the page gets a lower density that fits. So does a mesh that is too large for a page at the
//!   requested density.
//! * Pages are filled largest first, each group going to the emptiest page.

use super::chart_box::{BoxedChart, Gutters, chart_shapes};
use super::strip::{self, PackShape, Packed, PackedPosition};
use super::tile::{Tile, reference_scale};
use super::unwrap::Charts;
use super::{PageSize, Placement};
use glam::{DVec2, Vec2};
use rayon::prelude::*;

/// A mesh to be placed, and all its instances.
pub(super) struct AtlasMesh {
    pub form: MeshLayout,
    pub instances: Vec<AtlasInstance>,
    /// Share of the scene's density that this mesh gets: 1, or less if it would not fit a page otherwise.
    pub share: f64,
}

/// An instance that gets texels.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtlasInstance {
    /// Index in the scene.
    pub index: usize,
    /// Metres per unit of object space: the root of the ratio of areas.
    pub metres_per_unit: f64,
    /// Texels a metre, if not the scene's.
    pub own_density: Option<f64>,
}

impl AtlasInstance {
    /// Size of a unit of object space in texels, as metres of a scene of this density.
    fn scale(&self, texels_per_metre: f64) -> f64 {
        self.metres_per_unit * self.own_density.map_or(1.0, |own| own / texels_per_metre)
    }
}

/// How a mesh is laid out.
pub(super) enum MeshLayout {
    /// Charts from unwrapping, not packed yet.
    Charts(Charts),
    /// The file's own finished layout.
    FileLayout(FileLayout),
}

/// A layout from the file: the part of [0, 1] that it uses, and its scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FileLayout {
    /// Least texture coordinates.
    pub low: DVec2,
    /// Extent in texture coordinates.
    pub size: DVec2,
    /// Mean length in object space of one unit of texture coordinates.
    pub object_per_uv: f64,
    /// Area in texture coordinates.
    pub uv_area: f64,
}

/// A shape to be packed, and what it belongs to.
#[derive(Clone)]
struct Piece {
    shape: PackShape,
    item: usize,
    kind: PieceKind,
}

/// Pieces that must be on the same page, and their area in texels.
struct PieceGroup {
    pieces: Vec<Piece>,
    texels: f64,
}

#[derive(Clone)]
enum PieceKind {
    /// Charts of a mesh with a single instance.
    Charts(Vec<BoxedChart>),
    /// An instance's rectangle: its index in [`AtlasMesh::instances`], its content's size in texels, and the width of
    /// the gutter around it.
    Instance(usize, DVec2, u32),
}

/// The result: everything placed on pages.
pub(super) struct AtlasPlan {
    pages: Vec<PlannedPage>,
    /// For each mesh, its tile if it has several instances.
    tiles: Vec<Option<Tile>>,
}

struct PlannedPage {
    size: PageSize,
    pieces: Vec<Piece>,
    packed: Packed,
}

/// The meshes to be placed and the page settings.
pub(super) struct Arrangement<'a> {
    pub items: &'a [AtlasMesh],
    pub page_size_texels: u32,
    pub padding_texels: u32,
    /// Share of every density that is given.
    pub share: f64,
}

impl AtlasMesh {
    /// Surface area of the instances that have the scene's density, and texels of those that have their own.
    pub fn area_and_own_texels(&self) -> (f64, f64) {
        let add = |(area_m2, texels): (f64, f64), (of_part_m2, own): (f64, Option<f64>)| match own {
            Some(own) => (area_m2, texels + of_part_m2 * own * own),
            None => (area_m2 + of_part_m2, texels),
        };
        let parts = self.instances.iter().flat_map(|instance| self.parts(instance));
        parts.fold((0.0, 0.0), add)
    }

    /// Area of an instance's parts in square metres, each with its density, if that is not the scene's.
    fn parts(&self, instance: &AtlasInstance) -> Vec<(f64, Option<f64>)> {
        match &self.form {
            MeshLayout::Charts(charts) if charts.has_own_densities() => {
                let square_m = instance.metres_per_unit * instance.metres_per_unit;
                let own = |chart: usize| charts.own_density(chart).or(instance.own_density);
                charts.areas().enumerate().map(|(chart, area)| (area * square_m, own(chart))).collect()
            }
            _ => vec![(self.area_of_instance_m2(instance), instance.own_density)],
        }
    }

    /// About how many texels it gets in a scene of this density.
    pub fn texels(&self, texels_per_metre: f64) -> f64 {
        self.instances.iter().map(|instance| self.texels_of(instance, texels_per_metre)).sum()
    }

    /// The instance that gets most of them, by its index in the scene.
    pub fn most_asking(&self, texels_per_metre: f64) -> usize {
        let texels = |instance: &&AtlasInstance| self.texels_of(instance, texels_per_metre);
        let most = self.instances.iter().max_by(|a, b| texels(a).total_cmp(&texels(b)));
        most.map_or(0, |instance| instance.index)
    }

    fn texels_of(&self, instance: &AtlasInstance, texels_per_metre: f64) -> f64 {
        let texels = |(area_m2, own): (f64, Option<f64>)| area_m2 * own.unwrap_or(texels_per_metre).powi(2);
        self.parts(instance).into_iter().map(texels).sum()
    }

    fn area_of_instance_m2(&self, instance: &AtlasInstance) -> f64 {
        let object = match &self.form {
            MeshLayout::Charts(charts) => charts.area(),
            MeshLayout::FileLayout(given) => given.uv_area * given.object_per_uv * given.object_per_uv,
        };
        object * instance.metres_per_unit * instance.metres_per_unit
    }

    /// Number of charts, independent of the number of instances. A layout from the file counts as one.
    pub fn chart_count(&self) -> usize {
        match &self.form {
            MeshLayout::Charts(charts) => charts.sizes.len(),
            MeshLayout::FileLayout(_) => 1,
        }
    }

    fn has_loose_charts(&self) -> bool {
        matches!(self.form, MeshLayout::Charts(_)) && self.instances.len() == 1
    }

    fn scales(&self, texels_per_metre: f64) -> Vec<f64> {
        self.instances.iter().map(|instance| instance.scale(texels_per_metre)).collect()
    }
}

impl Arrangement<'_> {
    /// Places everything at a density in texels per metre, on at most `pages` pages; `None` if it does not fit.
    pub fn at_density(&self, texels_per_metre: f64, pages: u32) -> Option<AtlasPlan> {
        self.place(texels_per_metre, pages, self.page_size_texels)
    }

    /// Places everything on the smallest single page, or else on as few full pages as possible, up to `most`.
    pub fn compactly(&self, texels_per_metre: f64, most: u32) -> Option<AtlasPlan> {
        let (_, groups) = self.groups(texels_per_metre);
        let area: f64 = groups.iter().map(|u| u.texels).sum();
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

    /// Whether each instance of one mesh fits a page by itself, at this share of the densities.
    pub fn fits_alone(&self, item: usize, texels_per_metre: f64, share: f64) -> bool {
        let alone = Arrangement { items: std::slice::from_ref(&self.items[item]), share, ..*self };
        let instances = self.items[item].instances.len() as u32;
        alone.at_density(texels_per_metre, instances).is_some()
    }

    fn place(&self, texels_per_metre: f64, pages: u32, side: u32) -> Option<AtlasPlan> {
        let (tiles, groups) = self.groups(texels_per_metre);
        let dealt = deal(groups, pages);
        let place_page = |mut pieces: Vec<Piece>| {
            let shapes: Vec<_> = pieces.iter_mut().map(|p| std::mem::take(&mut p.shape)).collect();
            let packed = strip::pack(&shapes, side, side)?;
            let size = PageSize { width: side, height: packed.height.next_multiple_of(4).min(side) };
            Some(PlannedPage { size, pieces, packed })
        };
        let pages = dealt.into_par_iter().map(place_page).collect::<Option<Vec<_>>>()?;
        Some(AtlasPlan { pages, tiles })
    }

    /// Tiles, and the groups of pieces to be packed.
    fn groups(&self, texels_per_metre: f64) -> (Vec<Option<Tile>>, Vec<PieceGroup>) {
        let of_item = |(index, item): (usize, &AtlasMesh)| self.groups_of_mesh(index, item, texels_per_metre);
        let (tiles, groups): (Vec<_>, Vec<_>) = self.items.par_iter().enumerate().map(of_item).unzip();
        let measured = |pieces: Vec<Piece>| {
            let texels = pieces.iter().map(|p| p.shape.area()).sum();
            PieceGroup { pieces, texels }
        };
        (tiles, groups.into_iter().flatten().map(measured).collect())
    }

    fn groups_of_mesh(&self, item: usize, what: &AtlasMesh, texels_per_metre: f64) -> (Option<Tile>, Vec<Vec<Piece>>) {
        let (padding, scales) = (self.padding_texels, what.scales(texels_per_metre));
        let texels_per_metre = texels_per_metre * what.share * self.share;
        let limit_texels = f64::from(self.page_size_texels.saturating_sub(2 * padding).max(1));
        let rectangles = |contents: Vec<DVec2>, gutter: u32| {
            let piece = |(instance, content): (usize, DVec2)| {
                let cells = (content - 1e-6).ceil().max(DVec2::ONE);
                let [width, height] = [cells.x, cells.y].map(|c| (c as u32).saturating_add(2 * gutter));
                let shape = PackShape::rectangle(width, height, false);
                vec![Piece { shape, item, kind: PieceKind::Instance(instance, content, gutter) }]
            };
            contents.into_iter().enumerate().map(piece).collect()
        };
        match &what.form {
            MeshLayout::FileLayout(given) => {
                let content = |k: &f64| given.size * given.object_per_uv * k * texels_per_metre;
                (None, rectangles(scales.iter().map(content).collect(), padding))
            }
            MeshLayout::Charts(charts) if what.has_loose_charts() => {
                let density = |chart: usize| match charts.own_density(chart) {
                    Some(own) => own * what.instances[0].metres_per_unit * what.share * self.share,
                    None => texels_per_metre * scales[0],
                };
                let gutters = Gutters { padding_texels: padding, is_pinned: true };
                let shapes = chart_shapes(charts, density, limit_texels, gutters).into_iter();
                let pieces = shapes.map(|made| Piece { shape: made.shape, item, kind: PieceKind::Charts(made.charts) });
                (None, vec![pieces.collect()])
            }
            MeshLayout::Charts(charts) => {
                let (reference, gutters) = reference_scale(charts, &scales, texels_per_metre, padding);
                let largest = scales.iter().copied().fold(reference, f64::max);
                let limit_texels = limit_texels * reference / largest;
                let tile = Tile::new(charts, texels_per_metre * reference, limit_texels, gutters);
                let contents = scales.iter().map(|k| tile.size * (k.max(reference) / reference)).collect();
                (Some(tile), rectangles(contents, 0))
            }
        }
    }
}

/// Distributes groups over pages, largest first, each to the emptiest page. Empty pages are dropped.
fn deal(mut groups: Vec<PieceGroup>, pages: u32) -> Vec<Vec<Piece>> {
    groups.sort_by(|a, b| b.texels.total_cmp(&a.texels));
    let mut filled = vec![0.0f64; pages.max(1) as usize];
    let mut dealt = vec![Vec::new(); filled.len()];
    for PieceGroup { pieces, texels } in groups {
        let emptiest = (0..filled.len()).min_by(|&a, &b| filled[a].total_cmp(&filled[b])).unwrap_or(0);
        filled[emptiest] += texels;
        dealt[emptiest].extend(pieces);
    }
    dealt.retain(|pieces| !pieces.is_empty());
    dealt
}

impl AtlasPlan {
    /// Size of each page.
    pub fn page_sizes(&self) -> Vec<PageSize> {
        self.pages.iter().map(|p| p.size).collect()
    }

    /// Of the charts that have a density of their own and are too long for a page at it, the one that gets the least
    /// share: its instance, and the texels a metre that were asked for and that it gets.
    pub fn most_capped(&self, items: &[AtlasMesh]) -> Option<(usize, f64, f64)> {
        let capped = |piece: &Piece| {
            let PieceKind::Charts(boxed) = &piece.kind else { return None };
            let AtlasMesh { form: MeshLayout::Charts(charts), instances, .. } = &items[piece.item] else { return None };
            let of_chart = |boxed: &BoxedChart| {
                let asked = charts.own_density(boxed.chart as usize).or(instances[0].own_density)?;
                let reached = boxed.content.density / instances[0].metres_per_unit;
                (reached < 0.9 * asked).then_some((instances[0].index, asked, reached))
            };
            least_share(boxed.iter().filter_map(of_chart))
        };
        least_share(self.pages.iter().flat_map(|page| &page.pieces).filter_map(capped))
    }

    /// Writes the placements of all placed instances; the others are not changed.
    pub fn write_placements(&self, items: &[AtlasMesh], placements: &mut [Placement]) {
        for (page, planned) in self.pages.iter().enumerate() {
            for (piece, position) in planned.pieces.iter().zip(&planned.packed.positions) {
                let item = &items[piece.item];
                let page_texels = planned.size.as_dvec2();
                let corner = |gutter: u32| DVec2::new(f64::from(position.x + gutter), f64::from(position.y + gutter));
                let (instance, scale, offset) = match (&piece.kind, &item.form) {
                    (PieceKind::Charts(..), _) => (0, DVec2::ONE, DVec2::ZERO),
                    (&PieceKind::Instance(instance, content, gutter), MeshLayout::FileLayout(given)) => {
                        let scale = content / given.size;
                        (instance, scale / page_texels, (corner(gutter) - given.low * scale) / page_texels)
                    }
                    (&PieceKind::Instance(instance, content, gutter), MeshLayout::Charts(_)) => {
                        (instance, content / page_texels, corner(gutter) / page_texels)
                    }
                };
                placements[item.instances[instance].index] =
                    Placement { page: page as u32, scale: scale.as_vec2(), offset: offset.as_vec2() };
            }
        }
    }

    /// For each mesh, the layout coordinates of its vertices; empty for a layout from the file.
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

    /// For each mesh with a single instance, the positions of its charts; empty for the others.
    fn chart_positions(&self, items: &[AtlasMesh]) -> Vec<Vec<ChartPosition>> {
        let count = |item: &AtlasMesh| match &item.form {
            MeshLayout::Charts(charts) if item.has_loose_charts() => charts.sizes.len(),
            _ => 0,
        };
        let mut chart_positions: Vec<_> = items.iter().map(|item| vec![ChartPosition::NOWHERE; count(item)]).collect();
        for planned in &self.pages {
            for (piece, position) in planned.pieces.iter().zip(&planned.packed.positions) {
                let PieceKind::Charts(boxed) = &piece.kind else { continue };
                for &boxed in boxed {
                    chart_positions[piece.item][boxed.chart as usize] =
                        ChartPosition { boxed, shape: *position, page_texels: planned.size.as_dvec2() };
                }
            }
        }
        chart_positions
    }
}

/// Of instances with the density asked for and that reached, the one with the least share.
fn least_share(all: impl Iterator<Item = (usize, f64, f64)>) -> Option<(usize, f64, f64)> {
    all.min_by(|a, b| (a.2 / a.1).total_cmp(&(b.2 / b.1)))
}

/// Position of a chart on its page.
#[derive(Clone, Copy)]
struct ChartPosition {
    boxed: BoxedChart,
    /// Of the shape that it lies in.
    shape: PackedPosition,
    page_texels: DVec2,
}

impl ChartPosition {
    const NOWHERE: Self =
        Self { boxed: BoxedChart::EMPTY, shape: PackedPosition { x: 0, y: 0, turns: 0 }, page_texels: DVec2::ONE };

    fn uv(&self, point: DVec2) -> DVec2 {
        let corner = DVec2::new(f64::from(self.shape.x), f64::from(self.shape.y));
        (corner + self.boxed.texel(point, self.shape.turns)) / self.page_texels
    }
}
