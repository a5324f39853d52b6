//! What pictures under shadow volumes call for.

use super::super::batch::BatchKey;
use super::super::census::Census;
use super::super::effects::{SceneEffects, need, of_count, of_passes};
use super::super::needs::SceneNeeds;
use super::super::renderer::Output;
use super::super::scene::depth_key;
use super::VolumeSettings;
use super::programs::{Added, ProgramKey, VolumeKey, hard_key};
use crate::plan::{DrawPlan, Need};
use crate::stage::Stage;
use crate::volumes::{CasterCounts, Casters, MOST_COUNTED, MOST_COUNTED_BY_RUN, Mode, Part};
use std::collections::BTreeSet;
use sunbake_shaders::{HardLight, VolumeCorners, VolumeLight, VolumeUse};

/// Walls, caps and dark caps of a prism, in corners of triangles: of the sun three walls and a cap, of a lamp twice as many and an
/// end.
const MOST_CORNERS: [u64; 2] = [3 * 4, 3 * 8];

/// What a light calls for.
#[derive(Debug, Clone, PartialEq)]
pub struct LightNeeds {
    /// What adds it.
    pub hard: HardLight,
    /// How.
    pub added: Added,
    /// As how many lights it shines.
    pub count: usize,
    /// For how many of them volumes are counted.
    pub shaded: usize,
    /// Programs over faces.
    pub faces: BTreeSet<VolumeKey>,
    /// Runs in which faces are counted.
    pub runs: usize,
    /// Slots of each run's bindings.
    pub slots: usize,
    /// Buffers of its own, and their bytes.
    pub buffers: (usize, u64),
}

impl LightNeeds {
    fn is_lamp(&self) -> bool {
        matches!(self.hard, HardLight::Lamp | HardLight::LampGate)
    }

    fn keeps(&self) -> bool {
        self.runs > 1 && self.shaded > 0
    }

    fn counts(&self, is_z_pass: bool) -> bool {
        self.faces.iter().any(|key| key.of == VolumeUse::Stencil && key.is_z_pass == is_z_pass)
    }
}

/// What a picture calls for.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeNeeds {
    /// What it shows.
    pub output: Output,
    /// What lights it.
    pub lights: Vec<LightNeeds>,
    /// Buffers that all lights share, and their bytes.
    pub buffers: (usize, u64),
    /// Whether that is what a picture took; else it is the most that one may take.
    pub is_exact: bool,
}

/// What is added of the sun and of a lamp, as one of so many.
pub fn added(output: Output, count: usize) -> Added {
    match (output, count) {
        (_, 2..) => Added::Share,
        (Output::Lit, _) => Added::OnTop,
        _ => Added::Alone,
    }
}

/// What adds the sun, and what a lamp.
pub fn hard_lights(output: Output) -> [HardLight; 2] {
    match output {
        Output::Lit => [HardLight::Sun, HardLight::Lamp],
        Output::Visibility | Output::LampVisibility => [HardLight::SunGate, HardLight::LampGate],
    }
}

/// The programs over surfaces, under these lights.
pub fn surface_programs<'a>(
    scene: &'a SceneNeeds,
    output: Output,
    lights: impl Iterator<Item = (HardLight, Added)> + Clone + 'a,
) -> impl Iterator<Item = ProgramKey> + 'a {
    let of_batch = move |key: &'a BatchKey| {
        let around = (output == Output::Lit).then(|| ProgramKey::Around(scene.surface_key(key)));
        let lights = lights.clone().map(move |(hard, added)| ProgramKey::Light(hard, added, hard_key(key)));
        [ProgramKey::Depth(depth_key(key))].into_iter().chain(around).chain(lights)
    };
    let behind = if output == Output::Lit { ProgramKey::Sky } else { ProgramKey::Background };
    scene.batches.iter().flat_map(of_batch).chain([behind])
}

impl VolumeNeeds {
    /// The most that a picture may call for, whatever the view and the moment.
    pub fn most(
        stage: &Stage,
        casters: &Casters,
        settings: &VolumeSettings,
        output: Output,
        buffers: (usize, u64),
    ) -> Self {
        let most = Most { casters, settings, output };
        let sun = (stage.path.is_some() && output != Output::LampVisibility).then(|| most.light(false));
        let lamp = (stage.lamp.is_some() && output != Output::Visibility).then(|| most.light(true));
        Self { output, lights: sun.into_iter().chain(lamp).collect(), buffers, is_exact: false }
    }

