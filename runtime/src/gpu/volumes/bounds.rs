//! An upper bound of what a light calls for, before a view and a moment are known.

use super::VolumeSettings;
use super::plan::{LightNeeds, hard_lights, light_blend};
use super::programs::FaceKey;
use crate::gpu::frame::Output;
use crate::volumes::{Casters, MOST_COUNTED, MOST_COUNTED_BY_RUN, Mode, Part};
use std::collections::BTreeSet;
use sunbake_shaders::{VolumeCorners, VolumeLight, VolumeUse};

/// Corners of a triangle's prism: under the sun three walls of a triangle each and a cap; under a lamp three walls of
/// two triangles, a cap and a far end.
const MOST_CORNERS: [u64; 2] = [3 * 4, 3 * 8];

/// What bounds the needs of a light.
pub struct LightNeedsBound<'a> {
    pub casters: &'a Casters,
    pub settings: &'a VolumeSettings,
    pub output: Output,
}

impl LightNeedsBound<'_> {
    /// The needs of the sun, or of the lamp.
    pub fn light(&self, is_lamp: bool) -> LightNeeds {
        let [sun, lamp] = hard_lights(self.output);
        let count = if is_lamp { 1 } else { self.settings.sun_samples.max(1) as usize };
        let has_casters = !self.casters.all.is_empty();
        let runs = self.runs();
        let per_run = self.buffers_of_run(is_lamp, runs);
        let (reaches, reach_bytes) = if is_lamp { (1, 4 * self.casters.points_m.len().max(1) as u64) } else { (0, 0) };
        LightNeeds {
            hard: if is_lamp { lamp } else { sun },
            blend: light_blend(self.output, count),
            count,
            shaded: if has_casters { count } else { 0 },
            faces: if has_casters { self.faces(is_lamp) } else { BTreeSet::new() },
            runs,
            binding_count: 1 + reaches + if self.finds_on_gpu() { 3 } else { 0 },
            buffers: (reaches + per_run.0, reach_bytes + per_run.1),
        }
    }

    fn finds_on_gpu(&self) -> bool {
        self.settings.mode == Mode::Gpu && !self.casters.triangles.is_empty()
    }

    /// Casters are halved until no run has too many triangles.
    fn runs(&self) -> usize {
        match self.casters.triangles.len() {
            ..=MOST_COUNTED => 1,
            n => 2 * n / MOST_COUNTED_BY_RUN + 2,
        }
    }

    fn buffers_of_run(&self, is_lamp: bool, runs: usize) -> (usize, u64) {
        let triangles = self.casters.triangles.len() as u64;
        match self.finds_on_gpu() {
            // Two bits a triangle, all of them in each run.
            true => (runs, runs as u64 * 4 * triangles.div_ceil(16)),
            false if triangles == 0 => (0, 0),
            false => (runs, triangles * MOST_CORNERS[usize::from(is_lamp)] * 4),
        }
    }

    /// Volumes are counted in front of the surface where a caster's caps are hidden, behind it where the eye may be
    /// in shadow.
    fn faces(&self, is_lamp: bool) -> BTreeSet<FaceKey> {
        let wants_z_pass = match self.settings.mode {
            Mode::ZPass => true,
            Mode::ZFail | Mode::Triangles => false,
            Mode::Planned | Mode::Gpu => self.settings.optimizations.z_pass,
        };
        let hides_caps = self.casters.all.iter().any(|c| c.shows_both_sides || (c.shows_fronts && c.is_solid));
        let (corners, parts) = match (self.finds_on_gpu(), is_lamp) {
            (false, _) => (VolumeCorners::Indexed, &[Part::Walls][..]),
            (true, false) => (VolumeCorners::FromEdges, &[Part::Walls, Part::Caps][..]),
            (true, true) => (VolumeCorners::FromEdges, &Part::FACES[..]),
        };
        let light = if is_lamp { VolumeLight::LampWithRange } else { VolumeLight::Sun };
        let is_run = self.casters.triangles.len() > MOST_COUNTED;
        let ways = if wants_z_pass && hides_caps { &[true, false][..] } else { &[false][..] };
        let of = VolumeUse::Stencil;
        let key = |is_z_pass| move |&part| FaceKey { light, corners, part, of, is_z_pass, is_run };
        let has_smooth = self.casters.all.iter().any(|caster| caster.is_smooth && caster.is_solid);
        let spared = has_smooth.then(|| key(false)(&Part::Spared));
        // In front of the surface a caster's own caps are not counted.
        let is_there = |key: &FaceKey| !(key.is_z_pass && key.part == Part::Caps);
        ways.iter().flat_map(|&way| parts.iter().map(key(way))).filter(is_there).chain(spared).collect()
    }
}
