//! Brute force in `f64` that shares no code with what it checks: "Fast, Minimum Storage Ray/Triangle Intersection"
//! (Moeller and Trumbore, *Journal of Graphics Tools* 2(1), 1997) against every triangle, for evenly spaced positions
//! of the lamp.
//!
//! It follows the documentation of shadow rays: they start at [`Tracer::lift`], minus [`Tracer::run_up_m`], and end
//! the run-up before the lamp, measured square to the surface that they meet. An engine may disagree about a position
//! only if brute force, or the engine, changes its answer within one step of it: then one edge or two are that near.

use glam::{DVec2, DVec3};
use sunbake::atlas::SurfacePoint;
use sunbake::lamp::{LampKey, LampPath};
use sunbake::scene::{Alpha, Geometry, Scene};
use sunbake::testing::{SceneBuilder, pseudo_random};
use sunbake::trace::Tracer;
use sunbake::visibility::{Engine, IntervalTable, Intervals, LampEngine, LampRays, lit_at};

/// Places of the lamp that brute force asks.
pub const STEPS: usize = 4096;

/// A scene made by code, ready for both.
pub struct Here {
    pub scene: Scene,
    pub geometry: Geometry,
    pub tracer: Tracer,
}

impl Here {
    pub fn new(builder: SceneBuilder) -> Self {
        let scene = builder.build();
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        Self { scene, geometry, tracer }
    }

    /// A path through places of world space, evenly spaced in time, in bake space.
    pub fn lamp(&self, places: &[[f64; 3]]) -> LampPath {
        let last = (places.len() - 1) as f64;
        let key =
            |(i, place): (usize, &[f64; 3])| LampKey { t: i as f64 / last, position_m: DVec3::from_array(*place) };
        let keys = places.iter().enumerate().map(key).collect();
        LampPath::new(keys, 0.05, 10.0).unwrap().relative_to(self.scene.centre_m)
    }

    /// A point of a triangle.
    pub fn point(&self, triangle: usize, barycentric: [f64; 2]) -> SurfacePoint {
        SurfacePoint::of_triangle(&self.scene, &self.geometry, triangle, barycentric)
    }

    /// A few points of each triangle of the first `triangles`.
    pub fn points(&self, triangles: usize, each: usize, seed: u64) -> Vec<SurfacePoint> {
        let mut state = seed;
        let mut points = Vec::new();
        for triangle in 0..triangles {
            for _ in 0..each {
                let (u, v) = (pseudo_random(&mut state), pseudo_random(&mut state));
                points.push(self.point(triangle, if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] }));
            }
        }
        points
    }

    /// For each step, whether the point sees the lamp.
    pub fn brute_force(&self, lamp: &LampPath, point: &SurfacePoint) -> Vec<bool> {
        (0..STEPS).map(|step| self.sees(point, lamp.position_m((step as f64 + 0.5) / STEPS as f64))).collect()
    }

    pub fn sees(&self, point: &SurfacePoint, lamp_m: DVec3) -> bool {
        let height = point.normal.dot(lamp_m - point.position_m);
        let side = match height {
            height if height > 0.0 => point.normal,
            height if height < 0.0 && point.is_double_sided => -point.normal,
            _ => return false,
        };
        let origin = self.tracer.lift(point.position_m, side, point.triangle);
        !(0..self.geometry.triangles.len()).any(|triangle| self.hides(triangle, origin, lamp_m))
    }

    pub fn hides(&self, triangle: usize, origin: DVec3, lamp_m: DVec3) -> bool {
        let run_up_m = self.tracer.run_up_m();
        let way = (lamp_m - origin).normalize();
        let start = origin - way * run_up_m;
        let corners = self.geometry.triangles[triangle].map(|v| v.as_dvec3());
        let Some((distance, barycentric)) = met(corners, start, way) else { return false };
        let [a, b, c] = corners;
        let beyond = lamp_m.distance(start) - distance;
        let is_beyond = beyond * (b - a).cross(c - a).normalize().dot(way).abs() >= run_up_m;
        is_beyond && self.is_solid(triangle, barycentric)
    }

    /// Alpha of the nearest texel, of tiling textures without a transform of their own.
    pub fn is_solid(&self, triangle: usize, [v, w]: [f64; 2]) -> bool {
        let surface = self.geometry.surface(triangle);
        let mesh = &self.scene.meshes[self.scene.instances[surface.instance].mesh];
        let material = &self.scene.materials[mesh.material];
        let (Alpha::Mask { cutoff }, Some(texture)) = (material.alpha, material.base_color_texture) else {
            return true;
        };
        let uvs = mesh.texcoords[0].as_ref().unwrap();
        let corner = |k: usize| uvs[mesh.indices[3 * surface.mesh_triangle + k] as usize].as_dvec2();
        let uv: DVec2 = corner(0) * (1.0 - v - w) + corner(1) * v + corner(2) * w;
        let image = &self.scene.images[texture.image];
        let texel = |at: f64, size: u32| (at * f64::from(size)).floor().rem_euclid(f64::from(size)) as u32;
        let (x, y) = (texel(uv.x, image.width), texel(uv.y, image.height));
        f32::from(image.rgba[(y * image.width + x) as usize][3]) / 255.0 >= cutoff
    }
}

