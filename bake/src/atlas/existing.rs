//! Checks whether the file's own texture coordinates can be used as a layout.
//!
//! Theory: authors put light map coordinates into `TEXCOORD_1`; `TEXCOORD_0` usually tiles, mirrors and overlaps. A set
//! can be used as a layout if every surface point has its own texels.
//!
//! Practice: a mesh's set is used unchanged if
//!
//! * all coordinates are finite and within [0, 1];
//! * at most [`NO_AREA_SHARE`] of the surface has no area in the set;
//! * at most [`OVERLAP_SHARE`] of the set's area overlaps;
//! * at its final size on the page, at most [`CROWDED_SHARE`] of its texels are touched by two islands.
//!
//! Mirrored islands are allowed. There are two cases: all meshes, each drawn once, share one [0, 1] without overlap
//! ([`share_one_square`]); or each mesh has its own rectangle. In the second case a set must also fill [`LEAST_FILL`]
//! of its rectangle, because some exporters leave coordinates in `TEXCOORD_1` that do not overlap but spread small
//! specks over the whole square, which would waste the page.

use super::arrange::FileLayout;
use super::coverage;
use super::overlap::{Triangle, area2, overlap_more_than};
use super::{FILE_SET, PageSize};
use crate::scene::{Mesh, Scene};
use glam::{DVec2, Vec2};
use std::collections::{HashMap, HashSet};

/// Largest share of the surface without area in the set.
const NO_AREA_SHARE: f64 = 1e-4;
/// Largest share of the set's area that is covered twice.
const OVERLAP_SHARE: f64 = 1e-3;
/// Largest share of texels that two islands both touch.
pub(super) const CROWDED_SHARE: f64 = 0.02;
/// Least share of its bounding box that a set with its own rectangle must cover.
const LEAST_FILL: f64 = 0.25;
/// Marks a texel that two islands touch.
const CROWDED: u32 = u32::MAX;
/// Marks a texel that no island touches.
const UNOWNED: u32 = u32::MAX - 1;
/// Coordinates this far outside [0, 1] are accepted as rounding.
const ROUNDING: f32 = 1e-5;

/// Why a set cannot be used as a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LayoutProblem {
    /// The mesh has no such set.
    Missing,
    /// Some coordinate is NaN or infinite.
    NotFinite,
    /// Some coordinate is outside [0, 1]: the set tiles.
    Outside,
    /// Too much of the surface has no area in the set.
    NoArea,
    /// Too much of the set overlaps.
    Overlap,
    /// The set would leave most of its rectangle empty.
    Sparse,
}

/// The mesh's `TEXCOORD_1`, if it can be used.
pub(super) fn check_layout(mesh: &Mesh) -> Result<FileLayout, LayoutProblem> {
    let uvs = mesh.texcoord_set(FILE_SET).ok_or(LayoutProblem::Missing)?;
    let used = mesh.indices.iter().map(|&i| uvs[i as usize]);
    if !used.clone().all(|uv| uv.is_finite()) {
        return Err(LayoutProblem::NotFinite);
    }
    let (least, most) = (Vec2::splat(-ROUNDING), Vec2::splat(1.0 + ROUNDING));
    if !used.clone().all(|uv| uv.cmpge(least).all() && uv.cmple(most).all()) {
        return Err(LayoutProblem::Outside);
    }
    let triangles = triangles(mesh, uvs);
    let (object_area, uv_area) = areas(mesh, &triangles).ok_or(LayoutProblem::NoArea)?;
    if overlap_more_than(&without_copies(mesh, &triangles), OVERLAP_SHARE) {
        return Err(LayoutProblem::Overlap);
    }
    let low = used.clone().reduce(Vec2::min).unwrap_or_default().as_dvec2();
    let high = used.reduce(Vec2::max).unwrap_or_default().as_dvec2();
    Ok(FileLayout { low, size: high - low, object_per_uv: (object_area / uv_area).sqrt(), uv_area })
}

/// The same for a set that gets its own rectangle: it must also fill enough of its bounding box.
pub(super) fn check_own_rectangle(mesh: &Mesh) -> Result<FileLayout, LayoutProblem> {
    let given = check_layout(mesh)?;
    if given.uv_area < LEAST_FILL * given.size.x * given.size.y { Err(LayoutProblem::Sparse) } else { Ok(given) }
}

/// Whether the meshes, all valid and each drawn once, use separate parts of one [0, 1].
pub(super) fn share_one_square(scene: &Scene, meshes: &[usize]) -> bool {
    let mut all = Vec::new();
    for &mesh in meshes {
        let mesh = &scene.meshes[mesh];
        let Some(uvs) = mesh.texcoord_set(FILE_SET) else { return false };
        all.extend(without_copies(mesh, &triangles(mesh, uvs)));
    }
    !overlap_more_than(&all, OVERLAP_SHARE)
}

