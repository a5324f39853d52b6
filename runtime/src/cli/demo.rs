//! `sunplay demo`: bakes our own scene, plays its day back, and shows it beside truth.

use super::args::{AmbientChoice, DemoArgs, LightChoice, LookArgs, OutputChoice, TechniqueChoice};
use super::draw::{open_gpu, technique, view};
use super::files::{make_folder, write_rgb};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;
use sunbake::BakeReport;
use sunbake::console::{Command, Failure, ProgressLine, print, print_json, sentence, set_threads};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::{Date, DayRequest};
use sunbake_runtime::camera::CameraChoice;
use sunbake_runtime::compare::{mean, visibility_difference};
use sunbake_runtime::light::{clock_label, displayed};
use sunbake_runtime::shade::lit_picture;
use sunbake_runtime::sheet::{PictureTable, heat, heat_map};
use sunbake_runtime::technique::{Technique, Truth};
use sunbake_runtime::{Moment, Raster, Shot, Stage};

/// Where our scene lies, below the working directory or below the source.
const SCENE: &str = "assets/gas_station.glb";
/// The Mojave desert, in June.
const PLACE_DEG: [f64; 2] = [35.0, -116.0];
const UTC_OFFSET_H: f64 = -7.0;
const DATE: [u32; 3] = [2026, 6, 21];
/// Size of each picture on the sheet, and samples along each of a pixel's edges.
const SIZE: [u32; 2] = [400, 225];
const SUPERSAMPLE: u32 = 2;
/// Most columns of the sheet that stand side by side.
const MOST_COLUMNS: usize = 4;
/// Rays over the sun's disc for truth.
const TRUTH_RAYS: u32 = 32;

/// One column of the sheet.
struct Column {
    clock: String,
    pictures: [Raster<[u8; 3]>; 3],
    cost: ColumnCost,
}

/// What a column found.
#[derive(Debug, Clone, Serialize)]
struct ColumnCost {
    t: f64,
    mean_error: f64,
    baked_seconds: f64,
    truth_seconds: f64,
}

/// Bakes, draws, compares.
pub fn run(args: &DemoArgs) -> Result<(), Failure> {
    let start = Instant::now();
    set_threads(args.threads)?;
    make_folder(&args.output)?;
    let set = args.output.join("set");
    let progress = ProgressLine::new(args.printing.quiet);
    let scene = args.scene.clone().map_or_else(own_scene, Ok)?;
    let baked = bake(args, &scene, &set, &progress)?;
    let stage = Stage::read(&set)?;
    let look = look(args);
    let shot = Shot::new(&stage, view(&stage, &look, OutputChoice::Color)?);
    let gpu = open_gpu(&look, args.printing.quiet)?;
    let mut technique = technique(gpu.as_ref(), &stage, &look)?;
    progress.begin("drawing the day, baked and traced", u64::from(args.count));
    let mut columns = Vec::new();
    for i in 0..args.count {
        let t = (f64::from(i) + 0.5) / f64::from(args.count);
        columns.push(draw_column(technique.as_mut(), &shot, t)?);
        progress.step(1);
    }
    let contact = args.output.join("contact.png");
    write_rgb(&contact, &sheet(&columns, &baked).draw())?;
    drop(progress);
    let renderer = gpu.as_ref().map_or("the CPU", |gpu| &gpu.name);
    let summary = Summary::new(contact, set, &baked, &columns, renderer, start.elapsed().as_secs_f64());
    if args.printing.json {
        print_json(&summary)?;
    } else if !args.printing.quiet {
        print(&summary.text())?;
    }
    Ok(())
}

/// Our scene: beside the working directory or, failing that, where it was when this program was built.
fn own_scene() -> Result<PathBuf, Failure> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(SCENE);
    let found = [PathBuf::from(SCENE), source].into_iter().find(|path| path.is_file());
    found.ok_or_else(|| {
        Failure::io(format!("{SCENE} is not here: run the demo in sunbake's folder, or give --scene FILE"))
    })
}

fn bake(args: &DemoArgs, scene: &Path, set: &Path, progress: &ProgressLine) -> Result<BakeReport, Failure> {
    let [year, month, day] = DATE;
    let date = Date::new(year as i32, month, day)?;
    let sun = SunRequest::Day(DayRequest {
        latitude_deg: PLACE_DEG[0],
        longitude_deg: PLACE_DEG[1],
        date,
        utc_offset_h: Some(UTC_OFFSET_H),
        north_deg: 0.0,
        window: None,
    });
    let settings =
        BakeSettings { page_size_texels: args.page_size, threads: args.threads, ..BakeSettings::standard(sun) };
    Ok(sunbake::bake(scene, set, true, &settings, progress)?)
}

fn look(args: &DemoArgs) -> LookArgs {
    LookArgs {
        size: SIZE,
        camera: CameraChoice::Default,
        technique: TechniqueChoice::Baked,
        sun_samples: 1,
        lamp_range: None,
        map_size: None,
        cascades: None,
        bias: None,
        filter: None,
        supersample: Some(SUPERSAMPLE),
        light: LightChoice::Both,
        ambient: AmbientChoice::Best,
        renderer: args.renderer,
        threads: args.threads,
    }
}

