//! What was built for a stage, counted.

use super::batch::BatchKey;
use super::scene::SceneOnGpu;
use super::textures::BaseTextures;
use serde::Serialize;

/// Counts of what a renderer holds, or is to hold.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Census {
    /// Passes a frame.
    pub passes: usize,
    /// Pipelines.
    pub pipelines: usize,
    /// Pipelines that test alpha.
    pub alpha_test_pipelines: usize,
    /// Pipelines that draw both sides.
    pub two_sided_pipelines: usize,
    /// Textures with stored times.
    pub time_textures: usize,
    /// Bindings of a lamp: one where there is a lamp.
    pub lamp_bindings: usize,
    /// Textures with ambient light.
    pub ambient_textures: usize,
    /// Bindings of the sky in spherical harmonics: one where a page wants it.
    pub sky_bindings: usize,
    /// Base colour textures.
    pub base_color_textures: usize,
    /// Vertex buffers.
    pub vertex_buffers: usize,
    /// Groups of bindings that are kept from frame to frame.
    pub bind_groups: usize,
    /// Slots of these groups: each buffer, texture and sampler that some program may read, once for each group that it is in.
    pub bindings: usize,
    /// Pictures drawn into, the depth picture among them.
    pub targets: usize,
    /// Draw calls of a pass over the scene.
    pub draws: usize,
    /// Bytes of all textures with stored times or ambient light.
    pub map_bytes: u64,
    /// Pipelines that count volumes in the stencil, or keep what was counted.
    pub stencil_pipelines: usize,
    /// Buffers from which volumes are drawn.
    pub volume_buffers: usize,
    /// Bytes of these.
    pub volume_bytes: u64,
    /// Pipelines that draw shadow maps or pictures of what casts.
    pub shadow_pipelines: usize,
    /// Shadow maps, each face or cascade counted.
    pub shadow_maps: usize,
    /// Pictures of what casts, and those that blur them.
    pub shadow_masks: usize,
    /// Bytes of both.
    pub shadow_bytes: u64,
}

/// How many counts there are.
const COUNTS: usize = 22;

/// What is counted, one and several; nothing for what is among other bindings.
const WORDS: [[&str; 2]; COUNTS] = [
    ["pass", "passes"],
    ["pipeline", "pipelines"],
    ["alpha-test pipeline", "alpha-test pipelines"],
    ["two-sided pipeline", "two-sided pipelines"],
    ["texture of times", "textures of times"],
    ["", ""],
    ["texture of ambient light", "textures of ambient light"],
    ["", ""],
    ["base colour texture", "base colour textures"],
    ["vertex buffer", "vertex buffers"],
    ["group of bindings", "groups of bindings"],
    ["binding", "bindings"],
    ["target", "targets"],
    ["draw", "draws"],
    ["of maps", "of maps"],
    ["stencil pipeline", "stencil pipelines"],
    ["buffer of volumes", "buffers of volumes"],
    ["of volumes", "of volumes"],
    ["shadow pipeline", "shadow pipelines"],
    ["shadow map", "shadow maps"],
    ["mask", "masks"],
    ["of shadow maps and masks", "of shadow maps and masks"],
];

/// Places of bytes among the counts.
const BYTES: [usize; 3] = [14, 17, 21];

impl Census {
    /// Counts of what every technique shares.
    pub(super) fn of_scene(scene: &SceneOnGpu) -> Self {
        let page_groups = scene.pages.iter().filter(|page| page.bind_group.is_some()).count();
        let page_slots: usize = scene.pages.iter().map(|page| page.slots).sum();
        let texture_groups = scene.textures.bind_groups.len();
        Self {
            time_textures: scene.pages.iter().map(|page| page.time_textures).sum(),
            lamp_bindings: usize::from(scene.frame.lamp.is_some()),
            ambient_textures: scene.pages.iter().map(|page| page.ambient_textures).sum(),
            sky_bindings: usize::from(scene.frame.sky.is_some()),
            base_color_textures: scene.textures.texture_count,
            vertex_buffers: scene.streams.len(),
            bind_groups: 1 + page_groups + texture_groups,
            bindings: scene.frame.slots + page_slots + BaseTextures::SLOTS * texture_groups,
            draws: scene.batches.len(),
            map_bytes: scene.pages.iter().map(|page| page.bytes).sum(),
            ..Self::default()
        }
    }

