//! What must hold of every atlas, checked by brute force that shares no code with what it checks.

use crate::atlas::{Atlas, AtlasSettings, LayoutOrigin, PageSamples, build, gutter, sample_page, surface_point};
use crate::scene::{Geometry, Scene};
use glam::DVec2;
use std::collections::HashMap;

/// Part of a texel that a triangle may take without having to own it.
const HAIR: f64 = 0.02;
/// Weight in a filter that a texel may have without being of the triangle's chart.
const LEAST_WEIGHT: f64 = 1.0 / 200.0;

/// An atlas with its samples and gutters, and which sample each texel reads.
pub struct CheckedAtlas {
    /// The atlas.
    pub atlas: Atlas,
    /// The scene's triangles.
    pub geometry: Geometry,
    /// The samples of each page.
    pub pages: Vec<PageSamples>,
    /// For each page and texel, the sample that it shows.
    pub shown: Vec<Vec<Option<u32>>>,
}

/// Builds an atlas and takes its samples. Panics where a gutter texel is covered by a triangle.
pub fn bake(scene: &Scene, settings: &AtlasSettings) -> CheckedAtlas {
    let atlas = build(scene, settings, &|_| true).expect("the atlas fits");
    let geometry = Geometry::new(scene);
    let pages: Vec<_> = (0..atlas.pages.len()).map(|page| sample_page(scene, &geometry, &atlas, page as u32)).collect();
    let show = |(page, samples): (usize, &PageSamples)| {
        let mut shown = vec![None; atlas.pages[page].texel_count()];
        for (index, sample) in samples.samples.iter().enumerate() {
            shown[sample.texel as usize] = Some(index as u32);
        }
        for copy in gutter(scene, &geometry, &atlas, page as u32, samples, settings.padding_texels) {
            assert_eq!(shown[copy.texel as usize].replace(copy.sample), None, "a gutter texel is covered");
        }
        shown
    };
    let shown = pages.iter().enumerate().map(show).collect();
    CheckedAtlas { atlas, geometry, pages, shown }
}

/// Builds an atlas, and checks what must hold of every scene.
pub fn bake_and_check(scene: &Scene, settings: &AtlasSettings) -> CheckedAtlas {
    let baked = bake(scene, settings);
    baked.samples_lie_on_their_triangles(scene);
    baked.no_texel_has_two_instances(scene);
    baked.every_triangle_reads_its_own_instance(scene);
    baked
}

impl CheckedAtlas {
    /// TexelTriangle of every triangle on its page, in texels: page, instance, flat index, corners.
    pub fn triangles<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (usize, usize, u32, [DVec2; 3])> + 'a {
        let drawn = (0..scene.instances.len()).filter(|&i| !self.atlas.placements[i].is_empty());
        drawn.flat_map(move |instance| {
            let placement = self.atlas.placements[instance];
            let layout = &self.atlas.layouts[scene.instances[instance].mesh];
            let page = self.atlas.pages[placement.page as usize];
            let size = DVec2::new(f64::from(page.width), f64::from(page.height));
            (0..layout.indices.len() / 3).map(move |t| {
                let corners = [0, 1, 2].map(|k| {
                    let uv = layout.uvs[layout.indices[3 * t + k] as usize];
                    (uv * placement.scale + placement.offset).as_dvec2() * size
                });
                let flat = self.geometry.first_triangle[instance] + t as u32;
                (placement.page as usize, instance, flat, corners)
            })
        })
    }

    fn samples_lie_on_their_triangles(&self, scene: &Scene) {
        let by_triangle: HashMap<u32, [DVec2; 3]> =
            self.triangles(scene).map(|(_, _, flat, corners)| (flat, corners)).collect();
        for (page, samples) in self.pages.iter().enumerate() {
            assert!(samples.samples.windows(2).all(|w| w[0].texel < w[1].texel), "samples are not in order");
            for sample in &samples.samples {
                let [u, v] = sample.barycentric;
                assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.0, "{sample:?} is outside its triangle");
                let [a, b, c] = by_triangle[&sample.triangle];
                let at = a + (b - a) * f64::from(u) + (c - a) * f64::from(v);
                let width = self.atlas.pages[page].width;
                let centre = DVec2::new(f64::from(sample.texel % width), f64::from(sample.texel / width)) + 0.5;
                assert!((at - centre).abs().max_element() < 0.51, "{sample:?} is taken at {at}, not in its texel");
                let point = surface_point(scene, &self.geometry, sample);
                assert!(point.position_m.is_finite() && point.normal.is_normalized(), "{point:?}");
            }
        }
    }

    fn no_texel_has_two_instances(&self, scene: &Scene) {
        let mut owner: Vec<Vec<u32>> = self.shown.iter().map(|page| vec![u32::MAX; page.len()]).collect();
        for (page, instance, _, corners) in self.triangles(scene) {
            let width = self.atlas.pages[page].width as usize;
            for (x, y) in texels_that_share_area(&corners) {
                let owner = &mut owner[page][y * width + x];
                assert!(
                    *owner == u32::MAX || *owner == instance as u32,
                    "texel ({x}, {y}) of page {page} belongs to instances {owner} and {instance}"
                );
                *owner = instance as u32;
            }
        }
    }

    /// At its middle and close to its corners, a filter of two by two texels reads only its own instance, and of what
    /// was unwrapped only its own chart.
    fn every_triangle_reads_its_own_instance(&self, scene: &Scene) {
        let chart = self.charts(scene);
        for (page, instance, flat, corners) in self.triangles(scene) {
            let size = self.atlas.pages[page];
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            for point in corners.iter().map(|c| c.lerp(middle, 0.01)).chain([middle]) {
                let low = (point - 0.5).floor();
                for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                    let away = (point - 0.5 - low - DVec2::new(dx, dy)).abs();
                    if (1.0 - away.x) * (1.0 - away.y) < LEAST_WEIGHT {
                        continue;
                    }
                    let x = (low.x + dx).clamp(0.0, f64::from(size.width) - 1.0) as u32;
                    let y = (low.y + dy).clamp(0.0, f64::from(size.height) - 1.0) as u32;
                    let shown = self.shown[page][(y * size.width + x) as usize];
                    let Some(sample) = shown else {
                        panic!("triangle {flat} reads nothing at ({x}, {y}) of page {page}, corners {corners:?}");
                    };
                    let read = self.pages[page].samples[sample as usize].triangle;
                    let of = self.geometry.instance[read as usize] as usize;
                    assert_eq!(of, instance, "triangle {flat} reads another instance at ({x}, {y})");
                    let [own, other] = [chart[flat as usize], chart[read as usize]];
                    assert_eq!(own, other, "triangle {flat} of chart {own} reads {read} at ({x}, {y}), {corners:?}");
                }
            }
        }
    }
}

