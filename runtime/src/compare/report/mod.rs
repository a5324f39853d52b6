//! What a comparison found, as it is written down: `report.json`, whose schema is `runtime/schemas/compare.schema.json`.
//!
//! Every error stands beside the time and the bytes that it cost, and every time beside its error.

mod page;
mod pictures;
mod tables;
mod wording;

pub use page::page;
pub use pictures::{FramePictures, Pictures};

use super::score::Score;
use serde::{Deserialize, Serialize};

/// What [`Report::format`] says.
pub const FORMAT: &str = "sunbake-compare";
/// What [`Report::version`] says.
pub const VERSION: u32 = 1;

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
    /// What was drawn.
    pub scene: SceneEntry,
    /// What drew it.
    pub machine: MachineEntry,
    /// What every technique is held against.
    pub reference: ReferenceEntry,
    /// Width and height of every picture, in pixels.
    pub size: [u32; 2],
    /// Through which cameras.
    pub cameras: Vec<CameraEntry>,
    /// At which times.
    pub times: Vec<TimeEntry>,
    /// How often each picture was drawn; the least of its times counts.
    pub rounds: u32,
    /// What was compared.
    pub techniques: Vec<TechniqueEntry>,
    /// What was not, and why.
    pub left_out: Vec<LeftOut>,
    /// Limits that were set with `--fail-above`, and whether they were kept.
    pub limits: Vec<LimitEntry>,
    /// What makes these numbers worth less than they look.
    pub warnings: Vec<String>,
    /// How to read them.
    pub notes: Vec<String>,
}

/// The scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SceneEntry {
    /// Its file's name.
    pub name: String,
    /// SHA-256 of the file that was baked or drawn, and of what it refers to.
    pub sha256: String,
    /// Triangles that are drawn or cast.
    pub triangles: u64,
    /// The sets that were baked of it, or that was given.
    pub sets: Vec<SetEntry>,
}

/// A baked set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SetEntry {
    /// Lanes across the sun's disc.
    pub lanes: u64,
    /// Bits of a stored time.
    pub bits: u32,
    /// Texels that stand for a point of a surface.
    pub texels: u64,
    /// Their density.
    pub texels_per_metre: f64,
    /// Seconds to bake it, without ambient light, on the machine that did.
    pub bake_s: f64,
    /// Bytes of its files, without those of the scene and of ambient light.
    pub disk_bytes: u64,
    /// Engine that found its times.
    pub engine: String,
}

/// What drew.
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
    /// The GPU adapter; null where there was none and the CPU drew.
    pub adapter: Option<String>,
    /// Whether that adapter is a CPU that plays a GPU: its times are the CPU's, and tell nothing of a GPU's.
    pub is_software: bool,
}

/// What techniques are held against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReferenceEntry {
    /// Its name.
    pub name: String,
    /// Milliseconds a frame took, once it was known which surface each pixel shows.
    pub frame_ms: f64,
    /// How far it is from truth of four times as many rays, in the mean over the frame with most penumbra: an error of this size is
    /// noise. Null where the reference has none.
    pub noise: Option<f64>,
}

/// A camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CameraEntry {
    /// Its name.
    pub name: String,
    /// Where it stands, world space, metres.
    pub eye_m: [f64; 3],
    /// Unit vector along which it looks.
    pub forward: [f64; 3],
    /// Vertical field of view.
    pub fov_deg: f64,
}

/// A time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TimeEntry {
    /// On the sun's path, 0 to 1.
    pub t: f64,
    /// By local clocks or, where there are none, the same as text.
    pub clock: String,
    /// Degrees that the sun stands above the horizon.
    pub elevation_deg: f64,
}

/// A technique, with what it cost and how far it was off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TechniqueEntry {
    /// Its name, as `--techniques` takes it.
    pub name: String,
    /// `baked`, `volumes`, `map` or `truth`.
    pub family: String,
    /// Whether it takes the sun for a point.
    pub is_hard: bool,
    /// How far it is from the reference, over all frames.
    pub error: Score,
    /// Of one that takes the sun for a point: how far it is from truth of the sun's centre. Null for others, and where the
    /// reference is no soft truth.
    pub hard_error: Option<Score>,
    /// What a frame took, in the mean.
    pub times: Times,
    /// What it took before the first frame.
    pub preparation: Preparation,
    /// Bytes it keeps from frame to frame, beyond the scene itself.
    pub memory_bytes: u64,
    /// Bytes on disk, without the scene; null where nothing is stored, or what is stored was not written.
    pub disk_bytes: Option<u64>,
    /// What it decided for the last frame, in words.
    pub plan: Vec<String>,
    /// Frame by frame, cameras in turn at each time.
    pub frames: Vec<FrameEntry>,
}

/// What a frame takes while the sun moves: nothing is kept from frame to frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Times {
    /// Milliseconds a frame: its passes and what the CPU finds for them or, where passes are not timed, from call to picture.
    pub frame_ms: f64,
    /// Milliseconds of the passes by the adapter's clock; null where they are not timed.
    pub passes: Option<Passes>,
    /// Milliseconds on the CPU to find what passes draw.
    pub cpu_ms: f64,
    /// Milliseconds from call to picture, with reading it back.
    pub wall_ms: f64,
}

/// Milliseconds of passes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Passes {
    /// Depths.
    pub depth_ms: f64,
    /// Shadow volumes.
    pub volumes_ms: f64,
    /// Shadow maps.
    pub maps_ms: f64,
    /// Light.
    pub light_ms: f64,
    /// From the start of the first to the end of the last.
    pub all_ms: f64,
}

/// What comes before the first frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Preparation {
    /// Seconds to bake, with all stages but ambient light; null where nothing is baked, and for a lane cut out of a set of several.
    /// Of eight bits made of sixteen it is the set's, since rounding takes no time to speak of.
    pub bake_s: Option<f64>,
    /// Seconds to upload the scene and build what draws it.
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
    /// How far it is from the reference.
    pub error: Score,
    /// Milliseconds that it took, as in [`Times`].
    pub frame_ms: f64,
}

/// What was not compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LeftOut {
    /// Its name.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// A limit of `--fail-above`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LimitEntry {
    /// What is limited.
    pub key: String,
    /// The most that is allowed.
    pub limit: f64,
    /// Techniques that are above it, with what they have.
    pub above: Vec<AboveLimit>,
    /// Techniques of which that cannot be told: left out, or without a pixel to tell by.
    pub unchecked: Vec<String>,
}

/// A technique above a limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AboveLimit {
    /// Its name.
    pub name: String,
    /// What it has.
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
