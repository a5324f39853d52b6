//! Hard case B6 in filtered playback: no light passes through walls, however thin, at any density and angle. The floor
//! runs on outside, so that texels inside and outside are neighbours.

use glam::{DVec2, DVec3, Vec2, Vec3, Vec3Swizzles};
use sunbake::atlas::{Density, SurfacePoint};
use sunbake::progress::Silent;
use sunbake::scene::{Alpha, LoadLimits, Material, Scene};
use sunbake::settings::{AmbientRequest, BakeSettings, SunRequest, TrackChoice};
use sunbake::testing::{SceneBuilder, block, floor, opaque};
use sunbake::trace::Direction;
use sunbake::visibility::{ExactEngine, lit_at};
use sunbake_runtime::playback::{AmbientSky, Page};
use sunbake_runtime::stage::Stage;
use sunbake_runtime::{Filter, Moment};
use sunbake_tests::june_day;
use sunbake_tests::needs::workspace;

const TIMES: usize = 12;

/// A generator of numbers from 0 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

fn stage_of(scene: &Scene, texels_per_metre: f64, has_walls: bool) -> Stage {
    let settings = BakeSettings {
        density: Density::TexelsPerMetre(texels_per_metre),
        page_size_texels: 1024,
        ambient: Some(AmbientRequest::with_rays(64)),
        tracks: TrackChoice::Auto,
        threads: 1,
        ..BakeSettings::standard(SunRequest::Day(june_day()))
    };
    let mut bake = sunbake::bake_scene(scene, &settings, &Silent).unwrap();
    if !has_walls {
        bake.pages.iter_mut().for_each(|page| page.maps.walls = None);
    }
    Stage::of_bake(bake).unwrap()
}

/// The most light, of the sun and of the sky, that filtered playback shows at points of surfaces that `is_inside`
/// holds for. Gives the number of points too.
fn most_light(stage: &Stage, numbers: &mut Numbers, is_inside: impl Fn(&SurfacePoint) -> bool) -> ([f32; 2], usize) {
    let path = stage.path.as_ref().unwrap();
    let pages: Vec<Page> =
        stage.pages.iter().map(|page| Page::new(page, stage.bits, path.angular_radius_rad)).collect();
    let moments: Vec<_> = (0..TIMES).map(|k| stage.moment((k as f64 + 0.5) / TIMES as f64)).collect();
    let (mut most, mut count) = ([0.0f32; 2], 0);
    for triangle in 0..stage.geometry.triangles.len() {
        let Some(chart) = stage.chart(stage.geometry.instance[triangle] as usize) else { continue };
        let corners = stage.corners(triangle);
        let normal = stage.geometry.normal(triangle).as_vec3();
        for _ in 0..3000 {
            let (u, v) = (numbers.next(), numbers.next());
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let point = SurfacePoint {
                position_m: stage.geometry.point(triangle, [u, v]),
                normal: stage.geometry.normal(triangle),
                is_double_sided: false,
                triangle: triangle as u32,
                smooth: None,
            };
            if !is_inside(&point) {
                continue;
            }
            count += 1;
            let [a, b, c] = corners.page_uv;
            let page_uv = a * (1.0 - u - v) as f32 + b * u as f32 + c * v as f32;
            let page = &pages[chart.page as usize];
            for moment in &moments {
                for filter in [Filter::Bilinear, Filter::Sharp, Filter::Tracks] {
                    most[0] = most[0].max(page.sun_visibility(page_uv, normal, filter, moment));
                }
                let sky = AmbientSky::new(moment, &pages);
                most[1] = most[1].max(page.ambient_light(page_uv, Vec3::Y, false, &sky).max_element());
            }
        }
    }
    (most, count)
}

/// A closed room on a floor that runs on outside: walls `thickness_m` thick, 0 for sheets, and a roof.
struct Room {
    centre: DVec2,
    angle_rad: f64,
    half_m: DVec2,
    height_m: f64,
    thickness_m: f64,
}

impl Room {
    fn corners(&self, out_m: f64) -> [DVec2; 4] {
        let turn = DVec2::from_angle(self.angle_rad);
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, z]| self.centre + turn.rotate(DVec2::new(x, z) * (self.half_m + out_m)))
    }

    /// Whether a point lies inside, and not within a hundredth of a millimetre of a wall.
    fn holds(&self, at: DVec3) -> bool {
        let local = DVec2::from_angle(-self.angle_rad).rotate(at.xz() - self.centre).abs();
        local.cmplt(self.half_m - 1e-5).all() && at.y > -1e-3 && at.y < self.height_m - 1e-5
    }

    fn triangles(&self) -> Vec<[Vec3; 3]> {
        let mut all = Vec::new();
        let mut quad = |corners: [(DVec2, f64); 4]| {
            let [a, b, c, d] = corners.map(|(at, y)| DVec3::new(at.x, y, at.y).as_vec3());
            all.extend([[a, b, c], [a, c, d]]);
        };
        let top = self.height_m;
        let inner = self.corners(0.0);
        let outer = self.corners(self.thickness_m);
        for k in 0..4 {
            let (a, b) = (inner[k], inner[(k + 1) % 4]);
            quad([(a, -0.1), (a, top), (b, top), (b, -0.1)]);
            if self.thickness_m > 0.0 {
                let (a, b) = (outer[k], outer[(k + 1) % 4]);
                quad([(b, -0.1), (b, top), (a, top), (a, -0.1)]);
            }
        }
        quad(outer.map(|corner| (corner, top)));
        all
    }
}

