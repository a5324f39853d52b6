//! Shadows that are narrower than texels, close by: as texels show them, as tracks do, and as rays do.
//!
//!     cargo run --release --bin sunbake -- bake assets/gas_station.glb -o SET --only intervals --tracks OPTIONS
//!     cargo run --release --example track_sheet -- SET SHEET.png [OBJECT]
//!
//! SET is our own scene. The picket fence is seen at five times of its day, other narrow things at one each; given an
//! OBJECT of these, it alone is drawn.

mod common;

use common::{Anything, write};
use glam::DVec3;
use std::path::Path;
use sunbake::sun::clock_text;
use sunbake_runtime::compare::{mean, visibility_difference};
use sunbake_runtime::light::displayed;
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{BakedCpu, Technique, Truth};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{Camera, Filter, Shot, Stage, View};

/// Size of each picture.
const SIZE: [u32; 2] = [300, 200];
/// Columns that stand side by side.
const BAND: u32 = 5;
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 64;
/// Vertical field of view.
const FOV_RAD: f64 = 0.9;

/// An object, where it is looked at from and what is looked at, from its foot, metres; and when, as path times.
type Look = (&'static str, [f64; 3], [f64; 3], &'static [f64]);

const LOOKS: [Look; 6] = [
    ("fence west 1", [3.2, 1.5, -3.6], [-0.2, 0.2, 0.4], &[0.1, 0.3, 0.5, 0.7, 0.9]),
    ("wind pump tower", [6.0, 2.2, 5.0], [1.0, 0.0, 0.0], &[0.25]),
    ("pergola", [5.0, 2.6, 4.5], [0.0, 0.0, 0.0], &[0.5]),
    ("tree 0 wood", [5.0, 2.5, 5.0], [0.5, 0.0, 0.0], &[0.4]),
    ("post south 0", [3.0, 1.6, 3.0], [1.0, 0.0, 0.0], &[0.4]),
    ("water tank", [6.0, 2.4, 5.0], [1.0, 0.0, 0.0], &[0.25]),
];

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [set, sheet, object @ ..] = args.as_slice() else { return Err("give a set and a file to write".into()) };
    let stage = Stage::read(Path::new(set))?;
    let filters = [("filtered", Filter::Bilinear), ("tracks", Filter::Tracks)];
    let mut table = PictureTable {
        title: vec![
            "shadows narrower than texels, as texels, shadow tracks and rays show them".into(),
            "under each the mean error of visibility: filtered, then tracks".into(),
        ],
        rows: ["filtered", "tracks", "truth", "error", "of tracks"].map(|name| (name.to_owned(), Vec::new())).into(),
        heads: Vec::new(),
        feet: Vec::new(),
        band: BAND,
        legend: (["0".into(), "1".into()], "error of visibility: filtered above, tracks below".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    };
    let is_asked = |look: &Look| object.first().is_none_or(|object| object == look.0);
    for (name, eye, target, times) in LOOKS.into_iter().filter(is_asked) {
        let Some(foot_m) = foot(&stage, name) else { return Err(format!("the scene has no {name}").into()) };
        let [eye, target] = [eye, target].map(|from_foot| foot_m + DVec3::from(from_foot));
        let camera = Camera::look_at(eye, target, FOV_RAD).ok_or("a camera that looks nowhere")?;
        let shot = Shot::new(&stage, View::new(&camera, SIZE, &stage.scene));
        for &t in times {
            let moment = stage.moment(t);
            let mut truth = Truth::Soft { rays: TRUTH_RAYS };
            let seen = truth.visibility(&shot, &moment)?;
            let mut pictures = Vec::new();
            let mut differences = Vec::new();
            for (_, filter) in filters {
                let mut baked = BakedCpu::new(&stage, filter);
                pictures.push(displayed(&baked.color(&shot, &moment)?, 1));
                differences.push(visibility_difference(&baked.visibility(&shot, &moment)?, &seen));
            }
            pictures.push(displayed(&truth.color(&shot, &moment)?, 1));
            pictures.extend(differences.iter().map(heat_map));
            table.rows.iter_mut().zip(pictures).for_each(|((_, row), picture)| row.push(picture));
            let clock = stage.path.as_ref().and_then(|path| path.clock_min(t)).map(clock_text).unwrap_or_default();
            let errors = differences.iter().map(|difference| format!("{:.3}", mean(difference)));
            table.feet.push(errors.collect::<Vec<_>>().join("  "));
            table.heads.push(format!("{name}, {clock}"));
            println!("{name} {clock}: {}", table.feet.last().map_or("", String::as_str));
        }
    }
    write(Path::new(sheet), &table.draw())
}

/// The middle of the lowest part of an object, bake space.
fn foot(stage: &Stage, name: &str) -> Option<DVec3> {
    let scene = &stage.scene;
    let is_it = |node: &sunbake::scene::Node| node.name.as_deref() == Some(name);
    let instance = scene.instances.iter().position(|instance| is_it(&scene.nodes[instance.node]))?;
    let first = &stage.geometry.first_triangle;
    let corners = || stage.geometry.triangles[first[instance] as usize..first[instance + 1] as usize].iter().flatten();
    let low = corners().fold(glam::Vec3::INFINITY, |a, b| a.min(*b)).as_dvec3();
    let high = corners().fold(glam::Vec3::NEG_INFINITY, |a, b| a.max(*b)).as_dvec3();
    Some(((low + high) * 0.5).with_y(low.y))
}
