//! Volumes from casters: the boundary of the prisms that the light extrudes from triangles.
//!
//! A triangle that blocks the light shades a prism without end: the triangle is its *cap*, and from each of its edges a
//! *wall* leads away from the light. Where two prisms meet in a wall, one says +1 and the other -1, and the wall is not
//! there. So what has to be drawn is each edge times the sum of what its triangles say: nothing within a lit patch, once
//! around it, twice where two triangles that face the light from either side meet. Faces are signed, and counting them
//! along a line of sight counts the prisms that hold its end, for any triangles whatever (after Bergeron, "A general version
//! of Crow's shadow volumes", *IEEE CG&A* 6(9), 1986, and Kim, Kim and Turk, "A shadow-volume algorithm for opaque and
//! transparent nonmanifold casters", *Journal of Graphics Tools* 13(3), 2008).
//!
//! The sun's rays meet in one point at infinity, so its walls are single triangles and there is nothing to close them
//! with. A lamp's are quads, and end in *dark caps*.
//!
//! Corners are indices: below the number of points, a point; from there on, for the sun, the point where its rays meet,
//! and for a lamp each point extruded away from it.

use super::casters::{Caster, Casters};
use rayon::prelude::*;
use std::ops::Range;

/// What is extruded from an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extrusion {
    /// Walls that meet in a point.
    ToPoint,
    /// Walls that spread.
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
    /// For each caster, places in `indices`.
    pub parts: Vec<Parts>,
}

/// Where a caster's volume lies, in corners.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Parts {
    /// Walls.
    pub walls: Range<u32>,
    /// Caps at the casters themselves.
    pub caps: Range<u32>,
    /// Caps at infinity.
    pub dark_caps: Range<u32>,
}

/// A part of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// What leads away from the light.
    Walls,
    /// The casters themselves.
    Caps,
    /// What ends a lamp's volumes.
    DarkCaps,
}

impl Part {
    /// All of them, in the order in which they lie in [`Volumes::indices`].
    pub const ALL: [Self; 3] = [Self::Walls, Self::Caps, Self::DarkCaps];

    /// Where it lies.
    pub fn of(self, parts: &Parts) -> Range<u32> {
        match self {
            Self::Walls => parts.walls.clone(),
            Self::Caps => parts.caps.clone(),
            Self::DarkCaps => parts.dark_caps.clone(),
        }
    }
}

/// Which walls are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sharing {
    /// Those that cancel. Casters whose triangles share next to no edges are spared the search.
    Silhouettes,
    /// None: each triangle has its own prism, and is right by itself.
    Prisms,
}

/// The volumes of all casters.
pub fn volumes(casters: &Casters, faces: &[i8], extrusion: Extrusion, sharing: Sharing) -> Volumes {
    let of_caster = |caster: &Caster| {
        let walls = match sharing == Sharing::Prisms || caster.is_soup {
            true => walls_of_prisms(casters, faces, caster, extrusion),
            false => walls_of_silhouettes(casters, faces, caster, extrusion),
        };
        let (caps, dark_caps) = caps(casters, faces, caster, extrusion);
        [walls, caps, dark_caps]
    };
    joined(&casters.all.par_iter().map(of_caster).collect::<Vec<_>>())
}

fn walls_of_silhouettes(casters: &Casters, faces: &[i8], caster: &Caster, extrusion: Extrusion) -> Vec<u32> {
    let edges = caster.edges.clone().into_par_iter().with_min_len(4096);
    let walls = edges.flat_map_iter(|edge| {
        let times = edge_count(casters, faces, edge);
        wall(casters, casters.edges[edge], times.signum(), extrusion).repeat(times.unsigned_abs() as usize)
    });
    walls.collect()
}

fn walls_of_prisms(casters: &Casters, faces: &[i8], caster: &Caster, extrusion: Extrusion) -> Vec<u32> {
    let walls = caster.triangles.clone().into_par_iter().with_min_len(1024).flat_map_iter(|triangle| {
        let points = casters.triangles[triangle];
        let face = i32::from(faces[triangle]);
        (0..3).flat_map(move |k| {
            let (from, to) = (points[k], points[(k + 1) % 3]);
            let way = if from < to { face } else { -face };
            wall(casters, [from.min(to), from.max(to)], if from == to { 0 } else { way }, extrusion)
        })
    });
    walls.collect()
}

/// What the triangles along an edge say together.
pub fn edge_count(casters: &Casters, faces: &[i8], edge: usize) -> i32 {
    casters.uses_of(edge).iter().map(|u| u.sign() * i32::from(faces[u.triangle()])).sum()
}

/// A wall outside of a patch whose boundary runs along the edge from its lower point to its higher (`way` 1) or back (-1).
/// Both start from the same corner and cut their quad along the same diagonal, so that rasterisers, which reckon from the
/// first corner, give one the depths of the other.
fn wall(casters: &Casters, [low, high]: [u32; 2], way: i32, extrusion: Extrusion) -> Vec<u32> {
    let points = casters.points_m.len() as u32;
    match (extrusion, way) {
        (_, 0) => Vec::new(),
        (Extrusion::ToPoint, 1) => vec![high, low, points],
        (Extrusion::ToPoint, _) => vec![high, points, low],
        (Extrusion::Spread, 1) => vec![high, low, points + low, high, points + low, points + high],
        (Extrusion::Spread, _) => vec![high, points + low, low, high, points + high, points + low],
    }
}

fn caps(casters: &Casters, faces: &[i8], caster: &Caster, extrusion: Extrusion) -> (Vec<u32>, Vec<u32>) {
    let points = casters.points_m.len() as u32;
    let (mut caps, mut dark_caps) = (Vec::new(), Vec::new());
    for triangle in caster.triangles.clone().filter(|&triangle| faces[triangle] != 0) {
        let [a, b, c] = casters.triangles[triangle];
        let [a, b, c] = if faces[triangle] > 0 { [a, b, c] } else { [a, c, b] };
        caps.extend([a, b, c]);
        if extrusion == Extrusion::Spread {
            dark_caps.extend([a, c, b].map(|point| points + point));
        }
    }
    (caps, dark_caps)
}

fn joined(all: &[[Vec<u32>; 3]]) -> Volumes {
    let mut volumes = Volumes {
        indices: Vec::with_capacity(all.iter().flatten().map(Vec::len).sum()),
        parts: Vec::with_capacity(all.len()),
    };
    for parts in all {
        let [walls, caps, dark_caps] = parts.each_ref().map(|part| {
            let first = volumes.indices.len() as u32;
            volumes.indices.extend(part);
            first..volumes.indices.len() as u32
        });
        volumes.parts.push(Parts { walls, caps, dark_caps });
    }
    volumes
}
