//! Sets that are baked in code from scenes made in code, for tests of this crate and of those that depend on it. Not
//! part of the commands.

pub mod looks;
pub mod maps;
pub mod masks;

use crate::camera::{Camera, View};
use crate::compare::{Agreement, color_difference, edges, visibility_difference};
use crate::gpu::GpuError;
use crate::shot::Shot;
use crate::stage::Stage;
use crate::technique::{BakedCpu, BakedGpu, Technique};
use glam::{DVec3, IVec2, Vec2};
use sunbake::atlas::SurfacePoint;
use sunbake::disk::manifest::InstanceEntry;
use sunbake::lamp::LampPath;
use sunbake::maps::{Bits, Lane, LaneMaps, LayerMaps, PageEncoder, PageMaps};
use sunbake::scene::{Geometry, Scene};
use sunbake::sun::{SUN_ANGULAR_RADIUS_DEG, SunArc, SunPath};
use sunbake::trace::Tracer;
use sunbake::visibility::{Engine, LampEngine, RayEngine, lit_at};

/// An equinox day at a latitude: up in the east at t = 0, in the south at t = 1/2, down in the west at t = 1.
pub fn equinox(latitude_deg: f64) -> SunPath {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    let quarter = std::f64::consts::FRAC_PI_2;
    let arc = SunArc {
        axis: DVec3::new(0.0, -sin, cos),
        zero: DVec3::new(0.0, cos, sin),
        declination_rad: 0.0,
        hour_angle_rad: [-quarter, quarter],
        t: [0.0, 1.0],
    };
    // A path of one arc of these numbers is well formed at any latitude.
    SunPath::new(vec![arc], SUN_ANGULAR_RADIUS_DEG.to_radians(), 720.0).expect("a quarter turn either way is a path")
}

/// A path whose sun stays within half a degree of one direction.
pub fn standing_sun(direction: DVec3, angular_radius_rad: f64) -> SunPath {
    let zero = direction.normalize();
    let arc = SunArc {
        axis: zero.any_orthonormal_vector(),
        zero,
        declination_rad: 0.0,
        hour_angle_rad: [-0.01, 0.01],
        t: [0.0, 1.0],
    };
    SunPath::new(vec![arc], angular_radius_rad, 10.0).expect("a short turn is a path")
}

/// Bakes a scene whose meshes share no vertices between triangles: each triangle of each instance has a square of
/// `cell` texels on a page of its own making. Without a path, a set without a sun.
pub fn bake(scene: Scene, path: Option<SunPath>, cell: u32, bits: Bits) -> Stage {
    bake_lanes(scene, path, cell, bits, 1)
}

/// The same, with several lanes across the sun's disc.
pub fn bake_lanes(scene: Scene, path: Option<SunPath>, cell: u32, bits: Bits, lane_count: usize) -> Stage {
    let mut scene = scene;
    let geometry = Geometry::new(&scene);
    let triangles = geometry.triangles.len() as u32;
    let columns = (f64::from(triangles).sqrt().ceil() as u32).max(1);
    let edge = columns * cell;
    separate_meshes(&mut scene);
    let entries = lay_out(&mut scene, &geometry, columns, cell);
    let lanes = |path: &SunPath| Lane::across_disc(lane_count, path.angular_radius_rad);
    let bake_lane = |path: &SunPath, lane: Lane| LaneMaps {
        lane,
        layers: layers_along(&scene, &geometry, &path.lane(lane.offset_rad), columns, cell, bits),
    };
    let baked = |path: &SunPath| lanes(path).into_iter().map(|lane| bake_lane(path, lane)).collect();
    let lanes = path.as_ref().map(baked).unwrap_or_default();
    let pages =
        vec![PageMaps { width: edge, height: edge, lanes, lamp: None, ambient: None, walls: None, tracks: None }];
    Stage::new(scene, &entries, pages, bits, path).expect("a set made by code agrees with itself")
}

/// Gives each instance a mesh of its own, so that each may have coordinates of its own.
fn separate_meshes(scene: &mut Scene) {
    let mut meshes = Vec::new();
    for instance in &mut scene.instances {
        meshes.push(scene.meshes[instance.mesh].clone());
        instance.mesh = meshes.len() - 1;
    }
    scene.meshes = meshes;
}

fn lay_out(scene: &mut Scene, geometry: &Geometry, columns: u32, cell: u32) -> Vec<InstanceEntry> {
    let edge = (columns * cell) as f32;
    let mut entries = Vec::new();
    for (index, instance) in scene.instances.iter().enumerate() {
        let mesh = &mut scene.meshes[instance.mesh];
        let mut uvs = vec![Vec2::ZERO; mesh.positions.len()];
        for triangle in 0..mesh.triangle_count() {
            let corners = cell_corners(geometry.first_triangle[index] + triangle as u32, columns, cell);
            for k in 0..3 {
                uvs[mesh.indices[3 * triangle + k] as usize] = corners[k] / edge;
            }
        }
        mesh.texcoords.resize(2, None);
        mesh.texcoords[1] = Some(uvs);
        entries.push(InstanceEntry {
            node: instance.node,
            primitive: mesh.gltf.1,
            atlas: Some(0),
            casts: true,
            receives: true,
            uv_set: 1,
            uv_scale: [1.0; 2],
            uv_offset: [0.0; 2],
            double_sided: scene.materials[mesh.material].is_double_sided,
        });
    }
    entries
}

