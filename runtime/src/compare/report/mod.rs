//! The report of a comparison: `report.json`, whose schema is `runtime/schemas/compare.schema.json`, and a page of
//! HTML.
//!
//! Every error stands beside the time and the bytes that it cost, and every time beside its error.

mod page;
mod pictures;
mod tables;
mod wording;

pub use page::{PageError, page};
pub use pictures::{FramePictures, Pictures};

use super::score::Score;
use serde::{Deserialize, Serialize};

/// What [`Report::format`] says.
pub const FORMAT: &str = "sunbake-compare";
/// What [`Report::version`] says.
pub const VERSION: u32 = 1;

/// What [`Report::generator`] says: this crate's command.
pub const GENERATOR: &str = concat!("sunplay ", env!("CARGO_PKG_VERSION"));

/// The whole of `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Report {
    /// Always `sunbake-compare`.
    pub format: String,
    /// Always 1.
    pub version: u32,
    /// Program and version that made it.
    pub generator: String,
    /// The scene that was drawn.
    pub scene: SceneEntry,
    /// The machine that drew it.
    pub machine: MachineEntry,
    /// What every technique is compared with.
    pub reference: ReferenceEntry,
    /// Width and height of every picture, in pixels.
    pub size: [u32; 2],
    /// Cameras that every technique was drawn from.
    pub cameras: Vec<CameraEntry>,
    /// Times of day that every technique was drawn at.
    pub times: Vec<TimeEntry>,
    /// How often each picture was drawn; the least of its times counts.
    pub rounds: u32,
    /// Techniques that were compared.
    pub techniques: Vec<TechniqueEntry>,
    /// Techniques that were not compared, and why.
    pub left_out: Vec<LeftOut>,
    /// Limits that were set with `--fail-above`, and whether they were kept.
    pub limits: Vec<LimitEntry>,
    /// Why some of the numbers are worth less than they look.
    pub warnings: Vec<String>,
    /// How to read the numbers.
    pub notes: Vec<String>,
}

/// The scene, with the sets that were baked of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SceneEntry {
    /// Its file's name.
    pub name: String,
    /// SHA-256 of the file that was baked or drawn, and of the files that it refers to.
    pub sha256: String,
    /// Triangles that are drawn or cast shadows.
    pub triangles: u64,
    /// The sets that were baked of it, or the set that was given.
    pub sets: Vec<SetEntry>,
}

/// A baked set that techniques played back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SetEntry {
    /// Lanes across the sun's disc.
    pub lanes: u64,
    /// Bits of a stored time.
    pub bits: u32,
    /// Texels that hold a surface point.
    pub texels: u64,
    /// Density of texels on surfaces.
    pub texels_per_metre: f64,
    /// Seconds to bake it, without ambient light and shadow tracks, on the machine that baked it.
    pub bake_s: f64,
    /// Bytes of its files, without those of the scene, of ambient light and of shadow tracks.
    pub disk_bytes: u64,
    /// Its shadow tracks; null where there are none.
    pub tracks: Option<SetTracksEntry>,
    /// Engine that computed its times.
    pub engine: String,
}

/// The shadow tracks of a baked set.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SetTracksEntry {
    /// Seconds to find them, on the machine that baked them, beside those of the set.
    pub bake_s: f64,
    /// Bytes of their files, which are read in place of those of the intervals.
    pub disk_bytes: u64,
}

/// The machine that drew.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MachineEntry {
    /// Model of its processor; `unknown` where the system does not say.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: u64,
    /// Threads that did the work.
    pub threads: u64,
    /// Operating system and architecture.
    pub os: String,
    /// Name of the GPU adapter; null where the CPU drew.
    pub adapter: Option<String>,
    /// Whether that adapter is a software GPU (llvmpipe): its times are the CPU's, and say nothing of a GPU's.
    pub is_software: bool,
}

/// What every technique is compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReferenceEntry {
    /// Name of the technique that is the reference.
    pub name: String,
    /// Milliseconds per frame, without finding which surface each pixel shows.
    pub frame_ms: f64,
    /// Its mean error against truth with four times as many rays, in the frame with most penumbra: errors of this size
    /// are noise. Null where the reference has no noise.
    pub noise: Option<f64>,
}

