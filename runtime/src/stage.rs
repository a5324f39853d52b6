//! A baked set and its scene, joined: what every technique draws.

use crate::light::{LampMoment, Moment};
use crate::playback::page_variant;
use crate::sides::{Sides, sides};
use crate::texture::MipChain;
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use std::path::Path;
use std::sync::OnceLock;
use sunbake::disk::manifest::InstanceEntry;
use sunbake::lamp::LampPath;
use sunbake::maps::{Bits, Lane, PageMaps};
use sunbake::scene::alpha::{blend, image_uvs};
use sunbake::scene::{Alpha, Geometry, LoadError, LoadLimits, Material, Mesh, Scene, ShadingNormals};
use sunbake::sun::SunPath;
use sunbake::trace::{Direction, Hit, Tracer};
use sunbake_shaders::AmbientModel;

/// Memory that a scene may take.
pub const MAX_SCENE_BYTES: u64 = 16 << 30;

/// What is drawn, and the maps that light it.
pub struct Stage {
    /// The scene.
    pub scene: Scene,
    /// Its triangles in bake space.
    pub geometry: Geometry,
    /// Depth of stored times.
    pub bits: Bits,
    /// The maps, page by page.
    pub pages: Vec<PageMaps>,
    /// The sun's path; none where it does not rise.
    pub path: Option<SunPath>,
    /// The path of the lamp, bake space, if there is one.
    pub lamp: Option<LampPath>,
    /// For each instance, where its texels lie; none where it has none (and is not drawn).
    charts: Vec<Option<Chart>>,
    /// For each instance, unit shading normals in bake space from those in object space.
    normals: ShadingNormals,
    /// For each triangle, the sides that are drawn.
    sides: Vec<Sides>,
    /// For each image, its levels of detail, if a material draws it as a base colour.
    mips: Vec<Option<MipChain>>,
    /// Built when first asked for: drawing on the GPU needs none.
    tracer: OnceLock<Tracer>,
}

/// Where an instance's texels lie: `page_uv = texcoords[uv_set] * scale + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart {
    /// Index in [`Stage::pages`].
    pub page: u32,
    /// 0 or 1: which of [`Mesh::texcoords`].
    pub uv_set: usize,
    /// In page coordinates.
    pub scale: Vec2,
    /// In page coordinates.
    pub offset: Vec2,
}

/// What the three corners of a triangle carry.
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

/// Why a set cannot be staged.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// The folder is no baked set.
    #[error(transparent)]
    Set(#[from] sunbake::disk::read::ReadError),
    /// The set's scene cannot be read.
    #[error("the set's scene cannot be read: {0}")]
    Scene(#[from] LoadError),
    /// The set's scene is gone.
    #[error("{file} is missing from the set (its SHA-256 was {}): put it back, or bake the scene again", sha256.as_deref().unwrap_or("not kept"))]
    NoScene {
        /// Where it was.
        file: String,
        /// What it was known by, if the set keeps that.
        sha256: Option<String>,
    },
    /// The set's scene is another than was baked.
    #[error(
        "{file} is not the scene that the set was baked with: its SHA-256 is {found}, and was {baked}; bake it again"
    )]
    Changed {
        /// Which file.
        file: String,
        /// What it is known by now.
        found: String,
        /// What it was known by.
        baked: String,
    },
    /// The manifest and the scene do not agree.
    #[error("the set's scene and its manifest disagree: {reason}; bake the scene again")]
    Mismatch {
        /// About what.
        reason: String,
    },
}

impl Stage {
    /// Reads a baked set and its scene.
    pub fn read(folder: &Path) -> Result<Self, StageError> {
        let set = sunbake::disk::read::read(folder)?;
        let (file, baked) = (set.scene_file(), set.manifest.scene.sha256);
        if !file.is_file() {
            return Err(StageError::NoScene { file: file.display().to_string(), sha256: baked });
        }
        let scene = sunbake::scene::load(&file, &LoadLimits { max_memory_bytes: MAX_SCENE_BYTES })?;
        if let Some(baked) = baked.filter(|baked| *baked != scene.source.sha256) {
            let (file, found) = (file.display().to_string(), scene.source.sha256);
            return Err(StageError::Changed { file, found, baked });
        }
        let stage = Self::new(scene, &set.manifest.instances, set.pages, set.bits, set.path)?;
        Ok(stage.with_lamp(set.lamp.as_ref()))
    }

    /// A scene for which nothing was baked: it is drawn and traced, and its maps are empty.
    pub fn plain(scene: Scene, path: Option<SunPath>) -> Self {
        let chart = Chart { page: 0, uv_set: 0, scale: Vec2::ZERO, offset: Vec2::ZERO };
        let charts = vec![Some(chart); scene.instances.len()];
        let page = PageMaps { width: 1, height: 1, lanes: Vec::new(), lamp: None, ambient: None };
        Self::with_charts(scene, charts, vec![page], Bits::Eight, path)
    }

