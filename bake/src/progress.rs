//! How a bake tells how far it is.

/// A stage of a bake, in the order they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BakeStage {
    /// Reading the scene. Counts nothing.
    Load,
    /// Unwrapping and packing. Counts thousandths.
    Unwrap,
    /// Building the hierarchy. Counts nothing.
    Bvh,
    /// Finding when the sun is seen. Counts texels.
    Visibility,
    /// Finding when the lamp is seen. Counts texels.
    Lamp,
    /// Finding how much of the sky is seen. Counts texels.
    Ambient,
    /// Turning them into codes. Counts texels.
    Encode,
    /// Writing files. Counts nothing.
    Write,
}

impl BakeStage {
    /// What to call it while it runs.
    pub fn verb(self) -> &'static str {
        match self {
            Self::Load => "reading the scene",
            Self::Unwrap => "unwrapping",
            Self::Bvh => "building the hierarchy",
            Self::Visibility => "tracing the sun",
            Self::Lamp => "tracing the lamp",
            Self::Ambient => "tracing the sky",
            Self::Encode => "encoding",
            Self::Write => "writing",
        }
    }
}

/// Listens to a bake. Calls come from any thread.
pub trait Progress: Sync {
    /// What the stages to come are part of, where a bake is one of many things.
    fn task(&self, _name: &str) {}
    /// A stage starts; `total` is how much it will count, 0 if it does not count.
    fn start(&self, stage: BakeStage, total: u64);
    /// The current stage got on by so much.
    fn advance(&self, by: u64);
    /// Whether the bake should stop: it then fails with [`crate::BakeError::Cancelled`], and leaves nothing behind.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Listens to nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn start(&self, _stage: BakeStage, _total: u64) {}
    fn advance(&self, _by: u64) {}
}
