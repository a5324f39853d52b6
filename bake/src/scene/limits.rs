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

/// Warnings while loading. Equal sentences about several places are counted and reported once.
#[derive(Default)]
pub(super) struct WarningLog {
    entries: Vec<(String, String, usize)>,
}

impl WarningLog {
    /// Adds a warning: `sentence` is about `place`.
    pub fn warn(&mut self, sentence: impl Into<String>, place: impl Into<String>) {
        let sentence = sentence.into();
        match self.entries.iter_mut().find(|(known, _, _)| *known == sentence) {
            Some((_, _, count)) => *count += 1,
            None => self.entries.push((sentence, place.into(), 1)),
        }
    }

    /// One line for each sentence, in the order of their first place.
    pub fn into_sentences(self) -> Vec<String> {
        let say = |(sentence, place, count)| match count {
            1 => format!("{place}: {sentence}"),
            _ => format!("{place} and {} more: {sentence}", count - 1),
        };
        self.entries.into_iter().map(say).collect()
    }
}
