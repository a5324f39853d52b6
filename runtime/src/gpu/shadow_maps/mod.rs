//! Frames of a stage that shadow maps light.
//!
//! Built once per stage: the scene, and pipelines per variant that occurs. Per sun, or for maps that follow the view per frame:
//! a pass for each map. Per frame: depths, then one pass that lights, reading the maps. `map:ground` adds a picture of what casts,
//! drawn beside its map and blurred in two passes; `map:planar` has no map, and lays what casts flat as the camera sees it.
//!
//! Nothing is built for what is not called for: no map where nothing can be in shadow, no mask without a ground, no pipeline for
//! holes without holes.

mod needs;
mod passes;
mod probe;
mod programs;
mod targets;

use super::census::Census;
use super::device::{Gpu, GpuError};
use super::needs::SceneNeeds;
use super::program::Program;
use super::readback;
use super::renderer::Output;
use super::scene::SceneOnGpu;
use super::stopwatch::{FrameTimes, Stopwatch};
use super::target::{DEPTH_FORMAT, Target};
use crate::View;
use crate::light::Moment;
use crate::plan::DrawPlan;
use crate::shadow_maps::{Extents, MapProjection, MapSettings, ShadowScene, Variant};
use crate::stage::Stage;
use glam::Vec3;
use needs::{MapNeeds, Shading};
use programs::ProgramKey;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Instant;
use sunbake_shaders::ShadowTap;
use targets::{Bindings, Depths, Mask, Reads};

/// What a frame was made of.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct MapReport {
    /// Passes.
    pub passes: usize,
    /// Maps that were read.
    pub maps: usize,
    /// Of these, how many were drawn for this frame; the others were kept.
    pub drawn: usize,
    /// Longer edges of the texels in the middles of the maps, metres.
    pub texels_m: Vec<f64>,
    /// Why there is none, if there is none.
    pub without: Option<&'static str>,
    /// Seconds on the CPU to fit the maps.
    pub fit_seconds: f64,
    /// Seconds that passes took, if they were timed.
    pub times: Option<FrameTimes>,
}

/// A stage on the GPU, with its maps.
pub struct MapRenderer<'g> {
    gpu: &'g Gpu,
    settings: MapSettings,
    shadow_scene: ShadowScene,
    scene: SceneOnGpu,
    reads: Reads,
    halfway: Option<f32>,
    bindings: Bindings,
    depths: Option<Depths>,
    mask: Option<[Mask; 2]>,
    flat: Option<Mask>,
    read_group: Option<(wgpu::BindGroup, usize)>,
    /// The last sun's extents.
    extents: Option<Extents>,
    /// What the maps hold that are there.
    drawn: Vec<MapProjection>,
    programs: BTreeMap<ProgramKey, Program>,
    targets: BTreeMap<Output, Target>,
    stopwatch: Option<Stopwatch>,
    report: MapReport,
    /// What the last picture called for.
    last: Option<MapNeeds>,
}

/// The sun at a moment.
#[derive(Debug, Clone, PartialEq)]
pub enum SunNow {
    /// It gives no light.
    Down,
    /// Nothing can be in shadow.
    Open,
    /// Some things may be.
    Shaded(Vec<MapProjection>),
}

