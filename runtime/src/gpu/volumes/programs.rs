//! Pipelines of shadow volumes and of point lights.

use super::VolumeRenderer;
use super::draws::FaceDraw;
use super::extruded::Extruded;
use crate::gpu::frame::{
    BatchKey, Output, PipelineState, Program, ProgramKey, STENCIL_FORMAT, ShaderStages, TextureSet, depth_state,
    lit_state, sky_program, surface_stages, surface_state,
};
use crate::volumes::Part;
use sunbake_shaders::{Filter, HardLight, PageVariant, VolumeCorners, VolumeLight, VolumeUse};

/// How far faces are moved away from the eye: in steps of depth and, in pixels, along their slope. Rasterisation
/// moves corners by up to half of a 256th of a pixel, which on slanted faces is a change of depth.
const BIAS: wgpu::DepthBiasState = wgpu::DepthBiasState { constant: -16, slope_scale: -1.0 / 128.0, clamp: 0.0 };
/// How far spared triangles are moved towards the eye: no farther than depths are rounded, since they are the surface
/// that is seen.
const SPARED_BIAS: wgpu::DepthBiasState = wgpu::DepthBiasState { constant: 16, slope_scale: 0.0, clamp: 0.0 };
/// Bits of the stencil, where one run counts all.
const ALL_BITS: u32 = 0xff;
/// Bits that count a run, where there are several.
const RUN_BITS: u32 = 0x7f;
/// The bit that is set where an earlier run counted any.
pub const EARLIER_RUN: u32 = 0x80;

/// What tells pipelines of shadow volumes apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum VolumeProgram {
    /// Depths of surfaces.
    Depth(BatchKey),
    /// Ambient and emitted light.
    Ambient(BatchKey),
    /// Blended surfaces under all lights.
    Blended(BatchKey),
    /// The sky.
    Sky,
    /// What a picture of visibility shows where there is no surface.
    Background,
    /// Faces of volumes.
    Faces(FaceKey),
    /// Merges the count of a run into one bit.
    MergeRun,
    /// A light, where no volume holds the surface.
    Light(HardLight, LightBlend, BatchKey),
}

impl ProgramKey for VolumeProgram {
    fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Ambient(key) | Self::Blended(key) | Self::Light(_, _, key) => Some(key),
            Self::Sky | Self::Background | Self::Faces(_) | Self::MergeRun => None,
        }
    }

    fn has_color(&self) -> bool {
        match self {
            Self::Depth(_) | Self::MergeRun => false,
            Self::Faces(key) => key.of != VolumeUse::Stencil,
            Self::Ambient(_) | Self::Blended(_) | Self::Sky | Self::Background | Self::Light(..) => true,
        }
    }
}

impl VolumeProgram {
    /// Whether it draws volumes, or merges their counts.
    pub fn is_of_volumes(&self) -> bool {
        matches!(self, Self::Faces(_) | Self::MergeRun)
    }
}

/// What tells pipelines over faces of volumes apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FaceKey {
    /// The kind of light that extrudes them.
    pub light: VolumeLight,
    /// Where corners come from.
    pub corners: VolumeCorners,
    /// [`Part::Walls`] for all faces where corners are listed.
    pub part: Part,
    /// What pixels are used for.
    pub of: VolumeUse,
    /// Whether faces are counted in front of the surface; else behind it.
    pub is_z_pass: bool,
    /// Whether they are counted in runs.
    pub is_run: bool,
}

impl FaceKey {
    /// Whether faces are counted in front of the surface, or behind it. Spared triangles are no faces.
    pub fn counts(&self, is_z_pass: bool) -> bool {
        self.of == VolumeUse::Stencil && self.part != Part::Spared && self.is_z_pass == is_z_pass
    }
}

/// How a light is blended with what the picture holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightBlend {
    /// Overwrites the target: the only light of a mask.
    Replace,
    /// Adds to the target: the lights of a lit picture.
    Add,
    /// It is added, times the blend constant: one of several suns.
    AddShare,
}

