//! Progress of a bake, reported to the caller.

use crate::warning::Warning;

/// A step of a bake, in the order they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BakeStep {
    /// Reading the scene. No count.
    Load,
    /// Unwrapping and packing. Counts thousandths.
    Unwrap,
    /// Building the hierarchy. No count.
    Bvh,
    /// Finding the sun's lit intervals. Counts texels.
    Visibility,
    /// Finding shadow tracks. Counts texels that may have some, twice.
    Tracks,
    /// Finding the lamp's lit intervals. Counts texels.
    Lamp,
    /// Finding ambient light. Counts texels.
    Ambient,
    /// Encoding intervals. Counts texels.
    Encode,
    /// Writing files. No count.
    Write,
}

impl BakeStep {
    /// Name of the step while it runs.
    pub fn verb(self) -> &'static str {
        match self {
            Self::Load => "reading the scene",
            Self::Unwrap => "unwrapping",
            Self::Bvh => "building the hierarchy",
            Self::Visibility => "tracing the sun",
            Self::Tracks => "following shadows",
            Self::Lamp => "tracing the lamp",
            Self::Ambient => "tracing the sky",
            Self::Encode => "encoding",
            Self::Write => "writing",
        }
    }
}

/// Receives the progress of a bake. Calls come from any thread.
pub trait Progress: Sync {
    /// Name of the task that the next steps belong to, where a bake is one of several tasks.
    fn task(&self, _name: &str) {}
    /// A step starts; `total` is its final count, 0 if it does not count.
    fn start(&self, step: BakeStep, total: u64);
    /// Adds to the count of the current step.
    fn advance(&self, by: u64);
    /// Something that the user should know before the long part of the bake. It is told again at its end, with the
    /// other warnings of [`crate::BakeReport`].
    fn warn(&self, _warning: &Warning) {}
    /// Whether the bake should stop. It then fails with [`crate::BakeError::Cancelled`] and leaves nothing behind.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Ignores progress.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn start(&self, _step: BakeStep, _total: u64) {}
    fn advance(&self, _by: u64) {}
}
