//! Every option, with its range and its default.

use super::compare::args::CompareArgs;
use super::place::parse_camera;
use super::values::{parse_range, parse_size, parse_technique};
use super::when::parse_when;
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use sunbake::console::{ObjectArgs, SunArgs};
use sunbake_runtime::camera::CameraChoice;
use sunbake_runtime::light::TimeChoice;
use sunbake_runtime::shadow_maps::{Bias, Variant};
use sunbake_runtime::technique::Truth;
use sunbake_runtime::volumes::Mode;
use sunbake_runtime::{AmbientModel, Filter};

/// Heading of the sun's options. A set has its own sun.
pub const SUN_HEADING: &str = "Sun of a scene that is not baked";
/// Heading of the options that say what becomes of objects.
pub const OBJECTS_HEADING: &str = "Objects of a scene that is not baked";

/// Plays sunbake's maps back at any time of the day.
#[derive(Debug, Parser)]
#[command(name = "sunplay", version, max_term_width = 110)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw one picture of a set, or of a scene that is not baked.
    Frame(FrameArgs),
    /// Draw a day of a set, or of a scene that is not baked: numbered pictures, a contact sheet, an animation.
    Frames(FramesArgs),
    /// Compare a baked set with live shadows and a ray-traced truth: errors, times, bytes, pictures.
    ///
    /// Writes a folder: report.html, one page that needs no network, with pictures to slide between, tables and plots;
    /// report.json, the same for programs; and sheet.png, the best baked and the best live technique side by side, if
    /// both were drawn.
    Compare(Box<CompareArgs>),
    /// Bake our sample scene for a June day and draw the day beside the ray-traced truth.
    Demo(DemoArgs),
}

#[derive(Debug, ClapArgs)]
pub struct FrameArgs {
    /// The set's folder or, for techniques that need no bake, a scene: .gltf or .glb.
    pub set: PathBuf,
    /// When: HH:MM by the set's local clocks, or a fraction of its path from 0 to 1.
    ///
    /// The set's path usually runs from sunrise to sunset; `sunbake inspect` prints it.
    #[arg(long, value_name = "HH:MM|T", value_parser = parse_when, default_value = "0.5")]
    pub at: TimeChoice,
    /// File to write: .png, or .exr for linear numbers.
    ///
    /// A colour PNG holds the tone-mapped picture and a colour EXR linear light. A visibility PNG is grey with 16 bits,
    /// 0 for shade and 65535 for full sun, and a visibility EXR has one channel, Y.
    #[arg(short, long, value_name = "FILE")]
    pub output_file: PathBuf,
    #[command(flatten, next_help_heading = SUN_HEADING)]
    pub sun: SunArgs,
    #[command(flatten, next_help_heading = OBJECTS_HEADING)]
    pub objects: ObjectArgs,
    #[command(flatten)]
    pub look: LookArgs,
    /// What the picture shows.
    #[arg(long = "output", value_enum, default_value_t = OutputChoice::Color)]
    pub output: OutputChoice,
    #[command(flatten)]
    pub printing: PrintingArgs,
}

#[derive(Debug, ClapArgs)]
pub struct FramesArgs {
    /// The set's folder or, for techniques that need no bake, a scene: .gltf or .glb.
    pub set: PathBuf,
    /// How many pictures, 1 to 10000, at the middles of as many equal parts of the path.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub count: u32,
    /// Folder for the pictures; made if it is not there. Files of the same name are replaced.
    ///
    /// It holds frame_0000.png and so on, contact.png with thumbnails of all, and day.png, an animated PNG.
    #[arg(short, long = "folder", value_name = "DIR")]
    pub output_folder: PathBuf,
    #[command(flatten, next_help_heading = SUN_HEADING)]
    pub sun: SunArgs,
    #[command(flatten, next_help_heading = OBJECTS_HEADING)]
    pub objects: ObjectArgs,
    #[command(flatten)]
    pub look: LookArgs,
    /// What the pictures show.
    #[arg(long = "output", value_enum, default_value_t = OutputChoice::Color)]
    pub output: OutputChoice,
    #[command(flatten)]
    pub printing: PrintingArgs,
}

#[derive(Debug, ClapArgs)]
pub struct DemoArgs {
    /// Folder for the results; the set goes into its folder `set`.
    #[arg(short, long, value_name = "DIR", default_value = "target/demo")]
    pub output: PathBuf,
    /// Another scene than the sample: .gltf or .glb.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Edge of the set's page in texels, 64 to 16384. Time and bytes grow with the square.
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(64..=16384))]
    pub page_size: u32,
    /// Columns of the sheet, 1 to 24.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=24))]
    pub count: u32,
    /// What draws the baked row: the GPU if there is one, the GPU, or the CPU.
    #[arg(long, value_enum, default_value_t = RendererChoice::Auto)]
    pub renderer: RendererChoice,
    /// Threads of the CPU; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    #[command(flatten)]
    pub printing: PrintingArgs,
}

