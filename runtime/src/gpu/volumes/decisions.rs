//! Decisions about the effects of shadow volumes.

use super::VolumeSettings;
use super::plan::{LightNeeds, VolumeNeeds, light_blend};
use crate::gpu::plan::SceneNeeds;
use crate::plan::{Census, DrawEffect, DrawNeed, Reason, Uncounted};
use crate::volumes::{CasterCounts, Mode, Part};
use sunbake_shaders::VolumeUse;

/// Decides about each effect of shadow volumes.
pub struct VolumeDecisions<'a> {
    pub needs: &'a VolumeNeeds,
    pub scene: &'a SceneNeeds,
    pub counts: &'a CasterCounts,
    pub settings: &'a VolumeSettings,
}

impl VolumeDecisions<'_> {
    /// Decisions about every effect of shadow volumes.
    pub fn all(&self) -> Vec<DrawNeed> {
        vec![
            self.sun(),
            self.sun_samples(),
            self.counted(true),
            self.counted(false),
            self.open_meshes(),
            self.smooth_solids(),
            self.silhouettes_by_gpu(),
            self.runs(),
            self.visualized(),
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

    /// An effect that, before a picture, may only be needed.
    fn possible(&self, effect: DrawEffect, is_on: bool, drop: impl Fn(&mut VolumeNeeds)) -> DrawNeed {
        let reason = if is_on && !self.needs.is_exact { Reason::Possible } else { Reason::Usual };
        DrawNeed::new(effect, is_on.then(|| self.saved_by(drop)), reason)
    }

    fn sun(&self) -> DrawNeed {
        let is_on = self.any(|light| !light.is_lamp());
        self.possible(DrawEffect::SunVolumes, is_on, |needs| needs.lights.retain(LightNeeds::is_lamp))
    }

    fn sun_samples(&self) -> DrawNeed {
        let suns = self.needs.lights.iter().filter(|light| !light.is_lamp());
        let count = suns.map(|light| light.count).max().unwrap_or(0);
        let one = |needs: &mut VolumeNeeds| {
            let output = needs.output;
            for light in needs.lights.iter_mut().filter(|light| light.count > 1) {
                (light.count, light.shaded, light.blend) = (1, light.shaded.min(1), light_blend(output, 1));
            }
        };
        DrawNeed::new(DrawEffect::SoftSun, (count > 1).then(|| self.saved_by(one)), Reason::Count(count))
    }

    fn counted(&self, is_z_pass: bool) -> DrawNeed {
        let effect = if is_z_pass { DrawEffect::ZPass } else { DrawEffect::ZFail };
        let is_on = self.any(|light| light.counts(is_z_pass));
        self.possible(effect, is_on, |needs| {
            needs.lights.iter_mut().for_each(|light| light.faces.retain(|key| !key.counts(is_z_pass)));
        })
    }

    fn open_meshes(&self) -> DrawNeed {
        let count = self.counts.open_bodies;
        let triangles = self.counts.triangles - self.counts.solid_triangles;
        let need = DrawNeed::new(DrawEffect::OpenMeshes, (count > 0).then(Census::default), Reason::Count(count));
        need.with(Uncounted::Prisms(triangles))
    }

    fn smooth_solids(&self) -> DrawNeed {
        let is_on = self.any(|light| light.faces.iter().any(|key| key.part == Part::Spared));
        self.possible(DrawEffect::SmoothSolids, is_on, |needs| {
            needs.lights.iter_mut().for_each(|light| light.faces.retain(|key| key.part != Part::Spared));
        })
    }

    fn silhouettes_by_gpu(&self) -> DrawNeed {
        let is_on = self.settings.mode == Mode::Gpu;
        let saved = is_on.then(|| Census { volume_buffers: 2, ..Census::default() });
        DrawNeed::new(DrawEffect::SilhouettesByGpu, saved, Reason::Usual)
    }

    fn runs(&self) -> DrawNeed {
        let is_on = self.any(|light| light.runs > 1);
        self.possible(DrawEffect::SeveralRuns, is_on, |needs| {
            for light in needs.lights.iter_mut().filter(|light| light.runs > 1) {
                light.buffers.0 -= light.runs - 1;
                light.runs = 1;
            }
        })
    }

    fn visualized(&self) -> DrawNeed {
        let is_on = self.any(|light| light.faces.iter().any(|key| key.of == VolumeUse::Visualize));
        let hide = |needs: &mut VolumeNeeds| {
            needs.lights.iter_mut().for_each(|light| light.faces.retain(|key| key.of == VolumeUse::Stencil));
        };
        DrawNeed::new(DrawEffect::VisualizedVolumes, is_on.then(|| self.saved_by(hide)), Reason::Usual)
    }
}