    fn lights_in<'a>(&'a self, scene: &'a SceneNeeds) -> impl Iterator<Item = &'a LightNeeds> + Clone {
        self.lights.iter().filter(|light| scene.has_lamp || !light.is_lamp())
    }

    fn programs(&self, scene: &SceneNeeds) -> BTreeSet<ProgramKey> {
        let kinds = self.lights_in(scene).map(|light| (light.hard, light.added));
        let faces = self.lights_in(scene).flat_map(|light| light.faces.iter().copied().map(ProgramKey::Volume));
        let keep = self.lights_in(scene).any(LightNeeds::keeps).then_some(ProgramKey::Keep);
        surface_programs(scene, self.output, kinds).chain(faces).chain(keep).collect()
    }

    /// What is built for a scene.
    pub fn totals(&self, scene: &SceneNeeds) -> Census {
        let programs = self.programs(scene);
        let lights = || self.lights_in(scene);
        let is_alone = self.output == Output::Lit || lights().next().is_none();
        let own = scene.census();
        let slots: usize = lights().map(|light| light.runs * light.slots).sum();
        Census {
            passes: 1 + usize::from(is_alone) + lights().map(|light| light.count + light.shaded).sum::<usize>(),
            targets: 2,
            bind_groups: own.bind_groups + lights().map(|light| light.runs).sum::<usize>(),
            bindings: own.bindings + slots,
            stencil_pipelines: programs.iter().filter(|key| key.is_of_volumes()).count(),
            volume_buffers: self.buffers.0 + lights().map(|light| light.buffers.0).sum::<usize>(),
            volume_bytes: self.buffers.1 + lights().map(|light| light.buffers.1).sum::<u64>(),
            ..own.with_pipelines(programs.len(), programs.iter().filter_map(ProgramKey::batch))
        }
    }

    /// The plan of a picture.
    pub fn plan(&self, scene: &SceneNeeds, counts: &CasterCounts, settings: &VolumeSettings) -> DrawPlan {
        let totals = |scene: &SceneNeeds| self.totals(scene);
        let is_lit = |key: &ProgramKey| matches!(key, ProgramKey::Light(..) | ProgramKey::Around(_));
        let lit = self.programs(scene).iter().filter(|key| is_lit(key)).count();
        let of_volumes = Verdicts { needs: self, scene, counts, settings }.all();
        let of_scene = SceneEffects { scene, totals: &totals }.all();
        let needs = of_passes(scene, self.output, lit).into_iter().chain(of_volumes).chain(of_scene).collect();
        DrawPlan { needs, totals: self.totals(scene), is_exact: self.is_exact }
    }
}

/// What a light may call for at most.
struct Most<'a> {
    casters: &'a Casters,
    settings: &'a VolumeSettings,
    output: Output,
}

