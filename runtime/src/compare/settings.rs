//! What is compared, and how.

use super::{Limit, TechniqueSpec};
use crate::camera::CameraChoice;
use crate::light::TimeChoice;
use std::path::PathBuf;
use sunbake::Warning;
use sunbake::progress::{Progress, Silent};
use sunbake::scene::ObjectWishes;
use sunbake::settings::SunRequest;

/// Everything that a comparison is told.
#[derive(Debug, Clone)]
pub struct CompareSettings {
    /// A baked set, or a scene to be baked.
    pub source: CompareSource,
    /// Names of techniques, or parts of their names ([`super::selected`]). None: all that the source allows.
    pub techniques: Vec<String>,
    /// The reference: what every picture is compared with.
    pub against: TechniqueSpec,
    /// Cameras. None: three that see many shadow edges.
    pub cameras: Vec<CameraChoice>,
    /// Times of day. None: five, from a low sun in the morning to one in the evening.
    pub times: Vec<TimeChoice>,
    /// Width and height of every picture, in pixels.
    pub size: [u32; 2],
    /// How often each frame is drawn and timed; the least of its times counts. None: 3, or 1 without a real GPU.
    pub rounds: Option<u32>,
    /// Edge of shadow maps, in texels. None: as each variant has it.
    pub map_size_texels: Option<u32>,
    /// Limits that the report says were kept or not.
    pub limits: Vec<Limit>,
    /// Threads that bake, as the report states them; 0 is one per core. Drawing uses the current rayon pool.
    pub threads: usize,
}

/// What techniques are compared on.
#[derive(Debug, Clone)]
pub enum CompareSource {
    /// A baked set, compared as it is; fewer bits and lanes are made of those that it has.
    Set {
        /// The folder that holds `sunbake.json`.
        folder: PathBuf,
        /// The scene that it was baked of, to make sure that it still is that one.
        scene: Option<PathBuf>,
    },
    /// A scene, which is baked first: 16 bits, one lane and three.
    Scene {
        /// The glTF file.
        file: PathBuf,
        /// The sun's path.
        sun: SunRequest,
        /// Edge of the page it is baked into, in texels. None: 2048.
        page_size_texels: Option<u32>,
        /// What is asked for objects by name.
        objects: ObjectWishes,
    },
}

/// Listens to a comparison. While a scene is baked it hears that bake's steps.
pub trait CompareProgress: Progress {
    /// Drawing starts. [`Progress::advance`] follows once a frame, and drawing stops if [`Progress::is_cancelled`].
    fn start_drawing(&self, frame_count: u64);
    /// A scene was baked, and this is what the user should know of it. Called once, however many sets are baked.
    fn baked(&self, _warnings: &[Warning]) {}
}

impl CompareProgress for Silent {
    fn start_drawing(&self, _frame_count: u64) {}
}
