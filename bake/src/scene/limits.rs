//! Memory that loading may take, counted before it is taken.
//!
//! A file of a kilobyte can declare a thousand million vertices, so nothing is allocated for a count that a file states
//! until the budget has agreed. What is counted is what loading keeps, plus what decoding needs at the same time; it is
//! never handed back, so many primitives that share one large accessor add up as well.

use super::LoadError;
use std::cell::Cell;

/// Limits on what a scene may ask of the machine.
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

/// What is left of the limit.
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

    /// Takes `count` things of `size` bytes, or says what wanted them.
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

/// Warnings, with equal ones gathered into one sentence.
#[derive(Default)]
pub(super) struct WarningLog {
    entries: Vec<(String, String, usize)>,
}

impl WarningLog {
    /// Notes that `sentence` is true of `place`.
    pub fn warn(&mut self, sentence: impl Into<String>, place: impl Into<String>) {
        let sentence = sentence.into();
        match self.entries.iter_mut().find(|(known, _, _)| *known == sentence) {
            Some((_, _, count)) => *count += 1,
            None => self.entries.push((sentence, place.into(), 1)),
        }
    }

    /// One sentence each, in the order they were first noted.
    pub fn into_sentences(self) -> Vec<String> {
        let say = |(sentence, place, count)| match count {
            1 => format!("{place}: {sentence}"),
            _ => format!("{place} and {} more: {sentence}", count - 1),
        };
        self.entries.into_iter().map(say).collect()
    }
}
