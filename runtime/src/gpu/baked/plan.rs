//! What pictures of a baked stage call for.

use crate::Filter;
use crate::gpu::frame::{BatchKey, BatchRequest, Output, ProgramKey, depth_key, with_pipelines};
use crate::gpu::plan::{SceneEffects, SceneNeeds, of_passes};
use crate::plan::{Census, DrawPlan};
use crate::stage::Stage;
use std::collections::BTreeSet;

/// A pipeline. It does not depend on the image of a batch, but on how its page is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BakedProgram {
    /// Depths.
    Depth(BatchKey),
    /// Surfaces.
    Surface(Output, BatchKey),
    /// The sky.
    Sky,
}

impl ProgramKey for BakedProgram {
    fn batch(&self) -> Option<&BatchKey> {
        match self {
            Self::Depth(key) | Self::Surface(_, key) => Some(key),
            Self::Sky => None,
        }
    }

    fn has_color(&self) -> bool {
        !matches!(self, Self::Depth(_))
    }
}

/// What pictures of a kind call for of a baked stage of which nothing has been built.
pub fn baked_plan(stage: &Stage, filter: Filter, output: Output) -> DrawPlan {
    plan(&SceneNeeds::new(stage, request(filter)), output)
}

/// What a filter wants of a scene.
pub fn request(filter: Filter) -> BatchRequest<'static> {
    BatchRequest { wants_tracks: filter == Filter::Tracks, ..BatchRequest::default() }
}

/// What pictures of a kind call for of a scene.
pub fn plan(scene: &SceneNeeds, output: Output) -> DrawPlan {
    let totals = |scene: &SceneNeeds| totals(scene, output);
    let is_surface = |key: &BakedProgram| matches!(key, BakedProgram::Surface(..));
    let lit = programs(scene, output).into_iter().filter(is_surface).count();
    let of_scene = SceneEffects { scene, totals: &totals }.all();
    let needs = of_passes(scene, output, lit).into_iter().chain(of_scene).collect();
    DrawPlan { needs, totals: totals(scene), is_exact: true }
}

fn totals(scene: &SceneNeeds, output: Output) -> Census {
    let census = Census { passes: 2, targets: 2, ..scene.census() };
    with_pipelines(census, programs(scene, output).iter())
}

/// The programs of an output.
pub fn programs(scene: &SceneNeeds, output: Output) -> BTreeSet<BakedProgram> {
    let surface = |key: &BatchKey| BakedProgram::Surface(output, scene.surface_key(key, output));
    let depths = scene.solid(output).map(|key| BakedProgram::Depth(depth_key(key)));
    let surfaces = scene.solid(output).chain(scene.blended(output)).map(surface);
    let sky = (output == Output::Lit).then_some(BakedProgram::Sky);
    depths.chain(surfaces).chain(sky).collect()
}
