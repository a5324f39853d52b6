//! Ambient light of a bake's pages.

use super::error::BakeError;
use super::light::{AmbientAccount, AmbientJob};
use super::pages::{PageBaker, PageTexels};
use super::timing::{check_cancelled, timed};
use crate::ambient::{AmbientPage, AmbientPoint, Mismatch, Seams, ambient_visibility_of_vertices, solve_ambient};
use crate::atlas::{self, PageSamples, PageSize, Sample};
use crate::disk::manifest::{AmbientEntry, SeamEntry, VertexEntry};
use crate::disk::write::VERTICES_FILE;
use crate::glb;
use crate::progress::BakeStep;
use crate::settings::AmbientRequest;
use crate::warning::Warning;

impl PageBaker<'_> {
    /// Bakes the ambient light of a page, if that is asked for.
    pub(super) fn bake_ambient(&mut self, page: usize, texels: PageTexels) -> Result<Option<AmbientPage>, BakeError> {
        let Some(job) = self.lights.ambient else { return Ok(None) };
        self.progress.start(BakeStep::Ambient, texels.samples.samples.len() as u64);
        let mut seconds = 0.0;
        let baked = timed(&mut seconds, || self.bake_page_ambient(&job, page, texels));
        self.stats.seconds.ambient += seconds;
        baked.map(Some)
    }

    /// Bakes ambient visibility of vertices into a scene of its own, if that is asked for.
    pub(super) fn bake_vertices(&mut self) -> Result<Option<(Vec<u8>, VertexEntry)>, BakeError> {
        let Some((job, attribute)) = self.lights.ambient.and_then(|job| Some((job, job.request.vertices?))) else {
            return Ok(None);
        };
        let (scene, geometry, progress) = (self.scene, self.geometry, self.progress);
        progress.start(BakeStep::Ambient, 0);
        let find =
            || ambient_visibility_of_vertices(job.engine, scene, geometry, job.normals, |_| !progress.is_cancelled());
        let (open, rays) = timed(&mut self.stats.seconds.ambient, find).ok_or(BakeError::Cancelled)?;
        self.ambient_account.rays += rays;
        let glb = glb::write_vertices(scene, attribute, &open)?;
        Ok(Some((glb, VertexEntry { file: VERTICES_FILE.into(), attribute: attribute.name().into() })))
    }

    fn bake_page_ambient(
        &mut self,
        job: &AmbientJob,
        page: usize,
        PageTexels { samples, order, gutter, borders, .. }: PageTexels,
    ) -> Result<AmbientPage, BakeError> {
        let (scene, geometry, atlas, progress) = (self.scene, self.geometry, self.atlas, self.progress);
        let size = atlas.pages[page];
        let supersample = most_supersample(size).min(job.request.supersample);
        if supersample < job.request.supersample {
            self.ambient_account.supersample = Some(supersample);
        }
        let finer = FinerSamples::new(self, page, samples, supersample);
        let point = |sample: &Sample| {
            let weights = sample.barycentric.map(f64::from);
            let shading_normal = job.normals.at(scene, geometry, sample.triangle as usize, weights);
            AmbientPoint { surface: atlas::surface_point(scene, geometry, sample), shading_normal }
        };
        let texel = |place: usize, points: &mut Vec<AmbientPoint>| match finer.of(order[place] as usize, samples) {
            [one] => points.push(point(one)),
            several => job.engine.add_visible(several.iter().map(point), points),
        };
        let runs = solve_ambient(job.engine, order.len(), texel, |count| {
            progress.advance(count as u64);
            !progress.is_cancelled()
        })
        .ok_or(BakeError::Cancelled)?;
        let account = &mut self.ambient_account;
        account.unconverged_texels += runs.iter().map(|run| run.unconverged).sum::<u64>();
        account.rays += runs.iter().map(|run| run.rays).sum::<u64>();
        account.buried_texels += runs.iter().flat_map(|run| &run.buried).filter(|&&is_buried| is_buried).count() as u64;
        let mut baked = AmbientPage::new(size, samples, order, borders, &runs, job.engine.settings());
        drop(runs);
        baked.fill(gutter, samples);
        let seams = Seams::find(scene, geometry, job.normals, atlas, page as u32, samples);
        check_cancelled(progress)?;
        for side in baked.sides_mut() {
            self.ambient_account.seams.push(seams.stitch(&mut side.visibility, [0.0, 1.0]));
            for plane in side.bent.iter_mut().chain(&mut side.sky) {
                seams.stitch(plane, [-1.0, 1.0]);
            }
        }
        Ok(baked)
    }
}

