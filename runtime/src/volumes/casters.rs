//! Casters: groups of bodies, each large enough to be worth a culling decision and a draw of its own.
//!
//! A caster's points, triangles and edges are contiguous, so that a frame leaves a caster out by skipping a range.
//! Bodies of one instance stay together up to [`MOST_TRIANGLES`]; larger instances are split along a Morton curve. A
//! body that spans much of the scene, such as its ground, is a caster alone.

use super::bodies::{Bodies, Shape, cross};
use super::weld::{EdgeUse, Welded};
use crate::drawn_sides::DrawnSides;
use crate::stage::Stage;
use glam::{DVec3, Vec3};
use serde::Serialize;
use std::ops::Range;
use sunbake::scene::Alpha;

/// Triangles of a caster beyond which its instance is split into several.
const MOST_TRIANGLES: usize = 1024;
/// Share of the scene's size beyond which a body is a caster alone.
const OWN_CASTER_SHARE: f64 = 0.25;
/// Distance from a caster's plane within which points count as lying on it, as a share of the caster's size: as far as
/// rounding to `f32` moves them.
pub const PLANE_TOLERANCE_SHARE: f64 = 3e-7;

/// Everything that casts shadows, welded and sorted by caster.
#[derive(Debug, Clone, PartialEq)]
pub struct Casters {
    /// Points by caster, bake space.
    pub points_m: Vec<Vec3>,
    /// Triangles by caster: points, counter-clockwise from the front. The front of a solid is its outside.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle, whether it is a facet of something smooth that rises over its front.
    pub is_risen_over: Vec<bool>,
    /// Edges by caster: points, lower first.
    pub edges: Vec<[u32; 2]>,
    /// For each edge, where its uses begin; one more entry at the end.
    pub first_use: Vec<u32>,
    /// Triangles along each edge.
    pub uses: Vec<EdgeUse>,
    /// The casters themselves; each has ranges of the lists above.
    pub all: Vec<Caster>,
    /// Counts of what was found.
    pub counts: CasterCounts,
}

/// A group of bodies that is drawn or left out as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Caster {
    /// Indices in [`Casters::triangles`].
    pub triangles: Range<usize>,
    /// Indices in [`Casters::edges`].
    pub edges: Range<usize>,
    /// Whether all of it bounds solids.
    pub is_solid: bool,
    /// Whether something smooth rises over some of its triangles.
    pub is_smooth: bool,
    /// Whether few of its edges are shared, as in foliage made of cards.
    pub is_soup: bool,
    /// Whether the front of every triangle is drawn.
    pub shows_fronts: bool,
    /// Whether both sides of every triangle are drawn.
    pub shows_both_sides: bool,
    /// Least and greatest coordinates, bake space.
    pub bounds_m: [DVec3; 2],
    /// If it is flat: the unit normal of its plane, and the plane's offset along it in metres.
    pub plane: Option<(DVec3, f64)>,
}

/// Counts of what casts shadows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CasterCounts {
    /// Triangles that block light, alpha-masked ones included.
    pub triangles: usize,
    /// Of these, those that bound solids.
    pub solid_triangles: usize,
    /// Of these, those with an alpha mask. Their whole cards cast.
    #[serde(rename = "cut_triangles")]
    pub alpha_masked_triangles: usize,
    /// Points after welding.
    pub points: usize,
    /// Edges after welding.
    pub edges: usize,
    /// Edges of one triangle.
    pub open_edges: usize,
    /// Edges of three triangles or more.
    #[serde(rename = "crowded_edges")]
    pub nonmanifold_edges: usize,
    /// Bodies that bound solids.
    pub solid_bodies: usize,
    /// Bodies that bound solids inside out, and were turned over.
    #[serde(rename = "turned_bodies")]
    pub inside_out_bodies: usize,
    /// Bodies that do not bound solids.
    pub open_bodies: usize,
    /// Casters, which a frame draws or leaves out as a whole.
    pub casters: usize,
    /// Of these, those that share few edges.
    pub soups: usize,
}

