//! Composes shaders: constants, then files in reading order.

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
    /// Its mesh has vertex colours.
    pub has_vertex_color: bool,
    /// It has an alpha mask.
    pub has_alpha_mask: bool,
    /// Its faces are facets of something smooth: light ends where the shading normal says.
    pub is_smooth: bool,
    /// Its vertices say how far that is from the faces, as shadow maps need it.
    pub has_lift: bool,
    /// What only lit pictures show.
    pub look: LookVariant,
}

/// What a surface needs of a program that lights it, beyond its base colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct LookVariant {
    /// It is metallic or has highlights; else it only scatters light.
    pub is_specular: bool,
    /// Its material has a metallic-roughness texture; only of specular surfaces.
    pub has_metallic_roughness_map: bool,
    /// Its material has a normal map.
    pub has_normal_map: bool,
    /// Its material has an emissive texture.
    pub has_emissive_map: bool,
    /// It is blended with what lies behind.
    pub is_blended: bool,
}

impl SurfaceVariant {
    /// The same surface without its look, for programs that find depths and visibility.
    pub fn without_look(self) -> Self {
        Self { look: LookVariant::default(), ..self }
    }

    fn has_textures(self) -> bool {
        let look = self.look;
        self.is_textured || look.has_metallic_roughness_map || look.has_normal_map || look.has_emissive_map
    }
}

/// How stored times become a pixel's visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// The texel under the pixel, unfiltered: blocky, as in *GPU Gems* chapter 13.
    Nearest,
    /// Four texels, each evaluated, then blended.
    #[default]
    Bilinear,
    /// The same, and edges of shadows drawn sharply between texels: their distances in time are blended as well.
    Sharp,
    /// The sun's shadows occluder by occluder: times of the same one are blended, then evaluated, so that shadows far
    /// narrower than a texel are drawn. Texels without tracks, and lamps, are drawn as by the sharp filter.
    Tracks,
}

impl Filter {
    /// Whether edges are drawn sharply where a texel has no tracks.
    fn is_sharp(self) -> bool {
        matches!(self, Self::Sharp | Self::Tracks)
    }
}

/// A lane across the sun's disc, as a page stores it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneVariant {
    /// Number of layers; 0 where no texel of the page ever sees this lane.
    pub layer_count: u32,
    /// Its share of the sun's light, from 0 to 1.
    pub weight: f32,
    /// Its chord across the disc, as a share of the diameter. Its window is narrower by this factor.
    pub chord: f32,
}

/// What an atlas page needs of the programs that read it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageVariant {
    /// 255 or 65535.
    pub max_code: u16,
    /// In the order of their layers. Empty where the set has no sun, or where no texel of the page ever sees it.
    pub lanes: Vec<LaneVariant>,
    /// Whether the sun has no width, so that it is visible or not.
    pub is_point_sun: bool,
    /// Layers of the lamp's textures. 0 where the set has no lamp, or where no texel of the page ever sees it.
    pub lamp_layer_count: u32,
    /// How ambient light is computed.
    pub ambient: AmbientModel,
    /// Whether maps of ambient light have a slice for the backs of surfaces.
    pub has_backs: bool,
    /// Whether something stands between neighbouring texels, so that filters must not blend across it.
    pub has_walls: bool,
    /// Whether shadow tracks are read instead of the sun's times.
    pub has_tracks: bool,
}

/// How ambient light on a page's surfaces is computed. Each model reads more than the one before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum AmbientModel {
    /// Sky and ground by the normal alone: `(1 + n.y) / 2` of the sky. Reads no map.
    #[default]
    Hemisphere,
    /// The same, times ambient occlusion.
    Occlusion,
    /// The same with the bent normal instead of the normal.
    Bent,
    /// The sky of the moment in spherical harmonics, times each texel's visibility of it.
    Sky,
}

impl PageVariant {
    /// Layers of all lanes. 0: nothing on the page ever sees the sun.
    pub fn layer_count(&self) -> u32 {
        self.lanes.iter().map(|lane| lane.layer_count).sum()
    }

    /// Whether shadow tracks are read: nothing is where nothing ever sees the sun.
    pub fn reads_tracks(&self) -> bool {
        self.has_tracks && self.layer_count() > 0
    }

