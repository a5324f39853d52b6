//! What to measure, and within which limits.

use crate::scene::ObjectWishes;
use crate::settings::{BakeSettings, SunRequest};

/// What to measure, and how long that may take.
#[derive(Debug, Clone, PartialEq)]
pub struct CostSettings {
    /// Which sun.
    pub sun: SunRequest,
    /// What is asked for objects by name.
    pub objects: ObjectWishes,
    /// Edge of the page whose texels the sweeps sample, 64 to 16384, usually that of the standard preset.
    pub page_size_texels: u32,
    /// Seconds that all measurements may take, 10 to 86400, usually 600. With more seconds, more is run.
    pub budget_s: f64,
    /// Threads, 0 for one a core.
    pub threads: usize,
    /// Memory that a bake may plan for; none: what its preset allows.
    pub max_memory_bytes: Option<u64>,
}

impl CostSettings {
    /// A preset with this sun and these limits.
    pub(super) fn preset(&self, of: fn(SunRequest) -> BakeSettings) -> BakeSettings {
        let preset = of(self.sun.clone());
        BakeSettings {
            objects: self.objects.clone(),
            threads: self.threads,
            max_memory_bytes: self.max_memory_bytes.unwrap_or(preset.max_memory_bytes),
            ..preset
        }
    }
}
