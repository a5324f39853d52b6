//! Counts of what is built on the GPU, or is to be built.

use serde::Serialize;

/// Counts of what a renderer holds, or is to hold. Zero where there is none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Census {
    /// Number of passes per frame.
    pub passes: usize,
    /// Number of render pipelines.
    pub pipelines: usize,
    /// Pipelines that test alpha.
    pub alpha_test_pipelines: usize,
    /// Pipelines that draw both sides.
    pub two_sided_pipelines: usize,
    /// Pipelines that reflect highlights.
    pub specular_pipelines: usize,
    /// Pipelines that blend.
    pub blended_pipelines: usize,
    /// Textures of stored times.
    pub time_textures: usize,
    /// Bindings of a lamp: one where there is a lamp.
    pub lamp_bindings: usize,
    /// Textures of ambient light.
    pub ambient_textures: usize,
    /// Textures of what stands between texels.
    pub wall_textures: usize,
    /// Bindings of the sky in spherical harmonics: one where a page wants it.
    pub sky_bindings: usize,
    /// Number of base colour textures.
    pub base_color_textures: usize,
    /// Number of other textures of surfaces: metal and roughness, normals, emission.
    pub look_textures: usize,
    /// Number of vertex buffers.
    pub vertex_buffers: usize,
    /// Bind groups that are kept from frame to frame.
    pub bind_groups: usize,
    /// Entries of these groups: each buffer, texture and sampler, once for each group that it is in.
    pub bindings: usize,
    /// Textures drawn into, depth among them.
    pub targets: usize,
    /// Draw calls of one pass over the scene.
    pub draws: usize,
    /// Bytes of the textures of stored times and ambient light.
    pub map_bytes: u64,
    /// Pipelines that count volumes in the stencil, or merge the count of a run.
    pub stencil_pipelines: usize,
    /// Buffers that volumes are drawn from.
    pub volume_buffers: usize,
    /// Bytes of these buffers.
    pub volume_bytes: u64,
    /// Pipelines that draw shadow maps or masks.
    pub shadow_pipelines: usize,
    /// Shadow maps; each cascade and each face of a cube counts as one.
    pub shadow_maps: usize,
    /// Masks of casters on the ground, those of the blur included.
    pub shadow_masks: usize,
    /// Bytes of shadow maps and masks.
    pub shadow_bytes: u64,
}

impl Census {
    /// How many counts there are.
    pub(super) const COUNTS: usize = 26;
    /// Which of them are bytes.
    pub(super) const BYTES: [usize; 3] = [18, 21, 25];

    pub(super) fn counts(&self) -> [u64; Self::COUNTS] {
        [
            self.passes as u64,
            self.pipelines as u64,
            self.alpha_test_pipelines as u64,
            self.two_sided_pipelines as u64,
            self.specular_pipelines as u64,
            self.blended_pipelines as u64,
            self.time_textures as u64,
            self.lamp_bindings as u64,
            self.ambient_textures as u64,
            self.wall_textures as u64,
            self.sky_bindings as u64,
            self.base_color_textures as u64,
            self.look_textures as u64,
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

    fn of_counts(counts: [u64; Self::COUNTS]) -> Self {
        let [
            passes,
            pipelines,
            alpha_test_pipelines,
            two_sided_pipelines,
            specular_pipelines,
            blended_pipelines,
            rest @ ..,
        ] = counts.map(|count| count as usize);
        let [
            time_textures,
            lamp_bindings,
            ambient_textures,
            wall_textures,
            sky_bindings,
            base_color_textures,
            rest @ ..,
        ] = rest;
        let [look_textures, vertex_buffers, bind_groups, bindings, targets, draws, _, stencil_pipelines, rest @ ..] =
            rest;
        let [volume_buffers, _, shadow_pipelines, shadow_maps, shadow_masks, _] = rest;
        let [map_bytes, volume_bytes, shadow_bytes] = Self::BYTES.map(|i| counts[i]);
        Self {
            passes,
            pipelines,
            alpha_test_pipelines,
            two_sided_pipelines,
            specular_pipelines,
            blended_pipelines,
            time_textures,
            lamp_bindings,
            ambient_textures,
            wall_textures,
            sky_bindings,
            base_color_textures,
            look_textures,
            vertex_buffers,
            bind_groups,
            bindings,
            targets,
            draws,
            map_bytes,
            stencil_pipelines,
            volume_buffers,
            volume_bytes,
            shadow_pipelines,
            shadow_maps,
            shadow_masks,
            shadow_bytes,
        }
    }

    /// How much each count is beyond another's; zero where it is less.
    pub fn beyond(&self, other: &Self) -> Self {
        let [own, other] = [self.counts(), other.counts()];
        Self::of_counts(std::array::from_fn(|i| own[i].saturating_sub(other[i])))
    }

    /// Whether no count is beyond another's.
    pub fn is_within(&self, other: &Self) -> bool {
        self.beyond(other) == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_back_as_they_went() {
        let counts = std::array::from_fn(|i| i as u64 + 1);
        assert_eq!(Census::of_counts(counts).counts(), counts);
        assert_eq!(Census::of_counts(counts).shadow_bytes, Census::COUNTS as u64);
    }

    #[test]
    fn what_is_beyond_is_told_in_words() {
        let less = Census { passes: 2, pipelines: 3, map_bytes: 100, ..Census::default() };
        let more = Census { passes: 2, pipelines: 4, map_bytes: 2148, targets: 2, ..less };
        assert_eq!(more.beyond(&less).in_words(), "1 pipeline, 2 targets, 2.0 KiB of maps");
        assert!(less.is_within(&more) && !more.is_within(&less));
    }
}