impl Casters {
    /// Welds and sorts all casters of a stage.
    pub fn new(stage: &Stage) -> Self {
        let geometry = &stage.geometry;
        let flat: Vec<u32> =
            (0..geometry.triangles.len()).filter(|&i| geometry.casts(&stage.scene, i)).map(|i| i as u32).collect();
        let corners_m: Vec<[Vec3; 3]> = flat.iter().map(|&i| from_front(stage, i as usize)).collect();
        let welded = Welded::new(&corners_m);
        let bodies = Bodies::new(&welded, &corners_m, &flat, stage.tracer());
        let caster_of_body = group(stage, &bodies, &corners_m, &flat);
        let counts = count(stage, &welded, &bodies, &flat);
        arrange(stage, &welded, &bodies, &flat, &caster_of_body, counts)
    }

    /// Triangles along an edge.
    pub fn uses_of(&self, edge: usize) -> &[EdgeUse] {
        &self.uses[self.first_use[edge] as usize..self.first_use[edge + 1] as usize]
    }

    /// Corners of a triangle.
    pub fn corners_m(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|point| self.points_m[point as usize].as_dvec3())
    }
}

/// Corners counter-clockwise from the front, in the order in which they are drawn. Mirrored instances are turned over.
fn from_front(stage: &Stage, triangle: usize) -> [Vec3; 3] {
    let [a, b, c] = stage.geometry.triangles[triangle];
    match stage.scene.instances[stage.geometry.instance[triangle] as usize].is_mirrored {
        true => [a, c, b],
        false => [a, b, c],
    }
}

/// The order of bodies: compared field by field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct OrderKey {
    instance: u32,
    is_open: bool,
    /// The body itself, if it is a caster alone.
    alone: Option<u32>,
    morton: u32,
    body: u32,
}

/// For each body, its caster.
fn group(stage: &Stage, bodies: &Bodies, corners_m: &[[Vec3; 3]], flat: &[u32]) -> Vec<u32> {
    let count = bodies.shapes.len();
    let mut bounds = vec![[Vec3::INFINITY, Vec3::NEG_INFINITY]; count];
    let mut sizes = vec![0usize; count];
    let mut instance = vec![u32::MAX; count];
    for (triangle, corners) in corners_m.iter().enumerate() {
        let body = bodies.of_triangle[triangle] as usize;
        for corner in corners {
            bounds[body] = [bounds[body][0].min(*corner), bounds[body][1].max(*corner)];
        }
        sizes[body] += 1;
        instance[body] = instance[body].min(stage.geometry.instance[flat[triangle] as usize]);
    }
    let half_m = stage.scene.half_extent_m.max_element().max(f64::MIN_POSITIVE);
    let key = |body: usize| {
        let [low, high] = bounds[body].map(|corner| corner.as_dvec3());
        let is_large = (high - low).max_element() > OWN_CASTER_SHARE * 2.0 * half_m;
        OrderKey {
            instance: instance[body],
            is_open: bodies.shapes[body] == Shape::Open,
            alone: is_large.then_some(body as u32),
            morton: morton((low + high) * (0.25 / half_m) + 0.5),
            body: body as u32,
        }
    };
    let mut keys: Vec<OrderKey> = (0..count).map(key).collect();
    keys.sort_unstable();
    let mut caster_of_body = vec![0; count];
    let (mut caster, mut triangles_left) = (0, 0);
    for (i, key) in keys.iter().enumerate() {
        let is_together =
            |other: &OrderKey| (other.instance, other.is_open, other.alone) == (key.instance, key.is_open, key.alone);
        if i > 0 && (triangles_left == 0 || !is_together(&keys[i - 1])) {
            caster += 1;
            triangles_left = MOST_TRIANGLES;
        } else if i == 0 {
            triangles_left = MOST_TRIANGLES;
        }
        triangles_left = triangles_left.saturating_sub(sizes[key.body as usize]);
        caster_of_body[key.body as usize] = caster;
    }
    caster_of_body
}

/// The Morton code of a point in the unit cube.
fn morton(point: DVec3) -> u32 {
    let spread =
        |x: f64| (0..10).fold(0, |code, bit| code | ((x.clamp(0.0, 1.0) * 1023.0) as u32 >> bit & 1) << (3 * bit));
    spread(point.x) | spread(point.y) << 1 | spread(point.z) << 2
}

