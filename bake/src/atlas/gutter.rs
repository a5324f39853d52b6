//! The gutter: values for texels that no triangle touches but that a filter may read.
//!
//! Theory: a bilinear filter at a point of a chart reads the texel that holds the point, which is covered, and its
//! neighbours. So one ring of texels around a chart must hold the chart's values; wider filters and smaller mip levels
//! need more rings.
//!
//! Practice: rings grow outwards from all charts at once. A new texel takes the nearest of its neighbours' source
//! samples; ties go to the lowest sample. In the first two rings that is the nearest source of all; farther out,
//! another source may be nearer by a fraction of a texel. Charts are at least twice the padding apart, so within the
//! padding the source is always of the same chart. Based on: jump flooding with a step of one (Rong and Tan, "Jump
//! Flooding in GPU with Applications to Voronoi Diagram and Distance Transform", 2006).

use super::{PageSamples, PageSize};
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

/// Every uncovered texel within `reach_texels` rings of a covered one, ascending in `texel`.
pub fn gutter(size: PageSize, samples: &PageSamples, reach_texels: u32) -> Vec<GutterTexel> {
    let mut sources = vec![EMPTY; size.texel_count()];
    for (index, sample) in samples.samples.iter().enumerate() {
        sources[sample.texel as usize] = index as u32;
    }
    let mut grown = Vec::new();
    for _ in 0..reach_texels {
        let ring = next_ring(size, samples, &sources);
        if ring.is_empty() {
            break;
        }
        for &GutterTexel { texel, sample } in &ring {
            sources[texel as usize] = sample;
        }
        grown.extend(ring);
    }
    grown.par_sort_unstable();
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

    #[test]
    fn gutter_reaches_as_many_rings_as_asked_and_takes_the_nearest() {
        let size = PageSize { width: 40, height: 30 };
        let samples = covered(size, &[(3, 3), (4, 3), (20, 10), (21, 12), (39, 29)]);
        for reach in 0..4 {
            let plan = gutter(size, &samples, reach);
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
    fn gutter_of_an_empty_page_is_empty() {
        assert!(gutter(PageSize { width: 8, height: 8 }, &PageSamples::default(), 4).is_empty());
    }
}
