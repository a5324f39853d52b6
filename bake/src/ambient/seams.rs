//! Seams: where a surface was cut into charts, filtered values on both sides of the seam should agree.
//!
//! Theory. The texels of the two charts lie on different grids. So filtered values differ across the seam, by the
//! texels' noise and because the gutter only repeats values. Texels near seams are therefore changed as little as makes
//! the filtered values agree: of all x, the one with the least
//! `sum over points of (A x - B x)^2 + sum of weight (x - x0)^2`, where A and B filter the two sides. Based on:
//! Iwanicki, "Lighting technology of The Last of Us", *SIGGRAPH Talks* 2013.
//!
//! Practice. An edge is a seam where the two sides are one surface: same ends, same shading normals there. Points lie
//! half a texel apart. Gutter texels may change freely, covered texels much less. Solved by conjugate gradients on the
//! normal equations (Shewchuk, "An introduction to the conjugate gradient method without the agonizing pain", 1994).

use crate::atlas::{Atlas, Footprint, PageSamples, PageSize};
use crate::scene::{Geometry, Scene, ShadingNormals};
use crate::statistics;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Cosine of the angle by which shading normals of one surface may differ: two and a half degrees.
const SAME_NORMAL: f64 = 0.999;
/// Cosine of the angle by which the triangles themselves may differ: forty-five degrees. Larger angles belong to wires
/// and bars of four or five sides, whose sides see different halves of the world however smooth their normals.
const SAME_PLANE: f64 = 0.7;
/// Sides that differ by more than this are taken to differ in truth, as where another surface ends at the seam.
const MOST_DIFFERENCE: f64 = 0.25;
/// Distance in texels below which two points on a page are the same.
const SAME_PLACE_TEXELS: f64 = 1e-3;
/// Weight of the change of a covered texel, and of a gutter texel, against differences at seams.
const STIFFNESS: [f64; 2] = [0.05, 0.0005];
/// How many edges at the same position are searched for the next one of the same surface.
const NEXT: usize = 16;
/// Most points along an edge.
const MOST_POINTS: f64 = 4096.0;
const ITERATIONS: usize = 60;

/// The seams of a page.
pub struct Seams {
    /// For each point, eight texels (indices in `texels`): those of one side with their weights, those of the other
    /// with theirs negated.
    points: Vec<[(u32, f64); 8]>,
    /// For each texel, the points that it is part of, by `first`.
    of_texel: Vec<(u32, f64)>,
    first: Vec<u32>,
    /// Indices on the page.
    texels: Vec<u32>,
    stiffness: Vec<f64>,
}

/// Differences of filtered values across seams.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Mismatch {
    /// Points on seams at which both sides were compared.
    pub points: u64,
    /// Of these, those whose sides are taken to differ in truth: they are not changed, and do not count below.
    pub differing: u64,
    /// Mean over all that count.
    pub mean: f64,
    /// 99th percentile over all that count.
    pub p99: f64,
    /// The largest of all that count.
    pub worst: f64,
}

/// An edge of a triangle, from the end with the lesser coordinates to the other.
struct Edge {
    ends: [DVec2; 2],
    normals: [DVec3; 2],
    /// Of the triangle itself.
    plane: DVec3,
}

impl Seams {
    /// Finds the seams of a page.
    pub fn find(
        scene: &Scene,
        geometry: &Geometry,
        normals: &ShadingNormals,
        atlas: &Atlas,
        page: u32,
        samples: &PageSamples,
    ) -> Self {
        let size = atlas.pages[page as usize];
        let mut points = Vec::new();
        for edges in edges_by_place(scene, geometry, normals, atlas, page).values() {
            for (k, one) in edges.iter().enumerate() {
                // Where many edges share a position, each agrees with the next, and so with all.
                let next = edges[k + 1..].iter().take(NEXT).find(|other| is_seam(one, other));
                points.extend(next.into_iter().flat_map(|other| along(one, other, size)));
            }
        }
        // Hash maps have no order, and sums depend on it.
        points.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        points.dedup();
        Self::of_points(points, size, samples)
    }

    fn of_points(mut points: Vec<[(u32, f64); 8]>, size: PageSize, samples: &PageSamples) -> Self {
        let mut texels: Vec<u32> = points.iter().flatten().map(|&(texel, _)| texel).collect();
        texels.sort_unstable();
        texels.dedup();
        let mut index = vec![u32::MAX; size.texel_count()];
        texels.iter().enumerate().for_each(|(i, &texel)| index[texel as usize] = i as u32);
        points.iter_mut().flatten().for_each(|(texel, _)| *texel = index[*texel as usize]);
        let mut stiffness = vec![STIFFNESS[1]; texels.len()];
        for sample in &samples.samples {
            if let Some(stiffness) = stiffness.get_mut(index[sample.texel as usize] as usize) {
                *stiffness = STIFFNESS[0];
            }
        }
        let mut first = vec![0u32; texels.len() + 1];
        points.iter().flatten().for_each(|&(texel, _)| first[texel as usize + 1] += 1);
        (0..texels.len()).for_each(|i| first[i + 1] += first[i]);
        let mut next = first.clone();
        let mut of_texel = vec![(0, 0.0); 8 * points.len()];
        for (point, weights) in points.iter().enumerate() {
            for &(texel, weight) in weights {
                of_texel[next[texel as usize] as usize] = (point as u32, weight);
                next[texel as usize] += 1;
            }
        }
        Self { points, of_texel, first, texels, stiffness }
    }

