//! What pictures under shadow maps call for.

use super::bindings::MapReads;
use super::decisions::{MapDecisions, ground_apart};
use super::programs::{MapProgram, SunReads, caster_key};
use crate::gpu::frame::{BatchKey, Output, TextureSet, depth_key, with_pipelines};
use crate::gpu::plan::{SceneEffects, SceneNeeds, of_passes};
use crate::plan::{Census, DrawPlan};
use crate::shadow_maps::{MOST_MAPS, MapSettings, ShadowScene, Variant};
use crate::stage::Stage;
use std::collections::BTreeSet;

/// How the sun lights a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SunShading {
    /// It gives no light.
    Down,
    /// Nothing can be in shadow.
    Open,
    /// Something may be in shadow.
    Shaded {
        /// Maps that are read.
        maps: usize,
        /// Maps that are drawn for this picture; the others are kept from the last.
        drawn: usize,
    },
}

/// What a picture calls for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapNeeds {
    /// Lit scene, or visibility of one light.
    pub output: Output,
    /// How maps are made and read.
    pub settings: MapSettings,
    /// What surfaces read.
    pub reads: MapReads,
    /// How the sun lights it.
    pub shading: SunShading,
    /// Whether the ground casts.
    pub ground_casts: bool,
    /// Pixels of the picture.
    pub pixels: u64,
    /// Whether that is what a picture took; else it is an upper bound.
    pub is_exact: bool,
}

impl MapNeeds {
    /// An upper bound, whatever the view and the moment.
    pub fn most(
        stage: &Stage,
        scene: &ShadowScene,
        settings: &MapSettings,
        reads: MapReads,
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
            (false, _) => SunShading::Down,
            (true, false) => SunShading::Open,
            (true, true) if is_planar && scene.ground.height_m.is_none() => SunShading::Open,
            (true, true) => SunShading::Shaded { maps, drawn: maps },
        };
        let (settings, ground_casts) = (*settings, scene.ground.casts);
        Self { output, settings, reads, shading, ground_casts, pixels, is_exact: false }
    }

    /// The same where `drawn` maps were drawn, and the others kept.
    pub fn drawn(self, drawn: usize) -> Self {
        match self.shading {
            SunShading::Shaded { maps, .. } => Self { shading: SunShading::Shaded { maps, drawn }, ..self },
            _ => self,
        }
    }

    /// Keys of batches that cast: all, or all but the ground.
    fn casters<'a>(&self, scene: &'a SceneNeeds) -> impl Iterator<Item = BatchKey> + 'a {
        let casts = self.ground_casts;
        scene.surfaces().filter(move |key| !key.is_passed && (casts || !key.is_ground)).map(caster_key)
    }

    /// Casters on the ground.
    fn casters_on_ground<'a>(&self, scene: &'a SceneNeeds) -> impl Iterator<Item = BatchKey> + 'a {
        scene.surfaces().filter(|key| !key.is_passed && !key.is_ground).map(caster_key)
    }

    /// What is read of the sun for a batch.
    fn sun_of(&self, key: &BatchKey) -> SunReads {
        let is_read = self.settings.optimizations.sampling;
        match self.shading {
            _ if self.output == Output::LampVisibility => SunReads::Down,
            SunShading::Down => SunReads::Down,
            SunShading::Open => SunReads::Open,
            SunShading::Shaded { .. } if key.is_open => SunReads::Open,
            SunShading::Shaded { .. } if !is_read => SunReads::Open,
            SunShading::Shaded { .. } if self.reads.has_flat_mask => {
                if key.is_ground {
                    SunReads::Flat
                } else {
                    SunReads::Open
                }
            }
            SunShading::Shaded { .. } if self.reads.has_mask && key.is_ground => SunReads::Mask,
            SunShading::Shaded { .. } => SunReads::Maps,
        }
    }

    /// The key of the program that shades a batch.
    pub fn surface_program_key(&self, scene: &SceneNeeds, key: &BatchKey) -> MapProgram {
        let sun = self.sun_of(key);
        let key = match self.output {
            Output::Visibility => {
                let textures = TextureSet::default();
                BatchKey { page: 0, textures, is_passed: false, is_open: false, ..key.without_look() }
            }
            Output::Lit | Output::LampVisibility => scene.surface_key(key, self.output),
        };
        MapProgram::Surface(self.output, sun, BatchKey { is_ground: false, ..key })
    }

    /// Keys of every program of the picture.
    pub fn programs(&self, scene: &SceneNeeds) -> BTreeSet<MapProgram> {
        let depths = scene.solid(self.output).map(|key| MapProgram::Depth(depth_key(key)));
        let surfaces = scene.solid(self.output).chain(scene.blended(self.output));
        let mut all: BTreeSet<MapProgram> =
            depths.chain(surfaces.map(|key| self.surface_program_key(scene, key))).collect();
        all.extend((self.output == Output::Lit).then_some(MapProgram::Sky));
        if !self.is_shaded() {
            return all;
        }
        if self.reads.has_depths {
            all.extend(self.casters(scene).map(MapProgram::Map));
        }
        if self.reads.has_mask || self.reads.has_flat_mask {
            all.extend(self.casters_on_ground(scene).map(MapProgram::Mask));
        }
        if self.reads.has_mask {
            all.extend([false, true].map(|is_down| MapProgram::Blur { is_down }));
        }
        all
    }

    pub fn is_shaded(&self) -> bool {
        matches!(self.shading, SunShading::Shaded { .. })
    }

    /// Shadow maps that are built.
    pub fn maps(&self) -> usize {
        match self.shading {
            SunShading::Shaded { maps, .. } if self.reads.has_depths => maps,
            _ => 0,
        }
    }

    /// Passes that draw maps and masks, and that blur.
    fn shadow_passes(&self) -> usize {
        match self.shading {
            SunShading::Shaded { .. } if self.reads.has_flat_mask => 1,
            SunShading::Shaded { drawn, .. } if self.reads.has_mask && drawn > 0 => drawn + 3,
            SunShading::Shaded { drawn, .. } => drawn,
            _ => 0,
        }
    }

    /// Masks, and the texels of each.
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
        // A flat mask needs one matrix, and no map.
        let (groups, binding_count) = match self.is_shaded() {
            true => (1 + self.maps().max(1), self.reads.binding_count() + self.maps().max(1)),
            false => (0, 0),
        };
        let census = Census {
            passes: 2 + self.shadow_passes(),
            targets: 2,
            bind_groups: own.bind_groups + groups,
            bindings: own.bindings + binding_count,
            shadow_pipelines: programs.iter().filter(|key| key.is_shadow()).count(),
            shadow_maps: self.maps(),
            shadow_masks: masks,
            shadow_bytes: 4 * self.maps() as u64 * u64::from(self.settings.size_texels).pow(2)
                + masks as u64 * mask_texels,
            ..own
        };
        with_pipelines(census, programs.iter())
    }

    /// The plan of a picture.
    pub fn plan(&self, scene: &SceneNeeds) -> DrawPlan {
        let totals = |scene: &SceneNeeds| self.totals(scene);
        let is_lit = |key: &MapProgram| matches!(key, MapProgram::Surface(..));
        let lit = self.programs(scene).iter().filter(|key| is_lit(key)).count();
        let effects = SceneEffects { scene, totals: &totals };
        let of_maps = MapDecisions { needs: self, scene }.all().into_iter().chain([ground_apart(&effects)]);
        let needs = of_passes(scene, self.output, lit).into_iter().chain(of_maps).chain(effects.all()).collect();
        DrawPlan { needs, totals: self.totals(scene), is_exact: self.is_exact }
    }
}
