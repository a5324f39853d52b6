//! When points see a lamp, in closed form and by rays, held against brute force.
//!
//! Brute force is `f64` and shares no code with what it checks: "Fast, Minimum Storage Ray/Triangle Intersection" (Moeller
//! and Trumbore, *Journal of Graphics Tools* 2(1), 1997) against every triangle, for evenly spaced places of the lamp. It
//! follows what is documented of shadow rays: they start at [`Tracer::lift`] and [`Tracer::run_up_m`] before that, and end
//! the run-up before the lamp, measured square to what they meet. A place may be told otherwise than brute force tells it
//! only if brute force changes its mind within one step of it, or the engine does: then an edge, or two, are that near.

use glam::{DVec2, DVec3, Mat3, Vec2, Vec3};
use sunbake::atlas::SurfacePoint;
use sunbake::lamp::{LampKey, LampPath};
use sunbake::scene::{Alpha, Geometry, Mesh, Scene, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, block, cut, floor, icosphere, opaque, pseudo_random};
use sunbake::trace::Tracer;
use sunbake::visibility::{Engine, IntervalTable, Intervals, LampEngine, LampRays, lit_at};

/// Places of the lamp that brute force asks.
const STEPS: usize = 4096;

/// A scene made by code, ready for both.
struct Here {
    scene: Scene,
    geometry: Geometry,
    tracer: Tracer,
}

impl Here {
    fn new(builder: SceneBuilder) -> Self {
        let scene = builder.build();
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        Self { scene, geometry, tracer }
    }

    /// A path through places of world space, evenly spaced in time, in bake space.
    fn lamp(&self, places: &[[f64; 3]]) -> LampPath {
        let last = (places.len() - 1) as f64;
        let key =
            |(i, place): (usize, &[f64; 3])| LampKey { t: i as f64 / last, position_m: DVec3::from_array(*place) };
        let keys = places.iter().enumerate().map(key).collect();
        LampPath::new(keys, 0.05, 10.0).unwrap().relative_to(self.scene.centre_m)
    }

    /// A point of a triangle.
    fn point(&self, triangle: usize, barycentric: [f64; 2]) -> SurfacePoint {
        let instance = self.geometry.instance[triangle] as usize;
        SurfacePoint {
            position_m: self.geometry.point(triangle, barycentric),
            normal: self.geometry.normal(triangle),
            is_double_sided: self.scene.material(instance).is_double_sided,
            triangle: triangle as u32,
        }
    }