    /// Joins a scene with what was baked for it.
    pub fn new(
        scene: Scene,
        instances: &[InstanceEntry],
        pages: Vec<PageMaps>,
        bits: Bits,
        path: Option<SunPath>,
    ) -> Result<Self, StageError> {
        let charts = charts(&scene, instances, pages.len())?;
        Ok(Self::with_charts(scene, charts, pages, bits, path))
    }

    fn with_charts(
        scene: Scene,
        charts: Vec<Option<Chart>>,
        pages: Vec<PageMaps>,
        bits: Bits,
        path: Option<SunPath>,
    ) -> Self {
        let normals = ShadingNormals::new(&scene);
        let geometry = Geometry::new(&scene);
        let is_drawn =
            |instance: usize| charts[instance].is_some() && scene.material(instance).alpha != Alpha::Invisible;
        let sides = sides(&scene, &geometry, is_drawn);
        let mips = mips(&scene);
        let tracer = OnceLock::new();
        Self { scene, geometry, bits, pages, path, lamp: None, charts, normals, sides, mips, tracer }
    }

    /// The same stage with the lamp whose times are in the pages; its path in world space.
    pub fn with_lamp(self, lamp: Option<&LampPath>) -> Self {
        Self { lamp: lamp.map(|path| path.relative_to(self.scene.centre_m)), ..self }
    }

    /// The same stage without the maps that a model of ambient light has no use for: what is drawn from it reads, binds and
    /// uploads no more than that model does. A model that the maps do not allow falls back to the best that they do.
    pub fn with_ambient(mut self, model: AmbientModel) -> Self {
        for page in &mut self.pages {
            if model == AmbientModel::Hemisphere {
                page.ambient = None;
            }
            let sides = page
                .ambient
                .iter_mut()
                .flat_map(|ambient| std::iter::once(&mut ambient.front).chain(&mut ambient.back));
            for side in sides {
                side.sky = side.sky.take().filter(|_| model == AmbientModel::Sky);
                side.bent = side.bent.take().filter(|_| model >= AmbientModel::Bent);
            }
        }
        self
    }

    /// The best model of ambient light that the maps of every page allow.
    pub fn best_ambient(&self) -> AmbientModel {
        let models = self.pages.iter().map(|page| page_variant(page, self.bits, 0.0).ambient);
        models.min().unwrap_or_default()
    }

    /// The same stage with times of 8 bits, rounded again where they have 16.
    pub fn with_eight_bits(mut self) -> Self {
        let bits = std::mem::replace(&mut self.bits, Bits::Eight);
        self.pages = self.pages.into_iter().map(|page| page.with_eight_bits(bits)).collect();
        self
    }

    /// The same stage with the middle one of the lanes across the sun's disc, as if it had been baked alone.
    pub fn with_one_lane(mut self) -> Self {
        for page in &mut self.pages {
            let middle = page.lanes.len() / 2;
            page.lanes.truncate(middle + 1);
            page.lanes.drain(..middle);
            page.lanes.iter_mut().for_each(|lane| lane.lane = Lane::CENTRE);
        }
        self
    }

    /// The same stage without the sun's times: none is read, bound or uploaded.
    pub fn without_sun(mut self) -> Self {
        self.pages.iter_mut().for_each(|page| page.lanes.clear());
        self
    }

    /// The same stage without the times of either light, whose paths stay: for techniques that find shadows themselves.
    pub fn without_times(mut self) -> Self {
        self.pages.iter_mut().for_each(|page| page.lamp = None);
        self.without_sun()
    }

    /// The same stage without its lamp.
    pub fn without_lamp(mut self) -> Self {
        self.pages.iter_mut().for_each(|page| page.lamp = None);
        Self { lamp: None, ..self }
    }

    /// The lamp at `t`, if there is one.
    pub fn lamp_moment(&self, t: f64) -> Option<LampMoment> {
        self.lamp.as_ref().map(|path| LampMoment::new(path, t, self.scene.half_extent_m))
    }

    /// The moment `t` with all lights that there are.
    pub fn moment(&self, t: f64) -> Moment {
        Moment::new(self.path.as_ref(), t).with_lamp(self.lamp_moment(t))
    }

    /// The scene made ready for rays. The first call builds it, with all threads: whoever asks from many of them has to have asked
    /// before, since a thread that waits for others to build may take up work that asks again.
    pub fn tracer(&self) -> &Tracer {
        self.tracer.get_or_init(|| Tracer::new(&self.scene, &self.geometry))
    }

    /// Where an instance's texels lie.
    pub fn chart(&self, instance: usize) -> Option<&Chart> {
        self.charts[instance].as_ref()
    }

