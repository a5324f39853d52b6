//! The kinds of picture.

/// Format of lit pictures that are read back: linear light, as precise as the CPU's.
const LIT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of visibility pictures that are read back.
const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Output {
    /// The lit scene, as RGB in linear light. Values may exceed 1; no tone curve is applied.
    Lit,
    /// The visible share of the sun, from 0 to 1, in the red channel. Pixels without a surface are 1.
    Visibility,
    /// The same for the lamp.
    LampVisibility,
}

impl Output {
    /// Format of a picture that is read back.
    pub(in crate::gpu) fn readback_format(self) -> wgpu::TextureFormat {
        if self == Self::Lit { LIT_FORMAT } else { VISIBILITY_FORMAT }
    }

    /// What a picture is cleared to. A lit one is then covered by the sky.
    pub(in crate::gpu) fn background(self) -> wgpu::Color {
        if self == Self::Lit { wgpu::Color::BLACK } else { wgpu::Color::WHITE }
    }

    /// Numbers per pixel of a picture that is read back.
    pub(in crate::gpu) fn channels(self) -> u32 {
        if self == Self::Lit { 4 } else { 1 }
    }
}
