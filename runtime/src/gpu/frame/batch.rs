//! Vertices in batches: triangles that share a program, a page and a texture lie side by side, and are drawn at once.
//!
//! Vertices are those of [`sunbake::scene::Geometry`], with all transforms applied, so that what is rasterised is bit
//! for bit what is traced.

use crate::shadow_maps::Ground;
use crate::stage::Stage;
use glam::Vec3;
use std::collections::BTreeMap;
use sunbake::scene::{Alpha, Wrap};
use sunbake_shaders::{ColorVertex, PositionVertex, SurfaceVariant, SurfaceVertex, TextureVertex};

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
    /// The atlas page.
    pub page: u32,
    /// Image and wrap modes, if textured.
    pub texture: Option<TextureKey>,
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
pub fn batches(stage: &Stage, ground: Option<&Ground>) -> (Vec<Batch>, Vertices) {
    let mut vertices = Vertices::default();
    let batches = by_key(stage, ground).into_iter().map(|(key, triangles)| {
        let batch = Batch {
            key,
            vertex_count: 3 * triangles.len() as u32,
            first: vertices.positions.len() as u64,
            first_texture: vertices.textures.len() as u64,
            first_color: vertices.colors.len() as u64,
        };
        triangles.into_iter().for_each(|triangle| push_triangle(stage, triangle, &key, &mut vertices));
        batch
    });
    (batches.collect(), vertices)
}

/// The triangles of each batch.
pub fn by_key(stage: &Stage, ground: Option<&Ground>) -> BTreeMap<BatchKey, Vec<usize>> {
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
            let (is_two_sided, is_passed) = (sides.front && sides.back, ground.is_some() && !casts);
            let key = BatchKey { is_two_sided, is_ground, is_hidden, is_passed, ..key };
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
        },
        is_two_sided: false,
        is_ground: false,
        is_hidden: false,
        is_passed: false,
        is_open: !stage.scene.receives(instance),
        page: stage.chart(instance).map_or(0, |chart| chart.page),
        texture,
    }
}

fn push_triangle(stage: &Stage, triangle: usize, key: &BatchKey, vertices: &mut Vertices) {
    let instance = stage.geometry.instance[triangle] as usize;
    let corners = stage.corners(triangle);
    let front_normal = stage.geometry.normal(triangle).as_vec3().to_array();
    // Corners in the order that is counter-clockwise from the drawn side. A mirrored instance reverses it.
    let is_turned = stage.scene.instances[instance].is_mirrored == stage.sides(triangle).front;
    let order = if is_turned { [0, 2, 1] } else { [0, 1, 2] };
    let texels_per_metre = stage.texels_per_metre(triangle, corners.image_uv);
    for k in order {
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

fn snorm(normal: Vec3) -> [i16; 4] {
    let code = |x: f32| (x.clamp(-1.0, 1.0) * 32_767.0).round() as i16;
    [code(normal.x), code(normal.y), code(normal.z), 0]
}
