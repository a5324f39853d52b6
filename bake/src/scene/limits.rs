//! Memory that loading may take, counted before it is allocated.
//!
//! A file of one kilobyte can declare a thousand million vertices, so nothing is allocated for a count in the file
//! before the budget allows it. The budget counts what loading keeps and what decoding needs at the same time. It is
//! never given back, so many primitives that share one large accessor add up as well.

use super::LoadError;
use std::cell::Cell;

/// Limits for loading a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadLimits {
    /// Memory for the file, its vertices, its images and the triangles it draws, in bytes. A scene that needs more is
    /// refused before the memory is taken. 0 refuses everything.
    pub max_memory_bytes: u64,
}

impl Default for LoadLimits {
    /// 4 GiB.
    fn default() -> Self {
        Self { max_memory_bytes: 4 << 30 }
    }
}

/// The memory limit and what was taken of it.
pub(super) struct MemoryBudget {
    limit: u64,
    used: Cell<u64>,
}

impl MemoryBudget {
    pub fn new(limits: &LoadLimits) -> Self {
        Self { limit: limits.max_memory_bytes, used: Cell::new(0) }
    }

    pub fn left(&self) -> u64 {
        self.limit.saturating_sub(self.used.get())
    }

    /// Takes `count * size` bytes; an error that names `what` if they exceed the limit.
    pub fn take(&self, count: u64, size: u64, what: impl FnOnce() -> String) -> Result<(), LoadError> {
        let needed = count.saturating_mul(size);
        if needed > self.left() {
            return Err(LoadError::TooLarge {
                what: what(),
                needed_bytes: needed,
                left_bytes: self.left(),
                limit_bytes: self.limit,
            });
        }
        self.used.set(self.used.get() + needed);
        Ok(())
    }
}

/// Something in a scene that was not read as the file has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneWarning {
    /// What is wrong, and what was done about it.
    pub problem: String,
    /// Where in the file, for example `meshes[1] primitive 0`: the first place of its kind.
    pub place: String,
    /// How many places more have the same problem.
    pub more: usize,
}

impl std::fmt::Display for SceneWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self.more {
            0 => write!(f, "{}: {}", self.place, self.problem),
            more => write!(f, "{} and {more} more: {}", self.place, self.problem),
        }
    }
}

/// Warnings while loading. Equal problems of several places are counted and reported once.
#[derive(Default)]
pub(super) struct WarningLog {
    warnings: Vec<SceneWarning>,
}

impl WarningLog {
    /// Notes that `place` has this problem.
    pub fn warn(&mut self, problem: impl Into<String>, place: impl Into<String>) {
        let problem = problem.into();
        match self.warnings.iter_mut().find(|known| known.problem == problem) {
            Some(known) => known.more += 1,
            None => self.warnings.push(SceneWarning { problem, place: place.into(), more: 0 }),
        }
    }

    /// The warnings, in the order in which they were first noted.
    pub fn into_warnings(self) -> Vec<SceneWarning> {
        self.warnings
    }
}
