//! Pipelines of shadow maps, and of surfaces that read them.

use super::MapRenderer;
use super::bindings::blur_layout;
use super::textures::MASK_FORMAT;
use crate::gpu::frame::{
    BatchKey, DEPTH_FORMAT, Output, PipelineState, Program, ProgramKey, ShaderStages, depth_key, depth_state,
    lit_state, sky_program, surface_stages, surface_state,
};
use crate::shadow_maps::Variant;
use sunbake_shaders::{ShadowBias, ShadowFilter, ShadowMapChoice, ShadowSource, ShadowTap, SurfaceVariant};

/// What tells pipelines of shadow maps apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapProgram {
    /// Depths as the camera sees them.
    Depth(BatchKey),
    /// A shadow map.
    Map(BatchKey),
    /// A mask of casters on the ground.
    Mask(BatchKey),
    /// The blur of a mask.
    Blur {
        /// Down; else across.
        is_down: bool,
    },
    /// Surfaces, and what is read of the sun for them.
    Surface(Output, SunReads, BatchKey),
    /// The sky.
    Sky,
}

/// What is read of the sun for a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SunReads {
    /// Nothing: the sun is down, or not asked for.
    Down,
    /// Nothing: no caster hides the sun.
    Open,
    /// Shadow maps.
    Maps,
    /// A blurred mask.
    Mask,
    /// A mask of casters projected flat onto the ground.
    Flat,
}

impl ProgramKey for MapProgram {
    fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Map(key) | Self::Mask(key) | Self::Surface(_, _, key) => Some(key),
            Self::Blur { .. } | Self::Sky => None,
        }
    }

    fn has_color(&self) -> bool {
        matches!(self, Self::Surface(..) | Self::Sky)
    }
}

impl MapProgram {
    /// Whether it draws a shadow map or a mask.
    pub fn is_shadow(&self) -> bool {
        matches!(self, Self::Map(_) | Self::Mask(_) | Self::Blur { .. })
    }
}

/// The key of a caster's program. Both sides cast, and only alpha masks tell casters apart.
pub fn caster_key(key: &BatchKey) -> BatchKey {
    BatchKey { is_two_sided: true, ..depth_key(key) }
}

