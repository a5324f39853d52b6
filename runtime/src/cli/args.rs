//! Every option, with its range and its default.

use super::compare::args::CompareArgs;
use super::place::parse_camera;
use super::when::parse_when;
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use sunbake::console::SunArgs;
use sunbake_runtime::camera::CameraChoice;
use sunbake_runtime::light::{TimeChoice, WITHOUT_END};
use sunbake_runtime::shadow_maps::{Bias, Variant};
use sunbake_runtime::technique::Truth;
use sunbake_runtime::volumes::Mode;
use sunbake_runtime::{AmbientModel, Filter};

/// Heading of the options of a sun: a set has its own.
pub const SUN_HEADING: &str = "Sun of a scene that is not baked";

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
    /// report.json, the same for programs; and sheet.png, the most lifelike baked and live technique side by side, if both were drawn.
    Compare(Box<CompareArgs>),
    /// Bake our own scene for a June day and draw the day beside truth.
    Demo(DemoArgs),
}

#[derive(Debug, ClapArgs)]
pub struct FrameArgs {
    /// The set's folder, or for techniques that need no bake a scene: .gltf or .glb.
    pub set: PathBuf,
    /// When: HH:MM by the set's local clocks, or a fraction of its path from 0 to 1.
    ///
    /// The set's path runs from sunrise to sunset unless it was baked otherwise; `sunbake inspect` prints it.
    #[arg(long, value_name = "HH:MM|T", value_parser = parse_when, default_value = "0.5")]
    pub at: TimeChoice,
    /// File to write: .png, or .exr for the numbers themselves.
    ///
    /// A colour PNG holds the tone-mapped picture and a colour EXR linear light. A visibility PNG is grey with 16 bits, 0
    /// for shade and 65535 for full sun, and a visibility EXR has one channel, Y.
    #[arg(short, long, value_name = "FILE")]
    pub output_file: PathBuf,
    #[command(flatten, next_help_heading = SUN_HEADING)]
    pub sun: SunArgs,
    #[command(flatten)]
    pub look: LookArgs,
    /// What the picture shows.
    #[arg(long = "output", value_enum, default_value_t = OutputChoice::Color)]
    pub output: OutputChoice,
    #[command(flatten)]
    pub manners: MannersArgs,
}

#[derive(Debug, ClapArgs)]
pub struct FramesArgs {
    /// The set's folder, or for techniques that need no bake a scene: .gltf or .glb.
    pub set: PathBuf,
    /// How many pictures, 1 to 10000, at the middles of as many equal parts of the path.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub count: u32,
    /// Folder for the pictures; made if it is not there. Files of the same name are replaced.
    ///
    /// It gets frame_0000.png and so on, contact.png with all of them small, and day.png, an animated PNG.
    #[arg(short, long = "folder", value_name = "DIR")]
    pub output_folder: PathBuf,
    #[command(flatten, next_help_heading = SUN_HEADING)]
    pub sun: SunArgs,
    #[command(flatten)]
    pub look: LookArgs,
    /// What the pictures show.
    #[arg(long = "output", value_enum, default_value_t = OutputChoice::Color)]
    pub output: OutputChoice,
    #[command(flatten)]
    pub manners: MannersArgs,
}

#[derive(Debug, ClapArgs)]
pub struct DemoArgs {
    /// Folder for what the demo makes; the set goes into its folder `set`.
    #[arg(short, long, value_name = "DIR", default_value = "target/demo")]
    pub output: PathBuf,
    /// Another scene than our own: .gltf or .glb.
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
    /// Threads; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    #[command(flatten)]
    pub manners: MannersArgs,
}

/// What is printed.
#[derive(Debug, Clone, Copy, ClapArgs)]
#[command(next_help_heading = "Printing")]
pub struct MannersArgs {
    /// Print what was drawn, and at what cost, as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
    /// Print which effects the picture calls for (the last of several), what each takes and what turns it over, and what the
    /// technique decided.
    #[arg(long)]
    pub explain: bool,
}