impl CheckedAtlas {
    /// A number for each triangle's chart: triangles that meet in a place of the layout are of one. Layouts of a file
    /// count as one chart.
    fn charts(&self, scene: &Scene) -> Vec<usize> {
        let mut charts = Vec::new();
        for instance in 0..scene.instances.len() {
            let layout = &self.atlas.layouts[scene.instances[instance].mesh];
            let is_file = layout.origin == LayoutOrigin::File;
            let triangles = layout.indices.as_chunks::<3>().0;
            let place =
                |v: u32| if is_file { [0; 2] } else { layout.uvs[v as usize].to_array().map(|x| (x + 0.0).to_bits()) };
            let first = charts.len();
            charts.extend(first..first + triangles.len());
            // Each triangle takes the least number of those that it meets, until nothing changes.
            loop {
                let mut least: HashMap<[u32; 2], usize> = HashMap::new();
                for (corners, &number) in triangles.iter().zip(&charts[first..]) {
                    for corner in corners {
                        least.entry(place(*corner)).and_modify(|known| *known = number.min(*known)).or_insert(number);
                    }
                }
                let new: Vec<usize> =
                    triangles.iter().map(|t| t.iter().map(|c| least[&place(*c)]).min().unwrap_or(first)).collect();
                let has_changed = new != charts[first..];
                charts[first..].copy_from_slice(&new);
                if !has_changed {
                    break;
                }
            }
        }
        charts
    }
}

/// Texels of which the triangle takes more than a hair: every texel of its box, cut by the triangle.
fn texels_that_share_area(corners: &[DVec2; 3]) -> Vec<(usize, usize)> {
    let low = corners.iter().fold(DVec2::INFINITY, |a, b| a.min(*b)).floor().max(DVec2::ZERO);
    let high = corners.iter().fold(DVec2::NEG_INFINITY, |a, b| a.max(*b)).ceil();
    let mut found = Vec::new();
    for y in low.y as usize..high.y as usize {
        for x in low.x as usize..high.x as usize {
            if area_in_texel(corners, x as f64, y as f64) > HAIR {
                found.push((x, y));
            }
        }
    }
    found
}

/// Area of a triangle within a texel, by Green's theorem over the clipped polygon.
fn area_in_texel(corners: &[DVec2; 3], x: f64, y: f64) -> f64 {
    let mut polygon = corners.to_vec();
    let sides: [&dyn Fn(DVec2) -> f64; 4] = [&|p| p.x - x, &|p| x + 1.0 - p.x, &|p| p.y - y, &|p| y + 1.0 - p.y];
    for inside in sides {
        let mut cut = Vec::new();
        for k in 0..polygon.len() {
            let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            let (a, b) = (inside(p), inside(q));
            if a >= 0.0 {
                cut.push(p);
            }
            if a * b < 0.0 {
                cut.push(p + (q - p) * (a / (a - b)));
            }
        }
        polygon = cut;
    }
    let twice: f64 = (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum();
    twice.abs() * 0.5
}
