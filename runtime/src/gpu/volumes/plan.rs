//! What pictures under shadow volumes call for.

use super::VolumeSettings;
use super::bounds::LightNeedsBound;
use super::decisions::VolumeDecisions;
use super::programs::{FaceKey, LightBlend, VolumeProgram, hard_key};
use crate::gpu::frame::{BatchKey, Output, depth_key, with_pipelines};
use crate::gpu::plan::{SceneEffects, SceneNeeds, of_passes};
use crate::plan::{Census, DrawPlan};
use crate::stage::Stage;
use crate::volumes::{CasterCounts, Casters};
use std::collections::BTreeSet;
use sunbake_shaders::HardLight;

/// What a light calls for.
#[derive(Debug, Clone, PartialEq)]
pub struct LightNeeds {
    /// The shader that adds it.
    pub hard: HardLight,
    /// How it is added.
    pub blend: LightBlend,
    /// Lights that it consists of: more than one for a sun with a disc.
    pub count: usize,
    /// Of these, how many have volumes to count.
    pub shaded: usize,
    /// Pipelines over faces.
    pub faces: BTreeSet<FaceKey>,
    /// Runs in which faces are counted.
    pub runs: usize,
    /// Entries of each run's bind group.
    pub binding_count: usize,
    /// Number of its own buffers, and their bytes.
    pub buffers: (usize, u64),
}

impl LightNeeds {
    pub fn is_lamp(&self) -> bool {
        matches!(self.hard, HardLight::Lamp | HardLight::LampMask)
    }

    /// Whether counts of several runs are merged.
    fn merges(&self) -> bool {
        self.runs > 1 && self.shaded > 0
    }

    /// Whether faces are counted in front of the surface (z-pass), or behind it.
    pub fn counts(&self, is_z_pass: bool) -> bool {
        self.faces.iter().any(|key| key.counts(is_z_pass))
    }
}

/// What a picture calls for.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeNeeds {
    /// Lit scene, or visibility of one light.
    pub output: Output,
    /// What each light calls for.
    pub lights: Vec<LightNeeds>,
    /// Number of the buffers that all lights share, and their bytes.
    pub buffers: (usize, u64),
    /// Whether that is what a picture took; else it is an upper bound.
    pub is_exact: bool,
}

/// How one of `count` lights is added.
pub fn light_blend(output: Output, count: usize) -> LightBlend {
    match (output, count) {
        (_, 2..) => LightBlend::AddShare,
        (Output::Lit, _) => LightBlend::Add,
        _ => LightBlend::Replace,
    }
}

/// The shaders that add the sun and a lamp.
pub fn hard_lights(output: Output) -> [HardLight; 2] {
    match output {
        Output::Lit => [HardLight::Sun, HardLight::Lamp],
        Output::Visibility | Output::LampVisibility => [HardLight::SunMask, HardLight::LampMask],
    }
}

/// The programs over surfaces, under these lights.
pub fn surface_programs<'a>(
    scene: &'a SceneNeeds,
    output: Output,
    lights: impl Iterator<Item = (HardLight, LightBlend)> + Clone + 'a,
) -> impl Iterator<Item = VolumeProgram> + 'a {
    let of_batch = move |key: &'a BatchKey| {
        let ambient = (output == Output::Lit).then(|| VolumeProgram::Ambient(scene.surface_key(key, output)));
        let hard_key = hard_key(key, output);
        let lights = lights.clone().map(move |(hard, blend)| VolumeProgram::Light(hard, blend, hard_key));
        [VolumeProgram::Depth(depth_key(key))].into_iter().chain(ambient).chain(lights)
    };
    let behind = if output == Output::Lit { VolumeProgram::Sky } else { VolumeProgram::Background };
    let blended = scene.blended(output).map(move |key| VolumeProgram::Blended(scene.surface_key(key, output)));
    scene.solid(output).flat_map(of_batch).chain(blended).chain([behind])
}

impl VolumeNeeds {
    /// An upper bound, whatever the view and the moment.
    pub fn most(
        stage: &Stage,
        casters: &Casters,
        settings: &VolumeSettings,
        output: Output,
        buffers: (usize, u64),
    ) -> Self {
        let bounds = LightNeedsBound { casters, settings, output };
        let sun = (stage.path.is_some() && output != Output::LampVisibility).then(|| bounds.light(false));
        let lamp = (stage.lamp.is_some() && output != Output::Visibility).then(|| bounds.light(true));
        Self { output, lights: sun.into_iter().chain(lamp).collect(), buffers, is_exact: false }
    }

    fn lights_in<'a>(&'a self, scene: &'a SceneNeeds) -> impl Iterator<Item = &'a LightNeeds> + Clone {
        self.lights.iter().filter(|light| scene.has_lamp || !light.is_lamp())
    }

    fn programs(&self, scene: &SceneNeeds) -> BTreeSet<VolumeProgram> {
        let kinds = self.lights_in(scene).map(|light| (light.hard, light.blend));
        let faces = self.lights_in(scene).flat_map(|light| light.faces.iter().copied().map(VolumeProgram::Faces));
        let merge = self.lights_in(scene).any(LightNeeds::merges).then_some(VolumeProgram::MergeRun);
        surface_programs(scene, self.output, kinds).chain(faces).chain(merge).collect()
    }

    /// What is built for a scene.
    pub fn totals(&self, scene: &SceneNeeds) -> Census {
        let programs = self.programs(scene);
        let lights = || self.lights_in(scene);
        let is_alone = self.output == Output::Lit || lights().next().is_none();
        let own = scene.census();
        let blends = scene.blended(self.output).next().is_some();
        let binding_count: usize = lights().map(|light| light.runs * light.binding_count).sum();
        let census = Census {
            passes: 1
                + usize::from(is_alone)
                + usize::from(blends)
                + lights().map(|light| light.count + light.shaded).sum::<usize>(),
            targets: 2,
            bind_groups: own.bind_groups + lights().map(|light| light.runs).sum::<usize>(),
            bindings: own.bindings + binding_count,
            stencil_pipelines: programs.iter().filter(|key| key.is_of_volumes()).count(),
            volume_buffers: self.buffers.0 + lights().map(|light| light.buffers.0).sum::<usize>(),
            volume_bytes: self.buffers.1 + lights().map(|light| light.buffers.1).sum::<u64>(),
            ..own
        };
        with_pipelines(census, programs.iter())
    }

    /// The plan of a picture.
    pub fn plan(&self, scene: &SceneNeeds, counts: &CasterCounts, settings: &VolumeSettings) -> DrawPlan {
        let totals = |scene: &SceneNeeds| self.totals(scene);
        let is_lit = |key: &VolumeProgram| {
            matches!(key, VolumeProgram::Light(..) | VolumeProgram::Ambient(_) | VolumeProgram::Blended(_))
        };
        let lit = self.programs(scene).iter().filter(|key| is_lit(key)).count();
        let of_volumes = VolumeDecisions { needs: self, scene, counts, settings }.all();
        let of_scene = SceneEffects { scene, totals: &totals }.all();
        let needs = of_passes(scene, self.output, lit).into_iter().chain(of_volumes).chain(of_scene).collect();
        DrawPlan { needs, totals: self.totals(scene), is_exact: self.is_exact }
    }
}