/// What is printed.
#[derive(Debug, Clone, Copy, ClapArgs)]
#[command(next_help_heading = "Printing")]
pub struct PrintingArgs {
    /// Print what was drawn, and at what cost, as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
    /// Print which effects the picture needs (of several pictures, the last), the cost of each and what switches it,
    /// and what the technique decided.
    #[arg(long)]
    pub explain: bool,
}

/// Options of pictures, whatever they show.
#[derive(Debug, Clone, ClapArgs)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// Width and height in pixels, each 1 to 16384.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1280x720")]
    pub size: [u32; 2],
    /// A camera of the scene by name or as `camera:N`, `default`, or `ex,ey,ez,tx,ty,tz[,fov]`.
    ///
    /// `camera:0` is the scene's first camera: not all have names of their own. The numbers are the eye and the point
    /// that it looks at, in metres of the scene's world space, and the vertical field of view in degrees, 45 unless
    /// given. The default is the scene's first camera or, if it has none, a view from above that shows most of the
    /// scene.
    #[arg(long, value_name = "CAMERA", value_parser = parse_camera, default_value = "default")]
    #[arg(allow_hyphen_values = true)]
    pub camera: CameraChoice,
    /// How visibility is found: baked, `volumes[:MODE]`, `map[:VARIANT]`, truth:hard, truth:soft or truth:soft:N.
    ///
    /// `volumes` counts shadow volumes in the GPU's stencil buffer, without a bake: hard edges, exact at each pixel.
    /// Its modes are `volumes:zfail` (always correct), `volumes:zpass` (cheaper, used where it is correct),
    /// `volumes:triangles` (a volume for each triangle) and `volumes:gpu` (the vertex shader finds silhouettes).
    /// Without a mode, each caster uses the cheapest correct one. Alpha masks are ignored: leaves cast the shadow of
    /// their whole card.
    ///
    /// `map` draws shadow maps from the sun. Its variants are `map:plain` (one map, compared in the shader),
    /// `map:compare` (by the sampler), `map:pcf16` (sixteen comparisons), `map:pcf4` (four, dithered), `map:pcss`
    /// (percentage-closer soft shadows: as wide as the penumbra), `map:cascades` (a map for each slice of the view; the
    /// same as `map`), `map:perspective` and `map:cube` (perspective shadow maps: more texels near the eye),
    /// `map:ground` (a blurred projection onto the ground) and `map:planar` (casters flattened onto the ground, and no
    /// other shadow). A set's lamp keeps its baked shadows.
    ///
    /// `truth:hard` traces one ray from each pixel to the sun's centre, `truth:soft` N rays to its disc, 64 unless
    /// given: time grows with N, noise shrinks as 1/N.
    #[arg(long, value_name = "TECHNIQUE", value_parser = parse_technique, default_value = "baked")]
    pub technique: TechniqueChoice,
    /// With `volumes`: points of the sun's disc that cast hard shadows, 1 to 4096. Time grows with N; edges have N
    /// steps.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub sun_samples: u32,
    /// With `map`: edge of each map in texels, 16 to 16384. Bytes, and the time to draw a map, grow with the square.
    /// [default: 2048]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=16384))]
    pub map_size: Option<u32>,
    /// With `map:cascades`: most maps, 2 to 4. Bytes and time grow with the number. [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=4))]
    pub cascades: Option<u32>,
    /// With `map`: bias, which keeps surfaces from shadowing themselves: none, or parts with commas between them.
    ///
    /// Parts are constant:METRES or texels:N (along the light), `slope[:N]` (along the light, by the surface's slope),
    /// `normal[:N]` (along the surface's normal, by a texel's size) and plane (compares with the receiver's plane). A
    /// larger bias loses shadows of close casters; the default needs no tuning. [default: texels:0.5,plane; of
    /// map:compare and map:ground texels:0.5,normal:1; of map:plain texels:2]
    #[arg(long, value_name = "PARTS")]
    pub bias: Option<Bias>,
    /// Metres beyond which a set's lamp gives no light. Volumes end there and cost less. [default: no limit]
    #[arg(long, value_name = "M", value_parser = parse_range, allow_hyphen_values = true)]
    pub lamp_range: Option<f32>,
    /// Which lights are on.
    ///
    /// A visibility picture shows the sun's visibility; with `lamp` it shows the lamp's. A set's lamp has a fixed
    /// brightness at which its light is easy to see. `sky` is ambient light alone, and `sun` and `lamp` are without it.
    #[arg(long, value_enum, default_value_t = LightChoice::Both)]
    pub light: LightChoice,
    /// How ambient light is computed.
    #[arg(long, value_enum, default_value_t = AmbientChoice::Best)]
    pub ambient: AmbientChoice,
    /// How stored times are filtered. [default: tracks, where a set has them, else bilinear]
    #[arg(long, value_enum)]
    pub filter: Option<FilterChoice>,
    /// Samples along each of a pixel's edges, 1 to 8: pictures are drawn N times as wide and high, and averaged. Time
    /// grows with the square; 1 leaves edges jagged. [default: 2; of visibility, and of pictures over 4096 pixels, 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8))]
    pub supersample: Option<u32>,
    /// What draws: the GPU if there is one, the GPU, or the CPU.
    #[arg(long, value_enum, default_value_t = RendererChoice::Auto)]
    pub renderer: RendererChoice,
    /// Threads of the CPU; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

