//! Why a bake can fail.

use super::memory::BYTES_PER_SAMPLE;
use crate::atlas::{AtlasError, Misfit};
use crate::disk::write::WriteError;
use crate::glb::GlbTooLarge;
use crate::lamp::{LampError, LampFileError};
use crate::remedy::{Remedy, Setting};
use crate::scene::{LoadError, ObjectError, Scene};
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
    /// No page that is allowed holds what must lie on one.
    #[error("{misfit} of {page_size_texels} texels, with a padding of {padding_texels}")]
    PageTooSmall {
        /// What does not fit, up to the word page or pages.
        misfit: String,
        /// What would help.
        remedy: Remedy,
        /// Edge of a page that was asked for, in texels.
        page_size_texels: u32,
        /// Padding that was asked for, in texels.
        padding_texels: u32,
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
                    "the density asked for ({} texels, {} of them for {})",
                    about(texels),
                    about(of_instance),
                    mesh_label(scene, instance)
                ),
                smaller: vec![density_setting(scene, instance)],
                needed_mib: texels.saturating_mul(BYTES_PER_SAMPLE) >> 20,
                allowed_mib: most.saturating_mul(BYTES_PER_SAMPLE) >> 20,
            },
            AtlasError::PageTooSmall { misfit, padding, page_size } => Self::PageTooSmall {
                misfit: in_names(misfit, scene),
                remedy: Remedy::AnyOf(
                    [Remedy::Raise(Setting::PageSize)].into_iter().chain(smaller(misfit, scene)).collect(),
                ),
                page_size_texels: page_size,
                padding_texels: padding,
            },
            other => Self::Atlas(other),
        }
    }
}

/// What messages call the mesh of an instance.
fn mesh_label(scene: &Scene, instance: usize) -> String {
    scene.meshes[scene.instances[instance].mesh].label()
}

/// The setting that gives an instance its density.
fn density_setting(scene: &Scene, instance: usize) -> Setting {
    let has_own = scene.instances[instance].role.texels_per_metre.is_some();
    let is_around = scene.instances.iter().any(|other| other.role.texels_per_metre_around.is_some());
    match (has_own, is_around) {
        (true, _) => Setting::ObjectDensity,
        (false, true) => Setting::ObjectDensityAround,
        (false, false) => Setting::TexelsPerMetre,
    }
}

/// What does not fit pages, with the names of its objects.
pub(super) fn in_names(misfit: Misfit, scene: &Scene) -> String {
    match misfit {
        Misfit::Charts { instance, charts } => {
            format!("mesh {} has {charts} charts, too many for a page", mesh_label(scene, instance))
        }
        Misfit::Density { instance } => {
            format!("at the density asked for, mesh {} is too large for a page", mesh_label(scene, instance))
        }
        Misfit::Pages { .. } => misfit.to_string(),
    }
}

/// What makes it smaller.
pub(super) fn smaller(misfit: Misfit, scene: &Scene) -> Vec<Remedy> {
    match misfit {
        Misfit::Charts { .. } => vec![Remedy::Lower(Setting::Padding), Remedy::Do("simplify the mesh")],
        Misfit::Density { instance } => vec![Remedy::Lower(density_setting(scene, instance))],
        Misfit::Pages { .. } => vec![Remedy::Lower(Setting::TexelsPerMetre), Remedy::Do("simplify the scene")],
    }
}

/// A number of texels, in words where it is beyond counting.
fn about(texels: u64) -> String {
    match texels {
        0..1_000_000_000 => format!("about {texels}"),
        1_000_000_000..1_000_000_000_000 => format!("about {:.1} billion", texels as f64 * 1e-9),
        _ => "more than a thousand billion".to_owned(),
    }
}
