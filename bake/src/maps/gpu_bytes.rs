//! Bytes that a page takes on a GPU. Predictions, plans and reports all count them here.

use super::{Bits, PageMaps};

/// The textures of ambient light that a shader reads. Each takes bytes per texel and per side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AmbientTextures {
    /// None.
    #[default]
    None,
    /// Ambient occlusion: one 16-bit number, 2 bytes.
    Occlusion,
    /// Ambient occlusion, and bent normals as RGBA of 16 bits: 10 bytes.
    Bent,
    /// Sky visibility: nine numbers in three RGBA slices of 16 bits, 24 bytes. Ambient occlusion is not read.
    Sky,
}

impl AmbientTextures {
    /// The most detailed that a page's maps allow.
    pub fn of(page: &PageMaps) -> Self {
        match &page.ambient {
            None => Self::None,
            Some(ambient) if ambient.front.sky.is_some() => Self::Sky,
            Some(ambient) if ambient.front.bent.is_some() => Self::Bent,
            Some(_) => Self::Occlusion,
        }
    }
}

/// What a GPU stores for each texel of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GpuTexel {
    /// Layers of rise and fall times: those of all lanes of the sun, and those of the lamp.
    pub layers: u32,
    /// Bits of a time: 8 or 16.
    pub bits: u32,
    /// Textures of ambient light.
    pub ambient: AmbientTextures,
    /// Sides that ambient light is stored for: 1 or 2.
    pub sides: u32,
    /// Whether there is a texture of walls.
    pub walls: bool,
}

impl GpuTexel {
    /// Bytes of a texel.
    pub fn bytes(self) -> u64 {
        // A layer is two textures of four times each, so that it takes as many bytes as a time has bits.
        let times = u64::from(self.layers) * u64::from(self.bits);
        let ambient_side = match self.ambient {
            AmbientTextures::None => 0,
            AmbientTextures::Occlusion => 2,
            AmbientTextures::Bent => 2 + 8,
            AmbientTextures::Sky => 3 * 8,
        };
        times + ambient_side * u64::from(self.sides) + if self.walls { 2 } else { 0 }
    }
}

impl PageMaps {
    /// What a GPU stores for each texel, where everything that the page has is uploaded.
    pub fn gpu_texel(&self, bits: Bits) -> GpuTexel {
        let sun_layers: usize = self.lanes.iter().map(|lane| lane.layers.len()).sum();
        let lamp_layers = self.lamp.as_ref().map_or(0, Vec::len);
        let has_backs = self.ambient.as_ref().is_some_and(|ambient| ambient.back.is_some());
        GpuTexel {
            layers: (sun_layers + lamp_layers) as u32,
            bits: bits.count(),
            ambient: AmbientTextures::of(self),
            sides: if has_backs { 2 } else { 1 },
            walls: self.walls.is_some(),
        }
    }

    /// Bytes that the page takes on a GPU.
    pub fn gpu_bytes(&self, bits: Bits) -> u64 {
        u64::from(self.width) * u64::from(self.height) * self.gpu_texel(bits).bytes()
    }

    /// The same where its tracks, if it has any, take the place of the sun's times.
    pub fn gpu_bytes_with_tracks(&self, bits: Bits) -> u64 {
        let Some(tracks) = &self.tracks else { return self.gpu_bytes(bits) };
        let lamp_layers = self.lamp.as_ref().map_or(0, Vec::len) as u32;
        let texel = GpuTexel { layers: lamp_layers, ..self.gpu_texel(bits) };
        u64::from(self.width) * u64::from(self.height) * texel.bytes() + tracks.gpu_bytes()
    }
}