impl Most<'_> {
    fn light(&self, is_lamp: bool) -> LightNeeds {
        let [sun, lamp] = hard_lights(self.output);
        let count = if is_lamp { 1 } else { self.settings.sun_samples.max(1) as usize };
        let has_casters = !self.casters.all.is_empty();
        let runs = self.runs();
        let per_run = self.buffers_of_run(is_lamp, runs);
        let (reaches, reach_bytes) = if is_lamp { (1, 4 * self.casters.points_m.len().max(1) as u64) } else { (0, 0) };
        LightNeeds {
            hard: if is_lamp { lamp } else { sun },
            added: added(self.output, count),
            count,
            shaded: if has_casters { count } else { 0 },
            faces: if has_casters { self.faces(is_lamp) } else { BTreeSet::new() },
            runs,
            slots: 1 + reaches + if self.is_found() { 3 } else { 0 },
            buffers: (reaches + per_run.0, reach_bytes + per_run.1),
        }
    }

    fn is_found(&self) -> bool {
        self.settings.mode == Mode::Gpu && !self.casters.triangles.is_empty()
    }

    /// Triangles are halved until so few are left.
    fn runs(&self) -> usize {
        match self.casters.triangles.len() {
            ..=MOST_COUNTED => 1,
            n => 2 * n / MOST_COUNTED_BY_RUN + 2,
        }
    }

    fn buffers_of_run(&self, is_lamp: bool, runs: usize) -> (usize, u64) {
        let triangles = self.casters.triangles.len() as u64;
        match self.is_found() {
            // Two bits a triangle, all of them in each run.
            true => (runs, runs as u64 * 4 * triangles.div_ceil(16)),
            false if triangles == 0 => (0, 0),
            false => (runs, triangles * MOST_CORNERS[usize::from(is_lamp)] * 4),
        }
    }

    /// Counted before the surface wherever a caster's caps are hidden, behind it wherever the eye may be in shadow.
    fn faces(&self, is_lamp: bool) -> BTreeSet<VolumeKey> {
        let wants_z_pass = match self.settings.mode {
            Mode::ZPass => true,
            Mode::ZFail | Mode::Triangles => false,
            Mode::Planned | Mode::Gpu => self.settings.savings.z_pass,
        };
        let hides_caps = self.casters.all.iter().any(|c| c.shows_both_sides || (c.shows_fronts && c.is_solid));
        let (corners, parts) = match (self.is_found(), is_lamp) {
            (false, _) => (VolumeCorners::Indexed, &[Part::Walls][..]),
            (true, false) => (VolumeCorners::Found, &[Part::Walls, Part::Caps][..]),
            (true, true) => (VolumeCorners::Found, &Part::ALL[..]),
        };
        let light = if is_lamp { VolumeLight::LampWithRange } else { VolumeLight::Sun };
        let is_run = self.casters.triangles.len() > MOST_COUNTED;
        let ways = if wants_z_pass && hides_caps { &[true, false][..] } else { &[false][..] };
        let key =
            |is_z_pass| move |&part| VolumeKey { light, corners, part, of: VolumeUse::Stencil, is_z_pass, is_run };
        // Before the surface a caster's own caps are not counted.
        let is_there = |key: &VolumeKey| !(key.is_z_pass && key.part == Part::Caps);
        ways.iter().flat_map(|&way| parts.iter().map(key(way))).filter(is_there).collect()
    }
}

/// Verdicts on what volumes add.
struct Verdicts<'a> {
    needs: &'a VolumeNeeds,
    scene: &'a SceneNeeds,
    counts: &'a CasterCounts,
    settings: &'a VolumeSettings,
}

