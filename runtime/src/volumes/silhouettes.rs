//! Volumes of casters: the boundary of the prisms that are extruded from triangles away from the light.
//!
//! A triangle that blocks the light shades an infinite prism. The triangle is its *cap*, and from each of its edges a
//! *wall* leads away from the light. Where two prisms share a wall, one counts it +1 and the other -1, and it cancels.
//! So each edge's wall is drawn as often as the sum over its triangles says: not at all inside a lit patch, once around
//! it, twice where a triangle that faces the light meets one that faces away. Faces are signed, and counting them along
//! a line of sight counts the prisms that contain its end, for any triangles (after Bergeron, "A general version of
//! Crow's shadow volumes", *IEEE CG&A* 6(9), 1986, and Kim, Kim and Turk, "A shadow-volume algorithm for opaque and
//! transparent nonmanifold casters", *Journal of Graphics Tools* 13(3), 2008).
//!
//! The sun's rays meet in one point at infinity, so its walls are single triangles and need no far cap. A lamp's walls
//! are quads, and end in *dark caps*.
//!
//! Corners are indices: below the number of points, a point; from there on, for the sun, the point where its rays meet,
//! and for a lamp each point extruded away from it.

use super::casters::{Caster, Casters};
use super::light::Facings;
use rayon::prelude::*;
use std::ops::Range;

/// The shape of walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extrusion {
    /// Walls of the sun, which meet in a point at infinity.
    ToPoint,
    /// Walls of a lamp, which spread.
    Spread,
}

impl Extrusion {
    /// Triangles of a wall.
    pub fn wall_triangles(self) -> u32 {
        match self {
            Self::ToPoint => 1,
            Self::Spread => 2,
        }
    }
}

/// Volumes of all casters.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Volumes {
    /// Corners of triangles, counter-clockwise from outside.
    pub indices: Vec<u32>,
    /// For each caster, ranges of `indices`.
    pub parts: Vec<Parts>,
}

/// Where a caster's volume lies in [`Volumes::indices`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Parts {
    /// Walls along the edges.
    pub walls: Range<u32>,
    /// Caps at the casters themselves.
    pub caps: Range<u32>,
    /// Caps at infinity.
    pub dark_caps: Range<u32>,
    /// Triangles that the volume is not to shade, though it holds them.
    pub spared: Range<u32>,
}

/// A part of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Faces that lead from the caster's edges away from the light.
    Walls,
    /// The caster's own triangles.
    Caps,
    /// The far ends of a lamp's volumes.
    DarkCaps,
    /// No face of the volume: triangles of the caster that it is not to shade, though it holds them.
    Spared,
}

impl Part {
    /// The faces, in the order in which they lie in [`Volumes::indices`]. Spared triangles follow.
    pub const FACES: [Self; 3] = [Self::Walls, Self::Caps, Self::DarkCaps];

    /// The range of this part.
    pub fn of(self, parts: &Parts) -> Range<u32> {
        match self {
            Self::Walls => parts.walls.clone(),
            Self::Caps => parts.caps.clone(),
            Self::DarkCaps => parts.dark_caps.clone(),
            Self::Spared => parts.spared.clone(),
        }
    }
}

/// Which walls are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharing {
    /// Walls that cancel. Casters that share few edges are not searched.
    Silhouettes,
    /// No walls: each triangle has a whole prism.
    Prisms,
}

/// The volumes of all casters.
pub fn volumes(casters: &Casters, facings: &Facings, extrusion: Extrusion, sharing: Sharing) -> Volumes {
    let Facings { of_triangle: facings, is_spared, .. } = facings;
    let of_caster = |caster: &Caster| {
        let walls = match sharing == Sharing::Prisms || caster.is_soup {
            true => walls_of_prisms(casters, facings, caster, extrusion),
            false => walls_of_silhouettes(casters, facings, caster, extrusion),
        };
        let (caps, dark_caps) = caps(casters, facings, caster, extrusion);
        let spared = caster.triangles.clone().filter(|&triangle| is_spared[triangle]);
        [walls, caps, dark_caps, spared.flat_map(|triangle| casters.triangles[triangle]).collect()]
    };
    joined(&casters.all.par_iter().map(of_caster).collect::<Vec<_>>())
}

