//! Frames lit by lights without size, whose shadows are volumes counted in a stencil.
//!
//! Passes: depths; what comes from all around; and for each light its volumes, then what it adds where none holds the
//! surface. Nothing is drawn for a light that casts nothing in view, and a picture of visibility has no light from all around.
//!
//! Counting wraps around, and both sides of every face are counted in one pass: for casters counted behind the surface, back
//! faces that fail the depth test add one and front faces take one away; for those counted before it, front faces that pass
//! add one and back faces take one away. Both leave in the stencil how many prisms hold the surface, so that both can share
//! it. Where more prisms than 255 may hold one, they are counted in runs of at most 127, and between runs the eighth bit
//! keeps whether there were any.
//!
//! Every face is moved from the eye (`programs.rs`), by its slope and by steps of its depth, so that it never lies before a
//! surface that it touches.

mod buffers;
mod needs;
mod passes;
mod programs;

use super::census::Census;
use super::device::{Gpu, GpuError};
use super::needs::SceneNeeds;
use super::program::Program;
use super::readback;
use super::renderer::Output;
use super::scene::SceneOnGpu;
use super::stopwatch::{FrameTimes, Stopwatch};
use super::target::Target;
use crate::View;
use crate::light::{Moment, SunDisc, WITHOUT_END};
use crate::plan::DrawPlan;
use crate::stage::Stage;
use crate::volumes::culling::Receivers;
use crate::volumes::{CasterCounts, Casters, FramePlan, Light, Mode, PlanCounts, Savings};
use buffers::{CasterBuffers, Draws, Extruded};
use glam::Vec3;
use needs::{LightNeeds, VolumeNeeds, added, hard_lights};
use passes::Ends;
use programs::{Added, ProgramKey, VolumeKey};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;
use sunbake_shaders::{HardLight, VolumeUse};

/// What volumes are shown in that one looks into.
const WARM: Vec3 = Vec3::new(1.0, 0.36, 0.04);
/// What those are shown in that one looks through.
const COLD: Vec3 = Vec3::new(0.04, 0.22, 0.85);
/// How much less a face counts in that than a volume that holds the surface.
const SHOWN_THROUGH: f32 = 0.08;
/// How bright the picture stays beneath them.
const SHOWN_PICTURE: f32 = 0.8;
/// How much of it is covered by as many faces as a pixel with many has.
const SHOWN_FACES: f32 = 1.1;

/// How a stage is to be lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VolumeSettings {
    /// How volumes are made and counted.
    pub mode: Mode,
    /// What may be left out.
    pub savings: Savings,
    /// As how many suns the sun's disc shines: 1 for its centre alone.
    pub sun_samples: u32,
    /// Whether passes are timed, where the GPU can.
    pub is_timed: bool,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self { mode: Mode::Planned, savings: Savings::default(), sun_samples: 1, is_timed: false }
    }
}

/// What a frame's light was made of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LightReport {
    /// Which light.
    pub light: &'static str,
    /// What was drawn of the casters; of the last of several suns.
    pub plan: PlanCounts,
    /// Triangles of volumes drawn; for the last of several suns.
    pub triangles: usize,
    /// Runs in which they were counted.
    pub runs: usize,
    /// Seconds on the CPU to find silhouettes; zero where the last frame's served.
    pub find_seconds: f64,
    /// Of these, to make sure that the stencil can count them.
    pub overlap_seconds: f64,
    /// Seconds on the CPU to decide what to draw.
    pub plan_seconds: f64,
}

/// What a frame was made of.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FrameReport {
    /// Passes.
    pub passes: usize,
    /// Lights that were drawn; one entry for all suns of a disc, with the sums of their seconds.
    pub lights: Vec<LightReport>,
    /// Seconds that passes took, if they were timed.
    pub times: Option<FrameTimes>,
}