    /// Layers of the `rise` texture that programs read, and of the `fall` texture. 0: no texture, no binding, no loop.
    pub fn sun_layer_count(&self) -> u32 {
        if self.has_tracks { 0 } else { self.layer_count() }
    }

    /// Whether any map of texels is read.
    pub fn reads_texels(&self) -> bool {
        self.layer_count() > 0 || self.lamp_layer_count > 0 || self.ambient != AmbientModel::Hemisphere
    }
}

/// The depth pass: entry points `depth_vertex`, or for surfaces with alpha masks `surface_vertex` and `depth_fragment`.
pub fn depth_shader(surface: SurfaceVariant) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("frame/camera_projection")].concat();
    if surface.has_alpha_mask {
        push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
        text.push_str(wgsl!("frame/depth_fragment"));
    } else {
        text.push_str(DEPTH_VERTEX_WGSL);
    }
    text
}

/// The lit pass: entry points `surface_vertex` and `lit_fragment`.
pub fn lit_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    end_of_lit(&mut text, surface.look, page, filter);
    text
}

/// The rest of the lit pass, after the sun's visibility.
pub(crate) fn end_of_lit(text: &mut String, look: LookVariant, page: &PageVariant, filter: Filter) {
    push_lamp(text, page, filter);
    push_shade(text, look, page, page.lamp_layer_count > 0);
}

/// Shading, once it is known how much is seen of each light.
fn push_shade(text: &mut String, look: LookVariant, page: &PageVariant, has_lamp: bool) {
    push_ambient(text, page);
    push_surface(text, look);
    text.push_str(&match look.is_specular {
        // Reflections of the sky need its colours.
        true => [wgsl!("frame/air_color"), wgsl!("surface/ambient_specular"), wgsl!("surface/shade_specular")].concat(),
        false => wgsl!("surface/shade").to_owned(),
    });
    text.push_str(if has_lamp { wgsl!("lamp/shade") } else { wgsl!("lamp/shade_none") });
    text.push_str(wgsl!("surface/lit_fragment"));
}

/// The lit pass of a surface that nothing shades: entry points `surface_vertex` and `lit_fragment`. Of the page only
/// ambient light is read.
pub fn open_lit_shader(surface: SurfaceVariant, page: &PageVariant, has_lamp: bool) -> String {
    let page = PageVariant { lanes: Vec::new(), lamp_layer_count: 0, has_tracks: false, ..page.clone() };
    let mut text = on_surface(surface, &page, Filter::default());
    text.push_str(wgsl!("baked/sun_open"));
    text.push_str(&match has_lamp {
        true => [wgsl!("lamp/lamp"), wgsl!("lamp/to_lamp"), wgsl!("lamp/open")].concat(),
        false => wgsl!("lamp/none").to_owned(),
    });
    push_shade(&mut text, surface.look, &page, has_lamp);
    text
}

/// A surface at a pixel, and how it reflects a light.
pub(crate) fn push_surface(text: &mut String, look: LookVariant) {
    let files = [
        match (look.is_specular, look.has_metallic_roughness_map) {
            (false, _) => wgsl!("surface/metallic_roughness_none"),
            (true, false) => wgsl!("surface/metallic_roughness"),
            (true, true) => wgsl!("surface/metallic_roughness_map"),
        },
        if look.has_normal_map { wgsl!("surface/normal_map") } else { wgsl!("surface/normal") },
        if look.has_emissive_map { wgsl!("surface/emission_map") } else { wgsl!("surface/emission") },
        if look.is_blended { wgsl!("surface/opacity") } else { wgsl!("surface/opacity_one") },
        wgsl!("surface/surface"),
        if look.is_specular { wgsl!("surface/reflection_specular") } else { wgsl!("surface/reflection") },
    ];
    text.push_str(&files.concat());
}

/// The visibility pass: entry points `surface_vertex` and `visibility_fragment`.
pub fn visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = shading(surface, page, filter);
    text.push_str(wgsl!("surface/visibility_fragment"));
    text
}

