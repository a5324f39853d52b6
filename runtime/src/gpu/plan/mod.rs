//! What a scene calls for on the GPU, decided before anything is built. Each renderer adds its own in its `plan.rs`.

mod scene_effects;
mod scene_needs;

pub use scene_effects::{SceneEffects, change_keys, of_maps_alone, of_passes};
pub use scene_needs::{PageNeeds, SceneNeeds};
