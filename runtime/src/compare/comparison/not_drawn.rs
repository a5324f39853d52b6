//! Why a technique drew nothing.

use crate::gpu::GpuError;
use crate::stage::StageError;

/// Why a technique drew nothing.
pub(super) enum NotDrawn {
    Gpu(GpuError),
    Stage(StageError),
    Cancelled,
    /// It cannot be drawn here, and why.
    Unsupported(String),
}

impl From<GpuError> for NotDrawn {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl From<StageError> for NotDrawn {
    fn from(error: StageError) -> Self {
        Self::Stage(error)
    }
}