/// Where a triangle's corners lie on the page, in texels.
fn cell_corners(triangle: u32, columns: u32, cell: u32) -> [Vec2; 3] {
    let base = Vec2::new((triangle % columns * cell) as f32, (triangle / columns * cell) as f32);
    let (low, high) = (1.5, cell as f32 - 1.5);
    [Vec2::new(low, low), Vec2::new(high, low), Vec2::new(low, high)].map(|corner| base + corner)
}

fn layers_along(
    scene: &Scene,
    geometry: &Geometry,
    path: &SunPath,
    columns: u32,
    cell: u32,
    bits: Bits,
) -> Vec<LayerMaps> {
    let tracer = Tracer::new(scene, geometry);
    let engine = RayEngine::new(&tracer, std::slice::from_ref(path), 128);
    layers_by(scene, geometry, &engine, columns, cell, bits)
}

/// Adds a lamp, its path in world space, to a stage that [`bake`] made with the same `cell`.
pub fn with_lamp(mut stage: Stage, path: &LampPath, cell: u32) -> Stage {
    let in_bake = path.relative_to(stage.scene.centre_m);
    let layers = {
        let engine = LampEngine::new(stage.tracer(), &in_bake);
        let columns = stage.pages[0].width / cell;
        layers_by(&stage.scene, &stage.geometry, &engine, columns, cell, stage.bits)
    };
    stage.pages[0].lamp = Some(layers);
    stage.with_lamp(Some(path))
}

fn layers_by(
    scene: &Scene,
    geometry: &Geometry,
    engine: &dyn Engine,
    columns: u32,
    cell: u32,
    bits: Bits,
) -> Vec<LayerMaps> {
    let edge = columns * cell;
    let mut encoder = PageEncoder::new((edge * edge) as usize, bits, 8);
    for triangle in 0..geometry.triangles.len() as u32 {
        let [origin, right, _] = cell_corners(triangle, columns, cell);
        for i in 0..cell * cell {
            let local = Vec2::new((i % cell) as f32 + 0.5 - 1.5, (i / cell) as f32 + 0.5 - 1.5) / (right.x - origin.x);
            let inside = local.max(Vec2::ZERO);
            let inside = inside / (inside.x + inside.y).max(1.0);
            let texel = (origin - 1.5).as_ivec2() + IVec2::new((i % cell) as i32, (i / cell) as i32);
            let barycentric = [f64::from(inside.x), f64::from(inside.y)];
            let point = SurfacePoint::of_triangle(scene, geometry, triangle as usize, barycentric);
            let lit = &lit_at(engine, &point)[0];
            encoder.set((texel.y as u32 * edge + texel.x as u32) as usize, lit);
        }
    }
    encoder.finish()
}

/// Draws a moment on the GPU and by its twin on the CPU. Gives how far they agree, to 1/255, on visibility and on the
/// picture.
pub fn twins(
    on_gpu: &mut BakedGpu,
    on_cpu: &mut BakedCpu,
    shot: &Shot,
    t: f64,
) -> Result<[(&'static str, Agreement); 2], GpuError> {
    let moment = shot.stage.moment(t);
    let seen = [on_gpu.visibility(shot, &moment)?, on_cpu.visibility(shot, &moment)?];
    let color = [on_gpu.color(shot, &moment)?, on_cpu.color(shot, &moment)?];
    let edges = edges(shot, &seen[1]);
    let agreement = |difference| Agreement::new(&difference, &edges, 1.0 / 255.0 + 1e-6);
    Ok([
        ("visibility", agreement(visibility_difference(&seen[0], &seen[1]))),
        ("picture", agreement(color_difference(&color[0], &color[1]))),
    ])
}

/// A line of the table that tests print.
pub fn table_line(name: &str, t: f64, what: &str, found: &Agreement) -> String {
    format!(
        "{name:26} t {t:.4}  {what:10} {:6} pixels, {:8.4} % within 1/255, mean {:.6}, worst {:.4}; over: {:3} at \
         edges, {:3} elsewhere",
        found.pixels,
        found.share_within() * 100.0,
        found.mean,
        found.worst,
        found.at_edges,
        found.unexplained
    )
}

/// A view between two points of world space.
pub fn view(stage: &Stage, eye_m: DVec3, target_m: DVec3, size: [u32; 2]) -> View {
    let centre = stage.scene.centre_m;
    let camera = Camera::look_at(eye_m - centre, target_m - centre, 0.8).expect("eye and target differ");
    View::new(&camera, size, &stage.scene)
}
