//! Progress of building an atlas.

use std::sync::Mutex;

/// Share of the progress that unwrapping takes, 0 to 1.
pub(super) const UNWRAP_SHARE: f64 = 0.7;

/// Reports progress to a callback, and remembers if the callback asked to stop.
pub(super) struct ProgressMeter<'a> {
    callback: &'a (dyn Fn(f64) -> bool + Sync),
    /// Largest fraction reported, and whether to go on.
    state: Mutex<(f64, bool)>,
}

impl<'a> ProgressMeter<'a> {
    /// Wraps a callback that takes the share of work done, 0 to 1, and returns false to stop.
    pub fn new(callback: &'a (dyn Fn(f64) -> bool + Sync)) -> Self {
        Self { callback, state: Mutex::new((0.0, true)) }
    }

    /// Reports a fraction done (0 to 1); progress never goes backwards. Returns false to stop.
    pub fn reach(&self, fraction: f64) -> bool {
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        state.0 = state.0.max(fraction);
        state.1 = state.1 && (self.callback)(state.0);
        state.1
    }
}
