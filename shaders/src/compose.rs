//! Puts shaders together: constants, then files, in the order in which they would be read.

use crate::uniforms::{WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT};
use crate::vertex::{DEPTH_VERTEX_WGSL, surface_vertex_wgsl};
use std::fmt::Write;

macro_rules! wgsl {
    ($name:literal) => {
        include_str!(concat!("wgsl/", $name, ".wgsl"))
    };
}
pub(crate) use wgsl;

/// What a surface needs of its program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct SurfaceVariant {
    /// Its material has a base colour texture.
    pub is_textured: bool,
    /// Its mesh has colours.
    pub has_vertex_color: bool,
    /// It has holes.
    pub is_cut: bool,
}

/// How stored times become a pixel's visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// The texel under the pixel: blocky, as in the chapter.
    Nearest,
    /// Four texels, each evaluated, then blended.
    #[default]
    Bilinear,
}

/// A lane across the sun's disc, as a page stores it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneVariant {
    /// Number of layers.
    pub layer_count: u32,
    /// Share of the light.
    pub weight: f32,
    /// The lane's chord across the disc, as a share of the diameter: how much narrower its window is.
    pub chord: f32,
}

/// What an atlas page needs of the programs that read it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageVariant {
    /// 255 or 65535.
    pub max_code: u16,
    /// In the order of their layers. Empty: there is no sun in the set, or no texel of the page ever sees it.
    pub lanes: Vec<LaneVariant>,
    /// Whether the sun has no width: it is seen or not, and nothing measures how much of it.
    pub is_point_sun: bool,
    /// Array layers of the lamp's textures. None: there is no lamp in the set, or no texel of the page ever sees it.
    pub lamp_layer_count: u32,
    /// What ambient light is made of.
    pub ambient: AmbientModel,
    /// Whether maps of ambient light hold what backs see as well.
    pub has_backs: bool,
}

/// What ambient light on a page's surfaces is made of: each knows more than the one before it, and reads more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum AmbientModel {
    /// The normal alone: `(1 + n.y) / 2` of sky. No map.
    #[default]
    Hemisphere,
    /// That, times ambient occlusion.
    Occlusion,
    /// The same about the bent normal.
    Bent,
    /// The sky of the moment in spherical harmonics, against each texel's visibility of it.
    Sky,
}

impl PageVariant {
    /// Array layers of the page's `rise` and of its `fall` texture. None: no texture, no binding and no loop.
    pub fn layer_count(&self) -> u32 {
        self.lanes.iter().map(|lane| lane.layer_count).sum()
    }
}

/// The depth pass: entry points `depth_vertex`, or for surfaces with holes `surface_vertex` and `depth_fragment`.
pub fn depth_shader(surface: SurfaceVariant) -> String {
    let mut text = [wgsl!("frame"), wgsl!("place")].concat();
    if surface.is_cut {
        push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
        text.push_str(wgsl!("depth_fragment"));
    } else {
        text.push_str(DEPTH_VERTEX_WGSL);
    }
    text
}

/// The lit pass: entry points `surface_vertex` and `lit_fragment`.
pub fn lit_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    end_of_lit(&mut text, page, filter);
    text
}

/// All of the lit pass after what is known of the sun.
pub(crate) fn end_of_lit(text: &mut String, page: &PageVariant, filter: Filter) {
    push_ambient(text, page);
    text.push_str(wgsl!("shade"));
    push_lamp(text, page, filter);
    text.push_str(if page.lamp_layer_count > 0 { wgsl!("lamp_shade") } else { wgsl!("lamp_shade_none") });
    text.push_str(wgsl!("surface"));
    text.push_str(wgsl!("lit_fragment"));
}

/// The visibility pass: entry points `surface_vertex` and `visibility_fragment`.
pub fn visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    text.push_str(wgsl!("visibility_fragment"));
    text
}

/// The visibility pass of a lamp: entry points `surface_vertex` and `lamp_visibility_fragment`.
pub fn lamp_visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page);
    push_lamp(&mut text, page, filter);
    text.push_str(wgsl!("lamp_visibility_fragment"));
    text
}

/// The background: entry points `screen_vertex` and `sky_fragment`.
pub fn sky_shader() -> String {
    [&constants(), wgsl!("frame"), wgsl!("sky_color"), wgsl!("screen"), wgsl!("sky")].concat()
}

