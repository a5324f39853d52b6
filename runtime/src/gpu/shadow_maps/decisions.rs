//! Decisions about the effects of shadow maps.

use super::plan::{MapNeeds, SunShading};
use crate::gpu::frame::BatchKey;
use crate::gpu::plan::{SceneEffects, SceneNeeds, change_keys};
use crate::plan::{Census, DrawEffect, DrawNeed, Reason, Uncounted};
use crate::shadow_maps::Variant;
use sunbake_shaders::ShadowTap;

/// Whether the ground is drawn apart.
pub fn ground_apart(effects: &SceneEffects) -> DrawNeed {
    let is_on = effects.scene.surfaces().any(|key| key.is_ground);
    let join = |scene: &mut SceneNeeds| change_keys(scene, |key| BatchKey { is_ground: false, ..*key });
    DrawNeed::new(DrawEffect::SeparateGroundDraws, is_on.then(|| effects.saved_by(join)), Reason::Usual)
}

/// Decides about each effect of shadow maps.
pub struct MapDecisions<'a> {
    pub needs: &'a MapNeeds,
    pub scene: &'a SceneNeeds,
}

impl MapDecisions<'_> {
    /// Decisions about every effect of shadow maps.
    pub fn all(&self) -> Vec<DrawNeed> {
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

    fn shadows(&self) -> DrawNeed {
        let open = |needs: &mut MapNeeds| needs.shading = SunShading::Open;
        let saved = self.needs.is_shaded().then(|| self.saved_by(open));
        let reason = match (self.needs.shading, self.needs.is_exact) {
            (SunShading::Down, _) => Reason::SunDown,
            (SunShading::Open, _) | (SunShading::Shaded { .. }, true) => Reason::Usual,
            (SunShading::Shaded { .. }, false) => Reason::Possible,
        };
        DrawNeed::new(DrawEffect::SunShadows, saved, reason)
    }

    fn several_maps(&self) -> DrawNeed {
        let maps = self.needs.maps();
        let one = |needs: &mut MapNeeds| {
            if let SunShading::Shaded { maps, drawn } = needs.shading {
                needs.shading = SunShading::Shaded { maps: maps.min(1), drawn: drawn.min(1) };
            }
        };
        let reason = match (maps, self.needs.settings.variant) {
            (2.., Variant::Cascades) => Reason::Slices(maps),
            (2.., _) => Reason::CubeFaces(maps),
            _ => Reason::Count(maps),
        };
        DrawNeed::new(DrawEffect::SeveralMaps, (maps > 1).then(|| self.saved_by(one)), reason)
    }

    fn blurred_mask(&self) -> DrawNeed {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_mask;
        let saved = is_on.then(|| self.saved_by(|needs| needs.reads.has_mask = false));
        DrawNeed::new(DrawEffect::BlurredMask, saved, Reason::Usual)
    }

    fn flat_mask(&self) -> DrawNeed {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_flat_mask;
        let saved = is_on.then(|| self.saved_by(|needs| needs.shading = SunShading::Open));
        DrawNeed::new(DrawEffect::FlatMask, saved, Reason::Usual)
    }

    fn sampler(&self) -> DrawNeed {
        let is_on = self.needs.is_shaded() && self.needs.reads.has_sampler();
        let saved = is_on.then(|| self.saved_by(|needs| needs.reads.tap = ShadowTap::Manual));
        let is_gathered = is_on && self.needs.reads.tap == ShadowTap::Gathered;
        DrawNeed::new(DrawEffect::MapSampler, saved, if is_gathered { Reason::Gathered } else { Reason::Usual })
    }

    fn wide_filter(&self) -> DrawNeed {
        let taps = match self.needs.settings.variant {
            Variant::Pcf16 | Variant::Cascades => 16,
            Variant::Pcf4 => 4,
            _ => 1,
        };
        let is_on = taps > 1 && self.needs.is_shaded();
        let need = DrawNeed::new(DrawEffect::WideFilter, is_on.then(Census::default), Reason::Usual);
        need.with(Uncounted::Comparisons(taps))
    }

    fn penumbra(&self) -> DrawNeed {
        let is_on = self.needs.settings.variant == Variant::Pcss && self.needs.is_shaded();
        DrawNeed::new(DrawEffect::MapPenumbra, is_on.then(Census::default), Reason::Usual)
    }
}
