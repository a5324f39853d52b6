//! The time that measuring may take.

use crate::progress::{BakeStep, Progress};
use crate::report::with_unit;
use std::time::Instant;

/// How far a started run may exceed the budget, as a share of it.
const GRACE: f64 = 0.1;

/// The wall-clock time that is left. As a [`Progress`], it forwards everything to the caller's, and also cancels what
/// exceeds the budget.
pub(super) struct Budget<'a> {
    started: Instant,
    seconds: f64,
    progress: &'a dyn Progress,
}

impl<'a> Budget<'a> {
    pub fn new(seconds: f64, progress: &'a dyn Progress) -> Self {
        Self { started: Instant::now(), seconds, progress }
    }

    /// Seconds that are allowed.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    pub fn spent_s(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Why a run that takes this many seconds is not started, if it does not fit.
    pub fn refusal(&self, predicted_s: f64) -> Option<String> {
        let left_s = (self.seconds - self.spent_s()).max(0.0);
        (predicted_s > left_s).then(|| {
            format!(
                "not run: about {} predicted, {} of the budget left",
                with_unit(predicted_s, "s"),
                with_unit(left_s, "s")
            )
        })
    }

    /// Whether the user wants to stop.
    pub fn is_interrupted(&self) -> bool {
        self.progress.is_cancelled()
    }
}

impl Progress for Budget<'_> {
    fn task(&self, name: &str) {
        self.progress.task(name);
    }

    fn start(&self, step: BakeStep, total: u64) {
        self.progress.start(step, total);
    }

    fn advance(&self, by: u64) {
        self.progress.advance(by);
    }

    fn is_cancelled(&self) -> bool {
        self.is_interrupted() || self.spent_s() > (1.0 + GRACE) * self.seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;

    #[test]
    fn what_does_not_fit_is_refused_with_both_times() {
        let budget = Budget::new(100.0, &Silent);
        assert_eq!(budget.refusal(50.0), None);
        let words = budget.refusal(500.0).unwrap();
        assert!(words.contains("8.33 min predicted") && words.contains("of the budget left"), "{words}");
        assert!(!budget.is_cancelled() && Budget::new(-1.0, &Silent).is_cancelled());
    }
}