/// The visibility pass of a lamp: entry points `surface_vertex` and `lamp_visibility_fragment`.
pub fn lamp_visibility_shader(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page, filter);
    push_lamp(&mut text, page, filter);
    text.push_str(wgsl!("lamp/visibility_fragment"));
    text
}

/// The background: entry points `screen_vertex` and `sky_fragment`.
pub fn sky_shader() -> String {
    [
        &constants(),
        wgsl!("frame/frame"),
        wgsl!("frame/air_color"),
        wgsl!("frame/sky_color"),
        wgsl!("frame/screen_vertex"),
        wgsl!("frame/sky_fragment"),
    ]
    .concat()
}

fn constants() -> String {
    format!(
        "const WRAP_REPEAT: u32 = {WRAP_REPEAT}u;\nconst WRAP_MIRROR: u32 = {WRAP_MIRROR}u;\nconst WRAP_CLAMP: u32 = \
         {WRAP_CLAMP}u;\n"
    )
}

/// How every program that lights a surface begins.
pub(crate) fn on_surface(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = [wgsl!("frame/frame"), wgsl!("frame/camera_projection")].concat();
    push_alpha_mask(&mut text, surface, &surface_vertex_wgsl(surface, None));
    text.push_str(wgsl!("surface/facing"));
    text.push_str(if surface.is_smooth { wgsl!("surface/gate_smooth") } else { wgsl!("surface/gate_flat") });
    push_evaluation(&mut text, page, filter);
    text
}

/// What evaluates a page's maps: the texels around a page coordinate, and the lit share of stored times.
fn push_evaluation(text: &mut String, page: &PageVariant, filter: Filter) {
    let (has_sun, has_lamp) = (page.layer_count() > 0, page.lamp_layer_count > 0);
    if page.reads_texels() {
        text.push_str(wgsl!("baked/footprint"));
        text.push_str(if page.has_walls { wgsl!("baked/blend_beside_walls") } else { wgsl!("baked/blend") });
    }
    let has_sun = has_sun && !page.reads_tracks();
    if has_sun || has_lamp {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "const MAX_CODE: f32 = {:?};", f32::from(page.max_code));
    }
    if page.reads_tracks() || (filter.is_sharp() && (has_sun || has_lamp)) {
        text.push_str(wgsl!("baked/edge"));
    }
    if filter.is_sharp() {
        if has_sun || has_lamp {
            text.push_str(wgsl!("baked/edge_sample"));
        }
        return;
    }
    if has_sun && page.is_point_sun {
        text.push_str(wgsl!("baked/hard_visibility"));
    }
    if has_lamp || (has_sun && !page.is_point_sun) {
        text.push_str(wgsl!("baked/soft_visibility"));
    }
}

/// Ambient light.
fn push_ambient(text: &mut String, page: &PageVariant) {
    text.push_str(if page.has_backs { wgsl!("ambient/side_two") } else { wgsl!("ambient/side_one") });
    if matches!(page.ambient, AmbientModel::Occlusion | AmbientModel::Bent) {
        text.push_str(wgsl!("ambient/visibility"));
    }
    text.push_str(match page.ambient {
        AmbientModel::Hemisphere => wgsl!("ambient/hemisphere"),
        AmbientModel::Occlusion => wgsl!("ambient/occlusion"),
        AmbientModel::Bent => wgsl!("ambient/bent"),
        AmbientModel::Sky => wgsl!("ambient/sky"),
    });
}

/// The visible share of the lamp.
fn push_lamp(text: &mut String, page: &PageVariant, filter: Filter) {
    if page.lamp_layer_count == 0 {
        text.push_str(wgsl!("lamp/none"));
        return;
    }
    text.push_str(&[wgsl!("lamp/lamp"), wgsl!("lamp/maps")].concat());
    text.push_str(&match filter {
        Filter::Nearest => [wgsl!("lamp/baked_texel"), wgsl!("lamp/baked_nearest")].concat(),
        Filter::Bilinear => [wgsl!("lamp/baked_texel"), wgsl!("lamp/baked_bilinear")].concat(),
        Filter::Sharp | Filter::Tracks => wgsl!("lamp/baked_sharp").to_owned(),
    });
    text.push_str(wgsl!("lamp/to_lamp"));
    text.push_str(wgsl!("lamp/baked"));
}

