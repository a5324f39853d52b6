//! How a stage's surfaces look: materials, textures and tangents, ready to be drawn.

use super::Stage;
use super::tangents::tangents;
use crate::texture::{Encoding, MipChain};
use glam::{DMat3, DVec3, Mat3, Vec2, Vec3, Vec4};
use std::collections::BTreeMap;
use std::sync::OnceLock;
use sunbake::scene::alpha::image_uvs;
use sunbake::scene::looks::{Look, Looks};
use sunbake::scene::{Alpha, Instance, Material, Mesh, Scene, SceneWarning, TextureRef};
use sunbake::trace::{Direction, Hit, Tracer};

/// How the surfaces of a stage look.
pub(super) struct StageLooks {
    materials: Vec<Look>,
    /// By the index of the image, and by what its codes mean.
    textures: BTreeMap<(usize, Encoding), MipChain>,
    /// For each mesh with a normal map, the tangents of each triangle's corners, object space.
    tangents: Vec<Option<Vec<Vec4>>>,
    /// For each instance, whether lit pictures blend it with what lies behind.
    is_blended: Vec<bool>,
    warnings: Vec<SceneWarning>,
    /// Traces blended surfaces. Built on first use; none where there are none.
    tracer: OnceLock<Option<Tracer>>,
}

impl StageLooks {
    /// The looks of a scene.
    pub fn new(scene: &Scene, looks: Looks) -> Self {
        let is_blended = |instance: &Instance| looks.meshes[instance.mesh].is_blended;
        let is_blended = scene.instances.iter().map(is_blended).collect();
        let mut textures = BTreeMap::new();
        for look in &looks.materials {
            for (texture, encoding) in textures_of(look) {
                let mips = || MipChain::new(&looks.images[texture.image], encoding);
                textures.entry((texture.image, encoding)).or_insert_with(mips);
            }
        }
        let of_mesh = |(mesh, of_file): (&Mesh, Option<Vec<Vec4>>)| {
            let texture = looks.materials[mesh.material].normal_texture?;
            let corners = mesh.indices.iter();
            Some(match of_file {
                Some(all) => corners.map(|&vertex| all[vertex as usize]).collect(),
                None => tangents(mesh, &texture),
            })
        };
        let of_file = looks.meshes.into_iter().map(|mesh| mesh.tangents);
        let tangents = scene.meshes.iter().zip(of_file).map(of_mesh).collect();
        let (materials, warnings) = (looks.materials, looks.warnings);
        Self { materials, textures, tangents, is_blended, warnings, tracer: OnceLock::new() }
    }
}

/// Textures beside the base colour, and what their codes mean.
fn textures_of(look: &Look) -> impl Iterator<Item = (TextureRef, Encoding)> {
    let linear = look.metallic_roughness_texture.into_iter().chain(look.normal_texture);
    let colors = look.emissive_texture.into_iter();
    linear.map(|texture| (texture, Encoding::Linear)).chain(colors.map(|texture| (texture, Encoding::Srgb)))
}

impl Stage {
    /// The same stage with plain looks: every surface is solid and only scatters light, so that lit pictures tell of
    /// shadows alone. Nothing that only looks need is built.
    pub fn without_looks(mut self) -> Self {
        self.looks = StageLooks::new(&self.scene, Looks::plain(&self.scene));
        self
    }

    /// The same stage with these looks.
    pub fn with_looks(mut self, looks: Looks) -> Self {
        self.looks = StageLooks::new(&self.scene, looks);
        self
    }

    /// What could not be read of how surfaces look.
    pub fn look_warnings(&self) -> &[SceneWarning] {
        &self.looks.warnings
    }

    /// How a material looks, by its index in the scene.
    pub fn look(&self, material: usize) -> &Look {
        &self.looks.materials[material]
    }

    /// How a triangle's material looks.
    pub fn look_of(&self, triangle: usize) -> &Look {
        self.look(self.mesh(self.geometry.instance[triangle] as usize).material)
    }

    /// A texture beside the base colours.
    pub fn look_texture(&self, image: usize, encoding: Encoding) -> Option<&MipChain> {
        self.looks.textures.get(&(image, encoding))
    }

    /// Whether lit pictures blend an instance with what lies behind. Pictures of visibility show it as solid.
    pub fn is_blended(&self, instance: usize) -> bool {
        self.looks.is_blended[instance]
    }

    /// Whether any surface is blended with what lies behind.
    pub fn has_blended(&self) -> bool {
        self.looks.is_blended.iter().any(|&is_blended| is_blended)
    }

    /// Image coordinates of a triangle's corners for one of its textures.
    pub fn image_uvs(&self, triangle: usize, texture: &TextureRef) -> [Vec2; 3] {
        let surface = self.geometry.surface(triangle);
        image_uvs(self.mesh(surface.instance), texture, surface.mesh_triangle)
    }

    /// Texels per metre of a triangle: the square root of the ratio of the two areas. `size` is the image's.
    pub fn texels_per_metre_of(&self, triangle: usize, image_uv: [Vec2; 3], size: Vec2) -> f32 {
        let [a, b, c] = image_uv.map(|uv| uv * size);
        let [p, q, r] = self.geometry.triangles[triangle].map(|v| v.as_dvec3());
        let texels = f64::from((b - a).perp_dot(c - a).abs());
        (texels / (q - p).cross(r - p).length().max(f64::MIN_POSITIVE)).sqrt().min(1e12) as f32
    }