    /// A few points of each triangle of the first `triangles`.
    fn points(&self, triangles: usize, each: usize, seed: u64) -> Vec<SurfacePoint> {
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
    fn brute_force(&self, lamp: &LampPath, point: &SurfacePoint) -> Vec<bool> {
        (0..STEPS).map(|step| self.sees(point, lamp.position_m((step as f64 + 0.5) / STEPS as f64))).collect()
    }

    fn sees(&self, point: &SurfacePoint, lamp_m: DVec3) -> bool {
        let height = point.normal.dot(lamp_m - point.position_m);
        let side = match height {
            height if height > 0.0 => point.normal,
            height if height < 0.0 && point.is_double_sided => -point.normal,
            _ => return false,
        };
        let origin = self.tracer.lift(point.position_m, side, point.triangle);
        !(0..self.geometry.triangles.len()).any(|triangle| self.hides(triangle, origin, lamp_m))
    }

    fn hides(&self, triangle: usize, origin: DVec3, lamp_m: DVec3) -> bool {
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
    fn is_solid(&self, triangle: usize, [v, w]: [f64; 2]) -> bool {
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

/// Distance and weights of the second and third corner; grown by a part in 10^12, so that nothing slips through an edge.
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
fn unexplained(seen: &[bool], answer: &Intervals) -> Vec<usize> {
    let step_t = 1.0 / STEPS as f64;
    let t = |step: usize| (step as f64 + 0.5) * step_t;
    let is_at_edge = |step: usize| {
        let mut around = step.saturating_sub(1)..=(step + 1).min(STEPS - 1);
        let changes = around.any(|other| seen[other] != seen[step]);
        // A spell that falls between two steps, told by the engine alone, must begin or end beside the step it touches.
        changes || answer.as_slice().iter().flatten().any(|edge| (edge - t(step)).abs() <= 1e-9)
    };
    (0..STEPS).filter(|&step| answer.contains(t(step)) != seen[step] && !is_at_edge(step)).collect()
}

/// A moment of every lit and every dark spell, but for those too short for the oracle's growth. Not the middle, in which
/// a path that is its own mirror image may touch a surface.
fn moments(answer: &Intervals) -> Vec<f64> {
    let mut ends: Vec<f64> = answer.as_slice().iter().flatten().copied().collect();
    ends.insert(0, 0.0);
    ends.push(1.0);
    ends.windows(2)
        .filter(|spell| spell[1] - spell[0] > 1e-9)
        .map(|spell| spell[0] + 0.45 * (spell[1] - spell[0]))
        .collect()
}

/// Holds the exact engine to brute force at every point, and rays to the exact engine. Returns answers.
fn agree(name: &str, here: &Here, lamp: &LampPath, points: &[SurfacePoint]) -> Vec<Intervals> {
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

fn wall(min: [f32; 2], max: [f32; 2], z: f32) -> Vec<[Vec3; 3]> {
    let level = floor(Vec2::from(min), Vec2::from(max), 0.0);
    level.iter().map(|t| t.map(|v| Vec3::new(v.x, v.z, z))).collect()
}

fn ground() -> Vec<[Vec3; 3]> {
    floor(Vec2::splat(-5.0), Vec2::splat(5.0), 0.0)
}

#[test]
fn a_lamp_passes_behind_a_wall() {
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&wall([-1.0, 0.0], [1.0, 3.0], 0.0)));
    let lamp = here.lamp(&[[-6.0, 1.0, -2.0], [6.0, 1.0, -2.0]]);
    agree("wall", &here, &lamp, &here.points(2, 60, 1));
    // Straight through: from (0, 0, 2), edges at x = -1 and 1 stand before x = -2 and 2 of the lamp's line.
    let mut point = here.point(0, [0.3, 0.3]);
    point.position_m = DVec3::new(0.0, 0.0, 2.0) - here.scene.centre_m;
    let lit = agree("wall, trigonometry", &here, &lamp, &[point]);
    let expected = [[0.0, 4.0 / 12.0], [8.0 / 12.0, 1.0]];
    for (found, expected) in lit[0].as_slice().iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
}

#[test]
fn a_lamp_passes_a_doorway() {
    let door =
        [wall([-4.0, 0.0], [-0.5, 3.0], 0.0), wall([0.5, 0.0], [4.0, 3.0], 0.0), wall([-0.5, 2.0], [0.5, 3.0], 0.0)];
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&door.concat()));
    // Along the wall, through the door and back outside of it.
    let lamp = here.lamp(&[[-4.0, 1.2, -1.5], [0.1, 1.0, -1.5], [0.1, 1.3, 1.7], [3.0, 1.6, -0.4]]);
    agree("doorway", &here, &lamp, &here.points(8, 16, 2));
}

#[test]
fn occluders_beyond_the_lamp_do_not_count() {
    let roof = ground().iter().map(|t| t.map(|v| v + Vec3::Y * 3.0)).collect::<Vec<_>>();
    let here =
        Here::new(SceneBuilder::new().soup(&ground()).soup(&roof).block(Vec3::new(3.0, 0.0, -5.0), Vec3::splat(4.5)));
    let below = here.lamp(&[[-4.0, 2.9, 1.0], [2.5, 2.5, -1.0]]);
    let answers = agree("below the roof", &here, &below, &here.points(2, 40, 3));
    let is_free = |(point, answer): &(SurfacePoint, Intervals)| {
        point.position_m.x + here.scene.centre_m.x < 2.9 && *answer != Intervals::always()
    };
    assert!(!here.points(2, 40, 3).into_iter().zip(answers).any(|pair| is_free(&pair)));
    let above = here.lamp(&[[-4.0, 3.1, 1.0], [2.5, 3.5, -1.0]]);
    assert!(agree("above the roof", &here, &above, &here.points(2, 40, 3)).iter().all(|a| *a == Intervals::never()));
}

#[test]
fn a_lamp_passes_through_what_it_meets() {
    let here =
        Here::new(SceneBuilder::new().soup(&ground()).block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)));
    let lamp = here.lamp(&[[-3.0, 1.0, 0.2], [3.0, 1.0, 0.2], [0.0, -1.0, 3.0], [0.0, 4.0, -1.5]]);
    agree("through a box", &here, &lamp, &here.points(14, 8, 4));
    let through_points = here.points(2, 10, 5);
    let target = through_points[3].position_m + here.scene.centre_m;
    let lamp = here.lamp(&[[-2.0, 3.0, 1.0], target.to_array(), [1.0, 2.5, 1.0]]);
    agree("onto a point", &here, &lamp, &through_points);
}

