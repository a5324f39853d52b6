//! How surfaces look, and where light ends on them.

use super::tools::{must, node, scene, settings, stage};
use super::{Found, Row};
use glam::{DVec3, Vec3};
use sunbake::scene::{Geometry, Scene};
use sunbake::sun::{DayOutcome, SunPath, day};
use sunbake::trace::Tracer;
use sunbake::visibility::{ExactEngine, lit_at};
use sunbake_runtime::technique::{BakedCpu, Technique};
use sunbake_runtime::testing::view;
use sunbake_runtime::{Filter, Shot};
use sunbake_tests::{Traced, june_day};

pub const ROWS: &[Row] = &[
    Row::new("05_terminator", "light ends on the ball where it ends on a sphere", light_ends_as_on_a_sphere),
    Row::new("24_emissive", "a dark crate with one small yellow square", one_square_shines),
    Row::new("21_decal", "no dark line runs round what lies on the road", no_line_runs_round_decals),
];

/// Share of points and times at which light on the ball is not what it is on the sphere around it.
fn wrong_share(here: &Traced, path: &SunPath) -> f64 {
    let centre_m = DVec3::new(0.0, 1.3, 0.0) - here.scene.centre_m;
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(path));
    let (mut wrong, mut count) = (0.0, 0.0);
    for triangle in 0..here.geometry.triangles.len() {
        let instance = here.geometry.instance[triangle] as usize;
        let node = &here.scene.nodes[here.scene.instances[instance].node];
        if node.name.as_deref() != Some("ball") {
            continue;
        }
        for barycentric in [[1.0 / 3.0; 2], [0.1, 0.1], [0.8, 0.1], [0.1, 0.8], [0.45, 0.45], [0.45, 0.1]] {
            let point = here.point(triangle, barycentric);
            let normal = (point.position_m - centre_m).normalize();
            let lit = lit_at(&engine, &point).swap_remove(0);
            for k in 0..96 {
                let t = (f64::from(k) + 0.5) / 96.0;
                let is_lit = normal.dot(path.direction(t)) > 0.0;
                wrong += f64::from(u8::from(is_lit != lit.contains(t)));
                count += 1.0;
            }
        }
    }
    assert!(count > 0.0, "there is no ball");
    wrong / count
}

fn faceted(scene: Scene) -> Traced {
    let geometry = Geometry::faceted(&scene);
    let tracer = Tracer::new(&scene, &geometry);
    Traced { scene, geometry, tracer }
}

/// B19.
fn light_ends_as_on_a_sphere() -> Found {
    let Ok(DayOutcome::Path(path)) = day(&june_day()) else { return Err("no sun in June".into()) };
    let scene = scene("05_terminator/scene.glb");
    let [smooth, flat] = [Traced::new(scene.clone()), faceted(scene)].map(|here| wrong_share(&here, &path));
    let text = format!("{:.2} % of points and times are wrong, {:.2} % by facets", 100.0 * smooth, 100.0 * flat);
    must(smooth < 0.5 * flat && smooth < 0.03, || text.clone())?;
    Ok(text)
}

/// Light that is left without sun and sky.
fn one_square_shines() -> Found {
    let stage = stage(&scene("24_emissive/scene.glb"), &settings());
    let shot = Shot::new(&stage, view(&stage, DVec3::new(3.0, 2.0, 4.0), DVec3::new(0.0, 0.5, 0.0), [192, 144]));
    let moment = stage.moment(0.5).without_sun().without_sky();
    let light = BakedCpu::new(&stage, Filter::Bilinear).color(&shot, &moment).map_err(|error| error.to_string())?;
    let of_surfaces = || light.pixels.iter().zip(shot.hits()).filter_map(|(light, hit)| hit.map(|hit| (light, hit)));
    let is_yellow = |light: &Vec3| light.x > 0.4 && light.y > 0.4 && light.z < 0.2;
    let is_dark = |light: &Vec3| light.max_element() < 0.02;
    let on_crate = of_surfaces()
        .filter(|(_, hit)| node(&stage, stage.geometry.instance[hit.triangle as usize] as usize) == "radio");
    let (mut yellow, mut dark, mut all) = (0, 0, 0);
    for (light, _) in on_crate {
        yellow += u32::from(is_yellow(light));
        dark += u32::from(is_dark(light));
        all += 1;
    }
    let text = format!("{yellow} of {all} pixels of the crate are yellow, {dark} dark");
    must(yellow > 5 && 20 * yellow < all && 10 * dark > 9 * all, || text.clone())?;
    must(of_surfaces().all(|(light, _)| is_dark(light) || is_yellow(light) || light.x >= light.z), || text.clone())?;
    Ok(text)
}

/// Filtered playback on the road beside the decals, while the sun is so high that they cast less than their height: a
/// line would be darker than the road by itself.
fn no_line_runs_round_decals() -> Found {
    let stage = stage(&scene("21_decal/scene.glb"), &settings());
    let path = stage.path.clone().expect("a sun");
    let pages: Vec<_> = (stage.pages.iter())
        .map(|page| sunbake_runtime::playback::Page::new(page, stage.bits, path.angular_radius_rad))
        .collect();
    let down = sunbake::trace::Direction::new(-DVec3::Y);
    let (mut least, mut count) = (1.0f32, 0);
    for (i, j) in (0..240).flat_map(|i| (0..160).map(move |j| (i, j))) {
        let at = DVec3::new(f64::from(i) * 0.0133 - 1.6, 1.0, f64::from(j) * 0.0125 - 1.0) - stage.scene.centre_m;
        let Some(hit) = stage.eye_tracer().closest_hit(at, &down) else { continue };
        if node(&stage, stage.geometry.instance[hit.triangle as usize] as usize) != "road" {
            continue;
        }
        let (page, page_uv) = stage.page_uv(&hit).expect("the road has texels");
        for k in 0..5 {
            let moment = stage.moment(0.4 + 0.05 * f64::from(k));
            let seen = pages[page as usize].sun_visibility(page_uv, Vec3::Y, Filter::Bilinear, &moment);
            least = least.min(seen);
        }
        count += 1;
    }
    let text = format!("the darkest of {count} points beside the decals sees {least:.3} of the sun");
    must(count > 1000 && least > 0.9, || text.clone())?;
    Ok(text)
}
