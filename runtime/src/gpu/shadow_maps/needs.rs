//! What pictures under shadow maps call for.

use super::super::batch::BatchKey;
use super::super::census::Census;
use super::super::effects::{SceneEffects, change_keys, need, of_count, of_passes};
use super::super::needs::SceneNeeds;
use super::super::renderer::Output;
use super::super::scene::depth_key;
use super::programs::{ProgramKey, Sun, caster_key};
use super::targets::Reads;
use crate::plan::{DrawPlan, Need};
use crate::shadow_maps::{MOST_MAPS, MapSettings, ShadowScene, Variant};
use crate::stage::Stage;
use std::collections::BTreeSet;
use sunbake_shaders::ShadowTap;

/// What the sun does to a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shading {
    /// It gives no light.
    Down,
    /// Nothing can be in shadow.
    Open,
    /// Some things may be.
    Shaded {
        /// By so many maps.
        maps: usize,
        /// Of which so many are drawn for the picture.
        drawn: usize,
    },
}

/// What a picture calls for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapNeeds {
    /// What it shows.
    pub output: Output,
    /// How it is lit.
    pub settings: MapSettings,
    /// What surfaces read.
    pub reads: Reads,
    /// What the sun does.
    pub shading: Shading,
    /// Whether the ground casts.
    pub ground_casts: bool,
    /// Pixels of the picture.
    pub pixels: u64,
    /// Whether that is what a picture took; else it is the most that one may take.
    pub is_exact: bool,
}

impl MapNeeds {
    /// The most that a picture may call for, whatever the view and the moment.
    pub fn most(
        stage: &Stage,
        scene: &ShadowScene,
        settings: &MapSettings,
        reads: Reads,
        output: Output,
        pixels: u64,
    ) -> Self {
        let maps = match settings.variant {
            Variant::Planar => 0,
            Variant::Cascades => settings.cascades.clamp(2, 4),
            Variant::Cube => MOST_MAPS,
            _ => 1,
        };
        let is_planar = settings.variant == Variant::Planar;
        let shading = match (stage.path.is_some() && output != Output::LampVisibility, scene.has_casters()) {
            (false, _) => Shading::Down,
            (true, false) => Shading::Open,
            (true, true) if is_planar && scene.ground.height_m.is_none() => Shading::Open,
            (true, true) => Shading::Shaded { maps, drawn: maps },
        };
        let (settings, ground_casts) = (*settings, scene.ground.casts);
        Self { output, settings, reads, shading, ground_casts, pixels, is_exact: false }
    }

    /// The same where so many maps were drawn, and the others kept.
    pub fn drawn(self, drawn: usize) -> Self {
        match self.shading {
            Shading::Shaded { maps, .. } => Self { shading: Shading::Shaded { maps, drawn }, ..self },
            _ => self,
        }
    }

