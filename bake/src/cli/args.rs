//! Every option, with its range and its default.

use super::values::{
    parse_attribute, parse_bits, parse_budget, parse_bytes, parse_density, parse_edge_seconds, parse_engine,
    parse_error, parse_lanes, parse_metres, parse_only, parse_rays, parse_tracks, parse_window,
};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use sunbake::console::{DensityArgs, ObjectArgs, SunArgs};
use sunbake::maps::Bits;
use sunbake::settings::{EngineChoice, TrackChoice, VertexAttribute};

/// Bakes when every texel of a glTF scene sees the sun.
#[derive(Debug, Parser)]
#[command(name = "sunbake", version, max_term_width = 110)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Bake a glTF scene into a set of maps.
    ///
    /// Writes a folder: sunbake.json (what is in it), scene.glb (the scene with the bake's texture coordinates as
    /// TEXCOORD_1 and its ambient occlusion, for any viewer), PNGs with ambient occlusion, and pairs of PNGs with the
    /// times at which each texel starts and stops seeing the sun. The folder is written beside its target and moved
    /// into place when it is complete.
    ///
    /// Exit codes: 0 done, 1 usage, 2 reading or writing failed, 3 the input is bad, 4 a defect of sunbake, 5 not
    /// supported by this machine, 130 or 143 stopped by a signal.
    Bake(Box<BakeArgs>),
    /// Print what a set holds, what it cost and what it lost; or the names in a scene, for options that take them.
    Inspect(InspectArgs),
    /// Print some covered texels of a set as JSON lines.
    ///
    /// Each line holds one texel: atlas, x, y, instance, position, normal, double_sided, origin (where rays towards the
    /// sun start) and origin_back; on smooth surfaces shading_normal, and origin_lifted and origin_lifted_back (the
    /// same towards suns that only the shading normal faces); is_filled (where a buried texel has its neighbours'
    /// times); lit (when it sees the sun, as fractions of the path in sunbake.json), lanes (the same for each lane,
    /// where there are several: offset_deg, weight and lit), lamp (when it sees the lamp, where the set has one), ao,
    /// ao_back, bent and sky. With these, any ray tracer can check a bake.
    Texels(TexelsArgs),
    /// Measure what accuracy costs on a scene and this machine.
    ///
    /// Varies every setting that trades time or bytes for error (presets, page sizes, lanes, engines, bits, layers,
    /// rays of sky) and writes a folder: report.html (tables, plots and advice) and report.json (the same for
    /// programs). Errors of the sun are wrong minutes (mean, 99th percentile and worst) compared with the exact answer
    /// at points of the surfaces; errors of the sky are differences of ambient occlusion. The report lists what did not
    /// fit the budget. Times mean little if other programs run meanwhile.
    ///
    /// Exit codes are those of `bake`.
    Cost(Box<CostCommandArgs>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    /// A preview in seconds: a page of 512, 8 bits, 64 rays of sky.
    Draft,
    /// For a game level: a page of 2048, 16 bits, 128 rays of sky.
    Standard,
    /// For final use: a page of 4096, 16 bits, up to 8 layers, 512 rays of sky.
    Final,
}

/// What `--only` may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Only {
    /// When texels see the sun.
    Intervals,
    /// How much of the sky texels see.
    Ao,
}

