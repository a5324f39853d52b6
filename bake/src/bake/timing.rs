//! Timing and cancelling the steps of a bake.

use super::error::BakeError;
use crate::progress::Progress;
use std::time::Instant;

/// Fails if the caller wants the bake to stop.
pub(super) fn check_cancelled(progress: &dyn Progress) -> Result<(), BakeError> {
    if progress.is_cancelled() { Err(BakeError::Cancelled) } else { Ok(()) }
}

/// Runs `work` and adds its wall-clock seconds to `seconds`.
pub(super) fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let value = work();
    *seconds += started.elapsed().as_secs_f64();
    value
}
