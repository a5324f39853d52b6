//! Why measuring costs can fail.

use crate::BakeError;
use crate::disk::folder::FolderError;
use crate::disk::read::ReadError;
use crate::scene::LoadError;

/// Why costs were not measured. Nothing was left behind.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// The scene cannot be read or baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// A set that was just written cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The scene of a set that was just written cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The report cannot be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// There is no sun to measure with.
    #[error("{0}, and costs are measured by the sun")]
    NoSun(String),
    /// There is nothing to measure.
    #[error("the scene has no surface to bake, so there is nothing to measure")]
    NoSurface,
    /// A set's scene is not the scene that was baked.
    #[error("triangle {triangle} of the baked scene lies {apart_m} m from where it was: this is a defect of sunbake")]
    Moved {
        /// Index of the triangle in the scene that was read again.
        triangle: u32,
        /// Distance that it moved.
        apart_m: f64,
    },
}