/// A stage on the GPU, with its casters.
pub struct VolumeRenderer<'g> {
    gpu: &'g Gpu,
    settings: VolumeSettings,
    scene: SceneOnGpu,
    casters: Casters,
    receivers: Receivers,
    buffers: CasterBuffers,
    /// Of the last sun and the last lamp.
    extruded: [Option<Extruded>; 2],
    sun_radius_rad: f64,
    programs: BTreeMap<ProgramKey, Program>,
    targets: BTreeMap<Output, Target>,
    stopwatch: Option<Stopwatch>,
    report: FrameReport,
    /// Lights of the last frame, in their order; suns of a disc are one.
    last: Vec<Last>,
    last_output: Option<Output>,
    prepare_seconds: f64,
}

/// A light of the last frame.
struct Last {
    slot: usize,
    hard: HardLight,
    added: Added,
    count: usize,
    shaded: usize,
    faces: BTreeSet<VolumeKey>,
}

/// A light of a frame, with its moment: a sun of several has its own.
struct Shining {
    moment: Moment,
    light: Light,
    hard: HardLight,
    added: Added,
    share: f32,
}

impl<'g> VolumeRenderer<'g> {
    /// Uploads a stage, and welds what casts on it.
    pub fn new(gpu: &'g Gpu, stage: &Stage, settings: VolumeSettings) -> Result<Self, GpuError> {
        let cannot = "count shadow volumes beside depths in floating point";
        gpu.check_feature(wgpu::Features::DEPTH32FLOAT_STENCIL8, cannot, "DEPTH32FLOAT_STENCIL8")?;
        let started = Instant::now();
        let casters = Casters::new(stage);
        let prepare_seconds = started.elapsed().as_secs_f64();
        let (scene, buffers) = gpu.checked("uploading the scene", || {
            Ok::<_, GpuError>((SceneOnGpu::new(gpu, stage)?, CasterBuffers::new(gpu, &casters, settings.mode)?))
        })??;
        Ok(Self {
            gpu,
            settings,
            scene,
            casters,
            receivers: Receivers::new(stage),
            buffers,
            extruded: [None, None],
            sun_radius_rad: stage.path.as_ref().map_or(0.0, |path| path.angular_radius_rad),
            programs: BTreeMap::new(),
            targets: BTreeMap::new(),
            stopwatch: settings.is_timed.then(|| Stopwatch::new(gpu)).flatten(),
            report: FrameReport::default(),
            last: Vec::new(),
            last_output: None,
            prepare_seconds,
        })
    }