/// Distance and weights of the second and third corner; grown by a part in 10^12, so that nothing slips through an
/// edge.
fn met([a, b, c]: [DVec3; 3], start: DVec3, way: DVec3) -> Option<(f64, [f64; 2])> {
    const GROWTH: f64 = 1e-12;
    let (ab, ac) = (b - a, c - a);
    let p = way.cross(ac);
    let determinant = ab.dot(p);
    let from_a = start - a;
    let q = from_a.cross(ab);
    let [v, w, distance] = [from_a.dot(p), way.dot(q), ac.dot(q)].map(|x| x / determinant);
    (v >= -GROWTH && w >= -GROWTH && v + w <= 1.0 + GROWTH && distance > 0.0).then_some((distance, [v, w]))
}

/// Steps that differ from brute force though neither changes its mind within one step.
pub fn unexplained(seen: &[bool], answer: &Intervals) -> Vec<usize> {
    let step_t = 1.0 / STEPS as f64;
    let t = |step: usize| (step as f64 + 0.5) * step_t;
    let is_at_edge = |step: usize| {
        let mut around = step.saturating_sub(1)..=(step + 1).min(STEPS - 1);
        let changes = around.any(|other| seen[other] != seen[step]);
        // An interval that falls between two steps, told by the engine alone, must begin or end beside the step it
        // touches.
        changes || answer.as_slice().iter().flatten().any(|edge| (edge - t(step)).abs() <= 1e-9)
    };
    (0..STEPS).filter(|&step| answer.contains(t(step)) != seen[step] && !is_at_edge(step)).collect()
}

/// A moment of every lit and every dark interval, but for those too short for the oracle's growth. Not the middle, in
/// which a path that is its own mirror image may touch a surface.
pub fn moments(answer: &Intervals) -> Vec<f64> {
    let mut ends: Vec<f64> = answer.as_slice().iter().flatten().copied().collect();
    ends.insert(0, 0.0);
    ends.push(1.0);
    ends.windows(2)
        .filter(|interval| interval[1] - interval[0] > 1e-9)
        .map(|interval| interval[0] + 0.45 * (interval[1] - interval[0]))
        .collect()
}

/// Holds the exact engine to brute force at every point, and rays to the exact engine. Returns answers.
pub fn agree(name: &str, here: &Here, lamp: &LampPath, points: &[SurfacePoint]) -> Vec<Intervals> {
    let exact = LampEngine::new(&here.tracer, lamp);
    let mut table = IntervalTable::default();
    exact.session().lit(points, &mut table);
    let answers: Vec<Intervals> = table.iter().collect();
    let rays = LampRays::new(&here.tracer, lamp, STEPS);
    let mut by_rays = IntervalTable::default();
    rays.session().lit(points, &mut by_rays);
    for ((point, answer), rays) in points.iter().zip(&answers).zip(by_rays.iter()) {
        let seen = here.brute_force(lamp, point);
        let wrong = unexplained(&seen, answer);
        assert!(wrong.is_empty(), "{name}, {point:?}: {answer:?} at steps {wrong:?}");
        for t in moments(answer) {
            assert_eq!(answer.contains(t), here.sees(point, lamp.position_m(t)), "{name}: {answer:?} at {t}");
        }
        let wrong = unexplained(&seen, &rays);
        assert!(wrong.is_empty(), "{name}, {point:?}: rays {rays:?} at steps {wrong:?}");
        // What a session learned from other points must not matter.
        assert_eq!(lit_at(&exact, point), std::slice::from_ref(answer), "{name}");
    }
    answers
}
