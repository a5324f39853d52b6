//! Vertices in batches: triangles that share a program, a page and a texture lie side by side, and are drawn at once.
//!
//! Vertices are those of [`sunbake::scene::Geometry`], with all transforms applied, so that what is rasterised is bit
//! for bit what is traced.

use super::Output;
use crate::shadow_maps::{Ground, free_edge_lifts_m};
use crate::stage::Stage;
use crate::texture::Encoding;
use glam::{Vec2, Vec4};
use std::collections::BTreeMap;
use sunbake::scene::{Alpha, TextureRef, Wrap};
use sunbake_shaders::{
    ColorVertex, LiftVertex, LookVariant, NormalVertex, PositionVertex, Stream, SurfaceVariant, SurfaceVertex,
    TextureVertex,
};

/// What the triangles of one draw share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct BatchKey {
    /// What the surface needs of its program.
    pub surface: SurfaceVariant,
    /// Whether both sides are drawn; else only counter-clockwise faces.
    pub is_two_sided: bool,
    /// Whether it lies on the ground; false unless a ground was given.
    pub is_ground: bool,
    /// Whether it only casts, and is not drawn.
    pub is_hidden: bool,
    /// Whether light passes it, so that it does not cast; false unless a ground was given.
    pub is_passed: bool,
    /// Whether nothing shades it.
    pub is_open: bool,
    /// Whether lit pictures blend it with what lies behind.
    pub is_blended: bool,
    /// The atlas page.
    pub page: u32,
    /// Its textures, as far as a program reads them.
    pub textures: TextureSet,
}

/// The textures of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct TextureSet {
    /// Base colour.
    pub base: Option<TextureKey>,
    /// Metal and roughness.
    pub metallic_roughness: Option<TextureKey>,
    /// Normal map.
    pub normal: Option<TextureKey>,
    /// Emission.
    pub emissive: Option<TextureKey>,
}

impl TextureSet {
    /// The textures in the order of their bindings.
    pub fn in_order(&self) -> [Option<TextureKey>; 4] {
        [self.base, self.metallic_roughness, self.normal, self.emissive]
    }

    /// Bindings: each texture and its sampler.
    pub fn binding_count(&self) -> usize {
        2 * self.in_order().iter().flatten().count()
    }

    /// Which textures there are.
    pub fn kinds(&self) -> [bool; 4] {
        self.in_order().map(|key| key.is_some())
    }

    /// The base colour alone.
    pub fn base_alone(&self) -> Self {
        Self { base: self.base, ..Self::default() }
    }
}

impl BatchKey {
    /// The batch as programs of an output know it. Depths and visibility are found without looks; a lit picture blends
    /// surfaces instead of testing their alpha.
    pub fn for_output(&self, output: Output) -> Self {
        let is_blended = self.is_blended;
        match output {
            Output::Lit => Self {
                surface: SurfaceVariant {
                    has_alpha_mask: self.surface.has_alpha_mask && !is_blended,
                    look: LookVariant { is_blended, ..self.surface.look },
                    ..self.surface
                },
                ..*self
            },
            Output::Visibility | Output::LampVisibility => self.without_look(),
        }
    }

    /// The batch without what only lit pictures show.
    pub fn without_look(&self) -> Self {
        let (surface, textures) = (self.surface.without_look(), self.textures.base_alone());
        Self { surface, textures, is_blended: false, ..*self }
    }

    /// Whether pictures of an output show it as solid.
    pub fn is_solid_in(&self, output: Output) -> bool {
        !self.is_blended || output != Output::Lit
    }
}

/// What a technique wants of batches.
#[derive(Debug, Clone, Copy, Default)]
pub struct BatchRequest<'a> {
    /// The ground, for batches of its own, and beside it what casts and is not drawn.
    pub ground: Option<&'a Ground>,
    /// Whether facets of something smooth say how far that is above them.
    pub wants_lift: bool,
    /// Whether shadow tracks are read, where pages have them, instead of the sun's times.
    pub wants_tracks: bool,
}

/// A texture with its sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextureKey {
    /// Index of the image: among the scene's for base colours, else among those of looks.
    pub image: usize,
    /// What its codes mean.
    pub encoding: Encoding,
    /// Whether it is a base colour.
    pub is_base: bool,
    /// Wrap modes as in [`sunbake_shaders::MaterialUniform`].
    pub wrap: [u32; 2],
}

/// One draw, as ranges of the streams.
#[derive(Debug, Clone)]
pub struct Batch {
    /// What its triangles share.
    pub key: BatchKey,
    /// Number of vertices.
    pub vertex_count: u32,
    /// First vertex in the position and surface streams.
    pub first: u64,
    /// First vertex in each of the other streams, if it has vertices there.
    first_of: BTreeMap<Stream, u64>,
}

