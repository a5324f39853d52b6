//! Vertex attributes. The layout of the buffers, the WGSL structs and the vertex stage all come from [`attributes`].
//!
//! Vertices are split into streams, each in its own buffer, so that a pass reads only what it needs: the depth pass
//! of an opaque surface reads positions alone, and a surface without a texture has no texture coordinates.

use crate::SurfaceVariant;
use bytemuck::{Pod, Zeroable};
use std::fmt::Write;

/// A vertex buffer, by what one of its entries holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stream {
    /// [`PositionVertex`].
    Position,
    /// [`SurfaceVertex`].
    Surface,
    /// [`TextureVertex`]; only of textured surfaces.
    Texture,
    /// [`ColorVertex`]; only of surfaces with vertex colours.
    Color,
    /// [`TextureVertex`]; only of surfaces with a metallic-roughness texture.
    MetallicRoughness,
    /// [`NormalVertex`]; only of surfaces with a normal map.
    Normal,
    /// [`TextureVertex`]; only of surfaces with an emissive texture.
    Emissive,
    /// [`LiftVertex`]; only of facets of something smooth, where shadow maps are read.
    Lift,
}

impl Stream {
    /// Bytes from one vertex to the next.
    pub fn stride(self) -> u64 {
        let bytes = match self {
            Self::Position => size_of::<PositionVertex>(),
            Self::Surface => size_of::<SurfaceVertex>(),
            Self::Texture | Self::MetallicRoughness | Self::Emissive => size_of::<TextureVertex>(),
            Self::Normal => size_of::<NormalVertex>(),
            Self::Color => size_of::<ColorVertex>(),
            Self::Lift => size_of::<LiftVertex>(),
        };
        bytes as u64
    }
}

/// How an attribute is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// `f32`.
    Float,
    /// Two `f32`.
    Float2,
    /// Three `f32`.
    Float3,
    /// Four `i16`, from -1 to 1.
    Snorm16x4,
    /// Four `u16`, from 0 to 1.
    Unorm16x4,
    /// `u32`.
    Uint,
}

/// The position of a vertex.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct PositionVertex {
    /// In bake space, metres.
    pub position_m: [f32; 3],
}

/// Attributes of every lit surface.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SurfaceVertex {
    /// The triangle's unit front normal, the same at its three corners.
    pub front_normal: [f32; 3],
    /// Unit normal for shading; the fourth is unused.
    pub shading_normal: [i16; 4],
    /// Page coordinates of the maps.
    pub page_uv: [f32; 2],
    /// Index of the material.
    pub material: u32,
}

/// Attributes of textured surfaces.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TextureVertex {
    /// Image coordinates.
    pub image_uv: [f32; 2],
    /// Texels of the image's first level per metre of the triangle, the same at its three corners.
    pub texels_per_metre: f32,
}

/// Attributes of surfaces with a normal map.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct NormalVertex {
    /// Image coordinates of the normal map, and its texels per metre.
    pub texture: TextureVertex,
    /// Unit tangent in bake space, and 1 or -1: the bitangent is the cross product of normal and tangent, times that.
    pub tangent: [i16; 4],
}

/// An entry of [`Stream::Color`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ColorVertex {
    /// Linear RGBA.
    pub color: [u16; 4],
}

/// An entry of [`Stream::Lift`]: how the smooth shape rises above its facet.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LiftVertex {
    /// The vectors that the triangle's edges bulge by, metres, the same at its three corners: of the edge from its
    /// first corner to the second,
    pub first_lift_m: [f32; 3],
    /// from the second to the third,
    pub second_lift_m: [f32; 3],
    /// and from the third to the first.
    pub third_lift_m: [f32; 3],
    /// Weights of the second and third corner.
    pub lift_weights: [f32; 2],
}

/// One attribute of a vertex; its shader location is its place in [`attributes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attribute {
    /// Name in WGSL, in vertex and varyings alike.
    pub name: &'static str,
    /// The buffer it comes from.
    pub stream: Stream,
    /// How it is stored.
    pub format: Format,
    /// Bytes from the start of its vertex.
    pub offset: u64,
    /// Whether all three corners have the same value.
    pub is_flat: bool,
}