/// Longest edge of a picture that has several samples a pixel without being asked to: twice that many are as many as
/// every GPU draws.
const MOST_SMOOTHED_PIXELS: u32 = 4096;

impl LookArgs {
    /// Samples along each edge of a picture's pixels. Visibility is measured at one point of each pixel.
    pub fn samples(&self, output: OutputChoice) -> u32 {
        let is_large = self.size.iter().any(|&edge| edge > MOST_SMOOTHED_PIXELS);
        let usual = if is_large || output == OutputChoice::Visibility { 1 } else { 2 };
        self.supersample.unwrap_or(usual)
    }
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OutputChoice {
    /// The lit scene.
    Color,
    /// How much of the sun is seen, and nothing else; pixels without a surface read 1.
    Visibility,
    /// The lit scene with the sun's shadow volumes: front faces in warm colours, back faces in cold ones. With
    /// --technique volumes.
    Volumes,
}

/// How visibility is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TechniqueChoice {
    /// From the maps.
    Baked,
    /// By shadow volumes.
    Volumes(Mode),
    /// By shadow maps.
    Map(Variant),
    /// By rays.
    Truth(Truth),
}

/// Which lights are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LightChoice {
    /// The sun alone: what it does not reach is black.
    Sun,
    /// The sky alone.
    Sky,
    /// The lamp alone.
    Lamp,
    /// All that the set has.
    Both,
}

/// How ambient light is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AmbientChoice {
    /// The best that the set allows.
    Best,
    /// The sky of the moment, against what each texel sees of it; sets baked with --sky sh2.
    Sh2,
    /// Bent normals and ambient occlusion; sets baked with --bent.
    Bent,
    /// Ambient occlusion, and the normal.
    Ao,
    /// The normal alone, (1 + n.y) / 2 of sky: what there is without a bake.
    Hemisphere,
}

impl AmbientChoice {
    /// The model, and the flag that bakes what it needs; none for the best.
    pub fn model(self) -> Option<(AmbientModel, &'static str)> {
        match self {
            Self::Best => None,
            Self::Sh2 => Some((AmbientModel::Sky, "--sky sh2")),
            Self::Bent => Some((AmbientModel::Bent, "--bent")),
            Self::Ao => Some((AmbientModel::Occlusion, "--only intervals,ao")),
            Self::Hemisphere => Some((AmbientModel::Hemisphere, "")),
        }
    }
}

/// How stored times are filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FilterChoice {
    /// Four texels are evaluated, then blended.
    Bilinear,
    /// One texel, unfiltered: blocky.
    Nearest,
    /// As bilinear, and edges of shadows drawn sharply between texels.
    Sharp,
    /// Shadows occluder by occluder, also those far narrower than texels; sets baked with --tracks.
    Tracks,
}

impl From<FilterChoice> for Filter {
    fn from(choice: FilterChoice) -> Self {
        match choice {
            FilterChoice::Bilinear => Self::Bilinear,
            FilterChoice::Nearest => Self::Nearest,
            FilterChoice::Sharp => Self::Sharp,
            FilterChoice::Tracks => Self::Tracks,
        }
    }
}

/// What draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RendererChoice {
    /// The GPU, or the CPU where there is none.
    Auto,
    /// The GPU.
    Gpu,
    /// The CPU.
    Cpu,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_options_are_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn lit_pictures_have_smooth_edges_unless_told_otherwise() {
        let samples = |options: &[&str], output| {
            let args = ["sunplay", "frame", "set", "-o", "out.png", "--at", "0.5"].iter().chain(options);
            match Args::try_parse_from(args).unwrap().command {
                Command::Frame(args) => args.look.samples(output),
                _ => unreachable!(),
            }
        };
        assert_eq!(samples(&[], OutputChoice::Color), 2);
        assert_eq!(samples(&[], OutputChoice::Visibility), 1);
        assert_eq!(samples(&["--size", "5000x100"], OutputChoice::Color), 1);
        assert_eq!(samples(&["--supersample", "1"], OutputChoice::Color), 1);
        assert_eq!(samples(&["--supersample", "4"], OutputChoice::Visibility), 4);
    }
}