#[test]
fn points_and_lamps_in_one_plane_or_line_agree() {
    let here = Here::new(
        SceneBuilder::new()
            .soup_of(&ground(), sunbake::scene::Material { is_double_sided: true, ..opaque() })
            .block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)),
    );
    // In the ground's plane, in a side's plane, along an edge, straight away from a point, and back through it.
    let point = here.point(0, [0.25, 0.25]);
    let at = (point.position_m + here.scene.centre_m).to_array();
    let up = |y: f64| [at[0], at[1] + y, at[2]];
    for (name, places) in [
        ("in the ground", [[-4.0, 0.0, 3.0], [4.0, 0.0, 3.5]]),
        ("in a side", [[-4.0, 1.0, 1.0], [4.0, 1.0, 1.0]]),
        ("along an edge", [[-4.0, 2.0, 1.0], [4.0, 2.0, 1.0]]),
        ("away from a point", [up(0.5), up(3.0)]),
        ("through a point", [up(-1.0), up(3.0)]),
    ] {
        let mut points = here.points(14, 6, 6);
        points.push(point);
        agree(name, &here, &here.lamp(&places), &points);
    }
}

/// A wall of leaves: a mask with holes of a texel and of many.
fn leaf(builder: SceneBuilder, alpha: impl Fn(u32, u32) -> u8) -> SceneBuilder {
    const SIZE: u32 = 16;
    let (builder, image) =
        builder.image(SIZE, SIZE, (0..SIZE * SIZE).map(|i| [90, 120, 60, alpha(i % SIZE, i / SIZE)]).collect());
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] };
    let positions: Vec<Vec3> = wall([-2.0, 0.2], [2.0, 3.0], 0.5).into_iter().flatten().collect();
    let uvs = positions.iter().map(|p| Vec2::new(p.x * 0.4 + 0.03 * p.y, 0.37 * p.y)).collect();
    let indices = (0..positions.len() as u32).collect();
    let mesh = Mesh { positions, texcoords: [Some(uvs), None], indices, ..Mesh::default() };
    builder.mesh_of(mesh, cut(texture), &[glam::DMat4::IDENTITY])
}

#[test]
fn leaves_are_followed_texel_by_texel() {
    let checker = |x: u32, y: u32| if (x + y).is_multiple_of(2) || x < 5 && y < 6 { 255 } else { 0 };
    let here = Here::new(leaf(SceneBuilder::new().soup(&ground()), checker));
    let lamp = here.lamp(&[[-3.0, 1.0, -1.5], [3.0, 1.7, -1.0], [0.5, 2.9, 3.0], [-1.0, 0.5, -0.7]]);
    let answers = agree("leaf", &here, &lamp, &here.points(4, 20, 7));
    assert!(answers.iter().any(|a| a.as_slice().len() > 12), "the leaf has holes");
    let solid = Here::new(leaf(SceneBuilder::new().soup(&ground()), |_, _| 255));
    let clear = Here::new(leaf(SceneBuilder::new().soup(&ground()), |_, _| 0));
    for (name, here) in [("solid", &solid), ("clear", &clear)] {
        agree(name, here, &here.lamp(&[[-3.0, 1.0, -1.5], [3.0, 1.7, -1.0]]), &here.points(2, 20, 8));
    }
}

