//! Shaders of shadow volumes, and of lights without size.

use crate::compose::{on_surface, wgsl};
use crate::{PageVariant, SurfaceVariant};

/// A light that extrudes volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeLight {
    /// Walls meet in a point at infinity.
    Sun,
    /// Walls spread to infinity.
    Lamp,
    /// Walls spread to somewhere beyond the lamp's range.
    LampWithRange,
}

/// Where a volume's corners come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeCorners {
    /// A list: entry point `volume_vertex`.
    Indexed,
    /// Every edge: entry points `wall_vertex`, `cap_vertex`, and for lamps `dark_cap_vertex`.
    Found,
}

/// What becomes of a face's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeUse {
    /// Nothing but what the stencil does.
    Stencil,
    /// A signed sum: entry point `volume_count_fragment`.
    Count,
    /// A sum: entry point `volume_fill_fragment`.
    Fill,
    /// Sums for each side, to be shown: entry point `volume_show_fragment`.
    Show,
}

impl VolumeUse {
    /// The entry point for pixels.
    pub fn fragment(self) -> Option<&'static str> {
        match self {
            Self::Stencil => None,
            Self::Count => Some("volume_count_fragment"),
            Self::Fill => Some("volume_fill_fragment"),
            Self::Show => Some("volume_show_fragment"),
        }
    }
}

/// Shadow volumes.
pub fn volume_shader(light: VolumeLight, corners: VolumeCorners, of: VolumeUse) -> String {
    let mut text = [wgsl!("frame"), wgsl!("place"), wgsl!("volume_points")].concat();
    match light {
        VolumeLight::Sun => text.push_str(wgsl!("volume_corner_sun")),
        VolumeLight::Lamp => text.push_str(&[wgsl!("lamp"), wgsl!("volume_corner_lamp")].concat()),
        VolumeLight::LampWithRange => text.push_str(&[wgsl!("lamp"), wgsl!("volume_corner_lamp_finite")].concat()),
    }
    match (corners, light) {
        (VolumeCorners::Indexed, _) => text.push_str(wgsl!("volume_indexed")),
        (VolumeCorners::Found, VolumeLight::Sun) => {
            text.push_str(&[wgsl!("volume_found"), wgsl!("volume_wall_sun")].concat());
        }
        (VolumeCorners::Found, _) => text.push_str(&[wgsl!("volume_found"), wgsl!("volume_wall_lamp")].concat()),
    }
    text.push_str(match of {
        VolumeUse::Stencil => "",
        VolumeUse::Count => wgsl!("volume_count_fragment"),
        VolumeUse::Fill => wgsl!("volume_fill_fragment"),
        VolumeUse::Show => wgsl!("volume_show_fragment"),
    });
    text
}

/// A sun or lamp without size on surfaces that nothing hides from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum HardLight {
    /// Whether the sun shines there: entry points `surface_vertex` and `sun_gate_fragment`.
    SunGate,
    /// What the sun adds: `sun_light_fragment`.
    Sun,
    /// Whether the lamp shines there: `lamp_gate_fragment`.
    LampGate,
    /// What the lamp adds: `lamp_light_fragment`.
    Lamp,
}

impl HardLight {
    /// The entry point for pixels.
    pub fn fragment(self) -> &'static str {
        match self {
            Self::SunGate => "sun_gate_fragment",
            Self::Sun => "sun_light_fragment",
            Self::LampGate => "lamp_gate_fragment",
            Self::Lamp => "lamp_light_fragment",
        }
    }
}

/// A light without size.
pub fn hard_light_shader(surface: SurfaceVariant, light: HardLight) -> String {
    let mut text = on_surface(surface, &PageVariant::default());
    if matches!(light, HardLight::LampGate | HardLight::Lamp) {
        text.push_str(&[wgsl!("lamp"), wgsl!("way_to_lamp"), wgsl!("lamp_gate")].concat());
    }
    match light {
        HardLight::SunGate => text.push_str(wgsl!("sun_gate_fragment")),
        HardLight::Sun => text.push_str(&[wgsl!("surface"), wgsl!("sun_light_fragment")].concat()),
        HardLight::LampGate => text.push_str(wgsl!("lamp_gate_fragment")),
        HardLight::Lamp => {
            text.push_str(&[wgsl!("lamp_shade"), wgsl!("surface"), wgsl!("lamp_light_fragment")].concat());
        }
    }
    text
}

/// The whole picture, where there is no surface: entry points `screen_vertex` and `background_fragment`.
pub fn background_shader() -> String {
    [wgsl!("screen"), wgsl!("background_fragment")].concat()
}

/// The whole picture, for what the stencil does alone: entry point `screen_vertex`.
pub fn screen_shader() -> String {
    wgsl!("screen").to_owned()
}