impl MapRenderer<'_> {
    /// Compiles the pipeline of a key.
    pub(super) fn program(&self, key: &MapProgram, format: wgpu::TextureFormat) -> Program {
        let gpu = self.gpu;
        match key {
            MapProgram::Depth(key) => self.scene.depth_program(gpu, key, DEPTH_FORMAT),
            MapProgram::Sky => sky_program(gpu, &self.scene, surface_state(format, DEPTH_FORMAT, true)),
            MapProgram::Surface(output, sun, key) => self.surface_program(*output, *sun, key, format),
            MapProgram::Map(key) => self.map_program(key),
            MapProgram::Mask(key) => self.mask_program(key),
            MapProgram::Blur { is_down } => {
                let text = sunbake_shaders::blur_shader();
                let fragment = Some(if *is_down { "blur_down_fragment" } else { "blur_across_fragment" });
                let source = ShaderStages { text: &text, vertex: "screen_vertex", fragment, attributes: &[] };
                Program::new(gpu, &source, &[Some(&blur_layout(gpu))], mask_state())
            }
        }
    }

    fn surface_program(&self, output: Output, sun: SunReads, key: &BatchKey, format: wgpu::TextureFormat) -> Program {
        let source = self.source(sun);
        let page = self.scene.variant(key);
        let (text, fragment) = match output {
            Output::Lit => {
                let text = sunbake_shaders::mapped_lit_shader(key.surface, page, self.settings.lamp_filter, &source);
                (text, "lit_fragment")
            }
            Output::Visibility => {
                (sunbake_shaders::mapped_visibility_shader(key.surface, &source), "visibility_fragment")
            }
            Output::LampVisibility => {
                let text = sunbake_shaders::lamp_visibility_shader(key.surface, page, self.settings.lamp_filter);
                (text, "lamp_visibility_fragment")
            }
        };
        let attributes = sunbake_shaders::attributes(key.surface);
        let [frame, page, texture] = self.scene.groups(key);
        let page = page.filter(|_| output != Output::Visibility);
        let maps =
            matches!(sun, SunReads::Maps | SunReads::Mask | SunReads::Flat).then_some(&self.bindings.read_layout);
        let state = lit_state(key, format, DEPTH_FORMAT);
        Program::new(self.gpu, &surface_stages(&text, fragment, &attributes), &[frame, page, texture, maps], state)
    }

    fn map_program(&self, key: &BatchKey) -> Program {
        let has_alpha_mask = key.surface.has_alpha_mask;
        let attributes = caster_attributes(key);
        let source = ShaderStages {
            text: &sunbake_shaders::shadow_depth_shader(key.surface),
            vertex: if has_alpha_mask { "surface_vertex" } else { "depth_vertex" },
            fragment: has_alpha_mask.then_some("depth_fragment"),
            attributes: &attributes,
        };
        let depth = depth_state(DEPTH_FORMAT, true, wgpu::CompareFunction::Less);
        let state = PipelineState { clamps_depth: self.clamps_depth(), ..PipelineState::new(None, depth, true) };
        Program::new(self.gpu, &source, &self.caster_groups(key), state)
    }

    fn mask_program(&self, key: &BatchKey) -> Program {
        let has_alpha_mask = key.surface.has_alpha_mask;
        let attributes = caster_attributes(key);
        let is_flat = self.settings.variant == Variant::Planar;
        let source = ShaderStages {
            text: &sunbake_shaders::shadow_mask_shader(key.surface, is_flat),
            vertex: if has_alpha_mask { "surface_vertex" } else { "mask_vertex" },
            fragment: Some("mask_fragment"),
            attributes: &attributes,
        };
        let state = PipelineState { clamps_depth: self.clamps_depth() && !is_flat, ..mask_state() };
        Program::new(self.gpu, &source, &self.caster_groups(key), state)
    }

    fn caster_groups(&self, key: &BatchKey) -> [Option<&wgpu::BindGroupLayout>; 3] {
        let [frame, _, texture] = self.scene.groups(key);
        [frame, Some(&self.bindings.matrix_layout), texture.filter(|_| key.surface.has_alpha_mask)]
    }

    /// What a surface's shader reads of the sun.
    fn source(&self, sun: SunReads) -> ShadowSource {
        let settings = &self.settings;
        let filter = match settings.variant {
            Variant::Pcf16 | Variant::Cascades => ShadowFilter::Sixteen,
            Variant::Pcf4 => ShadowFilter::Four,
            Variant::Pcss => ShadowFilter::Penumbra,
            _ => ShadowFilter::One,
        };
        let tap = self.reads.tap;
        let choice = match settings.variant {
            Variant::Cascades => ShadowMapChoice::Blended,
            Variant::Cube => ShadowMapChoice::First,
            _ => ShadowMapChoice::One,
        };
        match sun {
            SunReads::Down => ShadowSource::Down,
            SunReads::Open => ShadowSource::Open,
            SunReads::Mask => ShadowSource::Mask,
            SunReads::Flat => ShadowSource::Flat,
            SunReads::Maps => {
                let margin_texels = settings.margin_texels() as f32 - 0.5;
                ShadowSource::Maps { filter, tap, choice, bias: self.bias(filter, tap), margin_texels }
            }
        }
    }

    fn bias(&self, filter: ShadowFilter, tap: ShadowTap) -> ShadowBias {
        let bias = &self.settings.bias;
        // How far the farthest texel of a comparison lies from the place that is compared, in texels.
        let tap_reach = match tap {
            ShadowTap::Filtered | ShadowTap::Gathered => 1.0,
            ShadowTap::Manual | ShadowTap::Nearest => 0.5,
        };
        let filter_reach = match filter {
            ShadowFilter::One => 0.0,
            ShadowFilter::Sixteen | ShadowFilter::Four => 1.5,
            ShadowFilter::Penumbra => 1.0,
        };
        ShadowBias {
            constant_m: bias.constant_m as f32,
            constant_texels: bias.constant_texels as f32,
            slope: bias.slope as f32,
            normal: bias.normal as f32,
            reach: match (bias.has_plane, tap) {
                (false, _) => tap_reach + filter_reach,
                (true, ShadowTap::Filtered) => tap_reach,
                // Each texel is compared with the plane at the texel itself.
                (true, _) => 0.0,
            },
            // Half a texel more: those of a perspective map grow along the way.
            reach_off_plane: tap_reach + filter_reach + 0.5,
            has_plane: bias.has_plane,
        }
    }
}

fn caster_attributes(key: &BatchKey) -> Vec<sunbake_shaders::Attribute> {
    match key.surface.has_alpha_mask {
        true => sunbake_shaders::attributes(key.surface),
        false => sunbake_shaders::attributes(SurfaceVariant::default())[..1].to_vec(),
    }
}

fn mask_state() -> PipelineState {
    PipelineState { target: Some(MASK_FORMAT.into()), depth_stencil: None, is_two_sided: true, clamps_depth: false }
}