#[derive(Debug, ClapArgs)]
pub struct BakeArgs {
    /// The scene: .gltf or .glb.
    pub scene: PathBuf,
    /// Folder to write the set to.
    #[arg(short, long, value_name = "DIR", required_unless_present = "explain")]
    pub output: Option<PathBuf>,
    /// Replace an older set in that folder.
    #[arg(long)]
    pub force: bool,
    /// Defaults of the options below.
    #[arg(long, value_enum, default_value_t = Preset::Standard)]
    pub preset: Preset,
    #[command(flatten)]
    pub objects: ObjectArgs,
    #[command(flatten)]
    pub densities: DensityArgs,
    #[command(flatten)]
    pub sun: PathArgs,
    #[command(flatten)]
    pub lamp: LampArgs,
    #[command(flatten)]
    pub cost: CostArgs,
    #[command(flatten)]
    pub ambient: AmbientArgs,
    /// What to bake, of: intervals (when the sun is seen), ao (how much of the sky). [default: both]
    #[arg(long, value_name = "WHAT", value_delimiter = ',', value_parser = parse_only)]
    pub only: Vec<Only>,
    /// Show where --layers and --bits lost minutes: a picture and the numbers for each page.
    ///
    /// Writes lost_minutes.N.png, from black (nothing lost) through violet, red and orange to pale yellow (the most, in
    /// minutes, is in the summary and in sunbake.json), and lost_minutes.N.exr with the channels `layers` and `bits`,
    /// in minutes.
    #[arg(long)]
    pub loss_map: bool,
    /// End the light on smooth surfaces face by face, as if they were flat.
    ///
    /// By default it ends where shading normals say that a ball of few faces turns away from the light. This is for
    /// scenes whose normals are not to be trusted, and for checks by ray tracers that know faces alone.
    #[arg(long)]
    pub flat_terminator: bool,
    /// Print what would be baked, why, at what cost and what would change that, and bake nothing.
    #[arg(long)]
    pub explain: bool,
    #[command(flatten)]
    pub printing: OutputArgs,
}

#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Sun")]
pub struct PathArgs {
    #[command(flatten)]
    pub day: SunArgs,
    /// Part of the day to bake, by local clocks; may pass midnight. Equal times are a whole day. [default: sunrise to
    /// sunset]
    #[arg(long, value_name = "HH:MM-HH:MM", value_parser = parse_window)]
    pub window: Option<[f64; 2]>,
    /// A file of keyed directions or positions instead of a place and a date.
    ///
    /// JSON: {"keys": [{"azimuth_deg": 90, "elevation_deg": 5}, {"direction": [0, 1, 0]}, ...]}, with an optional "t"
    /// in each key and optional "angular_radius_deg" and "duration_min" beside "keys".
    ///
    /// For `bake`, with positions it is the path of a lamp that moves through the scene, and the lamp is baked instead
    /// of the sun; see its --lamp.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["place", "date", "utc_offset", "window"])]
    pub path: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Sun")]
pub struct LampArgs {
    /// A file of keyed positions: a lamp that moves through the scene, beside the sun.
    ///
    /// JSON: {"radius_m": 0.05, "keys": [{"t": 0, "position": [0, 2, 0]}, {"t": 1, "position": [3, 2, 0]}]}, in metres
    /// of the scene's world, joined by straight lines. The lamp's t is the sun's: it is at its last key when the sun
    /// sets. Surfaces beyond the lamp do not hide it. It takes about the bytes and the time of one lane.
    #[arg(long, value_name = "FILE")]
    pub lamp: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
#[command(next_help_heading = "Quality and cost")]
pub struct CostArgs {
    /// Edge of a page in texels, 64 to 16384. [default: 512, 2048 or 4096, by preset]
    ///
    /// Without --texels-per-metre the whole scene is fitted into one page of this size; objects with a --density of
    /// their own may take more, or a larger one. Time and bytes grow with the square.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(64..=16384))]
    pub size: Option<u32>,
    /// Texels per metre, on as many pages as that takes. [default: as dense as one page allows]
    #[arg(long, value_name = "X", value_parser = parse_density)]
    pub texels_per_metre: Option<f64>,
    /// Width in texels of the gutter around every chart, which repeats the chart's border, 1 to 16. [default: 2]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub padding: Option<u32>,
    /// Bits of a stored time. [default: 8 in draft, else 16]
    ///
    /// 8 bits store an edge to within 1.7 minutes of a summer day, 16 bits to within 0.4 seconds, at twice the bytes.
    #[arg(long, value_name = "8|16", value_parser = parse_bits)]
    pub bits: Option<Bits>,
    /// Most layers of four intervals a texel, 1 to 16. [default: 2, 4 or 8, by preset]
    ///
    /// Layers that no texel needs are not written. Intervals that do not fit are merged so that least is lost; the loss
    /// is reported.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub layers: Option<u32>,
    /// Lanes across the sun's disc.
    ///
    /// With one lane the sun is a line along its path, and shadow edges along that path stay hard. With 3 or 5 lanes
    /// they soften in as many steps. Bytes grow with the number, and so does the time of the rays engine.
    #[arg(long, value_name = "1|3|5", value_parser = parse_lanes, default_value = "1")]
    pub lanes: usize,
    /// Find shadow tracks as well: when each thing that hides the sun starts and ends to, by itself.
    ///
    /// `sunplay --filter tracks` then draws shadows far narrower than texels, as those of fences, as clean lines. Takes
    /// about half the time of the intervals on top, and bytes where shadows are dense: see `tracks` in the summary.
    /// auto, which is meant without a value, keeps them where they gain something, within the bytes that the intervals
    /// take on a GPU; on keeps them wherever shade moves.
    #[arg(long, value_name = "auto|on|off", value_parser = parse_tracks, num_args = 0..=1, require_equals = true,
          default_missing_value = "auto")]
    pub tracks: Option<TrackChoice>,
    /// How to find the times: exact, rays:N or bisect:N, N from 2 to 65536. [default: exact]
    ///
    /// exact finds every edge in closed form and misses nothing. The others are for comparison. rays:N traces rays to N
    /// positions of the sun; edges are off by at most half a step, 1.8 minutes of a summer day at 256. bisect:N does
    /// the same and then bisects every change to within --edge-seconds. Both may miss intervals shorter than a step.
    /// Time grows with N.
    #[arg(long, value_name = "ENGINE", value_parser = parse_engine)]
    pub engine: Option<EngineChoice>,
    /// Largest error of an edge, in seconds of sun, 0.001 to 3600; for bisect:N. [default: 1]
    ///
    /// Halving it costs one ray more an edge. 16-bit times of a summer day are steps of 0.8 seconds.
    #[arg(long, value_name = "S", value_parser = parse_edge_seconds)]
    pub edge_seconds: Option<f64>,
    /// Threads; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Memory to plan for, as 8G or 500M; a bake that needs more is refused. [default: 4G, 8G or 16G, by preset]
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes)]
    pub max_memory: Option<u64>,
}

