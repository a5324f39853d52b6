//! A bake of only the texels that are read: what a set would show at points, without baking the rest of it.
//!
//! The scene is laid out as for the whole bake. Of the four texels around every point, each that is covered is baked;
//! others take the value of their source in the gutter. Times are encoded with the bits, layers and lanes of the bake,
//! and compared as if they had been read from its files: the sun's errors are the same to the last bit (a test compares
//! the two). Ambient visibility lacks the stitching of seams and the filling of buried texels, which need the whole
//! page. Seconds are a prediction. Only the bytes on the GPU are known, from the layers that these texels need.

use super::budget::Budget;
use super::playback::{self, PlaybackErrors, PlayedMaps};
use super::truth::{self, GroundTruth};
use super::workload::Workload;
use crate::ambient::AmbientPoint;
use crate::atlas::{self, Atlas, Footprint, GutterTexel, OPEN, PageSamples, Sample, SurfacePoint, WallFinder};
use crate::bake::fitting_atlas;
use crate::maps::{AmbientMaps, AmbientSide, Bits, LaneMaps, PageEncoder, PageMaps, encode_share};
use crate::progress::Progress;
use crate::settings::{AmbientRequest, BakeSettings};
use crate::{BakeError, progress::BakeStep};
use std::collections::{HashMap, HashSet};

/// The result of a sparse bake.
pub(super) struct SparseBake {
    pub errors: PlaybackErrors,
    /// Bytes of all maps on the GPU, scaled to whole pages.
    pub gpu_bytes: u64,
    /// Texels of all pages that stand for a point.
    pub texels: u64,
}

/// Bakes the texels around the points. None if it was stopped.
pub(super) fn sparse_bake(
    workload: &Workload,
    truth: &GroundTruth,
    settings: &BakeSettings,
    budget: &Budget,
) -> Result<Option<SparseBake>, BakeError> {
    let (mut warnings, scene) = (Vec::new(), workload.scene());
    let laid_out = workload.on_threads(|| fitting_atlas(scene, settings, &mut warnings, budget));
    let (atlas, settings) = match laid_out {
        Ok(laid_out) => laid_out,
        Err(BakeError::Cancelled) => return Ok(None),
        Err(error) => return Err(error),
    };
    budget.start(BakeStep::Encode, 0);
    let texels = workload.on_threads(|| SparseTexels::new(workload, truth, &atlas, settings.padding_texels));
    Ok(texels.bake(workload, truth, &settings, atlas.texel_count(), budget))
}

/// The texels that are read, and the points that read them.
struct SparseTexels {
    /// Texels that are baked, each once.
    samples: Vec<Sample>,
    /// For each point, the texels around it: indices in `samples`, or `samples.len()` for those that are not covered.
    blends: Vec<Footprint>,
    texels: u64,
}

impl SparseTexels {
    fn new(workload: &Workload, truth: &GroundTruth, atlas: &Atlas, padding: u32) -> Self {
        let (scene, geometry) = (workload.scene(), &workload.geometry);
        let finder = WallFinder::new(scene, geometry, atlas, &workload.tracer);
        let of_pages: Vec<(usize, Footprint)> =
            truth.points.iter().map(|place| playback::blend(place, scene, geometry, atlas)).collect();
        let mut read = Self { samples: Vec::new(), blends: vec![Footprint::default(); of_pages.len()], texels: 0 };
        // Texels that are not covered, until it is known how many are.
        const UNCOVERED: usize = usize::MAX;
        for page in 0..atlas.pages.len() {
            let samples = atlas::sample_page(scene, geometry, atlas, page as u32);
            read.texels += samples.samples.len() as u64;
            let on_page = of_pages.iter().enumerate().filter(|(_, (of, _))| *of == page);
            let texels = on_page.clone().flat_map(|(_, (_, blend))| blend.texels);
            let gutter = atlas::gutter(scene, geometry, atlas, page as u32, &samples, padding);
            let found = read.add(&texels.collect(), &samples, &gutter);
            for (point, (_, blend)) in on_page {
                let texels = blend.texels.map(|texel| *found.get(&texel).unwrap_or(&UNCOVERED));
                let codes = finder.codes(texels.map(|texel| read.samples.get(texel)));
                read.blends[point] = Footprint { texels, ..blend.among(codes) };
            }
        }
        let beyond = read.samples.len();
        read.blends.iter_mut().flat_map(|blend| &mut blend.texels).for_each(|place| *place = (*place).min(beyond));
        read
    }