    /// What casts on anything.
    fn casters<'a>(&self, scene: &'a SceneNeeds) -> impl Iterator<Item = BatchKey> + 'a {
        let casts = self.ground_casts;
        scene.surfaces().filter(move |key| casts || !key.is_ground).map(caster_key)
    }

    /// What casts on the ground.
    fn casters_on_ground<'a>(&self, scene: &'a SceneNeeds) -> impl Iterator<Item = BatchKey> + 'a {
        scene.surfaces().filter(|key| !key.is_ground).map(caster_key)
    }

    /// What is read of the sun for a batch.
    fn sun_of(&self, key: &BatchKey) -> Sun {
        let is_read = self.settings.means.sampling;
        match self.shading {
            _ if self.output == Output::LampVisibility => Sun::Down,
            Shading::Down => Sun::Down,
            Shading::Open => Sun::Open,
            Shading::Shaded { .. } if !is_read => Sun::Open,
            Shading::Shaded { .. } if self.reads.has_flat_mask => {
                if key.is_ground {
                    Sun::Flat
                } else {
                    Sun::Open
                }
            }
            Shading::Shaded { .. } if self.reads.has_mask && key.is_ground => Sun::Mask,
            Shading::Shaded { .. } => Sun::Maps,
        }
    }

    /// The key of the program that shades a batch.
    pub fn surface_program_key(&self, scene: &SceneNeeds, key: &BatchKey) -> ProgramKey {
        let sun = self.sun_of(key);
        let key = match self.output {
            Output::Visibility => BatchKey { page: 0, texture: None, ..*key },
            Output::Lit | Output::LampVisibility => scene.surface_key(key),
        };
        ProgramKey::Surface(self.output, sun, BatchKey { is_ground: false, ..key })
    }

    /// All programs.
    pub fn programs(&self, scene: &SceneNeeds) -> BTreeSet<ProgramKey> {
        let of_batch = |key: &BatchKey| [ProgramKey::Depth(depth_key(key)), self.surface_program_key(scene, key)];
        let mut all: BTreeSet<ProgramKey> = scene.batches.iter().flat_map(of_batch).collect();
        all.extend((self.output == Output::Lit).then_some(ProgramKey::Sky));
        if !self.is_shaded() {
            return all;
        }
        if self.reads.has_depths {
            all.extend(self.casters(scene).map(ProgramKey::Map));
        }
        if self.reads.has_mask || self.reads.has_flat_mask {
            all.extend(self.casters_on_ground(scene).map(ProgramKey::Mask));
        }
        if self.reads.has_mask {
            all.extend([false, true].map(|is_down| ProgramKey::Blur { is_down }));
        }
        all
    }

    fn is_shaded(&self) -> bool {
        matches!(self.shading, Shading::Shaded { .. })
    }

    fn maps(&self) -> usize {
        match self.shading {
            Shading::Shaded { maps, .. } if self.reads.has_depths => maps,
            _ => 0,
        }
    }

    /// Passes over what casts, and blurs.
    fn shadow_passes(&self) -> usize {
        match self.shading {
            Shading::Shaded { .. } if self.reads.has_flat_mask => 1,
            Shading::Shaded { drawn, .. } if self.reads.has_mask && drawn > 0 => drawn + 3,
            Shading::Shaded { drawn, .. } => drawn,
            _ => 0,
        }
    }

    /// Pictures of what casts, and the texels of each.
    fn masks(&self) -> (usize, u64) {
        match (self.is_shaded(), self.reads.has_mask, self.reads.has_flat_mask) {
            (true, true, _) => (2, u64::from(self.settings.size_texels).pow(2)),
            (true, _, true) => (1, self.pixels),
            _ => (0, 0),
        }
    }

    /// What is built for a scene.
    pub fn totals(&self, scene: &SceneNeeds) -> Census {
        let programs = self.programs(scene);
        let own = scene.census();
        let (masks, mask_texels) = self.masks();
        // What is laid flat reads one matrix, and has no map.
        let (groups, slots) = match self.is_shaded() {
            true => (1 + self.maps().max(1), self.reads.slots() + self.maps().max(1)),
            false => (0, 0),
        };
        Census {
            passes: 2 + self.shadow_passes(),
            targets: 2,
            bind_groups: own.bind_groups + groups,
            bindings: own.bindings + slots,
            shadow_pipelines: programs.iter().filter(|key| key.is_shadow()).count(),
            shadow_maps: self.maps(),
            shadow_masks: masks,
            shadow_bytes: 4 * self.maps() as u64 * u64::from(self.settings.size_texels).pow(2)
                + masks as u64 * mask_texels,
            ..own.with_pipelines(programs.len(), programs.iter().filter_map(ProgramKey::batch))
        }
    }

    /// The plan of a picture.
    pub fn plan(&self, scene: &SceneNeeds) -> DrawPlan {
        let totals = |scene: &SceneNeeds| self.totals(scene);
        let is_lit = |key: &ProgramKey| matches!(key, ProgramKey::Surface(..));
        let lit = self.programs(scene).iter().filter(|key| is_lit(key)).count();
        let effects = SceneEffects { scene, totals: &totals };
        let of_maps = Verdicts { needs: self, scene }.all().into_iter().chain([ground(&effects)]);
        let needs = of_passes(scene, self.output, lit).into_iter().chain(of_maps).chain(effects.all()).collect();
        DrawPlan { needs, totals: self.totals(scene), is_exact: self.is_exact }
    }
}

fn ground(effects: &SceneEffects) -> Need {
    let is_on = effects.scene.surfaces().any(|key| key.is_ground);
    let join = |scene: &mut SceneNeeds| change_keys(scene, |key| BatchKey { is_ground: false, ..*key });
    let saved = is_on.then(|| (effects.saved_by(join), String::new()));
    let why = if is_on { "the lowest large level plane is drawn apart" } else { "no surface is level" };
    need("ground-apart", saved, why.into(), "a draw", ["a scene without a level plane", "a level plane"])
}

/// Verdicts on what shadow maps add.
struct Verdicts<'a> {
    needs: &'a MapNeeds,
    scene: &'a SceneNeeds,
}

