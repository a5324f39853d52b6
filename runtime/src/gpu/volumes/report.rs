//! What a frame was made of: for reports, and for the plan of the last picture.

use super::draws::VolumeDraws;
use super::extruded::Extruded;
use super::lights::{FrameLight, light_index};
use super::plan::{LightNeeds, VolumeNeeds};
use super::programs::{FaceKey, LightBlend, VolumeProgram};
use super::{VolumeRenderer, caster_buffers};
use crate::gpu::frame::{BatchRequest, FrameTimes, Output, with_pipelines};
use crate::gpu::plan::SceneNeeds;
use crate::plan::{Census, DrawPlan};
use crate::stage::Stage;
use crate::volumes::{Casters, FramePlan, Light, PlanCounts};
use serde::Serialize;
use std::collections::BTreeSet;
use sunbake_shaders::HardLight;

/// What a frame's light was made of. Of several suns of a disc, the plan and the triangles are those of the last.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LightReport {
    /// `sun` or `lamp`.
    pub light: &'static str,
    /// How casters were drawn.
    pub plan: PlanCounts,
    /// Triangles of volumes drawn.
    pub triangles: usize,
    /// Runs in which they were counted.
    pub runs: usize,
    /// Seconds on the CPU to find silhouettes; 0 where those of the last frame served.
    pub find_seconds: f64,
    /// Of these, seconds to make sure that the stencil can count them.
    pub overlap_seconds: f64,
    /// Seconds on the CPU to decide what to draw.
    pub plan_seconds: f64,
}

/// What a frame was made of.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FrameReport {
    /// Number of passes.
    pub passes: usize,
    /// Lights that were drawn. All suns of a disc are one entry, with the sums of their seconds.
    pub lights: Vec<LightReport>,
    /// Seconds that passes took, if they were timed.
    pub times: Option<FrameTimes>,
}

/// A light of the last frame. All suns of a disc are one.
pub struct LastLight {
    pub light_index: usize,
    hard: HardLight,
    blend: LightBlend,
    count: usize,
    /// Lights that had volumes to count.
    shaded: usize,
    pub faces: BTreeSet<FaceKey>,
}

/// Seconds to find volumes: in all, and of these for overlaps.
pub type FindSeconds = [f64; 2];

impl VolumeRenderer<'_> {
    /// Adds a light to the report.
    pub(super) fn report_light(
        &mut self,
        light: &Light,
        plan: &FramePlan,
        draws: &VolumeDraws,
        [find_seconds, overlap_seconds]: FindSeconds,
        plan_seconds: f64,
    ) {
        let name = ["sun", "lamp"][light_index(light)];
        let (plan, triangles) = (plan.counts, draws.triangles());
        let runs = self.extruded[light_index(light)].as_ref().map_or(0, |extruded| extruded.runs.len());
        match self.report.lights.iter_mut().find(|report| report.light == name) {
            Some(report) => {
                (report.plan, report.triangles, report.runs) = (plan, triangles, report.runs.max(runs));
                report.find_seconds += find_seconds;
                report.overlap_seconds += overlap_seconds;
                report.plan_seconds += plan_seconds;
            }
            None => self.report.lights.push(LightReport {
                light: name,
                plan,
                triangles,
                runs,
                find_seconds,
                overlap_seconds,
                plan_seconds,
            }),
        }
    }

    /// Notes a light for the plan of this frame.
    pub(super) fn note_last(&mut self, light: &FrameLight, is_shaded: bool) {
        let (light_index, hard, blend, shaded) =
            (light_index(&light.light), light.hard, light.blend, usize::from(is_shaded));
        match self.last.last_mut().filter(|last| last.light_index == light_index) {
            Some(last) => (last.count, last.shaded) = (last.count + 1, last.shaded + shaded),
            None => self.last.push(LastLight { light_index, hard, blend, count: 1, shaded, faces: BTreeSet::new() }),
        }
    }

    /// What pictures of a kind call for: what the last picture took, if it was of this kind; else an upper bound.
    pub fn plan_of(&self, stage: &Stage, output: Output) -> DrawPlan {
        let needs = match self.last_output {
            Some(last) if last == output => {
                let lights = self.last.iter().map(|last| self.needs_of(last)).collect();
                VolumeNeeds { output, lights, buffers: self.buffers.size(), is_exact: true }
            }
            _ => VolumeNeeds::most(stage, &self.casters, &self.settings, output, self.buffers.size()),
        };
        needs.plan(&self.scene.needs, &self.casters.counts, &self.settings)
    }

    fn needs_of(&self, last: &LastLight) -> LightNeeds {
        let &LastLight { light_index, hard, blend, count, shaded, .. } = last;
        let extruded = self.extruded[light_index].as_ref();
        LightNeeds {
            hard,
            blend,
            count,
            shaded,
            faces: last.faces.clone(),
            runs: extruded.map_or(0, |extruded| extruded.runs.len()),
            binding_count: extruded.map_or(0, |extruded| self.buffers.binding_count(extruded.kind.0)),
            buffers: extruded.map_or((0, 0), Extruded::size),
        }
    }

    /// What has been built so far, and the passes of the last frame.
    pub fn census(&self) -> Census {
        let scene = self.scene.census();
        let extruded = self.extruded.iter().flatten().map(Extruded::size);
        let (buffers, bytes) = extruded.fold(self.buffers.size(), |(n, b), (m, c)| (n + m, b + c));
        let runs = || self.extruded.iter().flatten().flat_map(|extruded| &extruded.runs);
        let census = Census {
            passes: self.report.passes,
            targets: self.targets.count(),
            bind_groups: scene.bind_groups + runs().count(),
            bindings: scene.bindings + runs().map(|run| run.binding_count).sum::<usize>(),
            stencil_pipelines: self.programs.keys().filter(|key: &&VolumeProgram| key.is_of_volumes()).count(),
            volume_buffers: buffers,
            volume_bytes: bytes,
            ..scene
        };
        with_pipelines(census, self.programs.keys())
    }
}

/// An upper bound of what pictures of a kind call for, whatever the view and the moment, of a stage of which nothing
/// has been built.
pub fn volumes_plan(stage: &Stage, settings: &super::VolumeSettings, output: Output) -> DrawPlan {
    let casters = Casters::new(stage);
    let buffers = caster_buffers::size_of(&casters, settings.mode);
    let needs = VolumeNeeds::most(stage, &casters, settings, output, buffers);
    needs.plan(&SceneNeeds::new(stage, BatchRequest::default()), &casters.counts, settings)
}