fn constants() -> String {
    format!(
        "const WRAP_REPEAT: u32 = {WRAP_REPEAT}u;\nconst WRAP_MIRROR: u32 = {WRAP_MIRROR}u;\nconst WRAP_CLAMP: u32 = \
         {WRAP_CLAMP}u;\n"
    )
}

/// What every program that lights a surface begins with.
pub(crate) fn on_surface(surface: SurfaceVariant, page: &PageVariant) -> String {
    let mut text = [wgsl!("frame"), wgsl!("place")].concat();
    push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
    text.push_str(wgsl!("facing"));
    if page.layer_count() + page.lamp_layer_count > 0 {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "const MAX_CODE: f32 = {:?};", f32::from(page.max_code));
    }
    text
}

/// Light from all around.
fn push_ambient(text: &mut String, page: &PageVariant) {
    text.push_str(if page.has_backs { wgsl!("side_two") } else { wgsl!("side_one") });
    if matches!(page.ambient, AmbientModel::Occlusion | AmbientModel::Bent) {
        text.push_str(wgsl!("ambient_visibility"));
    }
    text.push_str(match page.ambient {
        AmbientModel::Hemisphere => wgsl!("ambient_hemisphere"),
        AmbientModel::Occlusion => wgsl!("ambient_occlusion"),
        AmbientModel::Bent => wgsl!("ambient_bent"),
        AmbientModel::Sky => wgsl!("ambient_sky"),
    });
}

/// What is seen of the lamp.
fn push_lamp(text: &mut String, page: &PageVariant, filter: Filter) {
    if page.lamp_layer_count == 0 {
        text.push_str(wgsl!("lamp_none"));
        return;
    }
    text.push_str(wgsl!("lamp"));
    text.push_str(wgsl!("lamp_soft_visibility"));
    text.push_str(match filter {
        Filter::Nearest => wgsl!("lamp_filter_nearest"),
        Filter::Bilinear => wgsl!("lamp_filter_bilinear"),
    });
    text.push_str(wgsl!("way_to_lamp"));
    text.push_str(wgsl!("lamp_baked"));
}

fn shading(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page);
    if page.layer_count() == 0 {
        text.push_str(wgsl!("sun_none"));
        return text;
    }
    text.push_str(if page.is_point_sun { wgsl!("hard_visibility") } else { wgsl!("soft_visibility") });
    text.push_str(&disc_visibility(&page.lanes, page.is_point_sun));
    text.push_str(match filter {
        Filter::Nearest => wgsl!("filter_nearest"),
        Filter::Bilinear => wgsl!("filter_bilinear"),
    });
    text.push_str(if page.is_point_sun { wgsl!("sun_baked_point") } else { wgsl!("sun_baked") });
    text
}

/// A vertex stage with its varyings, and what is known of the surface's colour and holes.
pub(crate) fn push_alpha_mask(text: &mut String, surface: SurfaceVariant, vertex: &str) {
    text.push_str(&constants());
    text.push_str(vertex);
    text.push_str(if surface.is_textured { wgsl!("texture_color") } else { wgsl!("texture_none") });
    text.push_str(if surface.has_vertex_color { wgsl!("vertex_color") } else { wgsl!("vertex_color_none") });
    if surface.is_cut {
        text.push_str(wgsl!("alpha_cut"));
        text.push_str(if surface.is_textured { wgsl!("texel_alpha") } else { wgsl!("texel_alpha_none") });
    } else {
        text.push_str(wgsl!("alpha_none"));
    }
}

/// The lanes' sum, written out: their number, layers, weights and chords are constants of the page.
fn disc_visibility(lanes: &[LaneVariant], is_point_sun: bool) -> String {
    let mut text = String::from("fn disc_visibility(texel: vec2<i32>) -> f32 {\n    var seen = 0.0;\n");
    let mut first = 0;
    for lane in lanes.iter().filter(|lane| lane.layer_count > 0) {
        let end = first + lane.layer_count;
        let (weight, chord) = (lane.weight, lane.chord);
        let (kind, width) =
            if is_point_sun { ("hard", String::new()) } else { ("soft", format!(", frame.width_t * {chord:?}")) };
        let _ = writeln!(
            text,
            "    seen += {weight:?} * {kind}_visibility(texel, vec2<i32>({first}, {end}), frame.t{width});"
        );
        first = end;
    }
    text.push_str("    return seen;\n}\n");
    text
}
