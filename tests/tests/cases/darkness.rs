//! Sealed rooms on a floor that runs on outside: filtered playback shows no light in them.

use super::tools::{must, scene, settings};
use super::{Found, Row};
use glam::DVec3;
use sunbake::atlas::Density;
use sunbake::settings::BakeSettings;
use sunbake_runtime::Filter;
use sunbake_runtime::playback::Page;
use sunbake_runtime::stage::Stage;

pub const ROWS: &[Row] = &[
    Row::new("11_leak", "no light inside, filtered, at any density", || dark("11_leak/one.glb", "floor")),
    Row::new("20_house", "no light inside, filtered, at any density: walls of 10 cm", || {
        dark("20_house/T0.1.glb", "lawn")
    }),
    Row::new("20_house", "no light inside, filtered, at any density: walls of 30 cm", || {
        dark("20_house/T0.3.glb", "lawn")
    }),
    Row::new("27_sheets", "no light inside, filtered, at any density", || dark("27_sheets/scene.glb", "slab")),
];

/// Texels a metre.
const DENSITIES: [f64; 3] = [1.5, 4.0, 9.0];
/// Points along an edge of the lattice over the floor.
const POINTS: usize = 300;

/// The most light of the day on points of the floor that closed walls surround: those from which rays in all directions
/// above the floor meet something.
fn dark(name: &str, floor: &str) -> Found {
    let scene = scene(name);
    let mut inside = 0;
    for density in DENSITIES {
        let settings = BakeSettings { density: Density::TexelsPerMetre(density), page_size_texels: 1024, ..settings() };
        let stage = super::tools::stage(&scene, &settings);
        let (most, count) = most_light(&stage, floor);
        must(count > 1000, || format!("only {count} points inside"))?;
        must(most == 0.0, || format!("{most} of the sun at {density} texels a metre, {count} points"))?;
        inside += count;
    }
    Ok(format!("0 at {inside} points, {DENSITIES:?} texels a metre"))
}

fn most_light(stage: &Stage, floor: &str) -> (f32, usize) {
    let path = stage.path.as_ref().expect("a sun");
    let pages: Vec<Page> =
        stage.pages.iter().map(|page| Page::new(page, stage.bits, path.angular_radius_rad)).collect();
    let moments: Vec<_> = (0..12).map(|k| stage.moment((f64::from(k) + 0.5) / 12.0)).collect();
    let (mut most, mut count) = (0.0f32, 0);
    for triangle in 0..stage.geometry.triangles.len() {
        let instance = stage.geometry.instance[triangle] as usize;
        let normal = stage.geometry.normal(triangle);
        if super::tools::node(stage, instance) != floor || normal.y < 0.9 {
            continue;
        }
        let chart = stage.chart(instance).expect("it is drawn");
        let [a, b, c] = stage.corners(triangle).page_uv;
        for (i, j) in (0..POINTS).flat_map(|i| (0..POINTS - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| (k as f64 + 1.0 / 3.0) / POINTS as f64);
            let point_m = stage.geometry.point(triangle, [u, v]);
            if !is_inside(stage, point_m + normal * 1e-4) {
                continue;
            }
            count += 1;
            let page_uv = a * (1.0 - u - v) as f32 + b * u as f32 + c * v as f32;
            let page = &pages[chart.page as usize];
            let light = |moment| page.sun_visibility(page_uv, normal.as_vec3(), Filter::Bilinear, moment);
            most = moments.iter().map(light).fold(most, f32::max);
        }
    }
    (most, count)
}

/// Whether rays in many directions above a point all meet a triangle: by Möller and Trumbore's test, in `f64`.
fn is_inside(stage: &Stage, from_m: DVec3) -> bool {
    let directions = (0..48).map(|k| {
        let height = (f64::from(k) + 0.5) / 48.0;
        let (sin, cos) = (f64::from(k) * 2.399_963_229_728_653).sin_cos();
        let level = (1.0 - height * height).sqrt();
        DVec3::new(level * cos, height, level * sin)
    });
    directions.into_iter().all(|direction| {
        stage.geometry.triangles.iter().any(|corners_m| {
            let [a, b, c] = corners_m.map(|corner| corner.as_dvec3());
            let (along, across) = (b - a, c - a);
            let p = direction.cross(across);
            let determinant = along.dot(p);
            let s = from_m - a;
            let q = s.cross(along);
            let [u, v, distance_m] = [s.dot(p), direction.dot(q), across.dot(q)].map(|x| x / determinant);
            determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance_m > 0.0
        })
    })
}