fn draw_column(technique: &mut dyn Technique, shot: &Shot, t: f64) -> Result<Column, Failure> {
    let moment = Moment::new(shot.stage.path.as_ref(), t);
    let start = Instant::now();
    let baked_light = technique.color(shot, &moment)?;
    let baked_seconds = start.elapsed().as_secs_f64();
    let baked_seen = technique.visibility(shot, &moment)?;
    shot.hits();
    let start = Instant::now();
    let truth_seen = Truth::Soft { rays: TRUTH_RAYS }.visibility(shot, &moment)?;
    let truth_light = lit_picture(shot, &moment, &truth_seen, None);
    let truth_seconds = start.elapsed().as_secs_f64();
    let difference = visibility_difference(&baked_seen, &truth_seen);
    let pictures = [
        displayed(&baked_light, SUPERSAMPLE),
        displayed(&truth_light, SUPERSAMPLE),
        heat_map(&difference.reduced(SUPERSAMPLE)),
    ];
    let cost = ColumnCost { t, mean_error: mean(&difference), baked_seconds, truth_seconds };
    Ok(Column { clock: clock_label(shot.stage.path.as_ref(), t), pictures, cost })
}

fn sheet(columns: &[Column], baked: &BakeReport) -> PictureTable {
    let row = |k: usize| columns.iter().map(|column| column.pictures[k].clone()).collect();
    let stats = &baked.manifest.stats;
    PictureTable {
        title: vec![
            format!(
                "{}, {} from sunrise to sunset",
                baked.manifest.source.file,
                DATE.map(|n| format!("{n:02}")).join("-")
            ),
            format!(
                "{} texels at {:.1} texels/m, {} bits, {}, baked in {:.0} s, {:.1} MiB on disk",
                stats.texels,
                baked.manifest.scene.texels_per_metre,
                baked.manifest.bits,
                stats.engine,
                bake_seconds(baked),
                mib(stats.bytes)
            ),
        ],
        rows: vec![
            ("baked".into(), row(0)),
            (format!("truth, {TRUTH_RAYS} rays"), row(1)),
            ("difference".into(), row(2)),
        ],
        heads: columns.iter().map(|column| column.clock.clone()).collect(),
        feet: columns.iter().map(|column| format!("mean error {:.4}", column.cost.mean_error)).collect(),
        band: columns.len().div_ceil(columns.len().div_ceil(MOST_COLUMNS)) as u32,
        legend: (["0".into(), "1".into()], "difference of visibility; 0 is none, 1 is sun for shade".into()),
        legend_color: |share| heat(sunbake_runtime::texture::srgb_from_linear(share)),
    }
}

fn bake_seconds(baked: &BakeReport) -> f64 {
    let s = &baked.manifest.stats.seconds;
    s.load + s.unwrap + s.bvh + s.visibility + s.ambient + s.encode + s.write
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// What the demo tells at its end.
#[derive(Debug, Serialize)]
struct Summary<'a> {
    contact: PathBuf,
    set: PathBuf,
    warnings: Vec<String>,
    bake_seconds: f64,
    bytes: u64,
    renderer: &'a str,
    mean_error: f64,
    columns: Vec<ColumnCost>,
    seconds: f64,
}

impl<'a> Summary<'a> {
    fn new(
        contact: PathBuf,
        set: PathBuf,
        baked: &'a BakeReport,
        columns: &[Column],
        renderer: &'a str,
        seconds: f64,
    ) -> Self {
        let columns: Vec<ColumnCost> = columns.iter().map(|column| column.cost.clone()).collect();
        Self {
            contact,
            set,
            warnings: baked.warnings.iter().map(|warning| sentence(warning, Command::Sunplay)).collect(),
            bake_seconds: bake_seconds(baked),
            bytes: baked.manifest.stats.bytes,
            renderer,
            mean_error: columns.iter().map(|c| c.mean_error).sum::<f64>() / columns.len().max(1) as f64,
            columns,
            seconds,
        }
    }

    fn text(&self) -> String {
        let mean = |seconds: fn(&ColumnCost) -> f64| {
            self.columns.iter().map(seconds).sum::<f64>() / self.columns.len().max(1) as f64
        };
        format!(
            "  {:40} the day, baked beside truth, with the difference\n  {:40} the set: {:.1} MiB, baked in {:.1} s\n\
             baked   {:8.3} s a frame on {}; mean error of visibility {:.4}\n\
             truth   {:8.3} s a frame on the CPU, {TRUTH_RAYS} rays a sample\n\
             all of it took {:.0} s; next: sunplay frames {} --count 24 -o day\n",
            self.contact.display().to_string(),
            self.set.display().to_string(),
            mib(self.bytes),
            self.bake_seconds,
            mean(|c| c.baked_seconds),
            self.renderer,
            self.mean_error,
            mean(|c| c.truth_seconds),
            self.seconds,
            self.set.display(),
        )
    }
}
