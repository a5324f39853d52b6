//! Plans of techniques that the CPU draws. Nothing is built: they take maps and rays.

use crate::gpu::of_maps_alone;
use crate::plan::{Census, DrawEffect, DrawNeed, DrawPlan, Reason, Uncounted};
use crate::stage::Stage;

/// Baked maps. Nothing is built for the properties of surfaces, which are looked up.
pub fn baked(stage: &Stage) -> DrawPlan {
    let (needs, map_bytes) = of_maps_alone(stage);
    DrawPlan { needs, totals: Census { map_bytes, ..Census::default() }, is_exact: true }
}

/// Rays: N per pixel over the light's disc, or one to its middle.
pub fn truth(stage: &Stage, rays: Option<u32>) -> DrawPlan {
    let need = |effect, is_on: bool| DrawNeed::new(effect, is_on.then(Census::default), Reason::Usual);
    let needs = vec![
        need(DrawEffect::TruthOfDisc, rays.is_some()).with(Uncounted::Rays(rays)),
        need(DrawEffect::TracedLamp, stage.lamp.is_some()).with(Uncounted::Rays(rays)),
        need(DrawEffect::TracedAlphaMask, stage.scene.has_alpha_mask()),
        need(DrawEffect::SmoothTerminator, stage.geometry.smooth_count() > 0),
    ];
    DrawPlan { needs, totals: Census::default(), is_exact: true }
}
