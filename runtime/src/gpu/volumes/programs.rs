//! Pipelines of volumes and of lights without size.

use super::super::batch::BatchKey;
use super::super::program::{Program, Source, State, depth_state};
use super::super::renderer::{Output, sky_program, surface_source};
use super::super::target::{STENCIL_FORMAT, Target};
use super::buffers::{Draws, Extruded};
use super::needs::surface_programs;
use super::{GpuError, Shining, VolumeRenderer};
use crate::volumes::Part;
use std::collections::BTreeSet;
use sunbake_shaders::{Filter, HardLight, PageVariant, VolumeCorners, VolumeLight, VolumeUse};

/// How far faces are moved from the eye: steps of their depth and, in pixels, along their slope. Rasterising moves corners
/// by up to half of a 256th of a pixel, which slanted faces turn into depth.
const BIAS: wgpu::DepthBiasState = wgpu::DepthBiasState { constant: -16, slope_scale: -1.0 / 128.0, clamp: 0.0 };
/// Bits of a stencil in which all are counted.
const ALL_BITS: u32 = 0xff;
/// Bits in which a run is counted.
const RUN_BITS: u32 = 0x7f;
/// The bit that keeps what earlier runs found.
pub const KEPT: u32 = 0x80;

/// Which pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProgramKey {
    /// Depths of surfaces.
    Depth(BatchKey),
    /// What comes from all around.
    Around(BatchKey),
    /// What is behind a picture.
    Sky,
    /// What is behind a picture of visibility.
    Background,
    /// Faces of volumes.
    Volume(VolumeKey),
    /// What keeps a run's count.
    Keep,
    /// What a light adds.
    Light(HardLight, Added, BatchKey),
}

impl ProgramKey {
    /// The surfaces that it draws, if it does.
    pub fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Around(key) | Self::Light(_, _, key) => Some(key),
            Self::Sky | Self::Background | Self::Volume(_) | Self::Keep => None,
        }
    }

    /// Whether it draws volumes, or keeps what was counted of them.
    pub fn is_of_volumes(&self) -> bool {
        matches!(self, Self::Volume(_) | Self::Keep)
    }
}

/// A pipeline over faces of volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct VolumeKey {
    /// Of which light.
    pub light: VolumeLight,
    /// Where corners come from.
    pub corners: VolumeCorners,
    /// [`Part::Walls`] for all parts where corners are listed.
    pub part: Part,
    /// What becomes of pixels.
    pub of: VolumeUse,
    /// Whether faces are counted before the surface.
    pub is_z_pass: bool,
    /// Whether they are counted in runs.
    pub is_run: bool,
}

/// How a light meets what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Added {
    /// There is nothing.
    Alone,
    /// On top.
    OnTop,
    /// On top, as one of several: in the share that the blend constant says.
    Share,
}

impl Added {
    fn blend(self) -> Option<wgpu::BlendState> {
        let src_factor = match self {
            Self::Alone => return None,
            Self::OnTop => wgpu::BlendFactor::One,
            Self::Share => wgpu::BlendFactor::Constant,
        };
        let component = wgpu::BlendComponent {
            src_factor,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        Some(wgpu::BlendState { color: component, alpha: component })
    }
}

impl VolumeRenderer<'_> {
    /// Makes whatever an output needs, volumes aside, and is not there yet.
    pub(super) fn prepare(&mut self, size: [u32; 2], output: Output, lights: &[Shining]) -> Result<(), GpuError> {
        if self.targets.get(&output).is_none_or(|target| target.size != size) {
            self.targets.insert(output, Target::new(self.gpu, size, output.format(), STENCIL_FORMAT)?);
        }
        let kinds = lights.iter().map(|light| (light.hard, light.added));
        let wanted = surface_programs(&self.scene.needs, output, kinds).collect();
        self.build(wanted);
        Ok(())
    }

    /// Makes the programs over faces that a plan needs and that are not there yet.
    pub(super) fn prepare_faces(&mut self, slot: usize, draws: &Draws, of: VolumeUse) {
        let Some(extruded) = &self.extruded[slot] else { return };
        let faces: Vec<VolumeKey> =
            draws.all().map(|(draw, is_z_pass)| volume_key(extruded, draw.part, of, is_z_pass)).collect();
        if let Some(light) = self.last.iter_mut().rfind(|light| light.slot == slot) {
            light.faces.extend(faces.iter().copied());
        }
        let keep = (draws.runs.len() > 1 && of == VolumeUse::Stencil).then_some(ProgramKey::Keep);
        let wanted = faces.into_iter().map(ProgramKey::Volume).chain(keep).collect();
        self.build(wanted);
    }

    fn build(&mut self, wanted: BTreeSet<ProgramKey>) {
        for key in wanted {
            if !self.programs.contains_key(&key) {
                let program = self.program(&key);
                self.programs.insert(key, program);
            }
        }
    }