#[derive(Debug, Clone, ClapArgs)]
#[command(next_help_heading = "Ambient light")]
pub struct AmbientArgs {
    /// Rays of sky a texel, a power of two from 4 to 65536. [default: 64, 128 or 512, by preset]
    ///
    /// Time grows with the number. The error of ambient occlusion is about 0.02 with 64 rays, 0.01 with 128, 0.005 with
    /// 512.
    #[arg(long, value_name = "N", value_parser = parse_rays)]
    pub ao_rays: Option<u32>,
    /// Only surfaces nearer than M metres hide the sky. [default: all do]
    ///
    /// A surface at distance d hides (1 - (d/M)^2)^2 of the light: all of it at contact, nothing at M. Use it for
    /// interiors: closed rooms are black without it. One or two metres show corners.
    #[arg(long, value_name = "M", value_parser = parse_metres)]
    pub ao_distance: Option<f64>,
    /// Stop a texel's rays once its error is below E with 95 % confidence, 0.001 to 0.5. [default: same number for all]
    ///
    /// Of many texels, 95 in 100 are within E. --ao-rays is then the most, 4096 unless given. Texels that see all of
    /// the sky, or none of it, take 64.
    #[arg(long, value_name = "E", value_parser = parse_error)]
    pub ao_error: Option<f64>,
    /// Spread a texel's rays over N by N points of its surface, 1 to 8.
    ///
    /// Takes no more rays. Softens details smaller than a texel.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    pub ao_supersample: u32,
    /// Bits of the occlusion textures. [default: 8 in draft, else 16]
    #[arg(long, value_name = "8|16", value_parser = parse_bits)]
    pub ao_bits: Option<Bits>,
    /// Bake bent normals as well: the mean direction in which each texel sees the sky.
    #[arg(long)]
    pub bent: bool,
    /// Bake sky visibility by direction: sh2, nine coefficients of spherical harmonics.
    ///
    /// A sky whose brightness changes through the day then lights the scene correctly. Takes 18 bytes a texel and side.
    #[arg(long, value_name = "BASIS")]
    pub sky: Option<SkyBasis>,
    /// Also write vertices.glb, with ambient occlusion at its vertices as COLOR_0 or _AO.
    ///
    /// For engines without a second set of texture coordinates. Every viewer shows COLOR_0; _AO is a separate number.
    #[arg(long, value_name = "ATTRIBUTE", value_parser = parse_attribute)]
    pub ao_vertices: Option<VertexAttribute>,
    /// Also write ambient light as OpenEXR with 32-bit floats.
    #[arg(long)]
    pub exr: bool,
}

