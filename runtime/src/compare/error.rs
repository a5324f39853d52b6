//! Why a comparison has no result.

use super::technique::TechniqueNameError;
use crate::camera::CameraError;
use crate::gpu::GpuError;
use crate::light::TimeError;
use crate::stage::StageError;
use sunbake::BakeError;

/// Why a comparison has no result.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A set cannot be read.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The scene cannot be baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// There is no folder to bake into.
    #[error("cannot make a folder to bake into: {0}")]
    WorkFolder(std::io::Error),
    /// The scene that a set is said to be baked of is another one.
    #[error(
        "{file} is not the scene that the set was baked of: its SHA-256 is {found}, and was {baked}; bake it again"
    )]
    OtherScene {
        /// Path of the scene file.
        file: String,
        /// SHA-256 of the scene file now.
        found: String,
        /// The hash of what was baked.
        baked: String,
    },
    /// A technique's name means none.
    #[error(transparent)]
    TechniqueName(#[from] TechniqueNameError),
    /// The reference needs bits or lanes that the set does not have.
    #[error("this set cannot be played back as {0}")]
    ReferenceNotInSet(String),
    /// Without a sun there is nothing to compare.
    #[error("there is no sun to compare by")]
    NoSun,
    /// A time is not on the sun's path.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// A camera cannot be had.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// All frames together have too many pixels.
    #[error("{frames} frames of {}x{} are {pixels} pixels, and {most} are the most", size[0], size[1])]
    TooManyPixels {
        /// Cameras times times of day.
        frames: usize,
        /// Width and height of a frame, in pixels.
        size: [u32; 2],
        /// Pixels of all frames.
        pixels: u64,
        /// The most that are allowed.
        most: u64,
    },
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The reference cannot be drawn.
    #[error("the reference {name} cannot be drawn: {reason}")]
    Reference {
        /// Name of the technique.
        name: String,
        /// Why it cannot be drawn.
        reason: String,
    },
    /// The listener asked to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
}
