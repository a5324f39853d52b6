//! The surface point that each texel represents.
//!
//! Theory: a texel represents the surface within it. If its centre lies on a triangle, that is the point. A texel at a
//! chart's border can be touched by triangles although its centre is outside them; so can every texel of a chart
//! thinner than a texel. Then the point is on the nearest triangle that touches the texel: the point nearest the centre
//! of the triangle's part within the texel.
//!
//! Practice: each page is cut into bands of rows. A band keeps the best triangle of each texel. Triangles are visited
//! in the order of their index, so ties go to the lowest index and the result does not depend on threads.
//!
//! * Points are never on a triangle's border, where a neighbour (a wall on a floor) may lie as well and a ray could
//!   start on either side of it. A point that is not the texel's centre is moved by [`PULL_OFF_CENTRE`] of the way to
//!   the middle of the triangle's part in the texel. A centre within [`BORDER_TEXELS`] of the border is moved by
//!   [`PULL_CENTRE`] of it.
//! * A triangle whose texture coordinates have no area gets only texels that no other triangle touches, and is sampled
//!   at its middle.

use super::coverage::{self, EPSILON_TEXELS, TexelTriangle};
use super::overlap::clip;
use super::{Atlas, PageSamples, PageSize, Sample, SurfacePoint};
use crate::scene::{Geometry, Scene};
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// How far a point that is not the texel's centre moves into its triangle, as a share of the way to the part's middle.
const PULL_OFF_CENTRE: f64 = 0.25;
/// The same for a centre that is almost on the border.
const PULL_CENTRE: f64 = 0.125;
/// Distance from the border, in texels, below which a centre is almost on it.
const BORDER_TEXELS: f64 = 1.0 / 64.0;
/// Rows in a band; 64 rows of 4096 texels take 2 MiB.
const BAND_ROWS: u32 = 64;
/// Edge of a tile, in texels, for [`in_tile_order`].
const TILE: u32 = 16;
/// Added to the squared distance of triangles without area, so that every other triangle is preferred.
const NO_AREA_PENALTY: f64 = 4.0;
/// Twice the area, in texels, at and below which a triangle counts as having none.
const NO_AREA_TEXELS: f64 = 1e-12;

/// A triangle on the page, in texels.
pub(super) struct PageTriangle {
    pub corners: TexelTriangle,
    /// Twice the signed area, in texels.
    area2: f64,
    triangle: u32,
}

impl PageTriangle {
    fn has_area(&self) -> bool {
        self.area2.abs() > NO_AREA_TEXELS
    }

    /// Distance in texels of `p` from the lines through the three edges, positive inside.
    fn heights(&self, p: DVec2) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let edge = self.corners[(k + 1) % 3] - self.corners[k];
            edge.perp_dot(p - self.corners[k]) * self.area2.signum() / edge.length().max(f64::MIN_POSITIVE)
        })
    }

    fn contains(&self, p: DVec2) -> bool {
        self.has_area()
            && [0, 1, 2].iter().all(|&k| {
                let (a, b) = (self.corners[k], self.corners[(k + 1) % 3]);
                (b - a).perp_dot(p - a) * self.area2.signum() >= 0.0
            })
    }

    /// Rank of this triangle for a texel with this centre: lower is better, 0 if the centre is inside.
    fn rank(&self, centre: DVec2) -> f64 {
        if self.contains(centre) {
            0.0
        } else {
            let penalty = if self.has_area() { 0.0 } else { NO_AREA_PENALTY };
            penalty + nearest_on(&self.corners, centre).distance_squared(centre)
        }
    }

    /// Weights of the second and third corner at `p`, clamped to the triangle.
    fn barycentric(&self, p: DVec2) -> [f32; 2] {
        if !self.has_area() {
            return [1.0 / 3.0; 2];
        }
        let [a, b, c] = self.corners;
        let second = ((p - a).perp_dot(c - a) / self.area2).clamp(0.0, 1.0) as f32;
        let third = ((b - a).perp_dot(p - a) / self.area2).clamp(0.0, 1.0) as f32;
        [second, third.min(1.0 - second)]
    }
}

