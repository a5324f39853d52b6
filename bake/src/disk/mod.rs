//! A baked set on disk: `sunbake.json`, `scene.glb` and the maps. Only [`write`] writes one; only [`read`] reads one.

pub mod manifest;
pub mod read;
pub mod write;
