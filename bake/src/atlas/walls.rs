//! What stands between neighbouring texels: see [`super::reach`].
//!
//! Theory: two points of a surface belong to one room if one can walk from one to the other. Between neighbouring
//! texels the way is the straight line just above the surface.
//!
//! Practice: a ray each way between the points from which shadow rays start, raised by what a curved surface bulges
//! between them. A surface counts as a wall if it also stands one texel higher, or nearly as high as a ceiling that is
//! lower than that: what is lower than a texel is wide parts no rooms, and is softened by the filter as any other
//! detail. The surface's own chart is no wall, and neither are surfaces with alpha masks, whose holes let light
//! through.

use super::reach::{HiddenEnd, MOST_OFF, OPEN, marked, wall_code};
use super::{Atlas, GutterTexel, PageSamples, PageSize, Sample, SurfacePoint, surface_point};
use crate::scene::{Geometry, Scene};
use crate::trace::{Direction, Tracer};
use glam::{DVec3, Vec2};
use rayon::prelude::*;
use std::collections::HashMap;

/// Codes of the ways to the right and to the lower neighbour of each texel of a page, in row order. `None` if nothing
/// stands on any of them.
pub fn find_walls(
    finder: &WallFinder,
    size: PageSize,
    samples: &PageSamples,
    gutter: &[GutterTexel],
) -> Option<Vec<[u8; 2]>> {
    let sources = sources(size, samples, gutter);
    let width = size.width as usize;
    let code = |a: u32, b: u32| match a == b || a == NO_SAMPLE || b == NO_SAMPLE {
        true => OPEN,
        false => finder.code(&samples.samples[a as usize], &samples.samples[b as usize]),
    };
    let of_texel = |texel: usize| {
        let right = (texel % width + 1 < width).then(|| sources[texel + 1]);
        let lower = sources.get(texel + width).copied();
        [right, lower].map(|other| other.map_or(OPEN, |other| code(sources[texel], other)))
    };
    let mut codes: Vec<[u8; 2]> = (0..sources.len()).into_par_iter().map(of_texel).collect();
    if codes.iter().all(|codes| *codes == [OPEN; 2]) {
        return None;
    }
    let shape = |texel: usize| {
        let [right, lower] = [texel + 1, texel + width];
        if texel % width + 1 == width || lower + 1 >= codes.len() {
            return WallShape::Straight;
        }
        let edges = [codes[texel][0], codes[lower][0], codes[texel][1], codes[right][1]];
        if edges == [OPEN; 4] {
            return WallShape::Straight;
        }
        let corners = [texel, right, lower, lower + 1].map(|corner| samples.samples.get(sources[corner] as usize));
        finder.shape(corners, edges)
    };
    let of_texel = |texel: usize| (texel, shape(texel));
    let shapes: Vec<(usize, WallShape)> =
        (0..codes.len()).into_par_iter().map(of_texel).filter(|(_, shape)| *shape != WallShape::Straight).collect();
    for (texel, shape) in shapes {
        let [level, upright] = codes[texel];
        codes[texel] = shape.marked([level, upright]);
    }
    Some(codes)
}

/// For each texel of a page, the sample that it shows, or [`NO_SAMPLE`].
fn sources(size: PageSize, samples: &PageSamples, gutter: &[GutterTexel]) -> Vec<u32> {
    let mut sources = vec![NO_SAMPLE; size.texel_count()];
    samples.samples.iter().zip(0..).for_each(|(sample, index)| sources[sample.texel as usize] = index);
    gutter.iter().for_each(|copy| sources[copy.texel as usize] = copy.sample);
    sources
}

/// A page's walls, if it has any, and more of them where a covered texel lies beside one of another chart, as without a
/// gutter between them. No filter reads such a neighbour; what looks around a texel in other ways must not either.
/// `None` if that leaves no wall.
pub(crate) fn walls_and_borders(
    finder: &WallFinder,
    size: PageSize,
    samples: &PageSamples,
    gutter: &[GutterTexel],
    walls: Option<&[[u8; 2]]>,
) -> Option<Vec<[u8; 2]>> {
    let sources = sources(size, samples, gutter);
    let width = size.width as usize;
    let sample = |texel: usize| Some(&samples.samples[*sources.get(texel).filter(|&&s| s != NO_SAMPLE)? as usize]);
    let is_border = |texel: usize, other: usize| {
        let (Some(a), Some(b)) = (sample(texel), sample(other)) else { return false };
        let is_covered = a.texel as usize == texel || b.texel as usize == other;
        is_covered && a.triangle != b.triangle && finder.chart(a.triangle) != finder.chart(b.triangle)
    };
    let of_texel = |texel: usize| {
        let own = walls.map_or([OPEN; 2], |codes| codes[texel]);
        let is_border = [texel % width + 1 < width && is_border(texel, texel + 1), is_border(texel, texel + width)];
        [0, 1].map(|way| if is_border[way] { BORDER } else { own[way] })
    };
    let codes: Vec<[u8; 2]> = (0..sources.len()).into_par_iter().with_min_len(4096).map(of_texel).collect();
    codes.iter().any(|codes| *codes != [OPEN; 2]).then_some(codes)
}