/// Every covered texel of a page with its surface point. A texel is covered if some triangle touches it.
pub fn sample_page(scene: &Scene, geometry: &Geometry, atlas: &Atlas, page: u32) -> PageSamples {
    sample_page_supersampled(scene, geometry, atlas, page, 1)
}

/// The same on a grid that is `factor` times finer along each axis: every covered cell has a point. [`Sample::texel`]
/// is an index in the finer grid.
pub fn sample_page_supersampled(
    scene: &Scene,
    geometry: &Geometry,
    atlas: &Atlas,
    page: u32,
    factor: u32,
) -> PageSamples {
    let Some(&PageSize { width, height }) = atlas.pages.get(page as usize) else {
        return PageSamples::default();
    };
    let size = PageSize { width: width * factor, height: height * factor };
    let bands = Bands::of_covered(scene, geometry, atlas, page, size);
    let samples = bands.rows(size).into_par_iter().map(|(members, rows)| sample_band(&bands, members, rows, size));
    PageSamples { samples: samples.collect::<Vec<_>>().concat() }
}

/// Indices of a page's samples, tile by tile, so that consecutive samples are close together on the surface.
pub fn in_tile_order(PageSamples { samples }: &PageSamples, size: PageSize) -> Vec<u32> {
    let place = |index: &u32| {
        let (x, y) = (samples[*index as usize].texel % size.width, samples[*index as usize].texel / size.width);
        (y / TILE, x / TILE, interleaved(x % TILE, y % TILE))
    };
    let mut order: Vec<u32> = (0..samples.len() as u32).collect();
    order.par_sort_unstable_by_key(place);
    order
}

/// Interleaved bits of two numbers (Morton order): close values are close in the plane.
fn interleaved(x: u32, y: u32) -> u32 {
    (0..TILE.ilog2()).map(|bit| ((x >> bit & 1) << (2 * bit)) | ((y >> bit & 1) << (2 * bit + 1))).sum()
}

/// The sample's point in the scene.
pub fn surface_point(scene: &Scene, geometry: &Geometry, sample: &Sample) -> SurfacePoint {
    SurfacePoint::of_triangle(scene, geometry, sample.triangle as usize, sample.barycentric.map(f64::from))
}

/// Triangles of all instances on the page, in the order of their index.
fn triangles_of_page(
    scene: &Scene,
    geometry: &Geometry,
    atlas: &Atlas,
    page: u32,
    size: PageSize,
) -> Vec<PageTriangle> {
    let on_page = |&(_, p): &(usize, &super::Placement)| p.page == page && !p.is_empty();
    let placed: Vec<_> = atlas.placements.iter().enumerate().filter(on_page).collect();
    let of_instance = |(instance, _): (usize, &super::Placement)| {
        let layout = &atlas.layouts[scene.instances[instance].mesh];
        let first = geometry.first_triangle[instance];
        layout.indices.chunks_exact(3).zip(first..).map(move |(corners, triangle)| {
            let corners = [0, 1, 2].map(|k| atlas.texel(instance, layout.uvs[corners[k] as usize], size));
            let area2 = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
            PageTriangle { corners, area2, triangle }
        })
    };
    placed.into_par_iter().flat_map_iter(of_instance).collect()
}

/// The triangles of a page, by bands of rows.
pub(super) struct Bands {
    pub triangles: Vec<PageTriangle>,
    /// For each band, those that touch it.
    members: Vec<Vec<u32>>,
}

impl Bands {
    /// Those of the rows that a triangle covers.
    fn of_covered(scene: &Scene, geometry: &Geometry, atlas: &Atlas, page: u32, size: PageSize) -> Self {
        Self::new(triangles_of_page(scene, geometry, atlas, page, size), size, coverage::rows)
    }

    /// Those of the rows that a filter reads at a triangle's points.
    pub fn of_read(scene: &Scene, geometry: &Geometry, atlas: &Atlas, page: u32, size: PageSize) -> Self {
        Self::new(triangles_of_page(scene, geometry, atlas, page, size), size, coverage::read_rows)
    }