/// How sky visibility is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SkyBasis {
    /// Spherical harmonics up to degree two.
    Sh2,
}

#[derive(Debug, Clone, Copy, ClapArgs)]
#[command(next_help_heading = "Output")]
pub struct OutputArgs {
    /// Print the result as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors (and the JSON, with --json).
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print every stage's seconds, and every effect.
    #[arg(short, long)]
    pub verbose: bool,
}

#[derive(Debug, ClapArgs)]
pub struct CostCommandArgs {
    /// The scene: .gltf or .glb.
    pub scene: PathBuf,
    /// Folder to write the report to.
    #[arg(short, long, value_name = "REPORT")]
    pub output: PathBuf,
    /// Replace an older report in that folder.
    #[arg(long)]
    pub force: bool,
    /// Seconds that all of it may take, 10 to 86400.
    ///
    /// The most useful measurements come first. The time of each is predicted: one that would not fit is left out and
    /// listed with its prediction. Reading the scene and unwrapping it are not limited.
    #[arg(long, value_name = "S", default_value = "600", value_parser = parse_budget)]
    pub budget: f64,
    #[command(flatten)]
    pub objects: ObjectArgs,
    #[command(flatten)]
    pub densities: DensityArgs,
    #[command(flatten)]
    pub sun: PathArgs,
    /// Edge of the page whose texels are sampled, 64 to 16384. Whole bakes have sizes of their own.
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(64..=16384))]
    pub size: u32,
    /// Threads; 0 is one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Memory to plan for, as 8G or 500M; a bake that needs more is left out. [default: 4G, 8G or 16G, by preset]
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes)]
    pub max_memory: Option<u64>,
    #[command(flatten)]
    pub printing: OutputArgs,
}

#[derive(Debug, ClapArgs)]
pub struct InspectArgs {
    /// The set's folder, or a scene: .gltf or .glb.
    #[arg(value_name = "SET|SCENE")]
    pub set: PathBuf,
    /// Print the manifest, or the names, as JSON.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct TexelsArgs {
    /// The set's folder.
    pub set: PathBuf,
    /// How many texels, 1 to 4294967295; at most all that are covered.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    pub count: u32,
    /// Which texels: the same seed draws the same ones.
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use sunbake::texels::{Texel, TexelLane};

    #[test]
    fn the_options_are_consistent() {
        Args::command().debug_assert();
    }

    /// A texel with all that a texel can have.
    fn whole_texel() -> Texel {
        let lanes = vec![TexelLane { offset_deg: 0.0, weight: 1.0, lit: Vec::new() }];
        Texel {
            atlas: 0,
            x: 0,
            y: 0,
            instance: 0,
            position: [0.0; 3],
            normal: [0.0; 3],
            double_sided: true,
            origin: [0.0; 3],
            origin_back: Some([0.0; 3]),
            shading_normal: Some([0.0; 3]),
            origin_lifted: Some([0.0; 3]),
            origin_lifted_back: Some([0.0; 3]),
            is_filled: true,
            lit: Vec::new(),
            lanes,
            lamp: Some(Vec::new()),
            ao: Some(0.0),
            ao_back: Some(0.0),
            bent: Some([0.0; 3]),
            sky: Some([0.0; 9]),
        }
    }

    #[test]
    fn the_help_names_every_field_of_a_texel() {
        let command = Args::command();
        let texels = command.find_subcommand("texels").expect("a command");
        let help = texels.get_long_about().expect("a text").to_string();
        let words: Vec<&str> = help.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        let texel = serde_json::to_value(whole_texel()).expect("JSON");
        let fields = [&texel, &texel["lanes"][0]].map(|value| value.as_object().expect("an object"));
        assert!(fields[0].len() >= 20, "some field was left out: {texel}");
        for field in fields.into_iter().flat_map(|fields| fields.keys()) {
            assert!(words.contains(&field.as_str()), "{field}: {help}");
        }
    }
}