/// A wall at the first of two texels.
const BORDER: u8 = 0;

/// The shape of the walls within a footprint, best first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum WallShape {
    /// As straight as filters take it to be.
    Straight,
    /// It cuts one texel off, and is the outline of the rectangle between that texel and the two places where it meets
    /// the edges: a corner whose sides run along rows and columns of texels.
    Square,
    /// Three edges have one, and beside the fourth a wall runs straight: the foot of a wall that is made of two boxes.
    BesideOpenEdge,
    /// It cuts one texel off, and turns within the circle around that rectangle: a corner at any angle.
    Round,
    /// Any other.
    Bent,
}

impl WallShape {
    /// The codes of a footprint's upper and left edge, with the mark of this shape.
    fn marked(self, [upper, left]: [u8; 2]) -> [u8; 2] {
        match self {
            Self::Straight => [upper, left],
            Self::Square | Self::BesideOpenEdge => [upper, marked(left)],
            Self::Round => [marked(upper), marked(left)],
            Self::Bent => [marked(upper), left],
        }
    }
}

const NO_SAMPLE: u32 = u32::MAX;
/// Parts into which a footprint is cut to see whether a wall is straight.
const WAYS: u32 = 6;
/// Share of the height of a ceiling that a wall below it must reach.
const UNDER_CEILING: f64 = 0.9;

/// The chart of every triangle of every mesh.
struct Charts {
    of_mesh: Vec<Vec<u32>>,
}

impl Charts {
    fn new(scene: &Scene, atlas: &Atlas) -> Self {
        let of_mesh = |mesh: usize| {
            let layout = &atlas.layouts[mesh];
            // Triangles that share a place on the page belong together, whether or not they share vertices.
            let mut first_at = HashMap::with_capacity(layout.uvs.len());
            let first = |(uv, v): (&Vec2, u32)| *first_at.entry((*uv + 0.0).to_array().map(f32::to_bits)).or_insert(v);
            let mut parent: Vec<u32> = layout.uvs.iter().zip(0..).map(first).collect();
            let triangles = layout.indices.as_chunks::<3>().0;
            for [a, b, c] in triangles {
                let [a, b, c] = [*a, *b, *c].map(|v| root(&mut parent, v));
                let least = a.min(b).min(c);
                [a, b, c].into_iter().for_each(|v| parent[v as usize] = least);
            }
            triangles.iter().map(|triangle| root(&mut parent, triangle[0])).collect()
        };
        Self { of_mesh: (0..scene.meshes.len()).into_par_iter().map(of_mesh).collect() }
    }
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// A wall on a way, seen from one of its ends.
#[derive(Debug, Clone, Copy)]
struct WallMet {
    /// Share of the way to it.
    share: f64,
    /// Whether only its back is seen, which nobody draws.
    is_back: bool,
}

/// Finds what stands between texels of an atlas.
pub struct WallFinder<'a> {
    scene: &'a Scene,
    geometry: &'a Geometry,
    tracer: &'a Tracer,
    charts: Charts,
}

impl<'a> WallFinder<'a> {
    /// Prepares the charts of an atlas.
    pub fn new(scene: &'a Scene, geometry: &'a Geometry, atlas: &Atlas, tracer: &'a Tracer) -> Self {
        Self { scene, geometry, tracer, charts: Charts::new(scene, atlas) }
    }

    /// Instance and chart of a triangle.
    fn chart(&self, triangle: u32) -> (usize, u32) {
        let surface = self.geometry.surface(triangle as usize);
        let mesh = self.scene.instances[surface.instance].mesh;
        (surface.instance, self.charts.of_mesh[mesh][surface.mesh_triangle])
    }

    /// The code of the way between two texels. Texels of different charts have none.
    pub fn code(&self, a: &Sample, b: &Sample) -> u8 {
        let [chart, other] = [a, b].map(|sample| self.chart(sample.triangle));
        if chart != other {
            return OPEN;
        }
        let points = [a, b].map(|sample| surface_point(self.scene, self.geometry, sample));
        let sides: &[f64] = if points[0].is_double_sided { &[1.0, -1.0] } else { &[1.0] };
        sides.iter().filter_map(|side| self.wall(&points, *side, chart)).min().unwrap_or(OPEN)
    }

