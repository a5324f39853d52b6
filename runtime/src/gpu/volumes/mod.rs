//! Draws a stage under point lights, whose shadows are volumes counted in a stencil.
//!
//! Based on: Crow, "Shadow algorithms for computer graphics", 1977; Everitt and Kilgard, "Practical and robust
//! stenciled shadow volumes", 2002.
//!
//! Passes: depths; ambient light; and for each light its volumes, then the light itself where no volume holds the
//! surface. Nothing is drawn for a light that casts no shadow in view, and a picture of visibility has no ambient
//! light.
//!
//! Counts wrap around, and both sides of every face are counted in one pass. Behind the surface (z-fail), back faces
//! that fail the depth test add one and front faces take one away. In front of it (z-pass), front faces that pass add
//! one and back faces take one away. Both leave in the stencil how many prisms hold the surface, so that both can
//! share it. Where more than 255 prisms may hold a surface, they are counted in runs of at most 127, and the eighth
//! bit is set where an earlier run counted any.
//!
//! Every face is moved away from the eye (`programs.rs`), by its slope and by steps of its depth, so that it never
//! lies in front of a surface that it touches.

mod bounds;
mod caster_buffers;
mod debug;
mod decisions;
mod draws;
mod extruded;
mod lights;
mod passes;
mod plan;
mod programs;
mod record;
mod report;

pub use report::{FrameReport, LightReport, volumes_plan};

use super::device::{Gpu, GpuError};
use super::frame::{Output, OwnTargets, PassClock, ProgramTable, STENCIL_FORMAT, SceneOnGpu, readback};
use crate::View;
use crate::light::Moment;
use crate::stage::Stage;
use crate::volumes::culling::Receivers;
use crate::volumes::{CasterCounts, Casters, Mode, VolumeOptimizations};
use caster_buffers::CasterBuffers;
use extruded::Extruded;
use glam::Vec3;
use programs::VolumeProgram;
use report::LastLight;
use std::time::Instant;

/// How a stage is lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VolumeSettings {
    /// How volumes are made and counted.
    pub mode: Mode,
    /// What may be left out.
    pub optimizations: VolumeOptimizations,
    /// Point suns that stand for the sun's disc: 1 for its centre alone, with hard edges. Time grows in proportion.
    pub sun_samples: u32,
    /// Whether passes are timed, if the GPU can.
    pub is_timed: bool,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self { mode: Mode::Planned, optimizations: VolumeOptimizations::default(), sun_samples: 1, is_timed: false }
    }
}

/// Draws a stage under shadow volumes.
pub struct VolumeRenderer<'g> {
    gpu: &'g Gpu,
    settings: VolumeSettings,
    scene: SceneOnGpu,
    casters: Casters,
    receivers: Receivers,
    buffers: CasterBuffers,
    /// Volumes of the last sun and the last lamp.
    extruded: [Option<Extruded>; 2],
    sun_radius_rad: f64,
    programs: ProgramTable<VolumeProgram>,
    targets: OwnTargets,
    clock: PassClock,
    report: FrameReport,
    last: Vec<LastLight>,
    last_output: Option<Output>,
    prepare_seconds: f64,
}

impl<'g> VolumeRenderer<'g> {
    /// Uploads a stage, and welds its casters.
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
            programs: ProgramTable::default(),
            targets: OwnTargets::new(STENCIL_FORMAT),
            clock: PassClock::new(gpu, settings.is_timed),
            report: FrameReport::default(),
            last: Vec::new(),
            last_output: None,
            prepare_seconds,
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

    /// The share of the lamp that each pixel's surface sees at a moment.
    pub fn lamp_visibility(&mut self, view: &View, moment: &Moment) -> Result<Vec<f32>, GpuError> {
        self.draw(view, moment, Output::LampVisibility)
    }

    /// What the last frame was made of.
    pub fn report(&self) -> &FrameReport {
        &self.report
    }

    /// Counts of the casters.
    pub fn caster_counts(&self) -> CasterCounts {
        self.casters.counts
    }

    /// Forgets the volumes of the last lights, so that the next frame computes them again.
    pub fn forget(&mut self) {
        self.extruded = [None, None];
    }

    /// The welded and sorted casters of the stage.
    pub fn casters(&self) -> &Casters {
        &self.casters
    }

    /// Seconds that it took to weld and sort the casters.
    pub fn prepare_seconds(&self) -> f64 {
        self.prepare_seconds
    }
}
