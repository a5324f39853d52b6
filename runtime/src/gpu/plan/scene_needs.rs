//! What a stage's surfaces, their maps and their textures call for. [`SceneOnGpu`](crate::gpu::frame::SceneOnGpu)
//! builds what is stated here, and plans count it.

use crate::gpu::frame::{BatchKey, BatchRequest, Output, TextureImage, TextureSet, by_key};
use crate::plan::Census;
use crate::playback::page_variant;
use crate::stage::Stage;
use std::collections::BTreeSet;
use sunbake::maps::{AmbientTextures, GpuTexel, PageMaps};
use sunbake::tracks::span_texels;
use sunbake_shaders::{AmbientModel, PageVariant, Stream};

/// What surfaces, their maps and their textures call for.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneNeeds {
    /// Keys of the draws of visible surfaces.
    pub batches: BTreeSet<BatchKey>,
    /// Casters that are not drawn; only with a ground.
    pub hidden: BTreeSet<BatchKey>,
    /// What each atlas page calls for.
    pub pages: Vec<PageNeeds>,
    /// Bits of a stored time.
    pub bits: u32,
    /// Whether there is a lamp.
    pub has_lamp: bool,
}

/// What a page calls for.
#[derive(Debug, Clone, PartialEq)]
pub struct PageNeeds {
    /// What programs must know of it.
    pub variant: PageVariant,
    /// Texels of the page.
    pub texels: u64,
    /// Spans of its shadow tracks, whether or not they are read.
    pub spans: u64,
}

impl SceneNeeds {
    /// What a stage calls for, with what a technique wants of its batches.
    pub fn new(stage: &Stage, request: BatchRequest) -> Self {
        Self::of(stage, by_key(stage, request).into_keys(), request)
    }

    /// What a stage calls for whose surfaces are drawn in these batches.
    pub fn of(stage: &Stage, keys: impl Iterator<Item = BatchKey>, request: BatchRequest) -> Self {
        let radius_rad = stage.path.as_ref().map_or(0.0, |path| path.angular_radius_rad);
        let page = |maps: &PageMaps| {
            let mut variant = page_variant(maps, stage.bits, radius_rad);
            variant.has_tracks = request.wants_tracks && maps.tracks.is_some() && !variant.is_point_sun;
            PageNeeds {
                variant,
                texels: u64::from(maps.width) * u64::from(maps.height),
                spans: maps.tracks.as_ref().map_or(0, |tracks| tracks.spans.len() as u64),
            }
        };
        let (hidden, batches) = keys.partition(|key| key.is_hidden);
        Self {
            batches,
            hidden,
            pages: stage.pages.iter().map(page).collect(),
            bits: stage.bits.count(),
            has_lamp: stage.lamp.is_some(),
        }
    }

    /// Everything that casts or may be shown as solid.
    pub fn surfaces(&self) -> impl Iterator<Item = &BatchKey> {
        self.batches.iter().chain(&self.hidden)
    }

    /// What pictures of an output show as solid.
    pub fn solid(&self, output: Output) -> impl Iterator<Item = &BatchKey> + Clone {
        self.batches.iter().filter(move |key| key.is_solid_in(output))
    }

    /// What pictures of an output blend.
    pub fn blended(&self, output: Output) -> impl Iterator<Item = &BatchKey> + Clone {
        let is_lit = output == Output::Lit;
        self.batches.iter().filter(move |key| is_lit && key.is_blended)
    }

    /// How programs read a batch's page.
    pub fn variant(&self, key: &BatchKey) -> &PageVariant {
        &self.pages[key.page as usize].variant
    }

    /// The key of a batch's program. Pages that programs read alike share one.
    pub fn surface_key(&self, key: &BatchKey, output: Output) -> BatchKey {
        let variant = self.variant(key);
        let page = self.pages.iter().position(|page| page.variant == *variant).unwrap_or(0) as u32;
        let textures = TextureSet::default();
        BatchKey { page, textures, is_passed: false, is_open: false, ..key.for_output(output) }
    }

