//! Every option of `sunplay compare`.

use super::super::args::{RendererChoice, SUN_HEADING};
use super::super::place::parse_camera;
use super::super::values::parse_size;
use super::super::when::parse_when;
use clap::Args as ClapArgs;
use std::path::PathBuf;
use sunbake::console::{DensityArgs, ObjectArgs, SunArgs};
use sunbake_runtime::camera::CameraChoice;
use sunbake_runtime::compare::Limit;
use sunbake_runtime::light::TimeChoice;

#[derive(Debug, ClapArgs)]
pub struct CompareArgs {
    /// A set's folder, or a scene (.gltf or .glb), which is baked first.
    ///
    /// A scene is baked twice, with 16 bits and with one lane, with shadow tracks, and three across the sun's disc, for
    /// as long as it is compared. A set is compared as it is, with what fewer bits and lanes can be made of it.
    pub source: PathBuf,
    /// Folder to write the report to: report.html, report.json and, where something baked was compared, sheet.png.
    #[arg(short, long, value_name = "REPORT")]
    pub output: PathBuf,
    /// Replace an older report in that folder.
    #[arg(long)]
    pub force: bool,
    /// Of a set: the scene that it was baked of, to make sure that it still is that one.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// What to compare, of: baked, volumes, map, truth, or parts of their names. [default: all]
    ///
    /// Names are those of the report: baked:16:lanes3:filtered, volumes, map:pcss, truth:hard. A family with parts of a
    /// name stands for all that have them: `baked:8`, `baked:nearest`, `map`. volumes:MODE and truth:soft:N are
    /// compared if they are named.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub techniques: Vec<String>,
    /// The reference: truth:soft, truth:soft:N, truth:hard, or any of what can be compared.
    #[arg(long, value_name = "NAME", default_value = "truth:soft")]
    pub against: String,
    /// When: HH:MM by the set's local clocks, or a fraction of its path. May be given several times. [default: five
    /// times]
    ///
    /// Unless given, five times from a low sun in the morning to one in the evening.
    #[arg(long, value_name = "HH:MM|T", value_parser = parse_when)]
    pub at: Vec<TimeChoice>,
    /// A camera of the scene by name or as `camera:N`, `default`, or `ex,ey,ez,tx,ty,tz[,fov]`. May be given several
    /// times. [default: three]
    ///
    /// Unless given, three cameras that see the edges of shadows: the scene's own, all of it, or a part from close by.
    #[arg(long, value_name = "CAMERA", value_parser = parse_camera, allow_hyphen_values = true)]
    pub camera: Vec<CameraChoice>,
    /// Width and height of pictures, in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "640x360")]
    pub size: [u32; 2],
    /// How often each picture is drawn and timed, 1 to 100; the least of its times counts. [default: 3, or 1 without a
    /// real GPU]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100))]
    pub rounds: Option<u32>,
    /// Edge of shadow maps in texels, 16 to 16384. [default: 2048]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=16384))]
    pub map_size: Option<u32>,
    /// Of a scene: edge of the page it is baked into, 64 to 16384. [default: 2048]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(64..=16384))]
    pub page_size: Option<u32>,
    #[command(flatten, next_help_heading = "Objects of a scene")]
    pub objects: ObjectArgs,
    #[command(flatten, next_help_heading = "Objects of a scene")]
    pub densities: DensityArgs,
    /// Exit with code 6 if any technique is above a limit: visibility=0.02,wrong=0.01.
    ///
    /// Keys: visibility (mean error), rms (root of the mean square), p99, worst, wrong (share of pixels off by more
    /// than a half), penumbra, outside (mean errors there), leak (mean light where truth has none), shade (mean shade
    /// where it has none), dissimilarity (1 less the structural similarity), frame_ms, mib. The report is written all
    /// the same. Name what it is to hold for with --techniques.
    #[arg(long, value_name = "KEY=N", value_delimiter = ',')]
    pub fail_above: Vec<Limit>,
    #[command(flatten, next_help_heading = SUN_HEADING)]
    pub sun: SunArgs,
    /// What draws: the GPU if there is one, the GPU, or the CPU, which draws neither volumes nor maps.
    #[arg(long, value_enum, default_value_t = RendererChoice::Auto)]
    pub renderer: RendererChoice,
    /// Threads of the CPU; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Print the report as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}