    /// The same with so many pipelines, of which these draw surfaces.
    pub(super) fn with_pipelines<'a>(self, count: usize, surfaces: impl Iterator<Item = &'a BatchKey>) -> Self {
        let of_key = |(alpha, two_sided): (usize, usize), key: &BatchKey| {
            (alpha + usize::from(key.surface.is_cut), two_sided + usize::from(key.is_two_sided))
        };
        let (alpha_test_pipelines, two_sided_pipelines) = surfaces.fold((0, 0), of_key);
        Self { pipelines: count, alpha_test_pipelines, two_sided_pipelines, ..self }
    }

    fn counts(&self) -> [u64; COUNTS] {
        [
            self.passes as u64,
            self.pipelines as u64,
            self.alpha_test_pipelines as u64,
            self.two_sided_pipelines as u64,
            self.time_textures as u64,
            self.lamp_bindings as u64,
            self.ambient_textures as u64,
            self.sky_bindings as u64,
            self.base_color_textures as u64,
            self.vertex_buffers as u64,
            self.bind_groups as u64,
            self.bindings as u64,
            self.targets as u64,
            self.draws as u64,
            self.map_bytes,
            self.stencil_pipelines as u64,
            self.volume_buffers as u64,
            self.volume_bytes,
            self.shadow_pipelines as u64,
            self.shadow_maps as u64,
            self.shadow_masks as u64,
            self.shadow_bytes,
        ]
    }

    fn of_counts(counts: [u64; COUNTS]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, map_bytes, o, p, volume_bytes, q, r, s, shadow_bytes] = counts;
        Self {
            passes: a as usize,
            pipelines: b as usize,
            alpha_test_pipelines: c as usize,
            two_sided_pipelines: d as usize,
            time_textures: e as usize,
            lamp_bindings: f as usize,
            ambient_textures: g as usize,
            sky_bindings: h as usize,
            base_color_textures: i as usize,
            vertex_buffers: j as usize,
            bind_groups: k as usize,
            bindings: l as usize,
            targets: m as usize,
            draws: n as usize,
            map_bytes,
            stencil_pipelines: o as usize,
            volume_buffers: p as usize,
            volume_bytes,
            shadow_pipelines: q as usize,
            shadow_maps: r as usize,
            shadow_masks: s as usize,
            shadow_bytes,
        }
    }

    /// What there is more of than in another; nothing where there is less.
    pub fn beyond(&self, other: &Self) -> Self {
        let [own, other] = [self.counts(), other.counts()];
        Self::of_counts(std::array::from_fn(|i| own[i].saturating_sub(other[i])))
    }

    /// Whether nothing is more than in another.
    pub fn is_within(&self, other: &Self) -> bool {
        self.beyond(other) == Self::default()
    }

    /// What there is, in words; nothing where there is nothing. Pipelines of a kind are among the pipelines.
    pub fn in_words(&self) -> String {
        let said = |(i, count): (usize, u64)| {
            let words = WORDS[i][usize::from(count != 1)];
            let is_said = count > 0 && !words.is_empty();
            let amount = if BYTES.contains(&i) { size(count) } else { count.to_string() };
            is_said.then(|| format!("{amount} {words}"))
        };
        self.counts().into_iter().enumerate().filter_map(said).collect::<Vec<_>>().join(", ")
    }
}

/// Bytes in the unit that suits them.
fn size(bytes: u64) -> String {
    match bytes {
        ..1024 => format!("{bytes} bytes"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_back_as_they_went() {
        let counts = std::array::from_fn(|i| i as u64 + 1);
        assert_eq!(Census::of_counts(counts).counts(), counts);
        assert_eq!(Census::of_counts(counts).shadow_bytes, COUNTS as u64);
    }

    #[test]
    fn what_is_beyond_is_told_in_words() {
        let less = Census { passes: 2, pipelines: 3, map_bytes: 100, ..Census::default() };
        let more = Census { passes: 2, pipelines: 4, map_bytes: 2148, targets: 2, ..less };
        assert_eq!(more.beyond(&less).in_words(), "1 pipeline, 2 targets, 2.0 KiB of maps");
        assert!(less.is_within(&more) && !more.is_within(&less));
    }
}
