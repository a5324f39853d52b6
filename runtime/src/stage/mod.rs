//! A stage: a scene with the maps that were baked for it, ready to be drawn. Every technique draws a stage.

mod looks;
mod read;
mod subsets;
mod tangents;

pub use looks::mapped_normal;
pub use read::{MAX_SCENE_BYTES, StageError};

use crate::drawn_sides::{DrawnSides, drawn_sides};
use crate::light::{LampMoment, Moment};
use crate::shade::towards_eye;
use crate::texture::{Encoding, MipChain};
use glam::{Vec2, Vec3, Vec4};
use looks::StageLooks;
use std::sync::OnceLock;
use sunbake::lamp::LampPath;
use sunbake::maps::{Bits, PageMaps};
use sunbake::scene::alpha::{blend, image_uvs};
use sunbake::scene::looks::Looks;
use sunbake::scene::{Geometry, LoadLimits, Material, Mesh, Scene, ShadingNormals};
use sunbake::sun::SunPath;
use sunbake::trace::{Direction, Hit, Tracer};

/// A scene, its maps, and what drawing needs beside them.
pub struct Stage {
    /// The glTF scene, with the instances and materials that the maps are of.
    pub scene: Scene,
    /// Its triangles in bake space.
    pub geometry: Geometry,
    /// Bits of stored times.
    pub bits: Bits,
    /// The maps, page by page.
    pub pages: Vec<PageMaps>,
    /// The sun's path. None where the sun does not rise.
    pub path: Option<SunPath>,
    /// The path of the lamp, bake space, if there is one.
    pub lamp: Option<LampPath>,
    /// For each instance, where its texels lie. None where it has none; it is not drawn then.
    charts: Vec<Option<Chart>>,
    /// Turns each instance's shading normals from object space into bake space.
    normals: ShadingNormals,
    /// For each triangle, the sides that are drawn.
    sides: Vec<DrawnSides>,
    /// For each image, its mip chain, if it is the base colour of some material.
    mips: Vec<Option<MipChain>>,
    /// How surfaces look, beyond their base colours.
    looks: StageLooks,
    /// Built on first use: drawing on the GPU needs none.
    tracer: OnceLock<Tracer>,
    /// What the eye sees, where that is more than what casts.
    eye_tracer: OnceLock<Option<Tracer>>,
}

/// Where an instance's texels lie: `page_uv = texcoords[uv_set] * scale + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart {
    /// Index in [`Stage::pages`].
    pub page: u32,
    /// Which of [`Mesh::texcoords`].
    pub uv_set: usize,
    /// Page coordinates per texture coordinate.
    pub scale: Vec2,
    /// Page coordinates of the texture coordinate (0, 0).
    pub offset: Vec2,
}

/// Attributes of a triangle's three corners.
#[derive(Debug, Clone, Copy)]
pub struct CornerAttributes {
    /// Page coordinates of the maps.
    pub page_uv: [Vec2; 3],
    /// Coordinates of the base colour texture; zero where there is none.
    pub image_uv: [Vec2; 3],
    /// Unit shading normals, bake space.
    pub normal: [Vec3; 3],
    /// Vertex colours; white where there are none.
    pub color: [Vec4; 3],
}

impl Stage {
    fn with_charts(
        mut scene: Scene,
        charts: Vec<Option<Chart>>,
        pages: Vec<PageMaps>,
        bits: Bits,
        path: Option<SunPath>,
    ) -> Self {
        let looks = Looks::read(&scene, &LoadLimits { max_memory_bytes: MAX_SCENE_BYTES });
        let looks = StageLooks::new(&scene, looks);
        // Drawing needs what was read, and not the file's bytes.
        scene.file = None;
        let normals = ShadingNormals::new(&scene);
        let geometry = Geometry::new(&scene);
        let is_drawn = |instance: usize| charts[instance].is_some() && scene.is_there(instance);
        let sides = drawn_sides(&scene, &geometry, is_drawn);
        let mips = mips(&scene);
        let (tracer, eye_tracer) = (OnceLock::new(), OnceLock::new());
        Self { scene, geometry, bits, pages, path, lamp: None, charts, normals, sides, mips, looks, tracer, eye_tracer }
    }

    /// The lamp at path time `t`, if there is one.
    pub fn lamp_moment(&self, t: f64) -> Option<LampMoment> {
        self.lamp.as_ref().map(|path| LampMoment::new(path, t, self.scene.half_extent_m))
    }

    /// The light at path time `t`, of the sun and of the lamp.
    pub fn moment(&self, t: f64) -> Moment {
        Moment::new(self.path.as_ref(), t).with_lamp(self.lamp_moment(t))
    }

    /// The ray tracer of what casts. The first call builds it, on all threads. Make that call before a parallel loop
    /// that uses it: a thread that waits for the build may take up another task of the loop, which waits for the same
    /// build.
    pub fn tracer(&self) -> &Tracer {
        self.tracer.get_or_init(|| Tracer::new(&self.scene, &self.geometry))
    }

    /// The ray tracer of what the eye sees: the same, unless light passes something. As [`Stage::tracer`], it is built
    /// by the first call.
    pub fn eye_tracer(&self) -> &Tracer {
        let is_passed = |instance: usize| self.scene.is_there(instance) && !self.scene.casts(instance);
        let own = self.eye_tracer.get_or_init(|| {
            let differs = (0..self.scene.instances.len()).any(is_passed);
            differs.then(|| Tracer::of_visible(&self.scene, &self.geometry))
        });
        own.as_ref().unwrap_or_else(|| self.tracer())
    }

