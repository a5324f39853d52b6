//! The gutter: values for texels that no triangle touches but that a filter may read.
//!
//! Theory: a bilinear filter at a point of a chart reads the texel that holds the point, which is covered, and its
//! neighbours. Those that are not covered must hold the chart's values; wider filters and smaller mip levels need rings
//! of texels around them as well.
//!
//! Practice: charts lie side by side, so what a texel shows is decided by the triangle that reads it, and not by which
//! sample is near: the nearest of these triangles gives the sample at its nearest point. Rings then grow outwards from
//! all charts at once. A new texel takes the nearest of its neighbours' source samples; ties go to the lowest sample.
//! Based on: jump flooding with a step of one (Rong and Tan, "Jump Flooding in GPU with Applications to Voronoi Diagram
//! and Distance Transform", 2006).

use super::samples::{Bands, PageTriangle, nearest_on};
use super::{Atlas, PageSamples, PageSize, coverage};
use crate::scene::{Geometry, Scene};
use glam::DVec2;
use rayon::prelude::*;

/// A texel beside a chart, and the sample whose value it copies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct GutterTexel {
    /// `y * width + x`.
    pub texel: u32,
    /// Index in [`PageSamples::samples`].
    pub sample: u32,
}

const EMPTY: u32 = u32::MAX;

/// Every uncovered texel of a page that a filter reads at some triangle's points, and those within `padding_texels`
/// less one rings of these and of covered ones; ascending in `texel`.
pub fn gutter(
    scene: &Scene,
    geometry: &Geometry,
    atlas: &Atlas,
    page: u32,
    samples: &PageSamples,
    padding_texels: u32,
) -> Vec<GutterTexel> {
    let Some(&size) = atlas.pages.get(page as usize) else { return Vec::new() };
    let mut sources = vec![EMPTY; size.texel_count()];
    for (index, sample) in samples.samples.iter().enumerate() {
        sources[sample.texel as usize] = index as u32;
    }
    let bands = Bands::of_read(scene, geometry, atlas, page, size);
    let mut grown = read_texels(&bands, size, samples, &sources);
    grown.iter().for_each(|copy| sources[copy.texel as usize] = copy.sample);
    grown.extend(rings(size, samples, &mut sources, padding_texels.saturating_sub(1)));
    grown.par_sort_unstable();
    grown
}

/// Uncovered texels that a filter reads at a triangle's points, each with the sample at that triangle's nearest point.
fn read_texels(bands: &Bands, size: PageSize, samples: &PageSamples, sources: &[u32]) -> Vec<GutterTexel> {
    let of_band = |(members, rows): (&Vec<u32>, std::ops::Range<u32>)| {
        let first = (rows.start * size.width) as usize;
        let mut best = vec![(f64::INFINITY, EMPTY); rows.len() * size.width as usize];
        for &member in members {
            let triangle = &bands.triangles[member as usize];
            let read = coverage::read_rows(&triangle.corners, size.height);
            for y in read.start.max(rows.start)..read.end.min(rows.end) {
                for x in coverage::read_columns(&triangle.corners, y, size.width) {
                    let texel = (y * size.width + x) as usize;
                    if sources[texel] == EMPTY {
                        let away =
                            nearest_on(&triangle.corners, centre(texel, size)).distance_squared(centre(texel, size));
                        if away < best[texel - first].0 {
                            best[texel - first] = (away, member);
                        }
                    }
                }
            }
        }
        let read = best.into_iter().enumerate().filter(|(_, (_, member))| *member != EMPTY);
        let copy = |(place, (_, member)): (usize, (f64, u32))| {
            let texel = first + place;
            let sample = sample_near(&bands.triangles[member as usize], texel, size, samples, sources)?;
            Some(GutterTexel { texel: texel as u32, sample })
        };
        read.filter_map(copy).collect::<Vec<_>>()
    };
    bands.rows(size).into_par_iter().flat_map_iter(of_band).collect()
}

/// The sample at the point of a triangle that is nearest to a texel's centre.
fn sample_near(
    triangle: &PageTriangle,
    texel: usize,
    size: PageSize,
    samples: &PageSamples,
    sources: &[u32],
) -> Option<u32> {
    let nearest = nearest_on(&triangle.corners, centre(texel, size));
    let middle = triangle.corners.iter().sum::<DVec2>() / 3.0;
    // On the border between two texels, only one of them may be covered.
    let inwards = [0.0, 0.02, 0.5, 1.0].map(|share| nearest.lerp(middle, share));
    let sample_at = |point: DVec2| {
        let [x, y] = point.floor().to_array().map(|at| at.max(0.0) as u32);
        let at = y.min(size.height - 1) * size.width + x.min(size.width - 1);
        Some(sources[at as usize]).filter(|&sample| sample != EMPTY)
    };
    let [x, y] = [texel as u32 % size.width, texel as u32 / size.width];
    inwards.into_iter().find_map(sample_at).or_else(|| nearest_source(size, samples, sources, (x, y)))
}

