//! Pipelines of shadow maps, and of surfaces that they light.

use super::super::batch::BatchKey;
use super::super::program::{Program, Source, State, depth_state};
use super::super::renderer::{Output, sky_program, surface_source, surface_state};
use super::super::target::DEPTH_FORMAT;
use super::MapRenderer;
use super::targets::{MASK_FORMAT, blur_layout};
use crate::shadow_maps::Variant;
use sunbake_shaders::{ShadowBias, ShadowFilter, ShadowSource, ShadowTap, ShadowViews, SurfaceVariant};

/// Which pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProgramKey {
    /// Depths as the camera sees them.
    Depth(BatchKey),
    /// Depths as the sun does.
    Map(BatchKey),
    /// A picture of what casts.
    Mask(BatchKey),
    /// Its blur, across or down.
    Blur {
        /// Which.
        is_down: bool,
    },
    /// Surfaces, and what is read of the sun for them.
    Surface(Output, Sun, BatchKey),
    /// The background.
    Sky,
}

/// What is read of the sun for a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sun {
    /// Nothing: it is down, or not asked for.
    Down,
    /// Nothing: nothing hides it.
    Open,
    /// Maps of depths.
    Maps,
    /// A blurred picture of what casts.
    Mask,
    /// A picture of what casts, laid flat.
    Flat,
}

impl ProgramKey {
    /// The surfaces that it draws, if it does.
    pub fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Map(key) | Self::Mask(key) | Self::Surface(_, _, key) => Some(key),
            Self::Blur { .. } | Self::Sky => None,
        }
    }

    /// Whether it draws a map or a picture of what casts.
    pub fn is_shadow(&self) -> bool {
        matches!(self, Self::Map(_) | Self::Mask(_) | Self::Blur { .. })
    }
}

/// The key of a caster's program: both sides cast, and only holes tell them apart.
pub fn caster_key(key: &BatchKey) -> BatchKey {
    BatchKey { is_two_sided: true, ..super::super::scene::depth_key(key) }
}

impl MapRenderer<'_> {
    /// Makes a program.
    pub(super) fn program(&self, key: &ProgramKey) -> Program {
        let gpu = self.gpu;
        match key {
            ProgramKey::Depth(key) => self.scene.depth_program(gpu, key, DEPTH_FORMAT),
            ProgramKey::Sky => sky_program(gpu, &self.scene, surface_state(Output::Lit, true)),
            ProgramKey::Surface(output, sun, key) => self.surface_program(*output, *sun, key),
            ProgramKey::Map(key) => self.map_program(key),
            ProgramKey::Mask(key) => self.mask_program(key),
            ProgramKey::Blur { is_down } => {
                let text = sunbake_shaders::blur_shader();
                let fragment = Some(if *is_down { "blur_down_fragment" } else { "blur_across_fragment" });
                let source = Source { text: &text, vertex: "screen_vertex", fragment, attributes: &[] };
                Program::new(gpu, &source, &[Some(&blur_layout(gpu))], mask_state())
            }
        }
    }

    fn surface_program(&self, output: Output, sun: Sun, key: &BatchKey) -> Program {
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
        let maps = matches!(sun, Sun::Maps | Sun::Mask | Sun::Flat).then_some(&self.bindings.read_layout);
        let state = surface_state(output, key.is_two_sided);
        Program::new(self.gpu, &surface_source(&text, fragment, &attributes), &[frame, page, texture, maps], state)
    }

    fn map_program(&self, key: &BatchKey) -> Program {
        let is_cut = key.surface.is_cut;
        let attributes = caster_attributes(key);
        let source = Source {
            text: &sunbake_shaders::shadow_depth_shader(key.surface),
            vertex: if is_cut { "surface_vertex" } else { "depth_vertex" },
            fragment: is_cut.then_some("depth_fragment"),
            attributes: &attributes,
        };
        let depth = depth_state(DEPTH_FORMAT, true, wgpu::CompareFunction::Less);
        let state = State { clamps_depth: self.clamps_depth(), ..State::new(None, depth, true) };
        Program::new(self.gpu, &source, &self.caster_groups(key), state)
    }

    fn mask_program(&self, key: &BatchKey) -> Program {
        let is_cut = key.surface.is_cut;
        let attributes = caster_attributes(key);
        let is_flat = self.settings.variant == Variant::Planar;
        let source = Source {
            text: &sunbake_shaders::shadow_mask_shader(key.surface, is_flat),
            vertex: if is_cut { "surface_vertex" } else { "mask_vertex" },
            fragment: Some("mask_fragment"),
            attributes: &attributes,
        };
        let state = State { clamps_depth: self.clamps_depth() && !is_flat, ..mask_state() };
        Program::new(self.gpu, &source, &self.caster_groups(key), state)
    }

    fn caster_groups(&self, key: &BatchKey) -> [Option<&wgpu::BindGroupLayout>; 3] {
        let [frame, _, texture] = self.scene.groups(key);
        [frame, Some(&self.bindings.view_layout), texture.filter(|_| key.surface.is_cut)]
    }

    /// What a surface's shader reads of the sun.
    fn source(&self, sun: Sun) -> ShadowSource {
        let settings = &self.settings;
        let filter = match settings.variant {
            Variant::Pcf16 | Variant::Cascades => ShadowFilter::Sixteen,
            Variant::Pcf4 => ShadowFilter::Four,
            Variant::Pcss => ShadowFilter::Penumbra,
            _ => ShadowFilter::One,
        };
        let tap = self.reads.tap;
        let views = match settings.variant {
            Variant::Cascades => ShadowViews::Blended,
            Variant::Cube => ShadowViews::First,
            _ => ShadowViews::One,
        };
        match sun {
            Sun::Down => ShadowSource::Down,
            Sun::Open => ShadowSource::Open,
            Sun::Mask => ShadowSource::Mask,
            Sun::Flat => ShadowSource::Flat,
            Sun::Maps => {
                let margin_texels = settings.margin_texels() as f32 - 0.5;
                ShadowSource::Maps { filter, tap, views, bias: self.bias(filter, tap), margin_texels }
            }
        }
    }

    fn bias(&self, filter: ShadowFilter, tap: ShadowTap) -> ShadowBias {
        let bias = &self.settings.bias;
        // Of the texels that a comparison takes, how far the farthest lies from the place that it is made for.
        let tap_reach = match tap {
            ShadowTap::Filtered => 1.0,
            // Compared with the plane at the texel itself, it is the same place.
            _ if bias.has_plane => 0.0,
            ShadowTap::Gathered => 1.0,
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
            reach: if bias.has_plane { tap_reach } else { tap_reach + filter_reach },
            has_plane: bias.has_plane,
        }
    }
}

fn caster_attributes(key: &BatchKey) -> Vec<sunbake_shaders::Attribute> {
    match key.surface.is_cut {
        true => sunbake_shaders::attributes(key.surface),
        false => sunbake_shaders::attributes(SurfaceVariant::default())[..1].to_vec(),
    }
}

fn mask_state() -> State {
    State { target: Some(MASK_FORMAT.into()), depth_stencil: None, is_two_sided: true, clamps_depth: false }
}
