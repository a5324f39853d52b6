//! Why a bake can fail.

use super::memory::BYTES_PER_SAMPLE;
use crate::atlas::AtlasError;
use crate::disk::write::WriteError;
use crate::glb::GlbTooLarge;
use crate::lamp::{LampError, LampFileError};
use crate::remedy::Setting;
use crate::scene::{LoadError, ObjectError, Role, Scene};
use crate::settings::EngineChoice;
use crate::sun::{DayError, KeyedError, LightError};

/// Why a bake did not finish. Nothing was left behind.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// The scene cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The day is impossible.
    #[error(transparent)]
    Day(#[from] DayError),
    /// The path file is wrong.
    #[error(transparent)]
    Keyed(#[from] KeyedError),
    /// The lamp's path file is wrong.
    #[error(transparent)]
    LampFile(#[from] LampFileError),
    /// The lamp's path cannot last as long as the sun's.
    #[error(transparent)]
    Lamp(#[from] LampError),
    /// Two lamps are asked for.
    #[error("the path file and the lamp file both bring a lamp, and a set holds one")]
    TwoLamps,
    /// The engine finds no lamps.
    #[error("the engine {0} does not find when a lamp is seen")]
    LampEngine(EngineChoice),
    /// The scene's light makes no path.
    #[error(transparent)]
    Light(#[from] LightError),
    /// What is asked for objects cannot be granted.
    #[error(transparent)]
    Objects(#[from] ObjectError),
    /// The scene cannot be laid out.
    #[error(transparent)]
    Atlas(AtlasError),
    /// The listener asked to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
    /// The scene cannot be written again.
    #[error(transparent)]
    TooLarge(#[from] GlbTooLarge),
    /// The set cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// More memory is needed than allowed.
    #[error("{what} needs about {needed_mib} MiB of memory and {allowed_mib} MiB are allowed")]
    Memory {
        /// What needs the memory, to be read before "needs".
        what: String,
        /// Settings of which a smaller value makes it need less.
        smaller: Vec<Setting>,
        /// How much, in MiB.
        needed_mib: u64,
        /// How much is allowed, in MiB.
        allowed_mib: u64,
    },
    /// The threads cannot be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system says.
        reason: String,
    },
    /// OpenEXR is asked for, and the feature `exr` is off.
    #[error("this build writes no OpenEXR, which ambient numbers and loss maps are stored as")]
    NoExr,
}

impl BakeError {
    /// Why a scene cannot be laid out, with the names of its objects.
    pub(super) fn of_atlas(error: AtlasError, scene: &Scene) -> Self {
        match error {
            AtlasError::Cancelled => Self::Cancelled,
            AtlasError::TooDense { instance, of_instance, texels, most } => Self::Memory {
                what: format!(
                    "the density asked for (about {texels} texels, {of_instance} of them for {})",
                    scene.meshes[scene.instances[instance].mesh].label()
                ),
                smaller: match &scene.instances[instance].role {
                    Role { texels_per_metre: Some(_), .. } => vec![Setting::ObjectDensity],
                    Role { texels_per_metre_around: Some(_), .. } => vec![Setting::ObjectDensityAround],
                    _ => vec![Setting::TexelsPerMetre],
                },
                needed_mib: texels.saturating_mul(BYTES_PER_SAMPLE) >> 20,
                allowed_mib: most.saturating_mul(BYTES_PER_SAMPLE) >> 20,
            },
            other => Self::Atlas(other),
        }
    }
}