fn centre(texel: usize, size: PageSize) -> DVec2 {
    let [x, y] = [texel % size.width as usize, texel / size.width as usize];
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}

/// Grows rings around all texels that have a source, and gives these sources as well.
fn rings(size: PageSize, samples: &PageSamples, sources: &mut [u32], count: u32) -> Vec<GutterTexel> {
    let mut grown = Vec::new();
    for _ in 0..count {
        let ring = next_ring(size, samples, sources);
        if ring.is_empty() {
            break;
        }
        ring.iter().for_each(|copy| sources[copy.texel as usize] = copy.sample);
        grown.extend(ring);
    }
    grown
}

/// The empty texels that have a neighbour with a source.
fn next_ring(size: PageSize, samples: &PageSamples, sources: &[u32]) -> Vec<GutterTexel> {
    let width = size.width as usize;
    let ring_of_row = |y: u32| {
        let row = &sources[y as usize * width..][..width];
        let empty = (0..size.width).filter(|&x| row[x as usize] == EMPTY);
        empty.filter_map(move |x| {
            let sample = nearest_source(size, samples, sources, (x, y))?;
            Some(GutterTexel { texel: y * size.width + x, sample })
        })
    };
    (0..size.height).into_par_iter().flat_map_iter(ring_of_row).collect()
}

/// The nearest of the eight neighbours' sources.
fn nearest_source(size: PageSize, samples: &PageSamples, sources: &[u32], (x, y): (u32, u32)) -> Option<u32> {
    let mut best = None;
    for ny in y.saturating_sub(1)..(y + 2).min(size.height) {
        for nx in x.saturating_sub(1)..(x + 2).min(size.width) {
            let source = sources[(ny * size.width + nx) as usize];
            if source != EMPTY {
                let texel = samples.samples[source as usize].texel;
                let (dx, dy) = ((texel % size.width).abs_diff(x), (texel / size.width).abs_diff(y));
                let key = (dx * dx + dy * dy, source);
                best = Some(best.map_or(key, |b: (u32, u32)| b.min(key)));
            }
        }
    }
    best.map(|(_, source)| source)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::Sample;

    fn covered(size: PageSize, texels: &[(u32, u32)]) -> PageSamples {
        let mut texels: Vec<u32> = texels.iter().map(|&(x, y)| y * size.width + x).collect();
        texels.sort_unstable();
        let sample = |texel| Sample { texel, triangle: 0, barycentric: [0.0; 2] };
        PageSamples { samples: texels.into_iter().map(sample).collect() }
    }

    fn rings_around(size: PageSize, samples: &PageSamples, count: u32) -> Vec<GutterTexel> {
        let mut sources = vec![EMPTY; size.texel_count()];
        samples.samples.iter().zip(0..).for_each(|(sample, index)| sources[sample.texel as usize] = index);
        rings(size, samples, &mut sources, count)
    }

    #[test]
    fn rings_reach_as_far_as_asked_and_takes_the_nearest() {
        let size = PageSize { width: 40, height: 30 };
        let samples = covered(size, &[(3, 3), (4, 3), (20, 10), (21, 12), (39, 29)]);
        for reach in 0..4 {
            let plan = rings_around(size, &samples, reach);
            for texel in 0..size.width * size.height {
                let (x, y) = (texel % size.width, texel / size.width);
                let distances = samples.samples.iter().map(|s| {
                    let (dx, dy) = ((s.texel % size.width).abs_diff(x), (s.texel / size.width).abs_diff(y));
                    (dx.max(dy), dx * dx + dy * dy)
                });
                let rings = distances.clone().map(|d| d.0).min().unwrap();
                let squared: Vec<u32> = distances.map(|d| d.1).collect();
                let entry = plan.iter().find(|g| g.texel == texel);
                assert_eq!(entry.is_some(), rings >= 1 && rings <= reach, "({x}, {y}) at reach {reach}");
                let nearest = f64::from(*squared.iter().min().unwrap()).sqrt();
                let taken = entry.map_or(nearest, |g| f64::from(squared[g.sample as usize]).sqrt());
                assert!(taken - nearest < 0.3 && (taken == nearest || reach > 2), "({x}, {y}) at reach {reach}");
            }
        }
    }

    #[test]
    fn an_empty_page_has_no_rings() {
        assert!(rings_around(PageSize { width: 8, height: 8 }, &PageSamples::default(), 4).is_empty());
    }
}