/// How many times finer a page can be sampled: texels of the finer grid are counted in 32 bits.
fn most_supersample(size: PageSize) -> u32 {
    0x1_0000 / size.width.max(size.height)
}

/// For each texel of a page, the points that stand for it.
struct FinerSamples {
    /// Samples of a finer grid, texel by texel of the page.
    samples: Vec<Sample>,
    /// For each of the page's samples, where its points begin. Empty: each stands for itself.
    first: Vec<u32>,
}

impl FinerSamples {
    fn new(baker: &PageBaker, page: usize, coarse: &PageSamples, finer: u32) -> Self {
        if finer < 2 {
            return Self { samples: Vec::new(), first: Vec::new() };
        }
        let width = baker.atlas.pages[page].width;
        let mut samples =
            atlas::sample_page_supersampled(baker.scene, baker.geometry, baker.atlas, page as u32, finer).samples;
        let texel_of = |sample: &Sample| {
            let (x, y) = (sample.texel % (width * finer), sample.texel / (width * finer));
            y / finer * width + x / finer
        };
        samples.sort_by_key(texel_of);
        let mut rest = samples.as_slice();
        let mut found = Self { samples: Vec::with_capacity(samples.len()), first: vec![0] };
        for sample in &coarse.samples {
            rest = &rest[rest.partition_point(|finer| texel_of(finer) < sample.texel)..];
            let (of_texel, others) = rest.split_at(rest.partition_point(|finer| texel_of(finer) == sample.texel));
            found.samples.extend_from_slice(of_texel);
            found.first.push(found.samples.len() as u32);
            rest = others;
        }
        found
    }

    /// The points of a texel: its own where the finer grid has none.
    fn of<'a>(&'a self, index: usize, coarse: &'a PageSamples) -> &'a [Sample] {
        let finer = match self.first.get(index..index + 2) {
            Some(&[start, end]) => &self.samples[start as usize..end as usize],
            _ => &[],
        };
        if finer.is_empty() { std::slice::from_ref(&coarse.samples[index]) } else { finer }
    }
}

/// Warnings about ambient light.
pub(super) fn warnings(entry: &AmbientEntry, request: &AmbientRequest) -> Vec<Warning> {
    let unconverged = (entry.unsettled_texels > 0).then(|| Warning::AmbientUnconverged {
        texels: entry.unsettled_texels,
        error: request.estimate.error.unwrap_or_default(),
        rays: request.estimate.rays,
    });
    let (asked, used) = (request.supersample, entry.supersample);
    unconverged.into_iter().chain((used < asked).then_some(Warning::FewerPoints { asked, used })).collect()
}

/// What `sunbake.json` says of ambient light: settings, rays, seams.
pub(super) fn entry(request: &AmbientRequest, account: &AmbientAccount) -> AmbientEntry {
    let counted = |seams: &Mismatch| (seams.points - seams.differing) as f64;
    let all: f64 = account.seams.iter().map(|[_, after]| counted(after)).sum();
    let mean =
        |which: usize| account.seams.iter().map(|s| s[which].mean * counted(&s[which])).sum::<f64>() / all.max(1.0);
    let largest = |of: fn(&Mismatch) -> f64| account.seams.iter().map(|[_, after]| of(after)).fold(0.0, f64::max);
    AmbientEntry {
        rays: request.estimate.rays,
        error: request.estimate.error,
        distance_m: request.estimate.distance_m,
        supersample: account.supersample.unwrap_or(request.supersample),
        bits: request.bits.count(),
        rays_traced: account.rays,
        buried_texels: account.buried_texels,
        unsettled_texels: account.unconverged_texels,
        seams: SeamEntry {
            points: account.seams.iter().map(|[_, after]| after.points).sum(),
            differing: account.seams.iter().map(|[_, after]| after.differing).sum(),
            mean_before: mean(0),
            mean: mean(1),
            p99: largest(|seams| seams.p99),
            worst: largest(|seams| seams.worst),
        },
        vertices: None,
    }
}