    /// Levels of detail of an image that some material draws.
    pub fn mips(&self, image: usize) -> Option<&MipChain> {
        self.mips[image].as_ref()
    }

    /// The mesh of an instance.
    pub fn mesh(&self, instance: usize) -> &Mesh {
        &self.scene.meshes[self.scene.instances[instance].mesh]
    }

    /// The sides of a triangle that are drawn: neither, if it has no texels or nothing of it can be seen.
    pub fn sides(&self, triangle: usize) -> Sides {
        self.sides[triangle]
    }

    /// What the corners of a triangle carry.
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
        match (&self.charts[instance], self.charts[instance].and_then(|c| mesh.texcoords[c.uv_set].as_ref())) {
            (Some(chart), Some(uvs)) => vertices.map(|v| uvs[v] * chart.scale + chart.offset),
            _ => [Vec2::ZERO; 3],
        }
    }

    fn shading_normal(&self, instance: usize, object: Vec3, front: Vec3) -> Vec3 {
        let normal = self.normals.turned(instance, object);
        if normal == glam::DVec3::ZERO { front } else { normal.as_vec3() }
    }

    /// Texels of the base colour texture a metre of a triangle: the square root of the ratio of their areas.
    pub fn texels_per_metre(&self, triangle: usize, image_uv: [Vec2; 3]) -> f32 {
        let instance = self.geometry.instance[triangle] as usize;
        let Some(texture) = self.scene.material(instance).base_color_texture else { return 0.0 };
        let image = &self.scene.images[texture.image];
        let size = Vec2::new(image.width as f32, image.height as f32);
        let [a, b, c] = image_uv.map(|uv| uv * size);
        let [p, q, r] = self.geometry.triangles[triangle].map(|v| v.as_dvec3());
        let texels = f64::from((b - a).perp_dot(c - a).abs());
        (texels / (q - p).cross(r - p).length().max(f64::MIN_POSITIVE)).sqrt().min(1e12) as f32
    }

    /// The first hit of a primary ray: the nearest surface that is drawn and turns a drawn side to the eye.
    pub fn primary_hit(&self, eye_m: glam::DVec3, direction: glam::DVec3) -> Option<Hit> {
        let direction = direction.normalize();
        self.tracer().closest_hit_where(eye_m, &Direction::new(direction), |triangle| {
            let sides = self.sides[triangle as usize];
            match sides.front == sides.back {
                true => sides.front,
                false => (self.geometry.normal(triangle as usize).dot(direction) < 0.0) == sides.front,
            }
        })
    }

    /// The material of a triangle.
    pub fn material(&self, triangle: usize) -> &Material {
        self.scene.material(self.geometry.instance[triangle] as usize)
    }

    /// Page coordinates of a hit, and its page.
    pub fn page_uv(&self, hit: &Hit) -> Option<(u32, Vec2)> {
        let triangle = hit.triangle as usize;
        let chart = self.charts[self.geometry.instance[triangle] as usize]?;
        Some((chart.page, blend(self.corners(triangle).page_uv, hit.barycentric.map(|b| b as f32))))
    }
}

fn charts(scene: &Scene, entries: &[InstanceEntry], page_count: usize) -> Result<Vec<Option<Chart>>, StageError> {
    let by_place: HashMap<(usize, usize), &InstanceEntry> =
        entries.iter().map(|e| ((e.node, e.primitive), e)).collect();
    let mismatch = |reason: String| StageError::Mismatch { reason };
    let chart = |instance: &sunbake::scene::Instance| {
        let mesh = &scene.meshes[instance.mesh];
        let place = (instance.node, mesh.gltf.1);
        let entry = by_place
            .get(&place)
            .ok_or_else(|| mismatch(format!("nothing is said of node {}, primitive {}", place.0, place.1)))?;
        let Some(page) = entry.atlas else { return Ok(None) };
        let uv_set = entry.uv_set as usize;
        let has_uvs = mesh.texcoords.get(uv_set).is_some_and(Option::is_some);
        if !has_uvs || page as usize >= page_count {
            let what = format!("node {}, primitive {} has no TEXCOORD_{uv_set} or no page {page}", place.0, place.1);
            return Err(mismatch(what));
        }
        Ok(Some(Chart { page, uv_set, scale: entry.uv_scale.into(), offset: entry.uv_offset.into() }))
    };
    scene.instances.iter().map(chart).collect()
}

fn mips(scene: &Scene) -> Vec<Option<MipChain>> {
    let mut mips: Vec<Option<MipChain>> = scene.images.iter().map(|_| None).collect();
    for instance in 0..scene.instances.len() {
        if let Some(texture) = scene.material(instance).base_color_texture {
            mips[texture.image].get_or_insert_with(|| MipChain::new(&scene.images[texture.image]));
        }
    }
    mips
}