    /// Weight of each point, 1 or 0: 0 where the sides differ in truth.
    fn weights(&self, plane: &[f32]) -> Vec<f64> {
        let differences = self.differences(&self.values(plane));
        differences.iter().map(|difference| f64::from(u8::from(difference.abs() <= MOST_DIFFERENCE))).collect()
    }

    fn values(&self, plane: &[f32]) -> Vec<f64> {
        self.texels.iter().map(|&texel| f64::from(plane[texel as usize])).collect()
    }

    fn mismatch(&self, plane: &[f32], weights: &[f64]) -> Mismatch {
        let differences = self.differences(&self.values(plane));
        let mut differences: Vec<f64> = differences
            .into_iter()
            .zip(weights)
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(difference, _)| difference.abs())
            .collect();
        differences.sort_unstable_by(f64::total_cmp);
        let count = differences.len();
        let at = |share: f64| {
            differences.get(((count as f64 * share) as usize).min(count.wrapping_sub(1))).copied().unwrap_or(0.0)
        };
        let mean = statistics::mean(differences.iter().copied());
        let points = weights.len() as u64;
        Mismatch { points, differing: points - count as u64, mean, p99: at(0.99), worst: at(1.0) }
    }

    /// Changes texels so that the two sides agree, all within `range`. Gives the differences before and after.
    pub fn stitch(&self, plane: &mut [f32], range: [f32; 2]) -> [Mismatch; 2] {
        let weights = self.weights(plane);
        let before = self.mismatch(plane, &weights);
        for (&texel, value) in self.texels.iter().zip(self.solved(&self.values(plane), &weights)) {
            plane[texel as usize] = (value as f32).clamp(range[0], range[1]);
        }
        [before, self.mismatch(plane, &weights)]
    }

    /// Conjugate gradients, preconditioned by the diagonal, for `(D'WD + H) x = H x0`.
    fn solved(&self, start: &[f64], of_points: &[f64]) -> Vec<f64> {
        let of_texel = |i: usize| self.points_of(i).iter().map(|&(p, w)| w * w * of_points[p as usize]).sum::<f64>();
        let diagonal: Vec<f64> = (0..start.len()).map(|i| self.stiffness[i] + of_texel(i)).collect();
        let normal = |x: &[f64]| {
            let mut differences = self.differences(x);
            differences.iter_mut().zip(of_points).for_each(|(difference, weight)| *difference *= weight);
            self.gathered(&differences)
        };
        let mut x = start.to_vec();
        let mut residual: Vec<f64> = normal(&x).iter().map(|g| -g).collect();
        let mut scaled: Vec<f64> = residual.iter().zip(&diagonal).map(|(r, d)| r / d).collect();
        let mut along = scaled.clone();
        let mut energy = dot(&residual, &scaled);
        let enough = energy * 1e-12;
        for _ in 0..ITERATIONS {
            if energy <= enough || energy == 0.0 {
                break;
            }
            let mut image = normal(&along);
            image.iter_mut().zip(&along).zip(&self.stiffness).for_each(|((i, a), h)| *i += h * a);
            let step = energy / dot(&along, &image);
            x.iter_mut().zip(&along).for_each(|(x, a)| *x += step * a);
            residual.iter_mut().zip(&image).for_each(|(r, i)| *r -= step * i);
            scaled.iter_mut().zip(&residual).zip(&diagonal).for_each(|((s, r), d)| *s = r / d);
            let next = dot(&residual, &scaled);
            along.iter_mut().zip(&scaled).for_each(|(a, s)| *a = s + next / energy * *a);
            energy = next;
        }
        x
    }

    fn points_of(&self, texel: usize) -> &[(u32, f64)] {
        &self.of_texel[self.first[texel] as usize..self.first[texel + 1] as usize]
    }

    /// One side minus the other, at every point.
    fn differences(&self, values: &[f64]) -> Vec<f64> {
        let difference = |point: &[(u32, f64); 8]| point.iter().map(|&(texel, w)| w * values[texel as usize]).sum();
        self.points.par_iter().with_min_len(1024).map(difference).collect()
    }

    /// For every texel, the sum over its points by its weight in each: the transpose of [`Self::differences`].
    fn gathered(&self, of_points: &[f64]) -> Vec<f64> {
        let gather = |texel| self.points_of(texel).iter().map(|&(point, w)| w * of_points[point as usize]).sum();
        (0..self.texels.len()).into_par_iter().with_min_len(1024).map(gather).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Bits of a position, to compare positions exactly.
type PositionBits = [u32; 3];

/// Edges of all triangles on a page, by the positions of their ends.
fn edges_by_place(
    scene: &Scene,
    geometry: &Geometry,
    normals: &ShadingNormals,
    atlas: &Atlas,
    page: u32,
) -> HashMap<[PositionBits; 2], Vec<Edge>> {
    let size = atlas.pages[page as usize];
    let place = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut edges: HashMap<[PositionBits; 2], Vec<Edge>> = HashMap::new();
    for (instance, _) in atlas.placements.iter().enumerate().filter(|(_, p)| p.page == page && !p.is_empty()) {
        let layout = &atlas.layouts[scene.instances[instance].mesh];
        let first = geometry.first_triangle[instance] as usize;
        for (triangle, vertices) in (first..).zip(layout.indices.chunks_exact(3)) {
            let corners = geometry.triangles[triangle];
            let texels = [0, 1, 2].map(|k| atlas.texel(instance, layout.uvs[vertices[k] as usize], size));
            const WEIGHTS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
            let plane = geometry.normal(triangle);
            let facing = WEIGHTS.map(|weights| normals.at(scene, geometry, triangle, weights));
            for k in 0..3 {
                let (mut a, mut b) = (k, (k + 1) % 3);
                if place(corners[b]) < place(corners[a]) {
                    (a, b) = (b, a);
                }
                let edge = Edge { ends: [texels[a], texels[b]], normals: [facing[a], facing[b]], plane };
                edges.entry([place(corners[a]), place(corners[b])]).or_default().push(edge);
            }
        }
    }
    edges
}

/// Whether two edges at the same position are one surface, and lie at different points of the page.
fn is_seam(one: &Edge, other: &Edge) -> bool {
    let is_apart = one.ends.iter().zip(&other.ends).any(|(a, b)| a.distance(*b) > SAME_PLACE_TEXELS);
    let is_one_surface = one.normals.iter().zip(&other.normals).all(|(a, b)| a.dot(*b) > SAME_NORMAL);
    is_apart && is_one_surface && one.plane.dot(other.plane) > SAME_PLANE
}

/// Points along a seam.
fn along(one: &Edge, other: &Edge, size: PageSize) -> impl Iterator<Item = [(u32, f64); 8]> {
    let length = |edge: &Edge| edge.ends[0].distance(edge.ends[1]);
    let steps = (2.0 * length(one).max(length(other))).ceil().clamp(1.0, MOST_POINTS) as u32;
    let sides = [one.ends, other.ends];
    (0..=steps).map(move |step| {
        let share = f64::from(step) / f64::from(steps);
        let [a, b] = sides.map(|ends| Footprint::new(ends[0].lerp(ends[1], share) - 0.5, size));
        let (of_a, of_b) = (a.weights(), b.weights());
        std::array::from_fn(|k| match k {
            0..4 => (a.texels[k] as u32, of_a[k]),
            _ => (b.texels[k - 4] as u32, -of_b[k - 4]),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A seam between two rows of texels that differ by a step, with a gutter row beside each.
    fn seams() -> (Seams, PageSize) {
        let size = PageSize { width: 16, height: 12 };
        let (normals, plane) = ([DVec3::Y; 2], DVec3::Y);
        let one = Edge { ends: [DVec2::new(2.0, 3.0), DVec2::new(14.0, 3.0)], normals, plane };
        let other = Edge { ends: [DVec2::new(3.0, 8.3), DVec2::new(13.0, 8.3)], normals, plane };
        assert!(is_seam(&one, &other) && !is_seam(&one, &one));
        let covered = (0..16).flat_map(|x| [2 * 16 + x, 8 * 16 + x]).collect::<std::collections::BTreeSet<u32>>();
        let sample = |texel| crate::atlas::Sample { texel, triangle: 0, barycentric: [0.0; 2] };
        let samples = PageSamples { samples: covered.into_iter().map(sample).collect() };
        (Seams::of_points(along(&one, &other, size).collect(), size, &samples), size)
    }

    #[test]
    fn stitched_sides_agree_and_covered_texels_hardly_change() {
        let (seams, size) = seams();
        let mut plane: Vec<f32> =
            (0..size.texel_count()).map(|i| if i / 16 < 6 { 0.6 } else { 0.5 } + (i % 3) as f32 * 0.02).collect();
        let before = plane.clone();
        let [earlier, after] = seams.stitch(&mut plane, [0.0, 1.0]);
        assert!(earlier.worst > 0.08 && earlier.differing == 0);
        assert!(after.worst < 0.01 && after.mean < 0.003, "{after:?}");
        let moved =
            |row: usize| (0..16).map(|x| (plane[row * 16 + x] - before[row * 16 + x]).abs()).fold(0.0, f32::max);
        assert!(moved(2) < 0.06 && moved(8) < 0.06, "{} {}", moved(2), moved(8));
        assert_eq!((moved(0), moved(5), moved(11)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn a_page_that_agrees_is_left_alone() {
        let (seams, size) = seams();
        let mut plane: Vec<f32> = vec![0.4; size.texel_count()];
        seams.stitch(&mut plane, [0.0, 1.0]);
        assert!(plane.iter().all(|&x| (x - 0.4).abs() < 1e-6));
    }
}