    /// The codes of a footprint's upper, lower, left and right edge, with the mark of the walls' shape. Of the four
    /// texels, some may not be there.
    pub fn codes(&self, corners: [Option<&Sample>; 4]) -> [u8; 4] {
        let code = |a: usize, b: usize| match (corners[a], corners[b]) {
            (Some(a), Some(b)) if a != b => self.code(a, b),
            _ => OPEN,
        };
        let mut codes = [code(0, 1), code(2, 3), code(0, 2), code(1, 3)];
        if codes != [OPEN; 4] {
            [codes[0], codes[2]] = self.shape(corners, codes).marked([codes[0], codes[2]]);
        }
        codes
    }

    /// The wall between two points on one side of their surface.
    fn wall(&self, points: &[SurfacePoint; 2], side: f64, chart: (usize, u32)) -> Option<u8> {
        let [a, b] = points.each_ref().map(|p| self.tracer.lift(p.position_m, p.normal * side, p.triangle));
        let apart_m = a.distance(b);
        let turn_rad = points[0].normal.angle_between(points[1].normal);
        // Twice the bulge of an arc.
        let raised_m = 0.25 * turn_rad * apart_m;
        let raised = |height_m: f64| {
            let up = |at: DVec3, p: &SurfacePoint| at + p.normal * (side * height_m);
            [up(a, &points[0]), up(b, &points[1])]
        };
        let [near, far] = self.met(raised(raised_m), chart)?;
        let clear_m = [(a, &points[0]), (b, &points[1])].map(|(from, point)| self.clear_m(from, point.normal * side));
        let higher_m = (raised_m + apart_m).min(UNDER_CEILING * clear_m[0].min(clear_m[1]));
        self.between(raised(higher_m), chart)?;
        let hidden = match [near.is_back, far.is_back] {
            [true, false] => HiddenEnd::First,
            [false, true] => HiddenEnd::Second,
            _ => HiddenEnd::None,
        };
        Some(wall_code(near.share, far.share, hidden))
    }