impl Verdicts<'_> {
    fn all(&self) -> Vec<Need> {
        vec![
            self.shadows(),
            self.several_maps(),
            self.blurred_mask(),
            self.flat_mask(),
            self.sampler(),
            self.wide_filter(),
            self.penumbra(),
        ]
    }

    fn saved_by(&self, change: impl Fn(&mut MapNeeds)) -> Census {
        let mut without = *self.needs;
        change(&mut without);
        self.needs.totals(self.scene).beyond(&without.totals(self.scene))
    }

    fn shadows(&self) -> Need {
        let open = |needs: &mut MapNeeds| needs.shading = Shading::Open;
        let saved = self.needs.is_shaded().then(|| (self.saved_by(open), String::new()));
        let why = match (self.needs.shading, self.needs.is_exact) {
            (Shading::Down, _) => "the sun is down, off or not asked for",
            (Shading::Open, _) => "nothing can be in shadow",
            (Shading::Shaded { .. }, true) => "something in view may be in shadow",
            (Shading::Shaded { .. }, false) => "something may be in shadow",
        };
        let more = "a map and a pass, a pipeline for what casts, and bindings";
        let by = ["--light sky, or a scene in which nothing casts", "an hour with a sun, and something that casts"];
        need("sun-shadows", saved, why.into(), more, by)
    }

    fn several_maps(&self) -> Need {
        let maps = self.needs.maps();
        let one = |needs: &mut MapNeeds| {
            if let Shading::Shaded { maps, drawn } = needs.shading {
                needs.shading = Shading::Shaded { maps: maps.min(1), drawn: drawn.min(1) };
            }
        };
        let saved = (maps > 1).then(|| (self.saved_by(one), String::new()));
        let why = match (maps, self.needs.settings.variant) {
            (2.., Variant::Cascades) => format!("{maps} slices of the view have a map each"),
            (2.., _) => format!("{maps} faces of a cube around the sun are seen"),
            _ => of_count(maps, "map holds all that may be in shadow", ""),
        };
        let more = "a map, a pass, a group and a binding for each more";
        need(
            "several-maps",
            saved,
            why,
            more,
            ["another --technique map:VARIANT", "--technique map:cascades or map:cube"],
        )
    }

    fn blurred_mask(&self) -> Need {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_mask;
        let saved = is_on.then(|| (self.saved_by(|needs| needs.reads.has_mask = false), String::new()));
        let why = if is_on { "map:ground blurs what casts on the ground" } else { "no surface reads one" };
        let more = "two masks of a map's size, three passes, three pipelines, and two bindings";
        need(
            "blurred-mask",
            saved,
            why.into(),
            more,
            ["another --technique map:VARIANT", "--technique map:ground, and a level plane"],
        )
    }

    fn flat_mask(&self) -> Need {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_flat_mask;
        let saved = is_on.then(|| (self.saved_by(|needs| needs.shading = Shading::Open), String::new()));
        let why = if is_on { "map:planar lays what casts flat on the ground" } else { "no surface reads one" };
        let more = "a mask of the picture's size, a pass, a pipeline, and a binding";
        need(
            "flat-mask",
            saved,
            why.into(),
            more,
            ["another --technique map:VARIANT", "--technique map:planar, and a level plane"],
        )
    }

    fn sampler(&self) -> Need {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_sampler();
        let saved = is_on.then(|| (self.saved_by(|needs| needs.reads.tap = ShadowTap::Manual), String::new()));
        let why = match self.needs.reads.tap {
            _ if !is_on => "the shader compares texels itself, or none is read",
            ShadowTap::Gathered => "the shader compares what a sampler gathers, each texel with the receiver's plane",
            _ => "a sampler compares",
        };
        let by = ["--technique map:plain", "--technique map and most variants"];
        need("map-sampler", saved, why.into(), "a binding", by)
    }

    fn wide_filter(&self) -> Need {
        let taps = match self.needs.settings.variant {
            Variant::Pcf16 | Variant::Cascades => 16,
            Variant::Pcf4 => 4,
            _ => 1,
        };
        let is_on = taps > 1 && self.needs.is_shaded();
        let saved = is_on.then(|| (Census::default(), format!("{taps} comparisons a pixel")));
        let why = if is_on { "edges are filtered over four by four texels" } else { "one place is compared" };
        let by = ["--technique map:compare", "--technique map:pcf16, map:pcf4 or map:cascades"];
        need("wide-filter", saved, why.into(), "4 or 16 comparisons a pixel", by)
    }

    fn penumbra(&self) -> Need {
        let is_on = self.needs.settings.variant == Variant::Pcss && self.needs.is_shaded();
        let words = "a search for blockers a pixel, and as many comparisons as the penumbra is wide";
        let saved = is_on.then(|| (Census::default(), words.to_owned()));
        let why = if is_on { "map:pcss filters as widely as the penumbra is" } else { "filters have one width" };
        need("map-penumbra", saved, why.into(), words, ["--technique map:pcf16", "--technique map:pcss"])
    }
}
