//! What is drawn of each caster. This is decided again for each view.

use super::casters::Casters;
use super::culling::{Frustum, Receivers, Targets, is_in_range};
use super::light::{Facings, Light};
use super::silhouettes::{Part, Parts};
use super::{Mode, VolumeOptimizations};
use crate::View;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// How a caster's volume is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StencilMethod {
    /// Faces in front of the surface, without caps at the caster. Cheaper, and wrong where the eye is in the volume or
    /// such a cap is visible.
    ZPass {
        /// Whether caps at the far end are drawn: needed where that is not at infinity.
        dark_caps: bool,
    },
    /// Faces behind the surface: always right.
    ZFail {
        /// Whether caps at the caster are drawn.
        caps: bool,
        /// Whether caps at infinity are drawn.
        dark_caps: bool,
    },
}

impl StencilMethod {
    /// Whether a part of the volume is drawn.
    fn has(self, part: Part) -> bool {
        match (self, part) {
            (_, Part::Walls | Part::Spared) => true,
            (Self::ZFail { caps, .. }, Part::Caps) => caps,
            (Self::ZFail { dark_caps, .. }, Part::DarkCaps) => dark_caps,
            (Self::ZPass { dark_caps }, Part::DarkCaps) => dark_caps,
            (Self::ZPass { .. }, Part::Caps) => false,
        }
    }
}

/// What a frame draws of one light's volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FramePlan {
    /// How each caster is drawn. None: it is left out.
    pub draws: Vec<Option<StencilMethod>>,
    /// Pixels outside of which nothing is drawn: left, top, width, height.
    pub scissor: [u32; 4],
    /// Counts of what was decided.
    pub counts: PlanCounts,
}

/// Counts of what was decided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct PlanCounts {
    /// Number of casters in all.
    pub casters: usize,
    /// Left out: they are out of the light's range, or cast nothing in this light.
    pub casting_nothing: usize,
    /// Left out: their volumes miss the view.
    pub out_of_view: usize,
    /// Left out: their volumes contain no surface in view.
    pub shading_nothing: usize,
    /// Counted in front of the surface.
    pub z_pass: usize,
    /// Counted behind the surface.
    pub z_fail: usize,
    /// Of those behind the surface, drawn without caps, which are out of view.
    pub without_caps: usize,
    /// Of those behind the surface, those for which z-pass was asked for and would be wrong.
    pub replaced: usize,
}

impl FramePlan {
    /// Decides for all casters. `faces` are those of all runs.
    pub fn new(
        casters: &Casters,
        receivers: &Receivers,
        facings: &Facings,
        light: &Light,
        view: &View,
        mode: Mode,
        optimizations: VolumeOptimizations,
    ) -> Self {
        let frustum = Frustum::new(view);
        let targets = Targets::new(receivers.in_view(&frustum, light), &frustum, light);
        let chooser = Chooser { casters, facings, light, frustum: &frustum, targets: &targets, mode, optimizations };
        let chosen: Vec<Choice> = (0..casters.all.len()).into_par_iter().map(|i| chooser.choose(i)).collect();
        let mut counts = PlanCounts { casters: chosen.len(), ..PlanCounts::default() };
        for choice in &chosen {
            match choice {
                Choice::CastingNothing => counts.casting_nothing += 1,
                Choice::OutOfView => counts.out_of_view += 1,
                Choice::ShadingNothing => counts.shading_nothing += 1,
                Choice::Drawn(StencilMethod::ZPass { .. }, _) => counts.z_pass += 1,
                Choice::Drawn(StencilMethod::ZFail { caps, .. }, is_replaced) => {
                    counts.z_fail += 1;
                    counts.without_caps += usize::from(!caps);
                    counts.replaced += usize::from(*is_replaced);
                }
            }
        }
        let draw = |choice: &Choice| match choice {
            Choice::Drawn(draw, _) => Some(*draw),
            _ => None,
        };
        let scissor = match optimizations.scissor {
            true => targets.pixels(&frustum, view, light),
            false => [0, 0, view.size[0], view.size[1]],
        };
        Self { draws: chosen.iter().map(draw).collect(), scissor, counts }
    }

    /// Index ranges of some parts of casters that are counted in front of the surface, or of those counted behind it.
    /// Adjacent ranges are joined.
    pub fn ranges(
        &self,
        all: &[Parts],
        is_z_pass: bool,
        wanted: &[Part],
        is_wanted: impl Fn(usize) -> bool,
    ) -> Vec<Range<u32>> {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        let mut push = |range: Range<u32>| match ranges.last_mut() {
            _ if range.is_empty() => {}
            Some(last) if last.end == range.start => last.end = range.end,
            _ => ranges.push(range),
        };
        for (caster, (draw, parts)) in self.draws.iter().zip(all).enumerate() {
            let Some(draw) =
                draw.filter(|draw| matches!(draw, StencilMethod::ZPass { .. }) == is_z_pass && is_wanted(caster))
            else {
                continue;
            };
            wanted.iter().filter(|part| draw.has(**part)).for_each(|part| push(part.of(parts)));
        }
        ranges
    }

    /// Whether some caster is drawn.
    pub fn draws_anything(&self) -> bool {
        self.scissor[2] > 0 && self.draws.iter().any(Option::is_some)
    }
}

enum Choice {
    CastingNothing,
    OutOfView,
    ShadingNothing,
    /// The flag says that z-pass was asked for and would be wrong.
    Drawn(StencilMethod, bool),
}

struct Chooser<'a> {
    casters: &'a Casters,
    facings: &'a Facings,
    light: &'a Light,
    frustum: &'a Frustum,
    targets: &'a Targets,
    mode: Mode,
    optimizations: VolumeOptimizations,
}

impl Chooser<'_> {
    fn choose(&self, index: usize) -> Choice {
        let caster = &self.casters.all[index];
        let casts = || caster.triangles.clone().any(|triangle| self.facings.of_triangle[triangle] != 0);
        if !is_in_range(&caster.bounds_m, self.light) || !casts() {
            return Choice::CastingNothing;
        }
        if self.optimizations.view_culling && self.frustum.misses_volume(&caster.bounds_m, self.light) {
            return Choice::OutOfView;
        }
        if self.optimizations.receiver_culling && !self.targets.any_behind(caster, self.light) {
            return Choice::ShadingNothing;
        }
        let wants_z_pass = match self.mode {
            Mode::ZPass => true,
            Mode::ZFail | Mode::Triangles => false,
            Mode::Planned | Mode::Gpu => self.optimizations.z_pass,
        };
        if wants_z_pass && self.allows_z_pass(index) {
            return Choice::Drawn(StencilMethod::ZPass { dark_caps: self.light.has_range() }, false);
        }
        let caps = !self.optimizations.cap_culling || !self.frustum.misses(&caster.bounds_m);
        let dark_caps = !self.optimizations.cap_culling || !self.frustum.misses_far_end(&caster.bounds_m, self.light);
        Choice::Drawn(StencilMethod::ZFail { caps, dark_caps }, self.mode == Mode::ZPass)
    }

    /// Whether a caster may be counted in front of the surface without its caps: every cap is hidden by the surface
    /// that it lies on, and the eye is outside of the volume.
    fn allows_z_pass(&self, index: usize) -> bool {
        let caster = &self.casters.all[index];
        let hides_caps = caster.shows_both_sides || (caster.shows_fronts && self.facings.is_solid[index]);
        hides_caps && !self.frustum.may_be_shaded_by(self.casters, caster, &self.facings.of_triangle, self.light)
    }
}