/// The attributes of a surface, for the passes that shade it and the depth pass of surfaces with alpha masks.
pub fn attributes(surface: SurfaceVariant) -> Vec<Attribute> {
    use std::mem::offset_of;
    let make = |name, stream, format, offset: usize, is_flat| Attribute {
        name,
        stream,
        format,
        offset: offset as u64,
        is_flat,
    };
    let mut all = vec![
        make("position_m", Stream::Position, Format::Float3, offset_of!(PositionVertex, position_m), false),
        make("front_normal", Stream::Surface, Format::Float3, offset_of!(SurfaceVertex, front_normal), true),
        make("shading_normal", Stream::Surface, Format::Snorm16x4, offset_of!(SurfaceVertex, shading_normal), false),
        make("page_uv", Stream::Surface, Format::Float2, offset_of!(SurfaceVertex, page_uv), false),
        make("material", Stream::Surface, Format::Uint, offset_of!(SurfaceVertex, material), true),
    ];
    if surface.is_textured {
        let offset = offset_of!(TextureVertex, texels_per_metre);
        all.push(make("image_uv", Stream::Texture, Format::Float2, offset_of!(TextureVertex, image_uv), false));
        all.push(make("texels_per_metre", Stream::Texture, Format::Float, offset, true));
    }
    if surface.has_vertex_color {
        all.push(make("color", Stream::Color, Format::Unorm16x4, offset_of!(ColorVertex, color), false));
    }
    // Coordinates and texels per metre in one: a GPU has no more than sixteen attributes.
    let mut texture = |stream, place| {
        all.push(make(place, stream, Format::Float3, offset_of!(TextureVertex, image_uv), false));
    };
    if surface.look.has_metallic_roughness_map {
        texture(Stream::MetallicRoughness, "metal_place");
    }
    if surface.look.has_emissive_map {
        texture(Stream::Emissive, "emissive_place");
    }
    if surface.look.has_normal_map {
        texture(Stream::Normal, "normal_place");
        all.push(make("tangent", Stream::Normal, Format::Snorm16x4, offset_of!(NormalVertex, tangent), false));
    }
    if surface.has_lift {
        let lift = |name, offset| make(name, Stream::Lift, Format::Float3, offset, true);
        all.push(lift("first_lift_m", offset_of!(LiftVertex, first_lift_m)));
        all.push(lift("second_lift_m", offset_of!(LiftVertex, second_lift_m)));
        all.push(lift("third_lift_m", offset_of!(LiftVertex, third_lift_m)));
        let offset = offset_of!(LiftVertex, lift_weights);
        all.push(make("lift_weights", Stream::Lift, Format::Float2, offset, false));
    }
    all
}

impl Format {
    fn wgsl(self) -> &'static str {
        match self {
            Self::Float => "f32",
            Self::Float2 => "vec2<f32>",
            Self::Float3 => "vec3<f32>",
            Self::Snorm16x4 | Self::Unorm16x4 => "vec4<f32>",
            Self::Uint => "u32",
        }
    }
}

/// The vertex stage of a surface. It projects the position and passes on all other attributes, and one more number if
/// given: its name and its expression.
pub(crate) fn surface_vertex_wgsl(surface: SurfaceVariant, more: Option<(&str, &str)>) -> String {
    let all = attributes(surface);
    let mut vertex = String::from("struct Vertex {\n");
    let mut varyings = String::from("struct Varyings {\n    @builtin(position) @invariant clip: vec4<f32>,\n");
    let mut copies = String::new();
    for (location, attribute) in all.iter().enumerate() {
        let (name, kind) = (attribute.name, attribute.format.wgsl());
        let flat = if attribute.is_flat { " @interpolate(flat)" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(vertex, "    @location({location}) {name}: {kind},");
        if attribute.stream != Stream::Position {
            let _ = writeln!(varyings, "    @location({location}){flat} {name}: {kind},");
            let _ = writeln!(copies, "    varyings.{name} = vertex.{name};");
        }
    }
    if let Some((name, value)) = more {
        let _ = writeln!(varyings, "    @location({}) {name}: f32,", all.len());
        let _ = writeln!(copies, "    varyings.{name} = {value};");
    }
    format!(
        "{vertex}}}\n\n{varyings}}}\n\n@vertex\nfn surface_vertex(vertex: Vertex) -> Varyings {{\n    var varyings: \
         Varyings;\n    varyings.clip = clip_position(vertex.position_m);\n{copies}    return varyings;\n}}\n"
    )
}

/// The vertex stage of the depth pass of a surface without an alpha mask.
pub(crate) const DEPTH_VERTEX_WGSL: &str = "@vertex
fn depth_vertex(@location(0) position_m: vec3<f32>) -> @builtin(position) @invariant vec4<f32> {
    return clip_position(position_m);
}
";