    /// The shape of the walls within a footprint, where two or three edges have one. Ways across the wall must meet it
    /// where a straight one would stand, or within the bounds of a corner.
    fn shape(&self, corners: [Option<&Sample>; 4], codes: [u8; 4]) -> WallShape {
        let has_wall = codes.map(|code| code != OPEN);
        if !(2..=3).contains(&has_wall.iter().filter(|has_wall| **has_wall).count()) {
            return WallShape::Straight;
        }
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return WallShape::Bent };
        let chart = self.chart(a.triangle);
        let points = [a, b, c, d].map(|sample| surface_point(self.scene, self.geometry, sample));
        let sides: &[f64] = if points[0].is_double_sided { &[1.0, -1.0] } else { &[1.0] };
        let shape = |side: &f64| {
            let places = points.map(|p| self.tracer.lift(p.position_m, p.normal * *side, p.triangle));
            self.shape_between(places, has_wall, chart).unwrap_or(WallShape::Bent)
        };
        sides.iter().map(shape).min().unwrap_or(WallShape::Bent)
    }

    /// The shape of the wall that two edges have. `None` where a way meets no wall.
    fn shape_between(&self, [a, b, c, d]: [DVec3; 4], has_wall: [bool; 4], chart: (usize, u32)) -> Option<WallShape> {
        match has_wall {
            [true, false, true, true] => self.shape_beside([c, d], [a, b], chart),
            [false, true, true, true] => self.shape_beside([a, b], [c, d], chart),
            [true, true, false, true] => self.shape_beside([a, c], [b, d], chart),
            [true, true, true, false] => self.shape_beside([b, d], [a, c], chart),
            [true, true, ..] => self.shape_across([a, c], [b, d], chart),
            [.., true, true] => self.shape_across([a, b], [c, d], chart),
            [true, _, true, _] => self.shape_around(a, [b, d, c], chart),
            [true, ..] => self.shape_around(b, [a, c, d], chart),
            [_, true, true, _] => self.shape_around(c, [d, b, a], chart),
            _ => self.shape_around(d, [c, a, b], chart),
        }
    }

    /// Of a wall between two edges, on ways from one to the other: the first way meets it on one edge of the footprint,
    /// the last on the opposite one.
    fn shape_across(&self, starts: [DVec3; 2], ends: [DVec3; 2], chart: (usize, u32)) -> Option<WallShape> {
        let bent = self.most_bent(starts, ends, chart)?;
        Some(if bent[0].max(bent[1]) > MOST_OFF { WallShape::Bent } else { WallShape::Straight })
    }

    /// Of the wall beside an open edge, on ways from there.
    fn shape_beside(&self, starts: [DVec3; 2], ends: [DVec3; 2], chart: (usize, u32)) -> Option<WallShape> {
        let [from_start, _] = self.most_bent(starts, ends, chart)?;
        Some(if from_start > MOST_OFF { WallShape::Bent } else { WallShape::BesideOpenEdge })
    }

    /// How far a wall is from straight, seen from the starts of ways across it and from their ends.
    fn most_bent(&self, starts: [DVec3; 2], ends: [DVec3; 2], chart: (usize, u32)) -> Option<[f64; 2]> {
        let way = |share: f64| [starts[0].lerp(starts[1], share), ends[0].lerp(ends[1], share)];
        let met_at = |share: f64| self.between(way(share), chart);
        let [first, last] = [met_at(0.0)?, met_at(1.0)?];
        let mut most = [0.0f64; 2];
        for step in 1..WAYS {
            let share = f64::from(step) / f64::from(WAYS);
            let met = met_at(share)?;
            for end in 0..2 {
                most[end] = most[end].max((met[end] - (first[end] + (last[end] - first[end]) * share)).abs());
            }
        }
        Some(most)
    }

    /// Of a wall around a texel that it cuts off, on ways from there to points on the two edges that do not meet there:
    /// they run from one of `ends` to the next.
    fn shape_around(&self, from: DVec3, ends: [DVec3; 3], chart: (usize, u32)) -> Option<WallShape> {
        // Shares of the ways to the first surface, and to the last.
        let met = |to: DVec3| self.between([from, to], chart).map(|[near, rest]| [near, 1.0 - rest]);
        let [level, upright] = [met(ends[0])?, met(ends[2])?];
        let near = [level[0].max(1e-9), upright[0].max(1e-9)];
        let [mut off_line, mut off_square, mut out_of_circle] = [0.0f64; 3];
        for step in 1..2 * WAYS {
            let share = f64::from(step) / f64::from(WAYS);
            let (to, [u, v]) = match share <= 1.0 {
                true => (ends[0].lerp(ends[1], share), [1.0, share]),
                false => (ends[1].lerp(ends[2], share - 1.0), [2.0 - share, 1.0]),
            };
            let [first, last] = met(to)?;
            off_line = off_line.max((first - 1.0 / (u / near[0] + v / near[1])).abs());
            // Where the way leaves the rectangle, and the circle, which passes through the texel.
            let square = [0, 1].map(|end: usize| (level[end] / u).min(upright[end] / v));
            let circle = (level[1] * u + upright[1] * v) / (u * u + v * v);
            off_square = off_square.max((square[0] - first).abs()).max((square[1] - last).abs());
            out_of_circle = out_of_circle.max(last - circle);
        }
        Some(match [off_line, off_square, out_of_circle].map(|off| off <= MOST_OFF) {
            [true, ..] => WallShape::Straight,
            [_, true, _] => WallShape::Square,
            [.., true] => WallShape::Round,
            _ => WallShape::Bent,
        })
    }

    /// How far it is to the ceiling above a point. From inside a solid, its top is none.
    fn clear_m(&self, from: DVec3, up: DVec3) -> f64 {
        let faces_down = |triangle: u32| {
            let instance = self.geometry.instance[triangle as usize] as usize;
            let is_double_sided = self.scene.material(instance).is_double_sided;
            is_double_sided || self.geometry.normal(triangle as usize).dot(up) < 0.0
        };
        let hit = self.tracer.closest_hit(from, &Direction::new(up)).filter(|hit| faces_down(hit.triangle));
        hit.map_or(f64::INFINITY, |hit| hit.distance_m)
    }

    /// How far, as shares of the way, the first walls are from either end.
    fn between(&self, ends: [DVec3; 2], chart: (usize, u32)) -> Option<[f64; 2]> {
        Some(self.met(ends, chart)?.map(|met| met.share))
    }

    /// The first walls from either end.
    fn met(&self, [a, b]: [DVec3; 2], chart: (usize, u32)) -> Option<[WallMet; 2]> {
        let apart_m = a.distance(b);
        let along = (b - a).try_normalize()?;
        let first = |from: DVec3, along: DVec3| {
            let is_wall = |triangle: u32| self.chart(triangle) != chart && !self.has_holes(triangle);
            let hit = self.tracer.closest_hit_where(from, &Direction::new(along), is_wall)?;
            let instance = self.geometry.instance[hit.triangle as usize] as usize;
            let is_back = self.geometry.normal(hit.triangle as usize).dot(along) > 0.0
                && !self.scene.material(instance).is_double_sided;
            (hit.distance_m < apart_m).then_some(WallMet { share: hit.distance_m / apart_m, is_back })
        };
        Some([first(a, along)?, first(b, -along)?])
    }

    fn has_holes(&self, triangle: u32) -> bool {
        let instance = self.geometry.instance[triangle as usize] as usize;
        matches!(self.scene.material(instance).alpha, crate::scene::Alpha::Mask { .. })
    }
}
