//! Shaders of shadow volumes and of point lights.

use crate::compose::{on_surface, push_surface, wgsl};
use crate::{Filter, PageVariant, SurfaceVariant};

/// A light that extrudes volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeLight {
    /// Walls meet in one point at infinity.
    Sun,
    /// Walls spread to infinity.
    Lamp,
    /// Walls end beyond the lamp's range.
    LampWithRange,
}

/// Where a volume's corners come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeCorners {
    /// An index list made by the CPU: entry point `volume_vertex`.
    Indexed,
    /// The vertex shader, from every edge: entry points `wall_vertex`, `cap_vertex`, for lamps `dark_cap_vertex`, and
    /// for smooth solids `spared_vertex`.
    FromEdges,
}

/// What the pixels of a face are used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VolumeUse {
    /// The stencil counts them.
    Stencil,
    /// They are summed with signs: entry point `volume_count_fragment`.
    Count,
    /// They are summed: entry point `volume_fill_fragment`.
    Fill,
    /// They are summed per side, for a picture of the volumes: entry point `volume_visualize_fragment`.
    Visualize,
}

impl VolumeUse {
    /// The entry point of the fragment stage.
    pub fn fragment(self) -> Option<&'static str> {
        match self {
            Self::Stencil => None,
            Self::Count => Some("volume_count_fragment"),
            Self::Fill => Some("volume_fill_fragment"),
            Self::Visualize => Some("volume_visualize_fragment"),
        }
    }
}

/// WGSL that draws faces of volumes.
pub fn volume_shader(light: VolumeLight, corners: VolumeCorners, of: VolumeUse) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("frame/camera_projection"), wgsl!("volumes/points")].concat();
    match light {
        VolumeLight::Sun => text.push_str(wgsl!("volumes/corner_sun")),
        VolumeLight::Lamp => text.push_str(&[wgsl!("lamp/lamp"), wgsl!("volumes/corner_lamp")].concat()),
        VolumeLight::LampWithRange => {
            text.push_str(&[wgsl!("lamp/lamp"), wgsl!("volumes/corner_lamp_finite")].concat());
        }
    }
    match (corners, light) {
        (VolumeCorners::Indexed, _) => text.push_str(wgsl!("volumes/indexed")),
        (VolumeCorners::FromEdges, VolumeLight::Sun) => {
            text.push_str(&[wgsl!("volumes/silhouettes_by_gpu"), wgsl!("volumes/wall_sun")].concat());
        }
        (VolumeCorners::FromEdges, _) => {
            text.push_str(&[wgsl!("volumes/silhouettes_by_gpu"), wgsl!("volumes/wall_lamp")].concat());
        }
    }
    text.push_str(match of {
        VolumeUse::Stencil => "",
        VolumeUse::Count => wgsl!("volumes/count_fragment"),
        VolumeUse::Fill => wgsl!("volumes/fill_fragment"),
        VolumeUse::Visualize => wgsl!("volumes/visualize_fragment"),
    });
    text
}

/// A point light on surfaces that no volume hides from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum HardLight {
    /// Whether the sun lights the surface: entry points `surface_vertex` and `sun_mask_fragment`.
    SunMask,
    /// Light of the sun: `sun_light_fragment`.
    Sun,
    /// Whether the lamp lights the surface: `lamp_mask_fragment`.
    LampMask,
    /// Light of the lamp: `lamp_light_fragment`.
    Lamp,
}

impl HardLight {
    /// The entry point of the fragment stage.
    pub fn fragment(self) -> &'static str {
        match self {
            Self::SunMask => "sun_mask_fragment",
            Self::Sun => "sun_light_fragment",
            Self::LampMask => "lamp_mask_fragment",
            Self::Lamp => "lamp_light_fragment",
        }
    }
}

/// WGSL that adds a point light on surfaces.
pub fn hard_light_shader(surface: SurfaceVariant, light: HardLight) -> String {
    let mut text = on_surface(surface, &PageVariant::default(), Filter::default());
    if matches!(light, HardLight::LampMask | HardLight::Lamp) {
        text.push_str(&[wgsl!("lamp/lamp"), wgsl!("lamp/to_lamp"), wgsl!("volumes/lamp_facing")].concat());
    }
    if matches!(light, HardLight::Sun | HardLight::Lamp) {
        push_surface(&mut text, surface.look);
    }
    text.push_str(&match light {
        HardLight::SunMask => wgsl!("volumes/sun_mask_fragment").to_owned(),
        HardLight::Sun => wgsl!("volumes/sun_light_fragment").to_owned(),
        HardLight::LampMask => wgsl!("volumes/lamp_mask_fragment").to_owned(),
        HardLight::Lamp => [wgsl!("lamp/shade"), wgsl!("volumes/lamp_light_fragment")].concat(),
    });
    text
}

/// Visibility of all pixels without a surface: entry points `screen_vertex` and `background_fragment`.
pub fn background_shader() -> String {
    [wgsl!("frame/screen_vertex"), wgsl!("frame/background_fragment")].concat()
}

/// All pixels, for the stencil alone: entry point `screen_vertex`.
pub fn screen_shader() -> String {
    wgsl!("frame/screen_vertex").to_owned()
}