    fn program(&self, key: &ProgramKey) -> Program {
        let gpu = self.gpu;
        let state = |output: Output, is_two_sided| {
            let depth = depth_state(STENCIL_FORMAT, false, wgpu::CompareFunction::Equal);
            State::new(Some(output.format().into()), depth, is_two_sided)
        };
        match key {
            ProgramKey::Depth(key) => self.scene.depth_program(gpu, key, STENCIL_FORMAT),
            ProgramKey::Sky => sky_program(gpu, &self.scene, state(Output::Lit, true)),
            ProgramKey::Background => {
                let text = sunbake_shaders::background_shader();
                let fragment = Some("background_fragment");
                let source = Source { text: &text, vertex: "screen_vertex", fragment, attributes: &[] };
                Program::new(gpu, &source, &[], state(Output::Visibility, true))
            }
            ProgramKey::Around(key) => {
                // Both lights are left out: what is left is what comes from all around, and what glows.
                let page = PageVariant { lanes: Vec::new(), lamp_layer_count: 0, ..self.scene.variant(key).clone() };
                let text = sunbake_shaders::lit_shader(key.surface, &page, Filter::Bilinear);
                let attributes = sunbake_shaders::attributes(key.surface);
                let source = surface_source(&text, "lit_fragment", &attributes);
                Program::new(gpu, &source, &self.scene.groups(key), state(Output::Lit, key.is_two_sided))
            }
            ProgramKey::Light(light, added, key) => {
                let text = sunbake_shaders::hard_light_shader(key.surface, *light);
                let attributes = sunbake_shaders::attributes(key.surface);
                let source = surface_source(&text, light.fragment(), &attributes);
                let is_mask = matches!(light, HardLight::SunGate | HardLight::LampGate);
                let output = if is_mask { Output::Visibility } else { Output::Lit };
                let mut state = state(output, key.is_two_sided);
                if let Some(target) = &mut state.target {
                    target.blend = added.blend();
                }
                if let Some(depth) = &mut state.depth_stencil {
                    depth.stencil = where_none_was_counted();
                }
                let [frame, _, texture] = self.scene.groups(key);
                Program::new(gpu, &source, &[frame, None, texture], state)
            }
            ProgramKey::Keep => self.keep_program(),
            ProgramKey::Volume(key) => self.volume_program(key),
        }
    }

    fn keep_program(&self) -> Program {
        let text = sunbake_shaders::screen_shader();
        let source = Source { text: &text, vertex: "screen_vertex", fragment: None, attributes: &[] };
        let mut depth_stencil = depth_state(STENCIL_FORMAT, false, wgpu::CompareFunction::Always);
        depth_stencil.stencil = keeping();
        Program::new(self.gpu, &source, &[], State::new(None, depth_stencil, true))
    }

    fn volume_program(&self, key: &VolumeKey) -> Program {
        let text = sunbake_shaders::volume_shader(key.light, key.corners, key.of);
        let vertex = match (key.corners, key.part) {
            (VolumeCorners::Indexed, _) => "volume_vertex",
            (VolumeCorners::Found, Part::Walls) => "wall_vertex",
            (VolumeCorners::Found, Part::Caps) => "cap_vertex",
            (VolumeCorners::Found, Part::DarkCaps) => "dark_cap_vertex",
        };
        let source = Source { text: &text, vertex, fragment: key.of.fragment(), attributes: &[] };
        let compare = match key.of {
            VolumeUse::Stencil | VolumeUse::Show => wgpu::CompareFunction::Greater,
            // Behind the surface is where the stencil's test fails.
            VolumeUse::Count => wgpu::CompareFunction::LessEqual,
            VolumeUse::Fill => wgpu::CompareFunction::Always,
        };
        let mut depth_stencil = depth_state(STENCIL_FORMAT, false, compare);
        depth_stencil.bias = BIAS;
        if key.of == VolumeUse::Stencil {
            depth_stencil.stencil = counting(key.is_z_pass, if key.is_run { RUN_BITS } else { ALL_BITS });
        }
        let format = if key.of == VolumeUse::Show { Output::Lit.format() } else { Output::Visibility.format() };
        let target = key.of.fragment().map(|_| wgpu::ColorTargetState {
            format,
            blend: Added::OnTop.blend(),
            write_mask: wgpu::ColorWrites::ALL,
        });
        let layout = self.buffers.layout(self.gpu, key.light);
        let groups = [Some(&self.scene.frame.layout), Some(&layout)];
        // Faces end at infinity, where depth is 0, and are moved from the eye: GPUs that clip depths for each pixel would leave out
        // what that takes below 0.
        let state = State { clamps_depth: self.gpu.clamps_depth(), ..State::new(target, depth_stencil, true) };
        Program::new(self.gpu, &source, &groups, state)
    }
}

/// The key of a pipeline that draws a part of what a light extrudes.
pub fn volume_key(extruded: &Extruded, part: Part, of: VolumeUse, is_z_pass: bool) -> VolumeKey {
    let (light, corners) = extruded.kind;
    let is_counted = of == VolumeUse::Stencil;
    VolumeKey {
        light,
        corners,
        part,
        of,
        is_z_pass: is_z_pass && is_counted,
        is_run: extruded.runs.len() > 1 && is_counted,
    }
}

/// The key of a batch's program under a light without size, which knows nothing of pages.
pub fn hard_key(key: &BatchKey) -> BatchKey {
    BatchKey { page: 0, texture: None, ..*key }
}

fn counting(is_z_pass: bool, bits: u32) -> wgpu::StencilState {
    use wgpu::StencilOperation::{DecrementWrap, IncrementWrap, Keep};
    let face = |depth_fail_op, pass_op| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: Keep,
        depth_fail_op,
        pass_op,
    };
    let (front, back) = match is_z_pass {
        true => (face(Keep, IncrementWrap), face(Keep, DecrementWrap)),
        false => (face(DecrementWrap, Keep), face(IncrementWrap, Keep)),
    };
    wgpu::StencilState { front, back, read_mask: ALL_BITS, write_mask: bits }
}

fn where_none_was_counted() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState { compare: wgpu::CompareFunction::Equal, ..wgpu::StencilFaceState::IGNORE };
    wgpu::StencilState { front: face, back: face, read_mask: ALL_BITS, write_mask: 0 }
}

/// Where a run has counted any, the kept bit is set and the count cleared.
fn keeping() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::NotEqual,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::Replace,
    };
    wgpu::StencilState { front: face, back: face, read_mask: RUN_BITS, write_mask: ALL_BITS }
}