impl Batch {
    /// Its first vertex in a stream that it has.
    pub fn first_in(&self, stream: Stream) -> u64 {
        self.first_of.get(&stream).copied().unwrap_or(self.first)
    }
}

/// All vertices.
#[derive(Debug, Default)]
pub struct Vertices {
    /// Of every triangle.
    pub positions: Vec<PositionVertex>,
    /// Of every triangle.
    pub surfaces: Vec<SurfaceVertex>,
    /// Of textured triangles.
    pub textures: Vec<TextureVertex>,
    /// Of triangles with vertex colours.
    pub colors: Vec<ColorVertex>,
    /// Of triangles with a metallic-roughness texture.
    pub metallic_roughness: Vec<TextureVertex>,
    /// Of triangles with a normal map.
    pub normals: Vec<NormalVertex>,
    /// Of triangles with an emissive texture.
    pub emissive: Vec<TextureVertex>,
    /// Of facets of something smooth, if wanted.
    pub lifts: Vec<LiftVertex>,
}

impl Vertices {
    /// Lengths of the streams that not every triangle has.
    fn lengths(&self) -> BTreeMap<Stream, u64> {
        BTreeMap::from([
            (Stream::Texture, self.textures.len() as u64),
            (Stream::Color, self.colors.len() as u64),
            (Stream::MetallicRoughness, self.metallic_roughness.len() as u64),
            (Stream::Normal, self.normals.len() as u64),
            (Stream::Emissive, self.emissive.len() as u64),
            (Stream::Lift, self.lifts.len() as u64),
        ])
    }
}

/// A wrap mode as shaders know it.
pub fn wrap_code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => sunbake_shaders::WRAP_REPEAT,
        Wrap::Mirror => sunbake_shaders::WRAP_MIRROR,
        Wrap::Clamp => sunbake_shaders::WRAP_CLAMP,
    }
}

/// Sorts triangles into batches and lays out the streams. With a ground, the ground gets batches of its own, and so
/// does what casts and is not drawn.
pub fn batches(stage: &Stage, request: BatchRequest) -> (Vec<Batch>, Vertices) {
    let mut vertices = Vertices::default();
    let batches = by_key(stage, request).into_iter().map(|(key, triangles)| {
        let batch = Batch {
            key,
            vertex_count: 3 * triangles.len() as u32,
            first: vertices.positions.len() as u64,
            first_of: vertices.lengths(),
        };
        if key.surface.has_lift {
            push_lifts(stage, &triangles, &mut vertices);
        }
        triangles.into_iter().for_each(|triangle| push_triangle(stage, triangle, &key, &mut vertices));
        batch
    });
    (batches.collect(), vertices)
}

/// The triangles of each batch.
pub fn by_key(stage: &Stage, request: BatchRequest) -> BTreeMap<BatchKey, Vec<usize>> {
    let BatchRequest { ground, wants_lift, .. } = request;
    let mut triangles: BTreeMap<BatchKey, Vec<usize>> = BTreeMap::new();
    for instance in 0..stage.scene.instances.len() {
        let key = key(stage, instance);
        for triangle in stage.geometry.first_triangle[instance]..stage.geometry.first_triangle[instance + 1] {
            let triangle = triangle as usize;
            let sides = stage.sides(triangle);
            let is_hidden = sides.is_none();
            let casts = stage.geometry.casts(&stage.scene, triangle);
            if is_hidden && !(ground.is_some() && casts) {
                continue;
            }
            let is_ground = ground.is_some_and(|ground| ground.holds(triangle));
            let key = if is_hidden { key.without_look() } else { key };
            let (is_two_sided, is_passed) = (sides.front && sides.back, ground.is_some() && !casts);
            let is_smooth = !is_hidden && stage.geometry.is_smooth(triangle);
            let surface = SurfaceVariant { is_smooth, has_lift: is_smooth && wants_lift, ..key.surface };
            let key = BatchKey { surface, is_two_sided, is_ground, is_hidden, is_passed, ..key };
            triangles.entry(key).or_default().push(triangle);
        }
    }
    triangles
}

fn key(stage: &Stage, instance: usize) -> BatchKey {
    let (material, look) = (stage.scene.material(instance), stage.look(stage.mesh(instance).material));
    let named = |texture: Option<TextureRef>, encoding, is_base| {
        texture.map(|t| TextureKey { image: t.image, encoding, is_base, wrap: t.wrap.map(wrap_code) })
    };
    let textures = TextureSet {
        base: named(material.base_color_texture, Encoding::Srgb, true),
        metallic_roughness: named(look.metallic_roughness_texture, Encoding::Linear, false),
        normal: named(look.normal_texture, Encoding::Linear, false),
        emissive: named(look.emissive_texture, Encoding::Srgb, false),
    };
    BatchKey {
        surface: SurfaceVariant {
            is_textured: textures.base.is_some(),
            has_vertex_color: stage.mesh(instance).colors.is_some(),
            has_alpha_mask: matches!(material.alpha, Alpha::Mask { .. }),
            look: LookVariant {
                is_specular: !look.is_diffuse(),
                has_metallic_roughness_map: textures.metallic_roughness.is_some(),
                has_normal_map: textures.normal.is_some(),
                has_emissive_map: textures.emissive.is_some(),
                is_blended: false,
            },
            ..SurfaceVariant::default()
        },
        is_two_sided: false,
        is_ground: false,
        is_hidden: false,
        is_passed: false,
        is_open: !stage.scene.receives(instance),
        is_blended: stage.is_blended(instance),
        page: stage.chart(instance).map_or(0, |chart| chart.page),
        textures,
    }
}