#[test]
fn a_closed_sphere_keeps_its_light() {
    let sphere = icosphere(3);
    let seat = floor(Vec2::splat(-0.3), Vec2::splat(0.3), -0.2);
    let here = Here::new(
        SceneBuilder::new()
            .soup_of(&seat, sunbake::scene::Material { is_double_sided: true, ..opaque() })
            .soup(&sphere),
    );
    let points = here.points(2, 40, 9);
    // A spiral around the sphere.
    let turn = |i: i32| (f64::from(i) * 0.5).sin_cos();
    let height = |i: i32| f64::from(i) / 12.0 - 2.5;
    let place = |i: i32| [3.0 * turn(i).0, height(i), 3.0 * turn(i).1];
    let around: Vec<[f64; 3]> = (0..=60).map(place).collect();
    let outside = agree("outside", &here, &here.lamp(&around), &points);
    assert!(outside.iter().all(|a| *a == Intervals::never()));
    // Rays from a point move along an edge of the sphere from corner to corner, and go on to the next.
    let from = points[7].position_m + here.scene.centre_m;
    let beyond = |corner: Vec3| (from + 3.0 * (corner.as_dvec3() - from)).to_array();
    for triangle in sphere.iter().step_by(29) {
        let lamp = here.lamp(&triangle.map(beyond));
        let engine = LampEngine::new(&here.tracer, &lamp);
        assert_eq!(lit_at(&engine, &points[7]), [Intervals::never()]);
    }
    let inside = here.lamp(&[[-0.4, 0.1, 0.2], [0.3, 0.5, -0.4], [0.2, 0.3, 0.6]]);
    assert!(agree("inside", &here, &inside, &points).iter().all(|a| *a == Intervals::always()));
    let leaving = here.lamp(&[[0.0, 0.4, 0.1], [0.3, 1.9, 0.2]]);
    let answers = agree("leaving", &here, &leaving, &points);
    assert!(answers.iter().all(|a| a.as_slice().len() == 1 && a.as_slice()[0][0] == 0.0 && a.lit_length() < 0.5));
}

#[test]
fn random_triangles_agree() {
    for seed in 1..=6 {
        let mut state = seed * 77;
        let mut random = |size: f64| (2.0 * pseudo_random(&mut state) - 1.0) * size;
        let mut vector = |size: f64| DVec3::new(random(size), random(size), random(size));
        let triangles: Vec<[Vec3; 3]> = (0..120)
            .map(|_| {
                let centre = vector(4.0);
                [0; 3].map(|_| (centre + vector(1.0)).as_vec3())
            })
            .collect();
        let places: Vec<[f64; 3]> = (0..4).map(|_| vector(5.0).to_array()).collect();
        let material = sunbake::scene::Material { is_double_sided: seed % 2 == 0, ..opaque() };
        let here = Here::new(SceneBuilder::new().soup_of(&triangles, material));
        agree(&format!("random {seed}"), &here, &here.lamp(&places), &here.points(120, 1, seed));
    }
}

/// Brute force cannot see what is shorter than its step; the exact engine does, and its answer is trigonometry's.
#[test]
fn shadows_shorter_than_a_step_are_found() {
    let wire = wall([-0.0001, 0.0], [0.0001, 3.0], 0.0);
    let here = Here::new(SceneBuilder::new().soup(&ground()).soup(&wire));
    let lamp = here.lamp(&[[-4.0, 1.0, -2.0], [4.0, 1.0, -2.0]]);
    let mut point = here.point(0, [0.3, 0.3]);
    point.position_m = DVec3::new(0.001, 0.0, 2.0) - here.scene.centre_m;
    let lit = agree("wire", &here, &lamp, &[point]);
    let ends: Vec<f64> = lit[0].as_slice().iter().flatten().copied().collect();
    // From (0.001, 0, 2) the wire's edges at x = ±0.0001 stand before x = -0.001 ± 0.0002 of the lamp's line.
    let expected = [0.0, (4.0 - 0.0012) / 8.0, (4.0 - 0.0008) / 8.0, 1.0];
    assert_eq!(ends.len(), 4, "{ends:?}");
    for (found, expected) in ends.iter().zip(expected) {
        // Where the ray starts is off the ground by a lift of a few micrometres, and off the triangle's edges too.
        assert!((found - expected).abs() < 3e-6, "{ends:?}");
    }
    assert!(ends[2] - ends[1] < 1.0 / STEPS as f64);
}

/// B4: a block casts the same shadow wherever the scene lies.
#[test]
fn size_and_place_do_not_matter() {
    for scale in [1e-3f32, 1.0, 1e4] {
        let scaled = |triangles: Vec<[Vec3; 3]>| triangles.iter().map(|t| t.map(|v| v * scale)).collect::<Vec<_>>();
        let here = Here::new(
            SceneBuilder::new()
                .soup(&scaled(ground()))
                .soup(&scaled(block(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0)))),
        );
        let places = [[-3.0, 2.5, 0.2], [3.0, 1.0, 0.2], [0.0, 1.0, 3.0]].map(|p| p.map(|x: f64| x * f64::from(scale)));
        agree(&format!("scale {scale}"), &here, &here.lamp(&places), &here.points(14, 4, 11));
    }
}