/// A camera that frames were drawn from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CameraEntry {
    /// The camera's name in the scene or, without one, where it looks from.
    pub name: String,
    /// Where it stands, world space, metres.
    pub eye_m: [f64; 3],
    /// Unit vector along which it looks.
    pub forward: [f64; 3],
    /// Vertical field of view, in degrees.
    pub fov_deg: f64,
}

/// A time of day.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TimeEntry {
    /// Place on the sun's path, 0 to 1.
    pub t: f64,
    /// Local clock time or, where there is no clock, `t` as text.
    pub clock: String,
    /// The sun's angle above the horizon, in degrees.
    pub elevation_deg: f64,
}

/// A technique, with its cost and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TechniqueEntry {
    /// Its name, as `--techniques` takes it.
    pub name: String,
    /// `baked`, `volumes`, `map` or `truth`.
    pub family: String,
    /// Whether it takes the sun for a point, and so draws no penumbra.
    pub is_hard: bool,
    /// Its error against the reference, over all frames.
    pub error: Score,
    /// Error against truth of the sun's centre, for a technique that takes the sun for a point. Null for others, and
    /// where the reference is not soft truth.
    pub hard_error: Option<Score>,
    /// Mean times of a frame.
    pub times: Times,
    /// What it needed before the first frame.
    pub preparation: Preparation,
    /// Bytes of memory kept from frame to frame, beyond the scene itself.
    pub memory_bytes: u64,
    /// Bytes on disk, without the scene; null where nothing is stored, or was not written to disk.
    pub disk_bytes: Option<u64>,
    /// What it decided for the last frame, as sentences.
    pub plan: Vec<String>,
    /// Frames: all cameras at the first time, then at the next.
    pub frames: Vec<FrameEntry>,
}

/// Times of a frame under a moving sun: nothing is kept from frame to frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Times {
    /// Milliseconds per frame: its passes and the CPU's work for them or, where passes are not timed, from call to
    /// picture.
    pub frame_ms: f64,
    /// Milliseconds of the passes by the adapter's clock; null where they are not timed.
    pub passes: Option<Passes>,
    /// Milliseconds on the CPU to find what the passes draw.
    pub cpu_ms: f64,
    /// Milliseconds from call to picture, including reading it back.
    pub wall_ms: f64,
}

/// Milliseconds of a frame's passes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Passes {
    /// The camera's depth pass.
    pub depth_ms: f64,
    /// Shadow volumes in the stencil buffer.
    pub volumes_ms: f64,
    /// Drawing shadow maps.
    pub maps_ms: f64,
    /// Finding visibility at each pixel.
    pub light_ms: f64,
    /// From the start of the first pass to the end of the last.
    pub all_ms: f64,
}

/// What comes before the first frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Preparation {
    /// Seconds to bake, with all steps but ambient light; null where nothing is baked, and for one lane of a set with
    /// several. For eight bits made of sixteen it is the set's, since rounding takes next to no time. For tracks it is
    /// that of the intervals, which they are found from, and their own.
    pub bake_s: Option<f64>,
    /// Seconds to upload the scene and build pipelines.
    pub setup_s: f64,
}

/// A frame of a technique.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrameEntry {
    /// Index in `cameras`.
    pub camera: u64,
    /// Index in `times`.
    pub time: u64,
    /// Its error against the reference.
    pub error: Score,
    /// Milliseconds of this frame, as in `times`.
    pub frame_ms: f64,
}

/// A technique that was not compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LeftOut {
    /// Name of the technique.
    pub name: String,
    /// Why it was not compared, as a sentence.
    pub reason: String,
}

/// A limit, and whether it was kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LimitEntry {
    /// The number that is limited, as `--fail-above` names it.
    pub key: String,
    /// The largest value allowed.
    pub limit: f64,
    /// Techniques above the limit, with their values.
    pub above: Vec<AboveLimit>,
    /// Techniques that could not be checked: left out, or without a compared pixel.
    pub unchecked: Vec<String>,
}

/// A technique above a limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AboveLimit {
    /// Name of the technique.
    pub name: String,
    /// The value that is above the limit.
    pub value: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_committed_schema_is_the_codes() {
        let mut schema = schemars::schema_for!(Report);
        schema.insert("title".into(), "report.json of sunplay compare".into());
        let made = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/compare.schema.json");
        if std::env::var_os("BLESS").is_some() {
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(&file, &made).unwrap();
        }
        let committed = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(committed == made, "{} is not what the code makes: run this test with BLESS=1", file.display());
    }
}