/// B6 and B18.
#[test]
fn random_closed_rooms_are_dark_in_filtered_playback() {
    let mut numbers = Numbers(7);
    let mut leaked = 0;
    for index in 0..24 {
        let texels_per_metre = [1.0, 3.0, 8.0][index % 3];
        let texel_m = 1.0 / texels_per_metre;
        let room = Room {
            centre: DVec2::new(numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0)),
            angle_rad: numbers.between(0.0, 7.0),
            // A room narrower than this may lie between the points of its texels.
            half_m: DVec2::new(numbers.between(0.0, 2.0), numbers.between(0.0, 2.0)) + 0.75 * texel_m,
            height_m: f64::max(1.2 * texel_m, 1.0) + numbers.between(0.0, 2.0),
            thickness_m: if index % 4 == 0 { 0.0 } else { numbers.between(0.0, 3.0 * texel_m) },
        };
        let two_sided = Material { is_double_sided: true, ..opaque() };
        let floor = [[-9.0f32, -9.0], [-9.0, 9.0], [9.0, 9.0], [9.0, -9.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
        let [a, b, c, d] = floor;
        let is_inside = |stage: &Stage, point: &SurfacePoint| {
            let at = point.position_m + stage.scene.centre_m;
            at.y < 1e-3 && room.holds(at)
        };
        let scene = SceneBuilder::new()
            .soup_of(&[[a, b, c], [a, c, d]], opaque())
            .soup_of(&room.triangles(), two_sided)
            .build();
        let stage = stage_of(&scene, texels_per_metre, true);
        let (most, count) = most_light(&stage, &mut numbers, |point| is_inside(&stage, point));
        assert!(count > 0, "room {index} is empty");
        let thickness_texels = room.thickness_m / texel_m;
        assert_eq!(most, [0.0; 2], "room {index}, {count} points: {thickness_texels} texels of wall");
        let stage = stage_of(&scene, texels_per_metre, false);
        let (plain, _) = most_light(&stage, &mut numbers, |point| is_inside(&stage, point));
        leaked += usize::from(plain[0] > 0.1);
    }
    assert!(leaked > 8, "without walls in the maps only {leaked} of 24 rooms leak: the test sees nothing");
}

/// B6 and B21: no dark line runs along the sunny side of what lies or stands on the ground, although the ground below
/// never sees the sun: a decal, a kerb that is lower than a texel, a stone.
#[test]
fn no_dark_line_runs_round_what_lies_on_the_ground() {
    let [low, high] = [Vec3::new(-1.03, 0.0, -0.47), Vec3::new(1.31, 0.0, 0.58)];
    let [a, b, c, d] = [[-9.0f32, -9.0], [-9.0, 9.0], [9.0, 9.0], [9.0, -9.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let decal: Vec<[Vec3; 3]> = floor(low.xz(), high.xz(), 0.002).to_vec();
    let of_height = |height: f32| block(low, high.with_y(height)).to_vec();
    for (name, on_ground) in [("decal", decal), ("kerb", of_height(0.1)), ("stone", of_height(0.9))] {
        let scene = SceneBuilder::new().soup(&[[a, b, c], [a, c, d]]).soup(&on_ground).build();
        let stage = stage_of(&scene, 4.0, true);
        let noon = stage.moment(0.5);
        let page = Page::new(&stage.pages[0], stage.bits, 0.004_7);
        let mut least = 1.0f32;
        for step in 0..400 {
            // South of it, where it casts no shadow at noon.
            let (along, away) = (f64::from(step % 20) / 19.0, 0.01 + f64::from(step / 20) * 0.02);
            let x = f64::from(low.x) * (0.95 - 0.9 * along) + f64::from(high.x) * (0.05 + 0.9 * along);
            least = least.min(seen_on_ground(&stage, &page, &noon, [x, f64::from(high.z) + away]));
        }
        assert!(least > 0.99, "{name}: {least}");
    }
}

/// What filtered playback shows of the sun on level ground.
fn seen_on_ground(stage: &Stage, page: &Page, moment: &Moment, [x, z]: [f64; 2]) -> f32 {
    let above = DVec3::new(x, 0.5, z) - stage.scene.centre_m;
    let hit = stage.tracer().closest_hit(above, &Direction::new(-DVec3::Y)).unwrap();
    let corners = stage.corners(hit.triangle as usize);
    let [v, w] = hit.barycentric.map(|weight| weight as f32);
    let page_uv = corners.page_uv[0] * (1.0 - v - w) + corners.page_uv[1] * v + corners.page_uv[2] * w;
    page.sun_visibility(page_uv, Vec3::Y, Filter::Bilinear, moment)
}

/// B6: around the southern corners of boxes at noon, wherever they lie between texels of 25 cm and whether or not they
/// are turned, nothing is dark a little away from them.
#[test]
fn no_dark_texel_lies_at_the_foot_of_a_boxs_corner() {
    let [a, b, c, d] = [[-9.0f32, -9.0], [-9.0, 9.0], [9.0, 9.0], [9.0, -9.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    for (place, degrees) in [(0.0f32, 0.0f32), (0.3, 0.0), (0.7, 0.0), (0.1, 4.0), (0.5, -7.0)] {
        let middle = Vec2::new(place * 0.25, place * 0.17);
        let half = Vec2::new(1.17, 0.58);
        let turned = |[x, z]: [f32; 2]| middle + Vec2::from_angle(degrees.to_radians()).rotate(half * Vec2::new(x, z));
        let stone = block(-half.extend(0.0).xzy(), half.extend(0.9).xzy());
        let place_of = |p: Vec3| turned((p.xz() / half).to_array()).extend(p.y).xzy();
        let stone: Vec<[Vec3; 3]> = stone.iter().map(|triangle| triangle.map(place_of)).collect();
        let scene = SceneBuilder::new().soup(&[[a, b, c], [a, c, d]]).soup(&stone).build();
        let stage = stage_of(&scene, 4.0, true);
        let noon = stage.moment(0.5);
        let page = Page::new(&stage.pages[0], stage.bits, 0.004_7);
        for side in [-1.0f32, 1.0] {
            let corner = turned([side, 1.0]).as_dvec2();
            for step in 0..200 {
                // At an angle the corner's bounds reach a third of a texel beyond its sides.
                let least_m = if degrees == 0.0 { 0.03 } else { 0.1 };
                let (turn, away_m) = (f64::from(step % 10) * 0.1 + 0.35, least_m + f64::from(step / 10) * 0.015);
                let at = corner + away_m * DVec2::new(f64::from(side) * turn.cos(), turn.sin());
                let seen = seen_on_ground(&stage, &page, &noon, at.to_array());
                assert!(seen > 0.99, "{place} {degrees}: {seen} {away_m} m from the corner {corner}");
            }
        }
    }
}

/// B6 and B18, in cases 11, 20 and 27: floors of sealed rooms and houses of thin walls and sheets.
#[test]
fn sealed_rooms_of_the_cases_are_dark_at_any_density() {
    for case in ["11_leak/one.glb", "20_house/T0.1.glb", "20_house/T0.3.glb", "27_sheets/scene.glb"] {
        let file = workspace().join("tests/cases").join(case);
        let scene = sunbake::scene::load(&file, &LoadLimits::default()).unwrap();
        assert!(scene.materials.iter().all(|material| material.alpha == Alpha::Opaque));
        for texels_per_metre in [1.5, 4.0, 9.0] {
            let stage = stage_of(&scene, texels_per_metre, true);
            // A point that sees neither the sun nor any sky is sealed in; one that sees some back lies within a wall,
            // if walls are thick.
            let has_thick_walls = case.starts_with("20");
            let path = stage.path.clone().unwrap();
            let engine = ExactEngine::new(stage.tracer(), &[path]);
            let is_sealed = |point: &SurfacePoint| {
                if point.normal.y < 0.9 {
                    return false;
                }
                let from = point.position_m + point.normal * 0.02;
                for k in 0..128 {
                    let (y, turn) = ((f64::from(k) + 0.5) / 64.0 - 1.0, f64::from(k) * 2.4);
                    let level = (1.0 - y * y).sqrt();
                    let direction = DVec3::new(level * turn.cos(), y, level * turn.sin());
                    if direction.dot(point.normal) > 0.0 {
                        let hit = stage.tracer().closest_hit(from, &Direction::new(direction));
                        let Some(hit) = hit else { return false };
                        let is_front = stage.geometry.normal(hit.triangle as usize).dot(direction) < 0.0;
                        if has_thick_walls && !is_front {
                            return false;
                        }
                    }
                }
                lit_at(&engine, point)[0].as_slice().is_empty()
            };
            let (most, count) = most_light(&stage, &mut Numbers(3), is_sealed);
            assert!(count > 100, "{case}: {count}");
            assert_eq!(most[0], 0.0, "{case} at {texels_per_metre}, {count} points");
            // To ambient occlusion, a room without inner faces is a solid: its floor takes the darkest value outside.
            assert!(!has_thick_walls || most[1] == 0.0, "{case} at {texels_per_metre}: {} of sky", most[1]);
        }
    }
}
