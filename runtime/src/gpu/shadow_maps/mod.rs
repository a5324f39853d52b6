//! Draws a stage that shadow maps light.
//!
//! For each direction of the sun, and for maps that follow the view in each frame: a pass for each map. Per frame:
//! depths, then one pass that lights and reads the maps. `map:ground` adds a mask of casters on the ground, as the
//! sun sees it, blurred in two passes. `map:planar` has no map: it projects casters flat onto the ground, as the
//! camera sees it.
//!
//! Nothing is built that is not called for: no map where nothing can be in shadow, no mask without a ground, no
//! pipeline for alpha masks without alpha masks.

mod bindings;
mod decisions;
mod passes;
mod plan;
mod probe;
mod programs;
mod record;
mod textures;

use super::device::{Gpu, GpuError};
use super::frame::{
    BatchRequest, DEPTH_FORMAT, FrameTimes, Output, OwnTargets, PassClock, ProgramTable, SceneOnGpu, readback,
    with_pipelines,
};
use super::plan::SceneNeeds;
use crate::View;
use crate::light::Moment;
use crate::plan::{Census, DrawPlan};
use crate::shadow_maps::{Extents, MapProjection, MapSettings, ShadowScene, Variant};
use crate::stage::Stage;
use bindings::{MapBindings, MapReads};
use glam::Vec3;
use plan::{MapNeeds, SunShading};
use programs::MapProgram;
use serde::Serialize;
use sunbake_shaders::ShadowTap;
use textures::{CasterMask, DepthMaps};

/// What a frame was made of.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct MapReport {
    /// Number of passes, those of the maps included.
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

/// Draws a stage under shadow maps.
pub struct MapRenderer<'g> {
    gpu: &'g Gpu,
    settings: MapSettings,
    shadow_scene: ShadowScene,
    scene: SceneOnGpu,
    reads: MapReads,
    halfway: Option<f32>,
    bindings: MapBindings,
    maps: Option<DepthMaps>,
    /// A mask as the sun sees it, and what it is blurred into.
    mask: Option<[CasterMask; 2]>,
    /// A mask of casters projected flat onto the ground, as the camera sees it.
    flat: Option<CasterMask>,
    /// What surfaces read, and its number of entries.
    read_group: Option<(wgpu::BindGroup, usize)>,
    /// The last sun's extents.
    extents: Option<Extents>,
    /// What the maps hold.
    drawn: Vec<MapProjection>,
    programs: ProgramTable<MapProgram>,
    targets: OwnTargets,
    clock: PassClock,
    report: MapReport,
    /// What the last picture called for.
    last: Option<MapNeeds>,
}

/// How the sun lights a view at a moment.
#[derive(Debug, Clone, PartialEq)]
pub enum SunNow {
    /// It gives no light.
    Down,
    /// Nothing can be in shadow.
    Open,
    /// Something may be in shadow; the maps that tell. None are needed to project casters flat.
    Shaded(Vec<MapProjection>),
}

impl<'g> MapRenderer<'g> {
    /// Uploads a stage.
    pub fn new(gpu: &'g Gpu, stage: &Stage, settings: MapSettings) -> Result<Self, GpuError> {
        let shadow_scene = ShadowScene::new(stage);
        let halfway = compares(&settings).then(|| probe::halfway(gpu)).transpose()?;
        let reads = MapReads::new(&settings, shadow_scene.ground.height_m.is_some(), halfway);
        let scene =
            gpu.checked("uploading the scene", || SceneOnGpu::with(gpu, stage, request(&settings, &shadow_scene)))??;
        Ok(Self {
            bindings: gpu.checked("preparing shadow maps", || MapBindings::new(gpu, &reads))?,
            gpu,
            settings,
            shadow_scene,
            scene,
            reads,
            halfway,
            maps: None,
            mask: None,
            flat: None,
            read_group: None,
            extents: None,
            drawn: Vec::new(),
            programs: ProgramTable::default(),
            targets: OwnTargets::new(DEPTH_FORMAT),
            clock: PassClock::new(gpu, settings.is_timed),
            report: MapReport::default(),
            last: None,
        })
    }

    /// The lit picture at a moment, in linear light and row order.
    pub fn lit(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        Ok(readback::colors(&self.draw(view, moment, Output::Lit)?))
    }