    /// Unit tangents of a triangle's corners in bake space, and 1 or -1: the bitangent is the cross product of normal
    /// and tangent, times that. Zero where there is no normal map.
    pub fn tangents(&self, triangle: usize) -> [Vec4; 3] {
        let surface = self.geometry.surface(triangle);
        let instance = &self.scene.instances[surface.instance];
        let Some(all) = &self.looks.tangents[instance.mesh] else { return [Vec4::ZERO; 3] };
        let turn = DMat3::from_mat4(instance.bake_from_object);
        // A mirrored cross product points the other way.
        let sign = if instance.is_mirrored { -1.0 } else { 1.0 };
        // One sign for the triangle, so that it is never blended.
        let side = all[3 * surface.mesh_triangle].w * sign;
        [0, 1, 2].map(|k| {
            let tangent = all[3 * surface.mesh_triangle + k].truncate().as_dvec3();
            (turn * tangent).normalize_or_zero().as_vec3().extend(side)
        })
    }

    /// The nearest solid surface along a primary ray: in lit pictures, what blended surfaces lie in front of.
    pub fn solid_hit(&self, eye_m: DVec3, direction: DVec3) -> Option<Hit> {
        self.hit_where(eye_m, direction, |triangle| !self.is_blended(self.geometry.instance[triangle] as usize))
    }

    /// Blended surfaces along a primary ray, from the nearest, as far as `end_m`.
    pub fn blended_hits(&self, eye_m: DVec3, direction: DVec3, end_m: f64) -> Vec<Hit> {
        let Some(tracer) = self.blended_tracer() else { return Vec::new() };
        let unit = direction.normalize();
        let (mut hits, mut ignored): (Vec<Hit>, Vec<u32>) = (Vec::new(), Vec::new());
        let instance = |hit: &Hit| self.geometry.instance[hit.triangle as usize];
        while let Some(hit) = tracer.closest_hit_where(eye_m, &Direction::new(unit), |triangle| {
            !ignored.contains(&triangle) && self.turns_to_eye(triangle as usize, unit)
        }) {
            // What lies on a solid surface is drawn onto it.
            if hit.distance_m > end_m * (1.0 + 1e-6) {
                break;
            }
            // A ray through an edge meets both of its triangles; a pixel shows one.
            let is_again = |known: &Hit| {
                (hit.distance_m - known.distance_m).abs() <= 1e-9 * known.distance_m
                    && instance(known) == instance(&hit)
            };
            ignored.push(hit.triangle);
            if !hits.last().is_some_and(is_again) {
                hits.push(hit);
            }
        }
        hits
    }

    /// Whether a blended triangle turns a side that is drawn to the eye.
    fn turns_to_eye(&self, triangle: usize, direction: DVec3) -> bool {
        let sides = self.sides(triangle);
        match self.geometry.normal(triangle).dot(direction) < 0.0 {
            true => sides.front,
            false => sides.back,
        }
    }

    /// The ray tracer of blended surfaces. The first call builds it: make it before a parallel loop, as that of
    /// [`Stage::tracer`].
    pub fn blended_tracer(&self) -> Option<&Tracer> {
        let build = || Some(Tracer::of_visible(&self.blended_alone(), &self.geometry));
        self.looks.tracer.get_or_init(|| if self.has_blended() { build() } else { None }).as_ref()
    }

    /// A scene with the same instances, of which only blended surfaces are there.
    fn blended_alone(&self) -> Scene {
        let plain = Material { alpha: Alpha::Opaque, base_color_texture: None, ..self.scene.materials[0].clone() };
        let air = Material { alpha: Alpha::Invisible, ..plain.clone() };
        let mut is_blended = vec![false; self.scene.meshes.len()];
        for (index, instance) in self.scene.instances.iter().enumerate() {
            is_blended[instance.mesh] |= self.is_blended(index);
        }
        let mesh = |(mesh, is_blended): (&Mesh, bool)| Mesh {
            positions: mesh.positions.clone(),
            indices: mesh.indices.clone(),
            material: usize::from(!is_blended),
            ..Mesh::default()
        };
        Scene {
            source: self.scene.source.clone(),
            nodes: Vec::new(),
            meshes: self.scene.meshes.iter().zip(is_blended).map(mesh).collect(),
            instances: self.scene.instances.clone(),
            materials: vec![plain, air],
            images: Vec::new(),
            cameras: Vec::new(),
            warnings: Vec::new(),
            file: None,
            ..self.scene
        }
    }
}

/// What a normal map makes of a unit normal. Twin of `surface/normal_map.wgsl`.
pub fn mapped_normal(normal: Vec3, tangent: Vec4, texel: Vec3, scale: f32) -> Vec3 {
    let along = tangent.truncate() - normal * normal.dot(tangent.truncate());
    if along.length_squared() < 1e-8 {
        return normal;
    }
    let along = along.normalize();
    let frame = Mat3::from_cols(along * scale, normal.cross(along) * (scale * tangent.w.signum()), normal);
    let tilted = frame * (texel * 2.0 - 1.0);
    tilted / tilted.length().max(1e-6)
}