fn push_triangle(stage: &Stage, triangle: usize, key: &BatchKey, vertices: &mut Vertices) {
    let instance = stage.geometry.instance[triangle] as usize;
    let corners = stage.corners(triangle);
    let front_normal = stage.geometry.normal(triangle).as_vec3().to_array();
    let order = corner_order(stage, triangle);
    for k in order {
        let position_m = stage.geometry.triangles[triangle][k].to_array();
        vertices.positions.push(PositionVertex { position_m });
        vertices.surfaces.push(SurfaceVertex {
            front_normal,
            shading_normal: snorm(corners.normal[k].extend(0.0)),
            page_uv: corners.page_uv[k].to_array(),
            material: stage.mesh(instance).material as u32,
        });
        if key.surface.has_vertex_color {
            let color = corners.color[k].to_array().map(|x| (x.clamp(0.0, 1.0) * 65_535.0).round() as u16);
            vertices.colors.push(ColorVertex { color });
        }
    }
    if key.surface.is_textured {
        let texels_per_metre = stage.texels_per_metre(triangle, corners.image_uv);
        vertices.textures.extend(texture_vertices(corners.image_uv, texels_per_metre, order));
    }
    if key.surface.look != LookVariant::default() {
        push_look(stage, triangle, order, vertices);
    }
}

/// Corners in the order that is counter-clockwise from the drawn side. A mirrored instance reverses it.
fn corner_order(stage: &Stage, triangle: usize) -> [usize; 3] {
    let instance = stage.geometry.instance[triangle] as usize;
    let is_turned = stage.scene.instances[instance].is_mirrored == stage.sides(triangle).front;
    if is_turned { [0, 2, 1] } else { [0, 1, 2] }
}

fn push_lifts(stage: &Stage, triangles: &[usize], vertices: &mut Vertices) {
    for (&triangle, lifts_m) in triangles.iter().zip(free_edge_lifts_m(stage, triangles)) {
        let [first_lift_m, second_lift_m, third_lift_m] = lifts_m.map(|lift_m| lift_m.to_array());
        let vertex = |k: usize| LiftVertex {
            first_lift_m,
            second_lift_m,
            third_lift_m,
            lift_weights: [1, 2].map(|corner| f32::from(u8::from(k == corner))),
        };
        vertices.lifts.extend(corner_order(stage, triangle).map(vertex));
    }
}

/// What only lit pictures read.
fn push_look(stage: &Stage, triangle: usize, order: [usize; 3], vertices: &mut Vertices) {
    let look = stage.look_of(triangle);
    let of_texture = |texture: Option<TextureRef>, encoding| {
        let texture = texture?;
        let first = stage.look_texture(texture.image, encoding)?.levels.first()?;
        let image_uv = stage.image_uvs(triangle, &texture);
        let size = Vec2::new(first.width as f32, first.height as f32);
        Some(texture_vertices(image_uv, stage.texels_per_metre_of(triangle, image_uv, size), order))
    };
    let metal = of_texture(look.metallic_roughness_texture, Encoding::Linear);
    vertices.metallic_roughness.extend(metal.into_iter().flatten());
    let emissive = of_texture(look.emissive_texture, Encoding::Srgb);
    vertices.emissive.extend(emissive.into_iter().flatten());
    if let Some(all) = of_texture(look.normal_texture, Encoding::Linear) {
        let tangents = stage.tangents(triangle);
        let vertex = |(texture, k): (TextureVertex, usize)| NormalVertex { texture, tangent: snorm(tangents[k]) };
        vertices.normals.extend(all.into_iter().zip(order).map(vertex));
    }
}

fn texture_vertices(image_uv: [Vec2; 3], texels_per_metre: f32, order: [usize; 3]) -> [TextureVertex; 3] {
    order.map(|k| TextureVertex { image_uv: image_uv[k].to_array(), texels_per_metre })
}

fn snorm(numbers: Vec4) -> [i16; 4] {
    numbers.to_array().map(|x| (x.clamp(-1.0, 1.0) * 32_767.0).round() as i16)
}