fn count(stage: &Stage, welded: &Welded, bodies: &Bodies, flat: &[u32]) -> CasterCounts {
    let is_alpha_masked = |&&i: &&u32| has_alpha_mask(stage, i as usize);
    let edges =
        |is_wanted: fn(usize) -> bool| (0..welded.edges.len()).filter(|&e| is_wanted(welded.uses_of(e).len())).count();
    let of_shape = |shape: Shape| bodies.shapes.iter().filter(|&&s| s == shape).count();
    CasterCounts {
        triangles: flat.len(),
        solid_triangles: bodies.of_triangle.iter().filter(|&&b| bodies.shapes[b as usize] != Shape::Open).count(),
        alpha_masked_triangles: flat.iter().filter(is_alpha_masked).count(),
        points: welded.points_m.len(),
        edges: welded.edges.len(),
        open_edges: edges(|uses| uses == 1),
        nonmanifold_edges: edges(|uses| uses > 2),
        solid_bodies: of_shape(Shape::Solid),
        inside_out_bodies: of_shape(Shape::InsideOut),
        open_bodies: of_shape(Shape::Open),
        casters: 0,
        soups: 0,
    }
}

/// Puts points, triangles and edges in the order of their casters.
fn arrange(
    stage: &Stage,
    welded: &Welded,
    bodies: &Bodies,
    flat: &[u32],
    caster_of_body: &[u32],
    counts: CasterCounts,
) -> Casters {
    let caster_of = |triangle: usize| caster_of_body[bodies.of_triangle[triangle] as usize];
    let count = caster_of_body.iter().max().map_or(0, |&last| last as usize + 1);
    let mut order: Vec<u32> = (0..welded.triangles.len() as u32).collect();
    order.sort_by_key(|&triangle| caster_of(triangle as usize));
    let mut edge_order: Vec<u32> = (0..welded.edges.len() as u32).collect();
    let caster_of_edge = |edge: u32| caster_of(welded.uses_of(edge as usize)[0].triangle());
    edge_order.sort_by_key(|&edge| caster_of_edge(edge));
    let mut new_triangle = vec![0u32; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_triangle[old as usize] = new as u32;
    }
    let mut casters = Casters {
        points_m: Vec::with_capacity(welded.points_m.len()),
        triangles: Vec::with_capacity(order.len()),
        is_risen_over: Vec::with_capacity(order.len()),
        edges: Vec::with_capacity(edge_order.len()),
        first_use: Vec::with_capacity(edge_order.len() + 1),
        uses: Vec::with_capacity(welded.uses.len()),
        all: Vec::with_capacity(count),
        counts: CasterCounts { casters: count, ..counts },
    };
    let (mut next, mut next_edge) = (0, 0);
    // Points are numbered again within each caster; those of two casters that touch are there twice.
    let mut new_point = vec![(u32::MAX, 0u32); welded.points_m.len()];
    for caster in 0..count as u32 {
        let (first, first_edge) = (next, next_edge);
        let mut sides = DrawnSides { front: true, back: true };
        let (mut is_solid, mut is_smooth) = (true, false);
        while next < order.len() && caster_of(order[next] as usize) == caster {
            let old = order[next] as usize;
            let shape = bodies.shapes[bodies.of_triangle[old] as usize];
            // An alpha mask shows what lies behind the cap.
            let drawn = if has_alpha_mask(stage, flat[old] as usize) {
                DrawnSides::default()
            } else {
                stage.sides(flat[old] as usize)
            };
            let is_turned = shape == Shape::InsideOut;
            sides.front &= if is_turned { drawn.back } else { drawn.front };
            sides.back &= if is_turned { drawn.front } else { drawn.back };
            is_solid &= shape != Shape::Open;
            let is_risen_over = is_risen_over(stage, flat[old] as usize, is_turned);
            is_smooth |= is_risen_over;
            let mut points =
                welded.triangles[old].map(|point| renumber(point, caster, welded, &mut new_point, &mut casters));
            if is_turned {
                points.swap(1, 2);
            }
            casters.triangles.push(points);
            casters.is_risen_over.push(is_risen_over);
            next += 1;
        }
        while next_edge < edge_order.len() && caster_of_edge(edge_order[next_edge]) == caster {
            let old = edge_order[next_edge] as usize;
            push_edge(old, welded, &new_point, &new_triangle, bodies, &mut casters);
            next_edge += 1;
        }
        let (bounds_m, plane) = bounds_and_plane(&casters, first..next);
        casters.all.push(Caster {
            triangles: first..next,
            edges: first_edge..next_edge,
            is_solid,
            is_smooth,
            is_soup: is_soup(&casters, first_edge..next_edge),
            shows_fronts: sides.front,
            shows_both_sides: sides.front && sides.back,
            bounds_m,
            plane,
        });
    }
    casters.first_use.push(casters.uses.len() as u32);
    casters.counts.soups = casters.all.iter().filter(|caster| caster.is_soup).count();
    casters
}

