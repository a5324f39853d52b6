//! Helpers of the tests: scenes made by code, points on them, suns, and oracles that share no code with the code
//! under test.

mod agreement;
pub mod ambient;
pub mod browser;
pub mod compare_command;
pub mod compared;
pub mod engines;
pub mod gltf_diff;
pub mod needs;
mod oracle;
pub mod paths;
pub mod viewer;

pub use agreement::Agreement;
pub use oracle::Oracle;

use glam::{DVec3, Vec3};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use sunbake::atlas::SurfacePoint;
use sunbake::disk::read::{BakedSet, read};
use sunbake::maps::{Bits, PageMaps, stored_intervals};
use sunbake::progress::Silent;
use sunbake::scene::{Geometry, Scene};
use sunbake::settings::{AmbientRequest, BakeSettings, SunRequest};
use sunbake::sun::{DayRequest, SunArc, SunPath};
use sunbake::trace::Tracer;
use sunbake::visibility::{ExactEngine, Intervals, RayEngine, lit_at};

/// A scene with what it takes to trace it.
pub struct Traced {
    /// The scene itself.
    pub scene: Scene,
    /// The scene's triangles in bake space.
    pub geometry: Geometry,
    /// The ray tracer over these triangles.
    pub tracer: Tracer,
}

impl Traced {
    /// Makes a scene ready.
    pub fn new(scene: Scene) -> Self {
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        Self { scene, geometry, tracer }
    }

    /// The same without regard to shading normals.
    pub fn faceted(scene: Scene) -> Self {
        let geometry = Geometry::faceted(&scene);
        Self { geometry, ..Self::new(scene) }
    }

    /// The point of a triangle (flat index) with these weights of its second and third corner.
    pub fn point(&self, triangle: usize, barycentric: [f64; 2]) -> SurfacePoint {
        SurfacePoint::of_triangle(&self.scene, &self.geometry, triangle, barycentric)
    }

    /// A point given in world space, taken to lie on a triangle's plane.
    pub fn point_at(&self, world: DVec3, triangle: usize) -> SurfacePoint {
        SurfacePoint { position_m: world - self.scene.centre_m, ..self.point(triangle, [0.25, 0.25]) }
    }

    /// A point in the air with a plane of its own, given in world space; its rays start as those of a triangle do.
    pub fn observer(&self, world: DVec3, normal: DVec3, triangle: usize) -> SurfacePoint {
        SurfacePoint { normal, smooth: None, ..self.point_at(world, triangle) }
    }

    /// When a point sees the sun, by `count` rays and exactly, each with how far off its edges may be in `t`.
    pub fn lit_by_both(&self, path: &SunPath, count: usize, point: &SurfacePoint) -> [(Intervals, f64); 2] {
        let lanes = std::slice::from_ref(path);
        let rays = lit_at(&RayEngine::new(&self.tracer, lanes, count), point).swap_remove(0);
        let exact = lit_at(&ExactEngine::new(&self.tracer, lanes), point).swap_remove(0);
        [(rays, 1.0 / count as f64), (exact, 1e-9)]
    }

    /// Where a point's rays towards suns in front of it start, in world space.
    pub fn start(&self, point: &SurfacePoint) -> DVec3 {
        self.tracer.lift(point.position_m, point.normal, point.triangle) + self.scene.centre_m
    }
}

/// The sun rises at azimuth `from` and moves at constant speed on the great circle through the zenith down to the
/// opposite horizon. `from` is a level unit vector.
pub fn over_the_top(from: DVec3) -> SunPath {
    let axis = from.cross(DVec3::Y);
    path_of(SunArc {
        axis,
        zero: from,
        declination_rad: 0.0,
        hour_angle_rad: [0.0, std::f64::consts::PI],
        t: [0.0, 1.0],
    })
}

/// A sun that stands nearly still in one direction.
pub fn standing(direction: DVec3) -> SunPath {
    let zero = direction.normalize();
    path_of(SunArc {
        axis: zero.any_orthonormal_vector(),
        zero,
        declination_rad: 0.0,
        hour_angle_rad: [-1e-9, 1e-9],
        t: [0.0, 1.0],
    })
}