    /// The share of the sun that each pixel's surface sees at a moment.
    pub fn visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::Visibility)
    }

    /// The share of the lamp that each pixel's surface sees at a moment, as it was baked; 0 where it was not.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    /// Depths of the surfaces of the last picture of visibility along the camera's axis, in metres; infinite where
    /// there is none.
    pub fn depths_m(&self, view: &View) -> Result<Vec<f32>, GpuError> {
        let Some(depth) = self.targets.last_depth(Output::Visibility) else { return Ok(Vec::new()) };
        let stored = self.gpu.checked("reading depths", || readback::read_depths(self.gpu, depth))??;
        Ok(stored.iter().map(|depth| view.near_m() / depth).collect())
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &MapReport {
        &self.report
    }

    /// Height of the ground in bake space, metres; none where no large plane is level.
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

    /// The maps that the last frame read; none if nothing in it could be in shadow.
    pub fn maps(&self) -> &[MapProjection] {
        &self.drawn[..self.report.maps.min(self.drawn.len())]
    }

    /// Forgets the maps, so that the next frame draws them again.
    pub fn forget(&mut self) {
        self.drawn.clear();
        self.extents = None;
    }

    /// Whether casters above a map are clamped to its top.
    fn clamps_depth(&self) -> bool {
        self.settings.optimizations.depth_clamp && self.gpu.clamps_depth()
    }

    /// How the sun lights a view at a moment, with the maps that it needs.
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

    /// What a frame calls for.
    fn needs_of(&self, size: [u32; 2], output: Output, now: &SunNow) -> MapNeeds {
        let shading = match now {
            SunNow::Down => SunShading::Down,
            SunNow::Open => SunShading::Open,
            SunNow::Shaded(maps) => SunShading::Shaded { maps: maps.len(), drawn: maps.len() },
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let (settings, reads, ground_casts) = (self.settings, self.reads, self.shadow_scene.ground.casts);
        MapNeeds { output, settings, reads, shading, ground_casts, pixels, is_exact: true }
    }

    /// What pictures of a kind and of a number of pixels call for: what the last picture took, if it was of this kind;
    /// else an upper bound.
    pub fn plan_of(&self, stage: &Stage, output: Output, pixels: u64) -> DrawPlan {
        let most = || MapNeeds::most(stage, &self.shadow_scene, &self.settings, self.reads, output, pixels);
        self.last.filter(|last| last.output == output).unwrap_or_else(most).plan(&self.scene.needs)
    }

    /// What has been built so far, and the passes of the last frame.
    pub fn census(&self) -> Census {
        let scene = self.scene.census();
        let read_bindings = self.read_group.as_ref().map(|(_, count)| *count);
        let matrices = self.bindings.matrix_count();
        let masks = || self.mask.iter().flatten().chain(&self.flat);
        let mask_bytes: u64 = masks().map(CasterMask::bytes).sum();
        let census = Census {
            passes: self.report.passes,
            targets: self.targets.count(),
            bind_groups: scene.bind_groups + usize::from(read_bindings.is_some()) + matrices,
            bindings: scene.bindings + read_bindings.unwrap_or(0) + matrices,
            shadow_pipelines: self.programs.keys().filter(|key| key.is_shadow()).count(),
            shadow_maps: self.maps.as_ref().map_or(0, |maps| maps.layers.len()),
            shadow_masks: masks().count(),
            shadow_bytes: self.maps.as_ref().map_or(0, DepthMaps::bytes) + mask_bytes,
            ..scene
        };
        with_pipelines(census, self.programs.keys())
    }
}

/// Whether a comparison sampler is used. It may or may not filter.
fn compares(settings: &MapSettings) -> bool {
    !settings.gathers() && !matches!(settings.variant, Variant::Plain | Variant::Planar)
}

/// What shadow maps want of batches. Casters that are projected flat are compared with nothing.
fn request<'a>(settings: &MapSettings, scene: &'a ShadowScene) -> BatchRequest<'a> {
    let wants_lift = settings.variant != Variant::Planar && settings.optimizations.sampling;
    BatchRequest { ground: Some(&scene.ground), wants_lift, wants_tracks: false }
}

/// An upper bound of what pictures of a kind and of a number of pixels call for, whatever the view and the moment, of a
/// stage of which nothing has been built.
pub fn maps_plan(stage: &Stage, settings: &MapSettings, output: Output, pixels: u64) -> DrawPlan {
    let scene = ShadowScene::new(stage);
    // Whether the sampler filters changes no count.
    let halfway = compares(settings).then_some(0.5);
    let reads = MapReads::new(settings, scene.ground.height_m.is_some(), halfway);
    let needs = MapNeeds::most(stage, &scene, settings, reads, output, pixels);
    needs.plan(&SceneNeeds::new(stage, request(settings, &scene)))
}