/// How pictures are taken, whatever they are of.
#[derive(Debug, Clone, ClapArgs)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// Width and height in pixels, each 1 to 16384.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1280x720")]
    pub size: [u32; 2],
    /// A camera of the scene by name, `default`, or `ex,ey,ez,tx,ty,tz[,fov]`.
    ///
    /// The numbers are the eye and the point it looks at in the scene's world space, in metres, and the vertical field
    /// of view in degrees, 45 unless given. The default is the scene's first camera or, if it has none, a view from
    /// above and aside that shows most of it.
    #[arg(long, value_name = "CAMERA", value_parser = parse_camera, default_value = "default", allow_hyphen_values = true)]
    pub camera: CameraChoice,
    /// How visibility is found: baked, `volumes[:MODE]`, `map[:VARIANT]`, truth:hard, truth:soft or truth:soft:N.
    ///
    /// `volumes` counts shadow volumes in the GPU's stencil: hard edges, exact at each pixel, anew for each picture, with no
    /// bake. Its modes are `volumes:zfail` (counted behind surfaces, always right), `volumes:zpass` (before them where that is
    /// right, cheaper), `volumes:triangles` (a volume a triangle) and `volumes:gpu` (silhouettes found by the vertex shader);
    /// without one, each caster is drawn as suits it. Leaves cast their whole cards.
    ///
    /// `map` draws what the sun sees into shadow maps. Its variants are `map:plain` (one map, compared texel by texel),
    /// `map:compare` (by the sampler), `map:pcf16` (sixteen comparisons), `map:pcf4` (four of
    /// them, dithered), `map:pcss` (as wide as the penumbra), `map:cascades` (a map for each slice of the view, what `map` is without a variant),
    /// `map:perspective` and `map:cube` (bent so that what is near gets more of it), `map:ground` (a blurred picture of what casts,
    /// on the ground) and `map:planar` (what casts laid flat on the ground, and nothing else).
    ///
    /// `truth:hard` traces one ray to the sun's
    /// centre from each pixel, `truth:soft` N rays over its disc, 64 unless given: time grows with N, noise shrinks as 1/N.
    #[arg(long, value_name = "TECHNIQUE", value_parser = parse_technique, default_value = "baked")]
    pub technique: TechniqueChoice,
    /// With `volumes`: as how many hard suns its disc shines, 1 to 4096. Time grows with N; edges have N steps.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub sun_samples: u32,
    /// With `map`: edge of each map in texels, 16 to 16384. Bytes, and time to draw a map, grow with the square. [default: 2048]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=16384))]
    pub map_size: Option<u32>,
    /// With `map:cascades`: the most maps, 2 to 4; each costs its bytes and its time. [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=4))]
    pub cascades: Option<u32>,
    /// With `map`: what keeps surfaces from shading themselves: none, or parts with commas between them.
    ///
    /// Parts are constant:METRES or texels:N (along the light), `slope[:N]` (along the light, by the surface's slant), `normal[:N]`
    /// (along its normal, by a texel's size) and plane (texels are compared with the surface's plane). More hides more of what
    /// is close; the default needs no tuning. [default: texels:0.5,plane; of map:compare and map:ground texels:0.5,normal:1; of map:plain
    /// texels:2]
    #[arg(long, value_name = "PARTS")]
    pub bias: Option<Bias>,
    /// Metres beyond which a set's lamp gives no light. Volumes end there, and cost less. [default: without end]
    #[arg(long, value_name = "M", value_parser = parse_range, allow_hyphen_values = true)]
    pub lamp_range: Option<f32>,
    /// Which lights are on.
    ///
    /// A visibility picture shows the sun's, whichever are on, or the lamp's where the lamp alone is. A set's lamp is drawn as bright as
    /// makes it readable. `sky` is what comes from all around, and `sun` and `lamp` are without it.
    #[arg(long, value_enum, default_value_t = LightChoice::Both)]
    pub light: LightChoice,
    /// What light from all around is made of.
    #[arg(long, value_enum, default_value_t = AmbientChoice::Best)]
    pub ambient: AmbientChoice,
    /// How stored times are filtered.
    #[arg(long, value_enum, default_value_t = FilterChoice::Bilinear)]
    pub filter: FilterChoice,
    /// Draw N times as wide and high, and average: 1 to 8. Time grows with the square.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    pub supersample: u32,
    /// What draws: the GPU if there is one, the GPU, or the CPU.
    #[arg(long, value_enum, default_value_t = RendererChoice::Auto)]
    pub renderer: RendererChoice,
    /// Threads; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OutputChoice {
    /// The lit scene.
    Color,
    /// How much of the sun is seen, and nothing else; pixels without a surface read 1.
    Visibility,
    /// The lit scene with the sun's shadow volumes: faces that turn to the eye warm, others cold. With --technique volumes.
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