impl Verdicts<'_> {
    fn all(&self) -> Vec<Need> {
        vec![
            self.sun(),
            self.sun_samples(),
            self.counted(true),
            self.counted(false),
            self.open_meshes(),
            self.found(),
            self.runs(),
            self.shown(),
        ]
    }

    fn saved_by(&self, change: impl Fn(&mut VolumeNeeds)) -> Census {
        let mut without = self.needs.clone();
        change(&mut without);
        self.needs.totals(self.scene).beyond(&without.totals(self.scene))
    }

    fn any(&self, is: impl Fn(&LightNeeds) -> bool) -> bool {
        self.needs.lights.iter().any(is)
    }

    /// Found before a picture, or of one.
    fn may(&self, is: &str, may: &str) -> String {
        if self.needs.is_exact { is } else { may }.into()
    }

    fn sun(&self) -> Need {
        let is_on = self.any(|light| !light.is_lamp());
        let saved = is_on.then(|| (self.saved_by(|needs| needs.lights.retain(LightNeeds::is_lamp)), String::new()));
        let why = if is_on {
            self.may("the sun is up", "the sun may be up")
        } else {
            "the sun is down, off or not asked for".into()
        };
        let more = "a pass of light, and where something casts one of volumes; a pipeline a kind of surface";
        need("sun-volumes", saved, why, more, ["--light sky or lamp, or an hour without sun", "an hour with a sun"])
    }

    fn sun_samples(&self) -> Need {
        let count =
            self.needs.lights.iter().filter(|light| !light.is_lamp()).map(|light| light.count).max().unwrap_or(0);
        let one = |needs: &mut VolumeNeeds| {
            let output = needs.output;
            for light in needs.lights.iter_mut().filter(|light| light.count > 1) {
                (light.count, light.shaded, light.added) = (1, light.shaded.min(1), added(output, 1));
            }
        };
        let saved = (count > 1).then(|| (self.saved_by(one), String::new()));
        let why = of_count(count, "sun: its centre, with hard edges", "suns share its disc");
        let more = "a pass of volumes and one of light for each sun more";
        need("soft-sun", saved, why, more, ["--sun-samples 1", "--sun-samples N"])
    }

    fn counted(&self, is_z_pass: bool) -> Need {
        let is_on = self.any(|light| light.counts(is_z_pass));
        let drop = |needs: &mut VolumeNeeds| {
            let is_kept = |key: &VolumeKey| key.of != VolumeUse::Stencil || key.is_z_pass != is_z_pass;
            needs.lights.iter_mut().for_each(|light| light.faces.retain(is_kept));
        };
        let saved = is_on.then(|| (self.saved_by(drop), String::new()));
        let more = "a pipeline";
        match (is_z_pass, is_on) {
            (true, true) => {
                let why = self.may(
                    "the eye is outside of some volume, and the surface hides its caps",
                    "the eye may be outside of volumes whose caps are hidden",
                );
                need("z-pass", saved, why, more, ["--technique volumes:zfail"; 2])
            }
            (true, false) => {
                let why = "nothing is counted before the surface".into();
                need("z-pass", saved, why, more, ["", "--technique volumes or volumes:zpass, and a closed mesh"])
            }
            (false, true) => {
                let why = self.may(
                    "the eye may be in some volume, or a cap shows: it is counted behind the surface, with its caps",
                    "the eye may come into some volume, or a cap show",
                );
                need("z-fail", saved, why, more, ["a view from outside of all volumes, of closed meshes"; 2])
            }
            (false, false) => {
                let why = "no eye is in a volume, and no cap shows".into();
                need("z-fail", saved, why, more, ["", "an eye in shadow, an open mesh, or --technique volumes:zfail"])
            }
        }
    }

    fn open_meshes(&self) -> Need {
        let count = self.counts.open_bodies;
        let triangles = self.counts.triangles - self.counts.solid_triangles;
        let words = || format!("prisms of all of their {triangles} triangles, whichever way they face");
        let saved = (count > 0).then(|| (Census::default(), words()));
        let why = of_count(count, "mesh that casts is open", "meshes that cast are open");
        let more = "prisms of all of its triangles, where a closed mesh has those of what faces the light";
        need("open-meshes", saved, why, more, ["closing their holes, or --leave-out when baking", "a mesh with a hole"])
    }

    fn found(&self) -> Need {
        let is_on = self.settings.mode == Mode::Gpu;
        let words = "every edge is drawn, and the vertex shader drops those that are no silhouette";
        let saved = is_on.then(|| (Census { volume_buffers: 2, ..Census::default() }, words.into()));
        let why = if is_on { "volumes:gpu asks for it" } else { "the CPU finds silhouettes" };
        let more = "two buffers of edges and triangles, and pipelines for each part of a volume";
        need("silhouettes-by-gpu", saved, why.into(), more, ["--technique volumes", "--technique volumes:gpu"])
    }

    fn runs(&self) -> Need {
        let is_on = self.any(|light| light.runs > 1);
        let one = |needs: &mut VolumeNeeds| {
            for light in needs.lights.iter_mut().filter(|light| light.runs > 1) {
                light.buffers.0 -= light.runs - 1;
                light.runs = 1;
            }
        };
        let saved = is_on.then(|| (self.saved_by(one), String::new()));
        let why = match is_on {
            true => self
                .may("more than 255 prisms may hold a pixel", "there are more than 255 triangles, which may overlap"),
            false => "no more than 255 prisms hold a pixel: eight bits count them".into(),
        };
        let more = "a pipeline that keeps what was counted, and a group of bindings and a buffer a run";
        need("several-runs", saved, why, more, ["casters that overlap less", "casters that overlap more"])
    }

    fn shown(&self) -> Need {
        let is_on = self.any(|light| light.faces.iter().any(|key| key.of == VolumeUse::Show));
        let hide = |needs: &mut VolumeNeeds| {
            needs.lights.iter_mut().for_each(|light| light.faces.retain(|key| key.of == VolumeUse::Stencil));
        };
        let saved = is_on.then(|| (self.saved_by(hide), "a pass over all faces, after the picture".into()));
        let why = if is_on { "--output volumes shows them" } else { "volumes are counted, and not shown" };
        let more = "a pipeline a part of a volume, and a pass over all faces";
        need("shown-volumes", saved, why.into(), more, ["--output color", "--output volumes"])
    }
}