    /// Sets of textures that are bound together: base colours alone where depths or visibility are found, and all of a
    /// surface's textures where it is lit.
    pub fn texture_sets(&self) -> BTreeSet<TextureSet> {
        let alone = self.surfaces().map(|key| key.textures.base_alone());
        let sets = alone.chain(self.batches.iter().map(|key| key.textures));
        sets.filter(|set| *set != TextureSet::default()).collect()
    }

    /// Number of base colour textures, and of other ones.
    pub fn texture_counts(&self) -> [usize; 2] {
        let sets = self.texture_sets();
        let images: BTreeSet<TextureImage> =
            sets.iter().flat_map(TextureSet::in_order).flatten().map(|key| key.source()).collect();
        let base = images.iter().filter(|(.., is_base)| *is_base).count();
        [base, images.len() - base]
    }

    /// Vertex streams in use.
    pub fn streams(&self) -> BTreeSet<Stream> {
        let of_key = |key: &BatchKey| sunbake_shaders::attributes(key.surface).into_iter().map(|a| a.stream);
        self.surfaces().flat_map(of_key).collect()
    }

    /// Whether some page reads the sky in spherical harmonics.
    pub fn has_sky(&self) -> bool {
        self.pages.iter().any(|page| page.variant.ambient == AmbientModel::Sky)
    }

    /// Counts of all of that, without programs, passes and targets.
    pub fn census(&self) -> Census {
        let textures = self.texture_sets();
        let [base_color_textures, look_textures] = self.texture_counts();
        let bindings = || self.pages.iter().map(PageNeeds::binding_count).filter(|&bindings| bindings > 0);
        let of_frame = 2 + usize::from(self.has_lamp) + usize::from(self.has_sky());
        Census {
            time_textures: self.pages.iter().map(PageNeeds::time_textures).sum(),
            lamp_bindings: usize::from(self.has_lamp),
            ambient_textures: self.pages.iter().map(PageNeeds::ambient_textures).sum(),
            wall_textures: self.pages.iter().map(PageNeeds::wall_textures).sum(),
            sky_bindings: usize::from(self.has_sky()),
            base_color_textures,
            look_textures,
            vertex_buffers: self.streams().len(),
            bind_groups: 1 + bindings().count() + textures.len(),
            bindings: of_frame
                + bindings().sum::<usize>()
                + textures.iter().map(TextureSet::binding_count).sum::<usize>(),
            draws: self.batches.len(),
            map_bytes: self.pages.iter().map(|page| page.bytes(self.bits)).sum(),
            ..Census::default()
        }
    }
}

impl PageNeeds {
    fn time_textures(&self) -> usize {
        2 * (usize::from(self.variant.sun_layer_count() > 0) + usize::from(self.variant.lamp_layer_count > 0))
            + self.track_textures()
    }

    /// Lists of texels, numbers of tracks, and times.
    fn track_textures(&self) -> usize {
        if self.variant.reads_tracks() { 3 } else { 0 }
    }

    fn ambient_textures(&self) -> usize {
        match self.variant.ambient {
            AmbientModel::Hemisphere => 0,
            AmbientModel::Occlusion | AmbientModel::Sky => 1,
            AmbientModel::Bent => 2,
        }
    }

    /// Each texture is one binding.
    fn binding_count(&self) -> usize {
        self.time_textures() + self.ambient_textures() + self.wall_textures()
    }

    fn wall_textures(&self) -> usize {
        usize::from(self.variant.has_walls && self.variant.reads_texels())
    }

    fn bytes(&self, bits: u32) -> u64 {
        let variant = &self.variant;
        let texel = GpuTexel {
            layers: variant.sun_layer_count() + variant.lamp_layer_count,
            bits,
            ambient: match variant.ambient {
                AmbientModel::Hemisphere => AmbientTextures::None,
                AmbientModel::Occlusion => AmbientTextures::Occlusion,
                AmbientModel::Bent => AmbientTextures::Bent,
                AmbientModel::Sky => AmbientTextures::Sky,
            },
            sides: if variant.has_backs { 2 } else { 1 },
            walls: self.wall_textures() > 0,
        };
        let tracks = if variant.reads_tracks() { 4 * self.texels + 6 * span_texels(self.spans) } else { 0 };
        self.texels * texel.bytes() + tracks
    }
}