    /// The picture at a moment, in linear light.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        let cannot = "add lights up in pictures of 32 bits";
        self.gpu.check_feature(wgpu::Features::FLOAT32_BLENDABLE, cannot, "FLOAT32_BLENDABLE")?;
        Ok(readback::colors(&self.draw(view, moment, Output::Lit)?))
    }

    /// How much of the sun each pixel's surface sees at a moment.
    pub fn visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        if self.settings.sun_samples > 1 {
            let cannot = "add suns up in pictures of 32 bits";
            self.gpu.check_feature(wgpu::Features::FLOAT32_BLENDABLE, cannot, "FLOAT32_BLENDABLE")?;
        }
        self.draw(view, moment, Output::Visibility)
    }

    /// How much of the lamp each pixel's surface sees at a moment.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    /// The picture at a moment with the sun's volumes shown, or the lamp's where it alone shines: warm where more faces
    /// turn to the eye than away, so that the surface lies in a volume, and cold where one looks through volumes and out of
    /// them. Each more counts the less.
    pub fn shown(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        let lit = self.lit(view, moment)?;
        let faces = readback::colors(&self.over_faces(view, moment, Output::Lit, VolumeUse::Show)?);
        let mut totals: Vec<f32> = faces.iter().map(|faces| faces.x + faces.z).filter(|&n| n > 0.0).collect();
        totals.sort_by(f32::total_cmp);
        let many = totals.get(totals.len() * 3 / 4).copied().unwrap_or(1.0);
        let mix = |(lit, faces): (&Vec3, &Vec3)| {
            let total = faces.x + faces.z;
            let entered = (faces.x - faces.z).max(0.0);
            let tint = COLD.lerp(WARM, entered / (entered + SHOWN_THROUGH * total).max(1.0));
            (*lit * SHOWN_PICTURE).lerp(tint, 1.0 - (-SHOWN_FACES * total / many).exp())
        };
        Ok(lit.iter().zip(&faces).map(mix).collect())
    }

    /// How many prisms hold each pixel's surface, counted without a stencil.
    pub fn counts(&mut self, view: &View, moment: &Moment, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let output = if of_lamp { Output::LampVisibility } else { Output::Visibility };
        self.draw(view, moment, output)?;
        self.over_faces(view, moment, output, VolumeUse::Count)
    }

    /// How many faces cover each pixel, before and behind its surface.
    pub fn fill(&mut self, view: &View, moment: &Moment, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let output = if of_lamp { Output::LampVisibility } else { Output::Visibility };
        self.draw(view, moment, output)?;
        self.over_faces(view, moment, output, VolumeUse::Fill)
    }

    /// How far along the camera's axis the surfaces of the last picture of visibility lie, in metres; without end where there
    /// is none.
    pub fn depths_m(&self, view: &View, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let output = if of_lamp { Output::LampVisibility } else { Output::Visibility };
        let Some(target) = self.targets.get(&output) else { return Ok(Vec::new()) };
        let stored = self.gpu.checked("reading depths", || readback::read_depths(self.gpu, target))??;
        Ok(stored.iter().map(|depth| view.near_m() / depth).collect())
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &FrameReport {
        &self.report
    }

    /// What there is to cast.
    pub fn caster_counts(&self) -> CasterCounts {
        self.casters.counts
    }

    /// Forgets what the last lights made of the casters.
    pub fn forget(&mut self) {
        self.extruded = [None, None];
    }

    /// What casts.
    pub fn casters(&self) -> &Casters {
        &self.casters
    }

    /// Seconds that it took to weld and sort what casts.
    pub fn prepare_seconds(&self) -> f64 {
        self.prepare_seconds
    }

    /// The lights of a frame, in the order in which they are added.
    fn shining(&self, moment: &Moment, output: Output) -> Vec<Shining> {
        let mut all = Vec::new();
        let [sun, lamp] = hard_lights(output);
        if output != Output::LampVisibility && (output == Output::Visibility || moment.daylight.sun_light != Vec3::ZERO)
        {
            let count = self.settings.sun_samples.max(1);
            let disc = SunDisc::new(moment.sun_direction.as_dvec3(), self.sun_radius_rad);
            let direction = |i| if count == 1 { disc.centre } else { disc.direction(i, count, 0.0) };
            let added = added(output, count as usize);
            // What is below the horizon lights nothing.
            all.extend((0..count).map(direction).map(|d| d.as_vec3()).filter(|d| d.y > 0.0).map(|towards| Shining {
                moment: Moment { sun_direction: towards, ..*moment },
                light: Light::Sun { towards: towards.as_dvec3() },
                hard: sun,
                added,
                share: 1.0 / count as f32,
            }));
        }
        // A stage without a lamp has no place for one.
        let has_lamp = self.scene.frame.lamp.is_some() && output != Output::Visibility;
        if let Some(at) = moment.lamp.filter(|_| has_lamp) {
            let range_m = (at.range_m < WITHOUT_END).then_some(f64::from(at.range_m));
            all.push(Shining {
                moment: *moment,
                light: Light::Lamp { position_m: at.position_m.as_dvec3(), range_m },
                hard: lamp,
                added: added(output, 1),
                share: 1.0,
            });
        }
        all
    }

    fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        self.report = FrameReport::default();
        (self.last, self.last_output) = (Vec::new(), Some(output));
        let lights = self.shining(moment, output);
        gpu.checked("building pipelines", || self.prepare(view.size, output, &lights))??;
        gpu.checked("drawing", || {
            self.scene.frame.write(gpu, view, moment);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if let Some(stopwatch) = &mut self.stopwatch {
                stopwatch.start();
            }
            self.depth_pass(&mut encoder, output);
            if output == Output::Lit {
                self.around_pass(&mut encoder);
            } else if lights.is_empty() {
                self.light_pass(&mut encoder, output, None, Ends { is_first: true, is_last: true });
            }
            for (i, shining) in lights.iter().enumerate() {
                // What the light's own passes read is written after what came before has been handed over.
                gpu.queue.submit([encoder.finish()]);
                self.scene.frame.write(gpu, view, &shining.moment);
                encoder = gpu.device.create_command_encoder(&Default::default());
                let ends = Ends { is_first: i == 0, is_last: i + 1 == lights.len() };
                self.light(&mut encoder, view, output, shining, ends)?;
            }
            let floats = readback::read(gpu, &self.targets[&output], output.channels(), encoder)?;
            self.report.times = self.stopwatch.as_ref().map(|stopwatch| stopwatch.read(gpu)).transpose()?;
            Ok(floats)
        })?
    }

    /// A light's volumes, and what it adds.
    fn light(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        output: Output,
        shining: &Shining,
        ends: Ends,
    ) -> Result<(), GpuError> {
        let found = self.extrude(&shining.light)?;
        let started = Instant::now();
        let (plan, draws) = self.plan(view, &shining.light);
        let plan_seconds = started.elapsed().as_secs_f64();
        self.note(&shining.light, &plan, &draws, found, plan_seconds);
        let slot = slot(&shining.light);
        let is_shaded = draws.triangles() > 0;
        self.note_last(shining, is_shaded);
        self.prepare_faces(slot, &draws, VolumeUse::Stencil);
        if is_shaded {
            self.volume_pass(encoder, output, slot, &plan, &draws);
        }
        self.light_pass(encoder, output, Some((shining, is_shaded)), ends);
        Ok(())
    }

    fn note(&mut self, light: &Light, plan: &FramePlan, draws: &Draws, found: [f64; 2], plan_seconds: f64) {
        let name = ["sun", "lamp"][slot(light)];
        let [find_seconds, overlap_seconds] = found;
        let (plan, triangles) = (plan.counts, draws.triangles());
        let runs = self.extruded[slot(light)].as_ref().map_or(0, |extruded| extruded.runs.len());
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
    fn note_last(&mut self, shining: &Shining, is_shaded: bool) {
        let (slot, hard, added) = (slot(&shining.light), shining.hard, shining.added);
        match self.last.last_mut().filter(|last| last.slot == slot) {
            Some(last) => (last.count, last.shaded) = (last.count + 1, last.shaded + usize::from(is_shaded)),
            None => {
                let shaded = usize::from(is_shaded);
                self.last.push(Last { slot, hard, added, count: 1, shaded, faces: BTreeSet::new() });
            }
        }
    }

    /// What pictures of a kind call for: of the kind that was drawn last what the last one took, else the most that one may take.
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

    fn needs_of(&self, last: &Last) -> LightNeeds {
        let &Last { slot, hard, added, count, shaded, .. } = last;
        let extruded = self.extruded[slot].as_ref();
        LightNeeds {
            hard,
            added,
            count,
            shaded,
            faces: last.faces.clone(),
            runs: extruded.map_or(0, |extruded| extruded.runs.len()),
            slots: extruded.map_or(0, |extruded| self.buffers.slots(extruded.kind.0)),
            buffers: extruded.map_or((0, 0), Extruded::size),
        }
    }

    /// Makes sure that what is kept is what this light makes of the casters. Seconds it took: in all, and for overlaps.
    fn extrude(&mut self, light: &Light) -> Result<[f64; 2], GpuError> {
        let kept = &self.extruded[slot(light)];
        if self.settings.savings.cache && kept.as_ref().is_some_and(|extruded| extruded.light == *light) {
            return Ok([0.0; 2]);
        }
        let VolumeSettings { mode, savings, .. } = self.settings;
        let extruded = Extruded::new(self.gpu, &self.casters, &self.buffers, *light, mode, savings)?;
        let seconds = [extruded.find_seconds, extruded.overlap_seconds];
        self.extruded[slot(light)] = Some(extruded);
        Ok(seconds)
    }

    /// What to draw of what was extruded.
    fn plan(&self, view: &View, light: &Light) -> (FramePlan, Draws) {
        let VolumeSettings { mode, savings, .. } = self.settings;
        let extruded = self.extruded[slot(light)].as_ref().expect("a light is planned once it has extruded");
        let plan = FramePlan::new(&self.casters, &self.receivers, &extruded.faces, light, view, mode, savings);
        let draws = Draws::new(extruded, &plan, savings);
        (plan, draws)
    }

    /// Sums over the faces of the volumes of the light that an output shows, in place of the picture that has been drawn.
    fn over_faces(
        &mut self,
        view: &View,
        moment: &Moment,
        output: Output,
        of: VolumeUse,
    ) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        let cannot = "add faces up in pictures of 32 bits";
        gpu.check_feature(wgpu::Features::FLOAT32_BLENDABLE, cannot, "FLOAT32_BLENDABLE")?;
        let lights = self.shining(moment, output);
        let Some(shining) = lights.first() else {
            return Ok(vec![0.0; view.pixel_count() * output.channels() as usize]);
        };
        gpu.checked("drawing volumes", || {
            // Of several suns the last one's volumes are at hand.
            self.extrude(&shining.light)?;
            self.scene.frame.write(gpu, view, &shining.moment);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let slot = slot(&shining.light);
            let (plan, draws) = self.plan(view, &shining.light);
            self.prepare_faces(slot, &draws, of);
            self.face_pass(&mut encoder, output, slot, &plan, &draws, of);
            readback::read(gpu, &self.targets[&output], output.channels(), encoder)
        })?
    }

    /// What has been built so far, and the passes of the last frame.
    pub fn census(&self) -> Census {
        let surfaces = self.programs.keys().filter_map(ProgramKey::batch);
        let scene = Census::of_scene(&self.scene).with_pipelines(self.programs.len(), surfaces);
        let extruded = self.extruded.iter().flatten().map(Extruded::size);
        let (buffers, bytes) = extruded.fold(self.buffers.size(), |(n, b), (m, c)| (n + m, b + c));
        let runs = || self.extruded.iter().flatten().flat_map(|extruded| &extruded.runs);
        Census {
            passes: self.report.passes,
            targets: 2 * self.targets.len(),
            bind_groups: scene.bind_groups + runs().count(),
            bindings: scene.bindings + runs().map(|run| run.slots).sum::<usize>(),
            stencil_pipelines: self.programs.keys().filter(|key| key.is_of_volumes()).count(),
            volume_buffers: buffers,
            volume_bytes: bytes,
            ..scene
        }
    }
}

/// The most that pictures of a kind may call for, whatever the view and the moment, of a stage of which nothing has been built.
pub fn volumes_plan(stage: &Stage, settings: &VolumeSettings, output: Output) -> DrawPlan {
    let casters = Casters::new(stage);
    let needs = VolumeNeeds::most(stage, &casters, settings, output, buffers::size_of(&casters, settings.mode));
    needs.plan(&SceneNeeds::new(stage, None), &casters.counts, settings)
}

/// Where what a light extrudes is kept, and at which place in the lists of names.
fn slot(light: &Light) -> usize {
    match light {
        Light::Sun { .. } => 0,
        Light::Lamp { .. } => 1,
    }
}
