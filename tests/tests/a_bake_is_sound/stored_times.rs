//! Stored times against brute force that shares no code with the baker.

use crate::{courtyard, temporary};
use glam::DVec3;
use sunbake::texels::draw;
use sunbake_tests::{CODE_STEP_T, bake_scene, quick};

/// An oracle of its own: f64 Moeller-Trumbore over all triangles, the sun from the manifest's own numbers. Each
/// stored time is the edge of a shadow to a code step, and what is stored between them is right.
#[test]
fn stored_times_agree_with_brute_force_within_a_code_step() {
    const MOMENTS: usize = 1024;
    let folder = temporary();
    let scene = courtyard().build();
    let set = bake_scene(&scene, &quick(), folder.path(), "yard");
    let path = set.manifest.path.as_ref().expect("a June day has a sun");
    let [ref arc] = path.arcs[..] else { panic!("one arc does for this day") };
    let triangles: Vec<[DVec3; 3]> = sunbake::scene::Geometry::new(&scene)
        .triangles
        .iter()
        .map(|t| t.map(|v| v.as_dvec3() + scene.centre_m))
        .collect();
    let mut edges = 0;
    // Of buried texels, nobody sees what is stored.
    for texel in draw(&set, 300, 5).expect("the scene loads").into_iter().filter(|texel| !texel.is_filled) {
        let is_lit = |t: f64| {
            let sun = sun_of(arc, t);
            let is_in_front = DVec3::from(texel.normal).dot(sun) > 0.0;
            let origin = if is_in_front { Some(texel.origin) } else { texel.origin_back };
            sun.y > 0.0 && origin.is_some_and(|o| !triangles.iter().any(|c| hits(o.into(), sun, c)))
        };
        let ends = texel.lit.as_flattened();
        for t in (0..MOMENTS).map(|i| (i as f64 + 0.5) / MOMENTS as f64) {
            let stored = texel.lit.iter().any(|[a, b]| (a..=b).contains(&&t));
            let beside = ends.iter().any(|end| (end - t).abs() <= CODE_STEP_T);
            assert!(beside || stored == is_lit(t), "{texel:?} at {t}: stored {stored}");
        }
        for (i, &end) in ends.iter().enumerate().filter(|(_, end)| (CODE_STEP_T..1.0 - CODE_STEP_T).contains(*end)) {
            let [before, after] = [-CODE_STEP_T, CODE_STEP_T].map(|off_t| is_lit(end + off_t));
            assert!((before, after) == (i % 2 == 1, i % 2 == 0), "{texel:?} at {end}: {before}, then {after}");
            edges += 1;
        }
    }
    assert!(edges > 200, "only {edges} edges");
}

fn sun_of(arc: &sunbake::disk::manifest::ArcEntry, t: f64) -> DVec3 {
    let [h0, h1] = arc.hour_angle_deg;
    let h = (h0 + (h1 - h0) * (t - arc.t[0]) / (arc.t[1] - arc.t[0])).to_radians();
    let d = arc.declination_deg.to_radians();
    let (axis, zero) = (DVec3::from(arc.axis), DVec3::from(arc.zero));
    (zero * h.cos() + axis.cross(zero) * h.sin()) * d.cos() + axis * d.sin()
}

fn hits(origin: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let inverse = 1.0 / e1.dot(p);
    let s = origin - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(e1);
    let (v, t) = (direction.dot(q) * inverse, e2.dot(q) * inverse);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0
}