fn triangles(mesh: &Mesh, uvs: &[Vec2]) -> Vec<Triangle> {
    let corners = |t: &[u32]| [0, 1, 2].map(|k| uvs[t[k] as usize].as_dvec2());
    mesh.indices.chunks_exact(3).map(corners).collect()
}

/// Removes triangles that repeat another one, in space and in the set, with the same front. They show the same surface,
/// so they may share its texels.
fn without_copies(mesh: &Mesh, triangles: &[Triangle]) -> Vec<Triangle> {
    let corner = |v: u32, uv: DVec2| {
        let at = mesh.positions[v as usize] + 0.0;
        (at.to_array().map(f32::to_bits), (uv + 0.0).to_array().map(f64::to_bits))
    };
    let mut seen = HashSet::with_capacity(triangles.len());
    let mut is_first = |(t, uvs): &(&[u32], &Triangle)| {
        let corners = [0, 1, 2].map(|k| corner(t[k], uvs[k]));
        let turned = [0, 1, 2].map(|k| [0, 1, 2].map(|j| corners[(j + k) % 3]));
        seen.insert(turned.into_iter().min())
    };
    mesh.indices.chunks_exact(3).zip(triangles).filter(|pair| is_first(pair)).map(|(_, t)| *t).collect()
}

/// Total area in object space and in texture coordinates; `None` if too much of the surface has no area in the set.
fn areas(mesh: &Mesh, triangles: &[Triangle]) -> Option<(f64, f64)> {
    let object: Vec<f64> = mesh.indices.chunks_exact(3).map(|t| object_area(mesh, t)).collect();
    let uv: Vec<f64> = triangles.iter().map(|t| area2(t).abs() * 0.5).collect();
    let (object_sum, uv_sum) = (object.iter().sum::<f64>(), uv.iter().sum::<f64>());
    if object_sum <= 0.0 || uv_sum <= 0.0 {
        return None;
    }
    // A triangle with a thousandth of the mean density counts as having no area.
    let collapsed = |&(o, u): &(&f64, &f64)| u / uv_sum < 1e-6 * (o / object_sum);
    let lost: f64 = object.iter().zip(&uv).filter(collapsed).map(|(o, _)| o).sum();
    (lost <= NO_AREA_SHARE * object_sum).then_some((object_sum, uv_sum))
}

fn object_area(mesh: &Mesh, triangle: &[u32]) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize].as_dvec3());
    (b - a).cross(c - a).length() * 0.5
}

/// The share of touched texels that two islands touch, for the meshes' `TEXCOORD_1` on a page of this size.
/// `texel_from_uv` maps texture coordinates to texels.
pub(super) fn crowded_share(meshes: &[&Mesh], size: PageSize, texel_from_uv: impl Fn(DVec2) -> DVec2) -> f64 {
    let mut owners = vec![UNOWNED; size.texel_count()];
    let (mut touched, mut crowded, mut base) = (0u32, 0u32, 0u32);
    for mesh in meshes {
        let Some(uvs) = mesh.texcoord_set(FILE_SET) else { continue };
        let island = islands(mesh, uvs);
        for (triangle, corners) in mesh.indices.chunks_exact(3).zip(triangles(mesh, uvs)) {
            let corners = corners.map(&texel_from_uv);
            let island_id = base + island[triangle[0] as usize];
            for y in coverage::rows(&corners, size.height) {
                for x in coverage::columns(&corners, y, size.width) {
                    let owner = &mut owners[(y * size.width + x) as usize];
                    if *owner == UNOWNED {
                        *owner = island_id;
                        touched += 1;
                    } else if *owner != island_id && *owner != CROWDED {
                        *owner = CROWDED;
                        crowded += 1;
                    }
                }
            }
        }
        base += mesh.positions.len() as u32;
    }
    f64::from(crowded) / f64::from(touched.max(1))
}

/// For each vertex, the lowest vertex of its island. Vertices with equal coordinates belong to the same island.
fn islands(mesh: &Mesh, uvs: &[Vec2]) -> Vec<u32> {
    fn find(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    let mut parent: Vec<u32> = (0..uvs.len() as u32).collect();
    let mut at: HashMap<[u32; 2], u32> = HashMap::with_capacity(uvs.len());
    let join = |parent: &mut Vec<u32>, a: u32, b: u32| {
        let (a, b) = (find(parent, a), find(parent, b));
        parent[a.max(b) as usize] = a.min(b);
    };
    for t in mesh.indices.chunks_exact(3) {
        join(&mut parent, t[0], t[1]);
        join(&mut parent, t[1], t[2]);
        for &v in t {
            let first = *at.entry((uvs[v as usize] + 0.0).to_array().map(f32::to_bits)).or_insert(v);
            join(&mut parent, first, v);
        }
    }
    (0..uvs.len() as u32).map(|v| find(&mut parent, v)).collect()
}