    fn new(triangles: Vec<PageTriangle>, size: PageSize, rows: impl Fn(&TexelTriangle, u32) -> Range<u32>) -> Self {
        let mut members = vec![Vec::new(); size.height.div_ceil(BAND_ROWS) as usize];
        for (triangle, index) in triangles.iter().zip(0..) {
            let rows = rows(&triangle.corners, size.height);
            for band in rows.start / BAND_ROWS..rows.end.div_ceil(BAND_ROWS) {
                members[band as usize].push(index);
            }
        }
        Self { triangles, members }
    }

    /// For each band, its triangles and its rows.
    pub fn rows(&self, size: PageSize) -> Vec<(&Vec<u32>, Range<u32>)> {
        let rows = |band: u32| band * BAND_ROWS..((band + 1) * BAND_ROWS).min(size.height);
        self.members.iter().zip((0..).map(rows)).collect()
    }
}

fn sample_band(bands: &Bands, members: &[u32], rows: Range<u32>, size: PageSize) -> Vec<Sample> {
    let page_triangles = &bands.triangles;
    let mut best = vec![(f32::INFINITY, 0u32); (rows.len()) * size.width as usize];
    for &member in members {
        let page_triangle = &page_triangles[member as usize];
        let touched = coverage::rows(&page_triangle.corners, size.height);
        for y in touched.start.max(rows.start)..touched.end.min(rows.end) {
            let row = &mut best[((y - rows.start) * size.width) as usize..][..size.width as usize];
            for x in coverage::columns(&page_triangle.corners, y, size.width) {
                let texel_best = &mut row[x as usize];
                if texel_best.0 > 0.0 {
                    let rank = page_triangle.rank(texel_centre(x, y)) as f32;
                    if rank < texel_best.0 {
                        *texel_best = (rank, member);
                    }
                }
            }
        }
    }
    let covered = best.iter().enumerate().filter(|(_, best)| best.0 < f32::INFINITY);
    covered
        .map(|(index, &(_, member))| {
            let texel = rows.start * size.width + index as u32;
            sample_texel(&page_triangles[member as usize], texel, size)
        })
        .collect()
}

fn texel_centre(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

fn sample_texel(page_triangle: &PageTriangle, texel: u32, size: PageSize) -> Sample {
    let (x, y) = (texel % size.width, texel / size.width);
    let centre = texel_centre(x, y);
    let point = if !page_triangle.contains(centre) {
        let part = part_in_texel(page_triangle, x, y);
        nearest_on(&part, centre).lerp(middle(&part), PULL_OFF_CENTRE)
    } else if page_triangle.heights(centre).iter().any(|&height| height < BORDER_TEXELS) {
        centre.lerp(middle(&part_in_texel(page_triangle, x, y)), PULL_CENTRE)
    } else {
        centre
    };
    Sample { texel, triangle: page_triangle.triangle, barycentric: page_triangle.barycentric(point) }
}

/// The triangle's part within a texel, which is enlarged by the epsilon of the coverage test; the whole triangle if
/// rounding leaves nothing.
fn part_in_texel(page_triangle: &PageTriangle, x: u32, y: u32) -> Vec<DVec2> {
    let low = DVec2::new(f64::from(x), f64::from(y)) - 2.0 * EPSILON_TEXELS;
    let high = low + 1.0 + 4.0 * EPSILON_TEXELS;
    let sides = [(DVec2::X, low.x), (DVec2::Y, low.y), (DVec2::NEG_X, -high.x), (DVec2::NEG_Y, -high.y)];
    let part = sides.iter().fold(page_triangle.corners.to_vec(), |part, &(normal, offset)| clip(&part, normal, offset));
    if part.is_empty() { page_triangle.corners.to_vec() } else { part }
}

fn middle(polygon: &[DVec2]) -> DVec2 {
    polygon.iter().sum::<DVec2>() / polygon.len() as f64
}

/// The point of a polygon's border nearest to `p`; the first of equally near ones.
pub(super) fn nearest_on(polygon: &[DVec2], p: DVec2) -> DVec2 {
    let on_edge = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let along = (p - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
        a + (b - a) * along.clamp(0.0, 1.0)
    };
    let nearer = |best: DVec2, q: DVec2| if q.distance_squared(p) < best.distance_squared(p) { q } else { best };
    (0..polygon.len()).map(on_edge).reduce(nearer).unwrap_or(p)
}