/// What light from all around is made of.
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
    /// One texel: blocky, the look of the chapter.
    Nearest,
}

impl From<FilterChoice> for Filter {
    fn from(choice: FilterChoice) -> Self {
        match choice {
            FilterChoice::Bilinear => Self::Bilinear,
            FilterChoice::Nearest => Self::Nearest,
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

/// Reads `WIDTHxHEIGHT`.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("`{text}` is not a size: give WIDTHxHEIGHT in pixels, as 1280x720");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let edge = |text: &str| text.parse().ok().filter(|edge| (1..=16_384).contains(edge)).ok_or_else(wrong);
    Ok([edge(width)?, edge(height)?])
}

fn parse_range(text: &str) -> Result<f32, String> {
    let range_m = text.parse().ok().filter(|range_m: &f32| *range_m > 0.0 && *range_m < WITHOUT_END);
    range_m.ok_or_else(|| format!("`{text}` is not a range: give metres above 0"))
}

fn parse_technique(text: &str) -> Result<TechniqueChoice, String> {
    let wrong = || {
        let modes = Mode::ALL.map(|mode| mode.to_string()).join(", ");
        let variants = Variant::ALL.map(|variant| variant.to_string()).join(", ");
        format!(
            "`{text}` is not a technique: give baked, {modes}, map, {variants}, truth:hard, truth:soft or truth:soft:N"
        )
    };
    if text == "map" {
        return Ok(TechniqueChoice::Map(Variant::default()));
    }
    if let Some(variant) = Variant::ALL.into_iter().find(|variant| variant.to_string() == text) {
        return Ok(TechniqueChoice::Map(variant));
    }
    if let Some(mode) = Mode::ALL.into_iter().find(|mode| mode.to_string() == text) {
        return Ok(TechniqueChoice::Volumes(mode));
    }
    match text {
        "baked" => Ok(TechniqueChoice::Baked),
        "truth:hard" => Ok(TechniqueChoice::Truth(Truth::Hard)),
        "truth:soft" => Ok(TechniqueChoice::Truth(Truth::Soft { rays: Truth::DEFAULT_RAYS })),
        _ => {
            let rays = text.strip_prefix("truth:soft:").and_then(|n| n.parse().ok()).ok_or_else(wrong)?;
            (1..=65_536).contains(&rays).then_some(TechniqueChoice::Truth(Truth::Soft { rays })).ok_or_else(wrong)
        }
    }
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
    fn sizes_and_techniques_outside_their_range_are_refused() {
        assert_eq!(parse_size("640x360"), Ok([640, 360]));
        for bad in ["640", "0x4", "x", "4x", "20000x4", "-4x4", "4x4x4"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_technique("truth:soft:9"), Ok(TechniqueChoice::Truth(Truth::Soft { rays: 9 })));
        assert_eq!(parse_technique("volumes"), Ok(TechniqueChoice::Volumes(Mode::Planned)));
        assert_eq!(parse_technique("volumes:gpu"), Ok(TechniqueChoice::Volumes(Mode::Gpu)));
        assert_eq!(parse_technique("map"), Ok(TechniqueChoice::Map(Variant::Cascades)));
        assert_eq!(parse_technique("map:cube"), Ok(TechniqueChoice::Map(Variant::Cube)));
        for bad in [
            "map:",
            "map:pcf",
            "maps",
            "truth",
            "truth:",
            "truth:soft:",
            "truth:soft:0",
            "truth:soft:x",
            "volumes:",
            "volumes:z",
        ] {
            assert!(parse_technique(bad).is_err(), "{bad}");
        }
    }
}