    /// Adds the samples of these texels of a page. Gives the index of each texel's sample.
    fn add(&mut self, texels: &HashSet<usize>, page: &PageSamples, gutter: &[GutterTexel]) -> HashMap<usize, usize> {
        let own = page.samples.iter().enumerate().map(|(k, sample)| (sample.texel as usize, k));
        let copied = gutter.iter().map(|copy| (copy.texel as usize, copy.sample as usize));
        let mut place_of: HashMap<usize, usize> = HashMap::new();
        let mut found = HashMap::new();
        for (texel, sample) in own.chain(copied).filter(|(texel, _)| texels.contains(texel)) {
            let place = *place_of.entry(sample).or_insert_with(|| {
                self.samples.push(page.samples[sample]);
                self.samples.len() - 1
            });
            found.insert(texel, place);
        }
        found
    }

    fn bake(
        self,
        workload: &Workload,
        truth: &GroundTruth,
        settings: &BakeSettings,
        page_texels: u64,
        budget: &Budget,
    ) -> Option<SparseBake> {
        let lanes = self.sun(workload, settings, budget)?;
        let ambient = match &settings.ambient {
            Some(request) => Some(self.sky(workload, request, budget)?),
            None => None,
        };
        // A page one texel high, with one uncovered texel at the end.
        let has_walls = self.blends.iter().any(|blend| blend.reach.is_some());
        let walls = has_walls.then(|| vec![[OPEN; 2]; self.samples.len() + 1]);
        let page = PageMaps {
            width: self.samples.len() as u32 + 1,
            height: 1,
            lanes,
            lamp: None,
            ambient,
            walls,
            tracks: None,
        };
        let gpu_bytes = page.gpu_bytes(settings.bits) / u64::from(page.width) * page_texels;
        let played =
            PlayedMaps { pages: std::slice::from_ref(&page), bits: settings.bits, path: Some(workload.path()) };
        let blends: Vec<(usize, Footprint)> = self.blends.into_iter().map(|blend| (0, blend)).collect();
        let errors = workload.on_threads(|| played.errors(truth, &blends));
        Some(SparseBake { errors, gpu_bytes, texels: self.texels })
    }

    fn sun(&self, workload: &Workload, settings: &BakeSettings, budget: &Budget) -> Option<Vec<LaneMaps>> {
        let (lanes, paths) = workload.lanes(settings.lane_count);
        let engine = settings.engine.engine(&workload.tracer, &paths, settings.edge_seconds, None);
        let points: Vec<SurfacePoint> = self.samples.iter().map(|sample| workload.point(sample)).collect();
        let (answers, _) = workload.solve_visibility(engine.as_ref(), &points, budget)?;
        let of_lane = |(k, &lane)| {
            let mut encoder = PageEncoder::new(points.len() + 1, settings.bits, settings.layer_cap);
            for (texel, lit) in answers.iter().skip(k).step_by(lanes.len()).enumerate() {
                encoder.set(texel, lit);
            }
            LaneMaps { lane, layers: encoder.finish() }
        };
        Some(lanes.iter().enumerate().map(of_lane).collect())
    }

    fn sky(&self, workload: &Workload, request: &AmbientRequest, budget: &Budget) -> Option<AmbientMaps> {
        let point = |sample: &Sample| AmbientPoint {
            surface: workload.point(sample),
            shading_normal: workload.shading_normal(sample.triangle, sample.barycentric.map(f64::from)),
        };
        let points: Vec<AmbientPoint> = self.samples.iter().map(point).collect();
        let engine = workload.ambient_engine(request.estimate.rays, request.estimate.seed);
        let (runs, _) = workload.solve_ambient_at(&engine, &points, budget)?;
        let sides: Vec<[f32; 2]> = runs.iter().flat_map(truth::sides).collect();
        let has_backs = points.iter().any(|point| point.surface.is_double_sided);
        let side = |k: usize| AmbientSide {
            visibility: sides.iter().map(|side| code(side[k], request.bits)).chain([0]).collect(),
            ..AmbientSide::default()
        };
        Some(AmbientMaps { front: side(0), back: has_backs.then(|| side(1)) })
    }
}

/// The code of an ambient visibility, after it was stored with these bits.
fn code(visibility: f32, bits: Bits) -> u16 {
    match bits {
        Bits::Sixteen => encode_share(visibility),
        Bits::Eight => (visibility.clamp(0.0, 1.0) * 255.0).round() as u16 * 257,
    }
}