fn walls_of_silhouettes(casters: &Casters, facings: &[i8], caster: &Caster, extrusion: Extrusion) -> Vec<u32> {
    let edges = caster.edges.clone().into_par_iter().with_min_len(4096);
    let walls = edges.flat_map_iter(|edge| {
        let winding = edge_winding(casters, facings, edge);
        wall(casters, casters.edges[edge], winding.signum(), extrusion).repeat(winding.unsigned_abs() as usize)
    });
    walls.collect()
}

fn walls_of_prisms(casters: &Casters, facings: &[i8], caster: &Caster, extrusion: Extrusion) -> Vec<u32> {
    let walls = caster.triangles.clone().into_par_iter().with_min_len(1024).flat_map_iter(|triangle| {
        let points = casters.triangles[triangle];
        let facing = i32::from(facings[triangle]);
        (0..3).flat_map(move |k| {
            let (from, to) = (points[k], points[(k + 1) % 3]);
            let orientation = if from < to { facing } else { -facing };
            wall(casters, [from.min(to), from.max(to)], if from == to { 0 } else { orientation }, extrusion)
        })
    });
    walls.collect()
}

/// How often the wall of an edge is drawn, with its sign: the sum over its triangles.
pub fn edge_winding(casters: &Casters, facings: &[i8], edge: usize) -> i32 {
    casters.uses_of(edge).iter().map(|u| u.sign() * i32::from(facings[u.triangle()])).sum()
}

/// A wall outside of a patch whose boundary runs along the edge from its lower point to its higher (`orientation` 1) or
/// back (-1). Both start at the same corner and cut the quad along the same diagonal, so that a rasteriser, which
/// interpolates from the first corner, gives both the same depths.
fn wall(casters: &Casters, [low, high]: [u32; 2], orientation: i32, extrusion: Extrusion) -> Vec<u32> {
    let points = casters.points_m.len() as u32;
    match (extrusion, orientation) {
        (_, 0) => Vec::new(),
        (Extrusion::ToPoint, 1) => vec![high, low, points],
        (Extrusion::ToPoint, _) => vec![high, points, low],
        (Extrusion::Spread, 1) => vec![high, low, points + low, high, points + low, points + high],
        (Extrusion::Spread, _) => vec![high, points + low, low, high, points + high, points + low],
    }
}

fn caps(casters: &Casters, facings: &[i8], caster: &Caster, extrusion: Extrusion) -> (Vec<u32>, Vec<u32>) {
    let points = casters.points_m.len() as u32;
    let (mut caps, mut dark_caps) = (Vec::new(), Vec::new());
    for triangle in caster.triangles.clone().filter(|&triangle| facings[triangle] != 0) {
        let [a, b, c] = casters.triangles[triangle];
        let [a, b, c] = if facings[triangle] > 0 { [a, b, c] } else { [a, c, b] };
        caps.extend([a, b, c]);
        if extrusion == Extrusion::Spread {
            dark_caps.extend([a, c, b].map(|point| points + point));
        }
    }
    (caps, dark_caps)
}

fn joined(all: &[[Vec<u32>; 4]]) -> Volumes {
    let mut volumes = Volumes {
        indices: Vec::with_capacity(all.iter().flatten().map(Vec::len).sum()),
        parts: Vec::with_capacity(all.len()),
    };
    for parts in all {
        let [walls, caps, dark_caps, spared] = parts.each_ref().map(|part| {
            let first = volumes.indices.len() as u32;
            volumes.indices.extend(part);
            first..volumes.indices.len() as u32
        });
        volumes.parts.push(Parts { walls, caps, dark_caps, spared });
    }
    volumes
}