fn shading(surface: SurfaceVariant, page: &PageVariant, filter: Filter) -> String {
    let mut text = on_surface(surface, page, filter);
    if page.layer_count() == 0 {
        text.push_str(wgsl!("baked/sun_none"));
        return text;
    }
    if page.reads_tracks() {
        let reach = if page.has_walls { "" } else { wgsl!("baked/reach") };
        text.push_str(&[reach, wgsl!("baked/sun_tracks"), wgsl!("baked/sun")].concat());
        return text;
    }
    text.push_str(wgsl!("baked/sun_maps"));
    text.push_str(&match filter {
        Filter::Nearest => [&disc_visibility(&page.lanes, page.is_point_sun), wgsl!("baked/sun_nearest")].concat(),
        Filter::Bilinear => [&disc_visibility(&page.lanes, page.is_point_sun), wgsl!("baked/sun_bilinear")].concat(),
        Filter::Sharp | Filter::Tracks => {
            [wgsl!("baked/sun_sharp"), &sharp_visibility(&page.lanes, page.is_point_sun)].concat()
        }
    });
    text.push_str(if page.is_point_sun { wgsl!("baked/sun_point") } else { wgsl!("baked/sun") });
    text
}

/// A vertex stage with its varyings, and the surface's colour and alpha mask.
pub(crate) fn push_alpha_mask(text: &mut String, surface: SurfaceVariant, vertex: &str) {
    text.push_str(&constants());
    text.push_str(vertex);
    if surface.has_textures() {
        text.push_str(wgsl!("surface/level"));
    }
    text.push_str(if surface.is_textured {
        wgsl!("surface/texture_color")
    } else {
        wgsl!("surface/texture_color_none")
    });
    text.push_str(if surface.has_vertex_color {
        wgsl!("surface/vertex_color")
    } else {
        wgsl!("surface/vertex_color_none")
    });
    if surface.has_alpha_mask {
        text.push_str(wgsl!("surface/alpha_mask"));
        text.push_str(if surface.is_textured {
            wgsl!("surface/texel_alpha")
        } else {
            wgsl!("surface/texel_alpha_none")
        });
    } else {
        text.push_str(wgsl!("surface/alpha_mask_none"));
    }
}

/// The same sum for the sharp filter, which works on each lane by itself.
fn sharp_visibility(lanes: &[LaneVariant], is_point_sun: bool) -> String {
    let mut text = String::from(
        "fn page_visibility(page_uv: vec2<f32>) -> f32 {\n    let at = footprint(page_uv, \
         textureDimensions(rise_map));\n    var visibility = 0.0;\n",
    );
    let mut first = 0;
    for lane in lanes.iter().filter(|lane| lane.layer_count > 0) {
        let end = first + lane.layer_count;
        let weight = lane.weight;
        let width = if is_point_sun { "0.0".to_owned() } else { format!("frame.width_t * {:?}", lane.chord) };
        let _ = writeln!(
            text,
            "    visibility += {weight:?} * lane_visibility(at, vec2<i32>({first}, {end}), frame.t, {width});"
        );
        first = end;
    }
    text.push_str("    return visibility;\n}\n");
    text
}

/// The sum over lanes, written out: their number, layers, weights and chords are constants of the page.
fn disc_visibility(lanes: &[LaneVariant], is_point_sun: bool) -> String {
    let mut text = String::from("fn disc_visibility(texel: vec2<i32>) -> f32 {\n    var visibility = 0.0;\n");
    let mut first = 0;
    for lane in lanes.iter().filter(|lane| lane.layer_count > 0) {
        let end = first + lane.layer_count;
        let (weight, chord) = (lane.weight, lane.chord);
        let (kind, width) =
            if is_point_sun { ("hard", String::new()) } else { ("soft", format!(", frame.width_t * {chord:?}")) };
        let _ = writeln!(
            text,
            "    visibility += {weight:?} * {kind}_visibility(rise_map, fall_map, texel, vec2<i32>({first}, {end}), \
             frame.t{width});"
        );
        first = end;
    }
    text.push_str("    return visibility;\n}\n");
    text
}