fn renumber(point: u32, caster: u32, welded: &Welded, new_point: &mut [(u32, u32)], casters: &mut Casters) -> u32 {
    let entry = &mut new_point[point as usize];
    if entry.0 != caster {
        *entry = (caster, casters.points_m.len() as u32);
        casters.points_m.push(welded.points_m[point as usize]);
    }
    entry.1
}

fn push_edge(
    old: usize,
    welded: &Welded,
    new_point: &[(u32, u32)],
    new_triangle: &[u32],
    bodies: &Bodies,
    casters: &mut Casters,
) {
    let [a, b] = welded.edges[old].map(|point| new_point[point as usize].1);
    casters.edges.push([a.min(b), a.max(b)]);
    casters.first_use.push(casters.uses.len() as u32);
    for &edge_use in welded.uses_of(old) {
        let is_turned = bodies.shapes[bodies.of_triangle[edge_use.triangle()] as usize] == Shape::InsideOut;
        let renumbered = edge_use.renumbered(new_triangle[edge_use.triangle()]);
        casters.uses.push(if (a > b) != is_turned { renumbered.reversed() } else { renumbered });
    }
}

/// Whether something smooth rises over a triangle's front, or over its back where that is outside.
fn is_risen_over(stage: &Stage, triangle: usize, is_turned: bool) -> bool {
    let front = stage.geometry.normal(triangle);
    let outside = if is_turned { -front } else { front };
    let lifts = stage.geometry.edge_lifts_m(triangle);
    lifts.is_some_and(|lifts| lifts.iter().any(|lift| lift.dot(outside) > 0.0))
}

/// Whether a triangle's material has an alpha mask.
fn has_alpha_mask(stage: &Stage, triangle: usize) -> bool {
    matches!(stage.material(triangle).alpha, Alpha::Mask { .. })
}

/// Whether fewer than one edge in ten is shared.
fn is_soup(casters: &Casters, edges: Range<usize>) -> bool {
    let ends = |edge: usize| casters.first_use.get(edge + 1).map_or(casters.uses.len(), |&end| end as usize);
    let shared = edges.clone().filter(|&edge| ends(edge) - casters.first_use[edge] as usize > 1).count();
    10 * shared < edges.len()
}

/// Bounds of a caster's triangles, and the plane on which they lie.
fn bounds_and_plane(casters: &Casters, triangles: Range<usize>) -> ([DVec3; 2], Option<(DVec3, f64)>) {
    let corners = || triangles.clone().map(|triangle| casters.corners_m(triangle));
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let mut widest = DVec3::ZERO;
    let mut on_plane = DVec3::ZERO;
    for triangle in corners() {
        for corner in triangle {
            bounds = [bounds[0].min(corner), bounds[1].max(corner)];
        }
        if cross(&triangle).length_squared() > widest.length_squared() {
            widest = cross(&triangle);
            on_plane = triangle[0];
        }
    }
    let normal = widest.normalize_or_zero();
    let tolerance_m = PLANE_TOLERANCE_SHARE * (bounds[1] - bounds[0]).max_element();
    let is_flat = corners().all(|t| t.iter().all(|corner| (*corner - on_plane).dot(normal).abs() <= tolerance_m));
    (bounds, (is_flat && normal != DVec3::ZERO).then(|| (normal, normal.dot(on_plane))))
}