impl<'g> MapRenderer<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, settings: MapSettings) -> Result<Self, GpuError> {
        let shadow_scene = ShadowScene::new(stage);
        let halfway = compares(&settings).then(|| probe::halfway(gpu)).transpose()?;
        let reads = Reads::new(&settings, shadow_scene.ground.height_m.is_some(), halfway);
        let scene =
            gpu.checked("uploading the scene", || SceneOnGpu::with_ground(gpu, stage, Some(&shadow_scene.ground)))??;
        Ok(Self {
            bindings: gpu.checked("preparing shadow maps", || Bindings::new(gpu, &reads))?,
            gpu,
            settings,
            shadow_scene,
            scene,
            reads,
            halfway,
            depths: None,
            mask: None,
            flat: None,
            read_group: None,
            extents: None,
            drawn: Vec::new(),
            programs: BTreeMap::new(),
            targets: BTreeMap::new(),
            stopwatch: settings.is_timed.then(|| Stopwatch::new(gpu)).flatten(),
            report: MapReport::default(),
            last: None,
        })
    }

    /// The picture at a moment, in linear light.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        Ok(readback::colors(&self.draw(view, moment, Output::Lit)?))
    }

    /// How much of the sun each pixel's surface sees at a moment.
    pub fn visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::Visibility)
    }

    /// How much of the lamp each pixel's surface sees at a moment, as it was baked; nothing where it was not.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    /// How far along the camera's axis the surfaces of the last picture of visibility lie, in metres; without end where there
    /// is none.
    pub fn depths_m(&self, view: &View) -> Result<Vec<f32>, GpuError> {
        let Some(target) = self.targets.get(&Output::Visibility) else { return Ok(Vec::new()) };
        let stored = self.gpu.checked("reading depths", || readback::read_depths(self.gpu, target))??;
        Ok(stored.iter().map(|depth| view.near_m() / depth).collect())
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &MapReport {
        &self.report
    }

    /// What its ground is.
    pub fn ground_height_m(&self) -> Option<f64> {
        self.shadow_scene.ground.height_m
    }

    /// Whether the comparison sampler filters, if there is one.
    pub fn filters(&self) -> Option<bool> {
        self.halfway.map(|_| self.reads.tap == ShadowTap::Filtered)
    }

    /// What the comparison sampler reads halfway between light and shade, if there is one.
    pub fn halfway(&self) -> Option<f32> {
        self.halfway
    }

    /// Maps that the last frame read; none if nothing in it could be in shadow, whatever earlier ones left.
    pub fn maps(&self) -> &[MapProjection] {
        &self.drawn[..self.report.maps.min(self.drawn.len())]
    }

    /// Forgets the maps that are there.
    pub fn forget(&mut self) {
        self.drawn.clear();
        self.extents = None;
    }

    /// Whether casters above a map are drawn at its top.
    fn clamps_depth(&self) -> bool {
        self.settings.means.depth_clamp && self.gpu.clamps_depth()
    }

    /// What the sun does at a moment, and the maps that a view then needs.
    fn sun_now(&mut self, view: &View, moment: &Moment, output: Output) -> SunNow {
        let towards = moment.sun_direction.as_dvec3();
        let is_disc = self.settings.variant == Variant::Pcss;
        let least = if is_disc { -f64::from(moment.sun_radius_rad) } else { 0.0 };
        let is_dark = output == Output::Lit && moment.daylight.sun_light == Vec3::ZERO;
        if output == Output::LampVisibility || is_dark || moment.sun_direction == Vec3::ZERO || towards.y <= least {
            return SunNow::Down;
        }
        let extents = match self.extents {
            Some(extents) if extents.axes.towards == towards.normalize() => extents,
            _ => *self.extents.insert(self.shadow_scene.extents(towards)),
        };
        if self.settings.variant == Variant::Planar {
            let has_both = self.shadow_scene.ground.height_m.is_some() && !extents.casters.is_empty();
            return if has_both { SunNow::Shaded(Vec::new()) } else { SunNow::Open };
        }
        let radius_rad = f64::from(moment.sun_radius_rad);
        let maps = self.settings.maps(&self.shadow_scene, &extents, view, radius_rad, self.clamps_depth());
        if maps.is_empty() { SunNow::Open } else { SunNow::Shaded(maps) }
    }

    fn draw(&mut self, view: &View, moment: &Moment, output: Output) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        self.report = MapReport::default();
        let started = Instant::now();
        let now = self.sun_now(view, moment, output);
        self.report.fit_seconds = started.elapsed().as_secs_f64();
        self.report.without = match &now {
            SunNow::Down => Some("the sun is down, or not asked for"),
            SunNow::Open => Some("nothing in view can be in shadow"),
            SunNow::Shaded(_) => None,
        };
        let needs = self.needs_of(view.size, output, &now);
        self.last = None;
        gpu.checked("building pipelines", || self.prepare(view.size, &needs))??;
        gpu.checked("drawing", || {
            self.scene.frame.write(gpu, view, moment);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if let Some(stopwatch) = &mut self.stopwatch {
                stopwatch.start();
            }
            if let SunNow::Shaded(maps) = &now {
                let height_m = self.shadow_scene.ground.casts_from_m as f32;
                self.bindings.write(gpu, maps, view.eye_m, height_m);
                self.shadow_passes(&mut encoder, maps);
            }
            self.depth_pass(&mut encoder, output);
            self.surface_pass(&mut encoder, output, &needs);
            let floats = readback::read(gpu, &self.targets[&output], output.channels(), encoder)?;
            self.report.times = self.stopwatch.as_ref().map(|stopwatch| stopwatch.read(gpu)).transpose()?;
            self.last = Some(needs.drawn(self.report.drawn));
            Ok(floats)
        })
        .flatten()
        // Maps of a frame that failed may not have been drawn.
        .inspect_err(|_| self.forget())
    }

    /// Makes whatever a frame needs and is not there yet.
    fn prepare(&mut self, size: [u32; 2], needs: &MapNeeds) -> Result<(), GpuError> {
        let output = needs.output;
        if self.targets.get(&output).is_none_or(|target| target.size != size) {
            self.targets.insert(output, Target::new(self.gpu, size, output.format(), DEPTH_FORMAT)?);
        }
        if let Shading::Shaded { maps, .. } = needs.shading {
            self.prepare_shadows(size, maps)?;
        }
        for key in needs.programs(&self.scene.needs) {
            if !self.programs.contains_key(&key) {
                let program = self.program(&key);
                self.programs.insert(key, program);
            }
        }
        Ok(())
    }

    /// Makes the maps and pictures of what casts that a frame needs and that are not there yet.
    fn prepare_shadows(&mut self, size: [u32; 2], count: usize) -> Result<(), GpuError> {
        let (gpu, size_texels) = (self.gpu, self.settings.size_texels);
        if self.reads.has_depths && self.depths.as_ref().is_none_or(|depths| depths.layers.len() < count) {
            self.depths = Some(Depths::new(gpu, size_texels, count as u32)?);
            (self.read_group, self.drawn) = (None, Vec::new());
        }
        if self.reads.has_mask && self.mask.is_none() {
            self.mask = Some([(); 2].map(|()| Mask::new(gpu, [size_texels; 2])));
        }
        if self.reads.has_flat_mask && self.flat.as_ref().is_none_or(|flat| flat.size != size) {
            (self.flat, self.read_group) = (Some(Mask::new(gpu, size)), None);
        }
        if self.read_group.is_none() {
            let mask = self.mask.as_ref().map(|[mask, _]| mask);
            self.read_group = Some(self.bindings.read(gpu, self.depths.as_ref(), mask, self.flat.as_ref()));
        }
        Ok(())
    }

    /// What a frame calls for.
    fn needs_of(&self, size: [u32; 2], output: Output, now: &SunNow) -> MapNeeds {
        let shading = match now {
            SunNow::Down => Shading::Down,
            SunNow::Open => Shading::Open,
            SunNow::Shaded(maps) => Shading::Shaded { maps: maps.len(), drawn: maps.len() },
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let (settings, reads, ground_casts) = (self.settings, self.reads, self.shadow_scene.ground.casts);
        MapNeeds { output, settings, reads, shading, ground_casts, pixels, is_exact: true }
    }

    /// What pictures of a kind and of so many pixels call for: of the kind that was drawn last what the last one took, else the most
    /// that one may take.
    pub fn plan_of(&self, stage: &Stage, output: Output, pixels: u64) -> DrawPlan {
        let most = || MapNeeds::most(stage, &self.shadow_scene, &self.settings, self.reads, output, pixels);
        self.last.filter(|last| last.output == output).unwrap_or_else(most).plan(&self.scene.needs)
    }

    /// What has been built so far, and the passes of the last frame.
    pub fn census(&self) -> Census {
        let surfaces = self.programs.keys().filter_map(ProgramKey::batch);
        let scene = Census::of_scene(&self.scene).with_pipelines(self.programs.len(), surfaces);
        let read_slots = self.read_group.as_ref().map(|(_, slots)| *slots);
        let views = self.bindings.view_count();
        let masks = || self.mask.iter().flatten().chain(&self.flat);
        let mask_bytes: u64 = masks().map(Mask::bytes).sum();
        Census {
            passes: self.report.passes,
            targets: 2 * self.targets.len(),
            bind_groups: scene.bind_groups + usize::from(read_slots.is_some()) + views,
            bindings: scene.bindings + read_slots.unwrap_or(0) + views,
            shadow_pipelines: self.programs.keys().filter(|key| key.is_shadow()).count(),
            shadow_maps: self.depths.as_ref().map_or(0, |depths| depths.layers.len()),
            shadow_masks: masks().count(),
            shadow_bytes: self.depths.as_ref().map_or(0, Depths::bytes) + mask_bytes,
            ..scene
        }
    }
}

/// Whether a sampler compares, which may or may not filter.
fn compares(settings: &MapSettings) -> bool {
    !settings.gathers() && !matches!(settings.variant, Variant::Plain | Variant::Planar)
}

/// The most that pictures of a kind and of so many pixels may call for, whatever the view and the moment, of a stage of which
/// nothing has been built.
pub fn maps_plan(stage: &Stage, settings: &MapSettings, output: Output, pixels: u64) -> DrawPlan {
    let scene = ShadowScene::new(stage);
    // Whether the sampler filters changes no count.
    let halfway = compares(settings).then_some(0.5);
    let reads = Reads::new(settings, scene.ground.height_m.is_some(), halfway);
    let needs = MapNeeds::most(stage, &scene, settings, reads, output, pixels);
    needs.plan(&SceneNeeds::new(stage, Some(&scene.ground)))
}