impl LightBlend {
    fn state(self) -> Option<wgpu::BlendState> {
        let src_factor = match self {
            Self::Replace => return None,
            Self::Add => wgpu::BlendFactor::One,
            Self::AddShare => wgpu::BlendFactor::Constant,
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
    pub(super) fn program(&self, key: &VolumeProgram, format: wgpu::TextureFormat) -> Program {
        let gpu = self.gpu;
        match key {
            VolumeProgram::Depth(key) => self.scene.depth_program(gpu, key, STENCIL_FORMAT),
            VolumeProgram::Sky => sky_program(gpu, &self.scene, surface_state(format, STENCIL_FORMAT, true)),
            VolumeProgram::Background => {
                let text = sunbake_shaders::background_shader();
                let fragment = Some("background_fragment");
                let stages = ShaderStages { text: &text, vertex: "screen_vertex", fragment, attributes: &[] };
                Program::new(gpu, &stages, &[], surface_state(format, STENCIL_FORMAT, true))
            }
            VolumeProgram::Ambient(key) => self.ambient_program(key, format),
            VolumeProgram::Blended(key) => self.blended_program(key, format),
            VolumeProgram::Light(light, blend, key) => self.light_program(*light, *blend, key, format),
            VolumeProgram::MergeRun => self.merge_program(),
            VolumeProgram::Faces(key) => self.face_program(key, format),
        }
    }

    /// The lit shader without times of the sun and the lamp: ambient and emitted light are left.
    fn ambient_program(&self, key: &BatchKey, format: wgpu::TextureFormat) -> Program {
        let text = sunbake_shaders::lit_shader(key.surface, &self.page_without_times(key), Filter::Bilinear);
        let attributes = sunbake_shaders::attributes(key.surface);
        let state = surface_state(format, STENCIL_FORMAT, key.is_two_sided);
        let stages = surface_stages(&text, "lit_fragment", &attributes);
        Program::new(self.gpu, &stages, &self.scene.groups(key), state)
    }

    /// Blended surfaces are drawn in one pass, under all lights. Volumes are counted at the solid surfaces behind them,
    /// so that nothing shades them.
    fn blended_program(&self, key: &BatchKey, format: wgpu::TextureFormat) -> Program {
        let page = self.page_without_times(key);
        let text = sunbake_shaders::open_lit_shader(key.surface, &page, self.scene.needs.has_lamp);
        let attributes = sunbake_shaders::attributes(key.surface);
        let stages = surface_stages(&text, "lit_fragment", &attributes);
        Program::new(self.gpu, &stages, &self.scene.groups(key), lit_state(key, format, STENCIL_FORMAT))
    }

    fn page_without_times(&self, key: &BatchKey) -> PageVariant {
        PageVariant { lanes: Vec::new(), lamp_layer_count: 0, ..self.scene.variant(key).clone() }
    }

    fn light_program(
        &self,
        light: HardLight,
        blend: LightBlend,
        key: &BatchKey,
        format: wgpu::TextureFormat,
    ) -> Program {
        let text = sunbake_shaders::hard_light_shader(key.surface, light);
        let attributes = sunbake_shaders::attributes(key.surface);
        let mut state = surface_state(format, STENCIL_FORMAT, key.is_two_sided);
        if let Some(target) = &mut state.target {
            target.blend = blend.state();
        }
        if let Some(depth) = &mut state.depth_stencil {
            depth.stencil = if key.is_open { Default::default() } else { where_none_was_counted() };
        }
        let [frame, _, texture] = self.scene.groups(key);
        let stages = surface_stages(&text, light.fragment(), &attributes);
        Program::new(self.gpu, &stages, &[frame, None, texture], state)
    }

    fn merge_program(&self) -> Program {
        let text = sunbake_shaders::screen_shader();
        let source = ShaderStages { text: &text, vertex: "screen_vertex", fragment: None, attributes: &[] };
        let mut depth_stencil = depth_state(STENCIL_FORMAT, false, wgpu::CompareFunction::Always);
        depth_stencil.stencil = merging();
        Program::new(self.gpu, &source, &[], PipelineState::new(None, depth_stencil, true))
    }

    fn face_program(&self, key: &FaceKey, format: wgpu::TextureFormat) -> Program {
        let text = sunbake_shaders::volume_shader(key.light, key.corners, key.of);
        let vertex = match (key.corners, key.part) {
            (VolumeCorners::Indexed, _) => "volume_vertex",
            (VolumeCorners::FromEdges, Part::Walls) => "wall_vertex",
            (VolumeCorners::FromEdges, Part::Caps) => "cap_vertex",
            (VolumeCorners::FromEdges, Part::DarkCaps) => "dark_cap_vertex",
            (VolumeCorners::FromEdges, Part::Spared) => "spared_vertex",
        };
        let source = ShaderStages { text: &text, vertex, fragment: key.of.fragment(), attributes: &[] };
        let is_spared = key.part == Part::Spared;
        let compare = match key.of {
            _ if is_spared => wgpu::CompareFunction::GreaterEqual,
            VolumeUse::Stencil | VolumeUse::Visualize => wgpu::CompareFunction::Greater,
            // Faces behind the surface: those that fail the test of the stencil's pass.
            VolumeUse::Count => wgpu::CompareFunction::LessEqual,
            VolumeUse::Fill => wgpu::CompareFunction::Always,
        };
        let mut depth_stencil = depth_state(STENCIL_FORMAT, false, compare);
        depth_stencil.bias = if is_spared { SPARED_BIAS } else { BIAS };
        let bits = if key.is_run { RUN_BITS } else { ALL_BITS };
        if is_spared {
            depth_stencil.stencil = sparing(bits);
        } else if key.of == VolumeUse::Stencil {
            depth_stencil.stencil = counting(key.is_z_pass, bits);
        }
        let target = key.of.fragment().map(|_| wgpu::ColorTargetState {
            format,
            blend: LightBlend::Add.state(),
            write_mask: wgpu::ColorWrites::ALL,
        });
        let layout = self.buffers.layout(self.gpu, key.light);
        let groups = [Some(&self.scene.frame.layout), Some(&layout)];
        // Faces end at infinity, where depth is 0. Their bias takes them below 0, where GPUs that clip depths per
        // pixel would cut them off.
        let state = PipelineState {
            clamps_depth: self.gpu.clamps_depth(),
            ..PipelineState::new(target, depth_stencil, !is_spared)
        };
        Program::new(self.gpu, &source, &groups, state)
    }
}

/// The key of the pipeline of a draw of a light's volumes.
pub fn face_key(extruded: &Extruded, draw: &FaceDraw, of: VolumeUse, is_z_pass: bool) -> FaceKey {
    let (light, corners) = extruded.kind;
    let is_counted = of == VolumeUse::Stencil;
    FaceKey {
        light,
        corners,
        part: draw.part,
        of,
        is_z_pass: is_z_pass && is_counted && draw.part != Part::Spared,
        is_run: extruded.runs.len() > 1 && is_counted,
    }
}

/// The key of a batch's program under a point light, which reads no page.
pub fn hard_key(key: &BatchKey, output: Output) -> BatchKey {
    BatchKey { page: 0, textures: TextureSet::default(), is_passed: false, ..key.for_output(output) }
}

/// Counts faces: in front of the surface (z-pass), or behind it.
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

/// Takes one from the count of what is seen.
fn sparing(bits: u32) -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        pass_op: wgpu::StencilOperation::DecrementClamp,
        ..wgpu::StencilFaceState::IGNORE
    };
    wgpu::StencilState { front: face, back: face, read_mask: ALL_BITS, write_mask: bits }
}

/// Draws where no volume was counted.
fn where_none_was_counted() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState { compare: wgpu::CompareFunction::Equal, ..wgpu::StencilFaceState::IGNORE };
    wgpu::StencilState { front: face, back: face, read_mask: ALL_BITS, write_mask: 0 }
}

/// Sets the bit of earlier runs and clears the count, wherever the run counted any.
fn merging() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::NotEqual,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::Replace,
    };
    wgpu::StencilState { front: face, back: face, read_mask: RUN_BITS, write_mask: ALL_BITS }
}