    /// Where an instance's texels lie.
    pub fn chart(&self, instance: usize) -> Option<&Chart> {
        self.charts[instance].as_ref()
    }

    /// The mip chain of an image that is some material's base colour.
    pub fn mips(&self, image: usize) -> Option<&MipChain> {
        self.mips[image].as_ref()
    }

    /// The mesh of an instance.
    pub fn mesh(&self, instance: usize) -> &Mesh {
        &self.scene.meshes[self.scene.instances[instance].mesh]
    }

    /// The drawn sides of a triangle: neither if it has no texels, or shares its place with triangles that are drawn
    /// instead.
    pub fn sides(&self, triangle: usize) -> DrawnSides {
        self.sides[triangle]
    }

    /// Attributes of a triangle's corners.
    pub fn corners(&self, triangle: usize) -> CornerAttributes {
        let surface = self.geometry.surface(triangle);
        let mesh = self.mesh(surface.instance);
        let material = self.scene.material(surface.instance);
        let vertices = [0, 1, 2].map(|k| mesh.indices[3 * surface.mesh_triangle + k] as usize);
        let front = self.geometry.normal(triangle).as_vec3();
        CornerAttributes {
            page_uv: self.page_uvs(surface.instance, mesh, vertices),
            image_uv: match &material.base_color_texture {
                Some(texture) => image_uvs(mesh, texture, surface.mesh_triangle),
                None => [Vec2::ZERO; 3],
            },
            normal: match &mesh.normals {
                Some(normals) => vertices.map(|v| self.shading_normal(surface.instance, normals[v], front)),
                None => [front; 3],
            },
            color: mesh.colors.as_ref().map_or([Vec4::ONE; 3], |colors| vertices.map(|v| colors[v])),
        }
    }

    fn page_uvs(&self, instance: usize, mesh: &Mesh, vertices: [usize; 3]) -> [Vec2; 3] {
        match (&self.charts[instance], self.charts[instance].and_then(|c| mesh.texcoord_set(c.uv_set))) {
            (Some(chart), Some(uvs)) => vertices.map(|v| uvs[v] * chart.scale + chart.offset),
            _ => [Vec2::ZERO; 3],
        }
    }

    fn shading_normal(&self, instance: usize, object: Vec3, front: Vec3) -> Vec3 {
        let normal = self.normals.turned(instance, object);
        if normal == glam::DVec3::ZERO { front } else { normal.as_vec3() }
    }

    /// The normal that decides whether a point of a triangle faces the light, on the side that a ray comes from: the
    /// shading normal where it is smooth, else the face's.
    pub fn gate_normal(&self, triangle: usize, barycentric: [f64; 2], ray: Vec3) -> Vec3 {
        let front = self.geometry.normal(triangle).as_vec3();
        let gate = match self.geometry.is_smooth(triangle) {
            true => blend(self.corners(triangle).normal, barycentric.map(|b| b as f32)).normalize_or(front),
            false => front,
        };
        towards_eye(gate, front, ray)
    }

    /// Texels of the base colour texture per metre of a triangle. 0 without texture.
    pub fn texels_per_metre(&self, triangle: usize, image_uv: [Vec2; 3]) -> f32 {
        let instance = self.geometry.instance[triangle] as usize;
        let Some(texture) = self.scene.material(instance).base_color_texture else { return 0.0 };
        let image = &self.scene.images[texture.image];
        self.texels_per_metre_of(triangle, image_uv, Vec2::new(image.width as f32, image.height as f32))
    }

    /// The first hit of a primary ray: the nearest surface that is drawn and turns a drawn side to the eye. Blended
    /// surfaces are solid here, but where they are part of an alpha mask.
    pub fn primary_hit(&self, eye_m: glam::DVec3, direction: glam::DVec3) -> Option<Hit> {
        self.hit_where(eye_m, direction, |_| true)
    }

    /// The same among some of the triangles.
    fn hit_where(&self, eye_m: glam::DVec3, direction: glam::DVec3, is_wanted: impl Fn(usize) -> bool) -> Option<Hit> {
        let direction = direction.normalize();
        self.eye_tracer().closest_hit_where(eye_m, &Direction::new(direction), |triangle| {
            let sides = self.sides[triangle as usize];
            let is_shown = match sides.front == sides.back {
                true => sides.front,
                false => (self.geometry.normal(triangle as usize).dot(direction) < 0.0) == sides.front,
            };
            is_shown && is_wanted(triangle as usize)
        })
    }

    /// Bytes of its maps, as a GPU holds them.
    pub fn gpu_bytes(&self) -> u64 {
        self.pages.iter().map(|page| page.gpu_bytes(self.bits)).sum()
    }

    /// The material of a triangle.
    pub fn material(&self, triangle: usize) -> &Material {
        self.scene.material(self.geometry.instance[triangle] as usize)
    }

    /// Page coordinates of a hit, and its page.
    pub fn page_uv(&self, hit: &Hit) -> Option<(u32, Vec2)> {
        let triangle = hit.triangle as usize;
        let chart = self.chart(self.geometry.instance[triangle] as usize)?;
        Some((chart.page, blend(self.corners(triangle).page_uv, hit.barycentric.map(|b| b as f32))))
    }
}

fn mips(scene: &Scene) -> Vec<Option<MipChain>> {
    let mut mips: Vec<Option<MipChain>> = scene.images.iter().map(|_| None).collect();
    for instance in 0..scene.instances.len() {
        if let Some(texture) = scene.material(instance).base_color_texture {
            let image = &scene.images[texture.image];
            mips[texture.image].get_or_insert_with(|| MipChain::new(image, Encoding::Srgb));
        }
    }
    mips
}
