//! What pictures of a baked stage call for.

use super::batch::BatchKey;
use super::census::Census;
use super::effects::{SceneEffects, of_passes};
use super::needs::SceneNeeds;
use super::renderer::Output;
use super::scene::depth_key;
use crate::plan::DrawPlan;
use crate::stage::Stage;
use std::collections::BTreeSet;

/// A batch's program does not depend on which image it draws with; on its page it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProgramKey {
    /// Depths.
    Depth(BatchKey),
    /// Surfaces.
    Surface(Output, BatchKey),
    /// The background.
    Sky,
}

impl ProgramKey {
    /// The surfaces that it draws, if it does.
    pub fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Surface(_, key) => Some(key),
            Self::Sky => None,
        }
    }
}

/// What pictures of a kind call for of a baked stage, of which nothing has been built.
pub fn baked_plan(stage: &Stage, output: Output) -> DrawPlan {
    plan(&SceneNeeds::new(stage, None), output)
}

/// What pictures of a kind call for of a scene.
pub fn plan(scene: &SceneNeeds, output: Output) -> DrawPlan {
    let totals = |scene: &SceneNeeds| totals(scene, output);
    let is_surface = |key: &ProgramKey| matches!(key, ProgramKey::Surface(..));
    let lit = programs(scene, output).into_iter().filter(is_surface).count();
    let of_scene = SceneEffects { scene, totals: &totals }.all();
    let needs = of_passes(scene, output, lit).into_iter().chain(of_scene).collect();
    DrawPlan { needs, totals: totals(scene), is_exact: true }
}

fn totals(scene: &SceneNeeds, output: Output) -> Census {
    let programs = programs(scene, output);
    let surfaces = programs.iter().filter_map(ProgramKey::batch);
    Census { passes: 2, targets: 2, ..scene.census().with_pipelines(programs.len(), surfaces) }
}

/// The programs of an output.
pub fn programs(scene: &SceneNeeds, output: Output) -> BTreeSet<ProgramKey> {
    let of_batch =
        |key: &BatchKey| [ProgramKey::Depth(depth_key(key)), ProgramKey::Surface(output, scene.surface_key(key))];
    let sky = (output == Output::Lit).then_some(ProgramKey::Sky);
    scene.batches.iter().flat_map(of_batch).chain(sky).collect()
}