/// A path of one arc, of a light without width.
pub fn path_of(arc: SunArc) -> SunPath {
    SunPath::new(vec![arc], 0.0, 720.0).expect("the arc is well formed")
}

/// The number that an environment variable gives, or a default.
pub fn asked_for(variable: &str, ordinarily: usize) -> usize {
    let asked = std::env::var(variable).ok();
    asked.map_or(ordinarily, |text| text.parse().unwrap_or_else(|_| panic!("{variable}={text} is no number")))
}

/// The triangles with their winding reversed.
pub fn flipped(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// Writes a scene made by code as `NAME.glb` in a folder, without unique coordinates.
pub fn write_scene(scene: &Scene, folder: &Path, name: &str) -> PathBuf {
    let file = folder.join(format!("{name}.glb"));
    let written = sunbake::glb::write_plain(scene).expect("a small scene");
    std::fs::write(&file, written).expect("a folder to write in");
    file
}

/// Midsummer at 40 degrees north.
pub fn june_day() -> DayRequest {
    DayRequest {
        latitude_deg: 40.0,
        longitude_deg: 0.0,
        date: "2026-06-21".parse().expect("a date"),
        utc_offset_h: Some(0.0),
        north_deg: 0.0,
        window: None,
    }
}

/// A small, quick bake: a page of 128, 16 bits, few rays of sky.
pub fn quick() -> BakeSettings {
    let ambient = Some(AmbientRequest::with_rays(16));
    BakeSettings { page_size_texels: 128, ambient, ..BakeSettings::standard(SunRequest::Day(june_day())) }
}

/// Bakes a scene made by code into `FOLDER/NAME` and reads the set back.
pub fn bake_scene(scene: &Scene, settings: &BakeSettings, folder: &Path, name: &str) -> BakedSet {
    let file = write_scene(scene, folder, name);
    let target = folder.join(name);
    sunbake::bake(&file, &target, true, settings, &Silent).unwrap_or_else(|error| panic!("{name}: {error}"));
    read(&target).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// From one code of 16 bits to the next.
pub const CODE_STEP_T: f64 = 1.0 / 65_535.0;

/// Share of texels whose stored times differ by more than a code step.
pub fn share_that_differs(a: &BakedSet, b: &BakedSet) -> f64 {
    assert_eq!(a.pages.len(), b.pages.len());
    let (mut different, mut all) = (0usize, 0usize);
    for (a, b) in a.pages.iter().zip(&b.pages) {
        assert_eq!((a.width, a.height), (b.width, b.height));
        for texel in 0..(a.width * a.height) as usize {
            let times = |page: &PageMaps| stored_intervals(&page.lanes[0].layers, texel, Bits::Sixteen);
            different += usize::from(!are_near(&times(a), &times(b)));
            all += 1;
        }
    }
    different as f64 / all as f64
}

fn are_near(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let both = a.as_flattened().iter().zip(b.as_flattened());
    a.len() == b.len() && both.map(|(a, b)| (a - b).abs()).all(|off_t| off_t <= 1.001 * CODE_STEP_T)
}

/// The file of a command, `sunbake` or `sunplay`. Where the whole workspace was built, as `tests/run` does, it lies
/// beside the tests' folder. Else cargo builds it first.
pub fn built_program(name: &str) -> PathBuf {
    let mut folder = std::env::current_exe().expect("a test has a file");
    folder.pop();
    if folder.ends_with("deps") {
        folder.pop();
    }
    let file = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    if !(needs::is_set("SUNBAKE_WORKSPACE_IS_BUILT") && file.is_file()) {
        let built = Command::new(env!("CARGO")).args(["build", "-q", "--workspace", "--bin", name]).status();
        assert!(built.is_ok_and(|status| status.success()), "cargo cannot build {name}");
    }
    file
}

/// Standard error as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
