//! Vertices in batches: triangles that share a program, a page and a texture lie side by side, and are drawn at once.
//!
//! Vertices are those of [`sunbake::scene::Geometry`], with all transforms applied, so that what is rasterised is bit
//! for bit what is traced.

use crate::shadow_maps::{Ground, free_edge_lifts_m};
use crate::stage::Stage;
use glam::Vec3;
use std::collections::BTreeMap;
use sunbake::scene::{Alpha, Wrap};
use sunbake_shaders::{ColorVertex, LiftVertex, PositionVertex, SurfaceVariant, SurfaceVertex, TextureVertex};

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
    /// The atlas page.
    pub page: u32,
    /// Image and wrap modes, if textured.
    pub texture: Option<TextureKey>,
}

/// What a technique wants of batches.
#[derive(Debug, Clone, Copy, Default)]
pub struct BatchRequest<'a> {
    /// The ground, for batches of its own, and beside it what casts and is not drawn.
    pub ground: Option<&'a Ground>,
    /// Whether facets of something smooth say how far that is above them.
    pub wants_lift: bool,
}

/// A texture with its sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextureKey {
    /// Index of the image.
    pub image: usize,
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
    /// First vertex in the texture stream, if textured.
    pub first_texture: u64,
    /// First vertex in the colour stream, if there are vertex colours.
    pub first_color: u64,
    /// First vertex in the lift stream, if there are lifts.
    pub first_lift: u64,
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
    /// Of facets of something smooth, if wanted.
    pub lifts: Vec<LiftVertex>,
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
            first_texture: vertices.textures.len() as u64,
            first_color: vertices.colors.len() as u64,
            first_lift: vertices.lifts.len() as u64,
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
    let BatchRequest { ground, wants_lift } = request;
    let mut triangles: BTreeMap<BatchKey, Vec<usize>> = BTreeMap::new();
    for instance in 0..stage.scene.instances.len() {
        let key = key(stage, instance);
        for triangle in stage.geometry.first_triangle[instance]..stage.geometry.first_triangle[instance + 1] {
            let triangle = triangle as usize;
            let sides = stage.sides(triangle);
            let is_hidden = sides.is_none();
            if is_hidden && !(ground.is_some() && stage.geometry.is_solid(&stage.scene, triangle)) {
                continue;
            }
            let is_ground = ground.is_some_and(|ground| ground.holds(triangle));
            let is_smooth = !is_hidden && stage.geometry.is_smooth(triangle);
            let surface = SurfaceVariant { is_smooth, has_lift: is_smooth && wants_lift, ..key.surface };
            let key = BatchKey { surface, is_two_sided: sides.front && sides.back, is_ground, is_hidden, ..key };
            triangles.entry(key).or_default().push(triangle);
        }
    }
    triangles
}

fn key(stage: &Stage, instance: usize) -> BatchKey {
    let material = stage.scene.material(instance);
    let texture = material.base_color_texture.map(|t| TextureKey { image: t.image, wrap: t.wrap.map(wrap_code) });
    BatchKey {
        surface: SurfaceVariant {
            is_textured: texture.is_some(),
            has_vertex_color: stage.mesh(instance).colors.is_some(),
            has_alpha_mask: matches!(material.alpha, Alpha::Mask { .. }),
            ..SurfaceVariant::default()
        },
        is_two_sided: false,
        is_ground: false,
        is_hidden: false,
        page: stage.chart(instance).map_or(0, |chart| chart.page),
        texture,
    }
}

fn push_triangle(stage: &Stage, triangle: usize, key: &BatchKey, vertices: &mut Vertices) {
    let instance = stage.geometry.instance[triangle] as usize;
    let corners = stage.corners(triangle);
    let front_normal = stage.geometry.normal(triangle).as_vec3().to_array();
    let texels_per_metre = stage.texels_per_metre(triangle, corners.image_uv);
    for k in corner_order(stage, triangle) {
        let position_m = stage.geometry.triangles[triangle][k].to_array();
        vertices.positions.push(PositionVertex { position_m });
        vertices.surfaces.push(SurfaceVertex {
            front_normal,
            shading_normal: snorm(corners.normal[k]),
            page_uv: corners.page_uv[k].to_array(),
            material: stage.mesh(instance).material as u32,
        });
        if key.surface.is_textured {
            vertices.textures.push(TextureVertex { image_uv: corners.image_uv[k].to_array(), texels_per_metre });
        }
        if key.surface.has_vertex_color {
            let color = corners.color[k].to_array().map(|x| (x.clamp(0.0, 1.0) * 65_535.0).round() as u16);
            vertices.colors.push(ColorVertex { color });
        }
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

fn snorm(normal: Vec3) -> [i16; 4] {
    let code = |x: f32| (x.clamp(-1.0, 1.0) * 32_767.0).round() as i16;
    [code(normal.x), code(normal.y), code(normal.z), 0]
}
