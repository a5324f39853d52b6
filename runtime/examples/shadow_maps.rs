//! Every kind of shadow map beside truth, and how they differ, on one sheet.
//!
//!     cargo run --release --example shadow_maps -- SHEET.png [SCENE [HH:MM [MAP_SIZE]]]
//!
//! Draws our own scene from nearby, or another through its default camera, on a June day in the desert, at 17:00
//! unless told otherwise, with maps of 1024 texels. Hard variants are compared with truth of the sun's centre, soft
//! ones against truth of its disc.

mod common;

use common::{Anything, write};
use glam::DVec3;
use std::path::Path;
use sunbake::scene::{LoadLimits, load};
use sunbake::sun::{DayOutcome, DayRequest, SunPath, day};
use sunbake_runtime::compare::{mean, visibility_difference};
use sunbake_runtime::gpu::Gpu;
use sunbake_runtime::light::displayed;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{ShadowMaps, Technique, Truth};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{Camera, Moment, Shot, Stage, View};

/// Size of each picture.
const SIZE: [u32; 2] = [330, 220];
/// Where our own scene is looked at from, and what is looked at, world space: the canopy's shadow, the pumps and the
/// wall.
const EYE_M: DVec3 = DVec3::new(18.0, 3.0, 4.0);
const TARGET_M: DVec3 = DVec3::new(5.0, 0.8, -3.0);
/// Columns that stand side by side.
const BAND: u32 = 5;
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 64;

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let Some(sheet) = args.first() else { return Err("give a file to write".into()) };
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/gas_station.glb");
    let scene = load(Path::new(args.get(1).map_or(own, String::as_str)), &LoadLimits::default())?;
    let clock = args.get(2).map_or("17:00", String::as_str);
    let size_texels = args.get(3).map_or(Ok(1024), |n| n.parse())?;
    let stage = Stage::plain(scene, Some(june()?));
    let moment = Moment::new(stage.path.as_ref(), at(stage.path.as_ref(), clock)?);
    let gpu = Gpu::open()?;
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let camera = match args.get(1) {
        None => Camera::look_at(EYE_M - stage.scene.centre_m, TARGET_M - stage.scene.centre_m, 0.8),
        Some(_) => None,
    };
    let camera = camera.unwrap_or_else(|| Camera::default_of(&stage, aspect));
    let shot = Shot::new(&stage, View::new(&camera, SIZE, &stage.scene));
    let truths = [Truth::Hard, Truth::Soft { rays: TRUTH_RAYS }].map(|mut truth| -> Result<_, Anything> {
        Ok((truth.visibility(&shot, &moment)?, displayed(&truth.color(&shot, &moment)?, 1)))
    });
    let [hard, soft] = truths;
    let (hard, soft) = (hard?, soft?);
    let mut table = PictureTable {
        title: vec![
            format!("shadow maps of {size_texels} texels at {clock}"),
            "under each its mean error: hard variants against truth of the sun's centre, soft ones of its disc".into(),
        ],
        rows: ["map", "truth", "difference"].map(|name| (name.to_owned(), Vec::new())).into(),
        heads: Vec::new(),
        feet: Vec::new(),
        band: BAND,
        legend: (["0".into(), "1".into()], "difference of visibility; 0 is none, 1 is sun for shade".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    };
    for variant in Variant::ALL {
        let settings = MapSettings { size_texels, ..MapSettings::new(variant) };
        let mut maps = ShadowMaps::new(&gpu, &stage, settings)?;
        let (truth, truth_picture) = if variant.is_soft() { &soft } else { &hard };
        let difference = visibility_difference(&maps.visibility(&shot, &moment)?, truth);
        let error = mean(&difference);
        let bytes = maps.bytes() as f64 / f64::from(1 << 20);
        println!("{:16} mean error {error:.4}, {bytes:.1} MiB", variant.to_string());
        let pictures = [displayed(&maps.color(&shot, &moment)?, 1), truth_picture.clone(), heat_map(&difference)];
        table.rows.iter_mut().zip(pictures).for_each(|((_, row), picture)| row.push(picture));
        table.heads.push(variant.to_string());
        table.feet.push(format!("{error:.4}, {bytes:.1} MiB"));
    }
    write(Path::new(sheet), &table.draw())
}

fn june() -> Result<SunPath, Anything> {
    let request = DayRequest {
        latitude_deg: 35.0,
        longitude_deg: -116.0,
        date: "2026-06-21".parse()?,
        utc_offset_h: Some(-7.0),
        north_deg: 0.0,
        window: None,
    };
    match day(&request)? {
        DayOutcome::Path(path) => Ok(path),
        DayOutcome::NoSun { .. } => Err("the sun does not rise".into()),
    }
}

/// The path time of a clock time.
fn at(path: Option<&SunPath>, clock: &str) -> Result<f64, Anything> {
    let (hours, minutes) = clock.split_once(':').ok_or("give a time as HH:MM")?;
    let wanted_min = 60.0 * hours.parse::<f64>()? + minutes.parse::<f64>()?;
    let times = (0..=10_000).map(|i| f64::from(i) / 10_000.0);
    let off = |t: &f64| path.and_then(|path| path.clock_min(*t)).map_or(f64::INFINITY, |min| (min - wanted_min).abs());
    times.min_by(|a, b| off(a).total_cmp(&off(b))).ok_or_else(|| "there is no such time".into())
}
