//! The models of ambient light side by side, and the bytes that each reads.
//!
//!     cargo run --release --example ambient_models -- SET SHEET.png [T]
//!
//! Draws a set that was baked with `--bent --sky sh2` through the scene's default camera at path time T (0.12 unless
//! given) on the CPU: by the normal alone, with ambient occlusion, with bent normals and with the sky in spherical
//! harmonics; the sky alone, the sun with it, and how far the first is from what the normal alone says.

mod common;

use common::{Anything, write};
use std::path::Path;
use std::time::Instant;
use sunbake::maps::{Bits, GpuTexel, PageMaps};
use sunbake::sun::clock_text;
use sunbake_runtime::light::{LUMINANCE, displayed};
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{BakedCpu, Technique};
use sunbake_runtime::texture::srgb_from_linear;
use sunbake_runtime::{AmbientModel, Camera, Filter, Moment, Raster, Shot, Stage, View};

/// Size of each picture, and samples along each of a pixel's edges.
const SIZE: [u32; 2] = [360, 220];
const SUPERSAMPLE: u32 = 2;
const MODELS: [(AmbientModel, &str); 4] = [
    (AmbientModel::Hemisphere, "the normal alone"),
    (AmbientModel::Occlusion, "ambient occlusion"),
    (AmbientModel::Bent, "bent normals"),
    (AmbientModel::Sky, "the sky in harmonics"),
];

/// A model's pictures: the sky alone, and with the sun.
struct Column {
    sky: Raster<glam::Vec3>,
    both: Raster<glam::Vec3>,
    foot: String,
}

fn main() -> Result<(), Anything> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [set, sheet, time @ ..] = args.as_slice() else {
        return Err("give a set, a file to write, and perhaps a path time".into());
    };
    let t: f64 = time.first().map_or(Ok(0.12), |t| t.parse())?;
    let columns = MODELS.iter().map(|&(model, _)| draw(Path::new(set), model, t)).collect::<Result<Vec<_>, _>>()?;
    let path = Stage::read(Path::new(set))?.path;
    let clock = path.and_then(|path| path.clock_min(t)).map_or_else(|| format!("t {t:.3}"), clock_text);
    write(Path::new(sheet), &table(&columns, &clock).draw())
}

fn draw(set: &Path, model: AmbientModel, t: f64) -> Result<Column, Anything> {
    let stage = Stage::read(set)?.with_ambient(model);
    let camera = Camera::default_of(&stage, f64::from(SIZE[0]) / f64::from(SIZE[1]));
    let shot = Shot::new(&stage, View::new(&camera, SIZE.map(|edge| edge * SUPERSAMPLE), &stage.scene));
    let moment = Moment::new(stage.path.as_ref(), t);
    let mut technique = BakedCpu::new(&stage, Filter::Bilinear);
    shot.hits();
    let start = Instant::now();
    let both = technique.color(&shot, &moment)?;
    let seconds = start.elapsed().as_secs_f64();
    let sky = technique.color(&shot, &moment.without_sun())?;
    let bytes = stage.pages.iter().map(|page| ambient_bytes(page, stage.bits)).max().unwrap_or(0);
    Ok(Column { sky, both, foot: format!("{bytes} bytes a texel, {seconds:.2} s") })
}

/// Bytes of ambient light for each texel.
fn ambient_bytes(page: &PageMaps, bits: Bits) -> u64 {
    GpuTexel { layers: 0, walls: false, ..page.gpu_texel(bits) }.bytes()
}

fn table(columns: &[Column], clock: &str) -> PictureTable {
    let sky = columns.iter().map(|column| displayed(&column.sky, SUPERSAMPLE)).collect();
    let both = columns.iter().map(|column| displayed(&column.both, SUPERSAMPLE)).collect();
    let apart = |column: &Column| {
        let pairs = column.sky.pixels.iter().zip(&columns[0].sky.pixels);
        let pixels = pairs.map(|(a, b)| (*a - *b).dot(LUMINANCE).abs().min(1.0)).collect();
        heat_map(&Raster { size: column.sky.size, pixels }.reduced(SUPERSAMPLE))
    };
    PictureTable {
        title: vec![
            format!("Ambient light, {clock}"),
            "below each column, what it reads and the time of a frame".into(),
        ],
        rows: vec![
            ("sky alone".into(), sky),
            ("sun and sky".into(), both),
            ("difference".into(), columns.iter().map(apart).collect()),
        ],
        heads: MODELS.iter().map(|(_, name)| (*name).to_owned()).collect(),
        feet: columns.iter().map(|column| column.foot.clone()).collect(),
        band: MODELS.len() as u32,
        legend: (["0".into(), "1".into()], "luminance of the sky alone, against the normal alone".into()),
        legend_color: |share| heat(srgb_from_linear(share)),
    }
}
