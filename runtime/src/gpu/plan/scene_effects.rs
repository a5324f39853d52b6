//! Decisions about the effects that all renderers share: those of surfaces, their maps and their textures.

use super::{PageNeeds, SceneNeeds};
use crate::gpu::frame::{BatchKey, BatchRequest, Output, TextureSet, depth_key};
use crate::plan::{Census, DrawEffect, DrawNeed, Reason};
use crate::stage::Stage;
use std::collections::BTreeSet;
use sunbake_shaders::{AmbientModel, LaneVariant, LookVariant, PageVariant, SurfaceVariant};

/// Decisions where only the maps take anything, and their bytes: for pictures that the CPU draws.
pub fn of_maps_alone(stage: &Stage) -> (Vec<DrawNeed>, u64) {
    let scene = SceneNeeds::new(stage, BatchRequest::default());
    let totals = |scene: &SceneNeeds| Census { map_bytes: scene.census().map_bytes, ..Census::default() };
    (SceneEffects { scene: &scene, totals: &totals }.all(), totals(&scene).map_bytes)
}

/// Decides what a scene calls for. Each effect takes what `totals` is less for a scene without it.
pub struct SceneEffects<'a> {
    /// What the scene calls for.
    pub scene: &'a SceneNeeds,
    /// What a technique builds for a scene.
    pub totals: &'a dyn Fn(&SceneNeeds) -> Census,
}

impl SceneEffects<'_> {
    /// Decisions about every effect of the scene itself.
    pub fn all(&self) -> Vec<DrawNeed> {
        let surfaces =
            [self.textures(), self.vertex_colors(), self.alpha_test(), self.two_sided(), self.smooth_terminator()];
        let surfaces = surfaces.into_iter().chain(self.of_looks());
        surfaces.chain(self.of_times()).chain(self.of_ambient()).chain([self.walls(), self.pages()]).collect()
    }

    /// What a change to the scene would save.
    pub fn saved_by(&self, change: impl Fn(&mut SceneNeeds)) -> Census {
        let mut without = self.scene.clone();
        change(&mut without);
        (self.totals)(self.scene).beyond(&(self.totals)(&without))
    }

    /// An effect that is on where something is counted; `strip` takes it from a surface.
    fn of_surfaces(&self, effect: DrawEffect, count: usize, strip: impl Fn(&BatchKey) -> BatchKey) -> DrawNeed {
        let saved = (count > 0).then(|| self.saved_by(|scene| change_keys(scene, &strip)));
        DrawNeed::new(effect, saved, Reason::Count(count))
    }

    fn textures(&self) -> DrawNeed {
        let count = self.scene.census().base_color_textures;
        self.of_surfaces(DrawEffect::BaseColorTextures, count, |key| BatchKey {
            surface: SurfaceVariant { is_textured: false, ..key.surface },
            textures: TextureSet { base: None, ..key.textures },
            ..*key
        })
    }

    /// What only lit pictures show.
    fn of_looks(&self) -> [DrawNeed; 5] {
        let count =
            |is_so: fn(&LookVariant) -> bool| self.scene.batches.iter().filter(|key| is_so(&key.surface.look)).count();
        let strip = |effect, is_so, change: fn(&mut LookVariant, &mut TextureSet)| {
            self.of_surfaces(effect, count(is_so), |key| {
                let mut key = *key;
                change(&mut key.surface.look, &mut key.textures);
                key
            })
        };
        [
            strip(
                DrawEffect::Highlights,
                |look| look.is_specular,
                |look, textures| {
                    (look.is_specular, look.has_metallic_roughness_map) = (false, false);
                    textures.metallic_roughness = None;
                },
            ),
            strip(
                DrawEffect::MetallicRoughnessTextures,
                |look| look.has_metallic_roughness_map,
                |look, textures| {
                    (look.has_metallic_roughness_map, textures.metallic_roughness) = (false, None);
                },
            ),
            strip(
                DrawEffect::NormalMaps,
                |look| look.has_normal_map,
                |look, textures| {
                    (look.has_normal_map, textures.normal) = (false, None);
                },
            ),
            strip(
                DrawEffect::EmissiveTextures,
                |look| look.has_emissive_map,
                |look, textures| {
                    (look.has_emissive_map, textures.emissive) = (false, None);
                },
            ),
            self.blended(),
        ]
    }

    fn blended(&self) -> DrawNeed {
        let count = self.scene.blended(Output::Lit).count();
        let strip = |scene: &mut SceneNeeds| change_keys(scene, |key| BatchKey { is_blended: false, ..*key });
        DrawNeed::new(DrawEffect::BlendedSurfaces, (count > 0).then(|| self.saved_by(strip)), Reason::Count(count))
    }

    fn vertex_colors(&self) -> DrawNeed {
        let count = self.scene.surfaces().filter(|key| key.surface.has_vertex_color).count();
        self.of_surfaces(DrawEffect::VertexColors, count, |key| BatchKey {
            surface: SurfaceVariant { has_vertex_color: false, ..key.surface },
            ..*key
        })
    }

    fn alpha_test(&self) -> DrawNeed {
        let count = self.scene.surfaces().filter(|key| key.surface.has_alpha_mask).count();
        self.of_surfaces(DrawEffect::AlphaTest, count, |key| BatchKey {
            surface: SurfaceVariant { has_alpha_mask: false, ..key.surface },
            ..*key
        })
    }

    fn two_sided(&self) -> DrawNeed {
        let count = self.scene.surfaces().filter(|key| key.is_two_sided).count();
        self.of_surfaces(DrawEffect::TwoSidedFaces, count, |key| BatchKey { is_two_sided: false, ..*key })
    }

    fn smooth_terminator(&self) -> DrawNeed {
        let count = self.scene.surfaces().filter(|key| key.surface.is_smooth).count();
        self.of_surfaces(DrawEffect::SmoothTerminator, count, |key| BatchKey {
            surface: SurfaceVariant { is_smooth: false, has_lift: false, ..key.surface },
            ..*key
        })
    }

    /// What a change to all pages would save.
    fn saved_on_pages(&self, change: fn(&mut PageVariant)) -> Census {
        self.saved_by(|scene| scene.pages.iter_mut().for_each(|page| change(&mut page.variant)))
    }

    fn of_times(&self) -> Vec<DrawNeed> {
        let pages = || self.scene.pages.iter().map(|page| &page.variant);
        let has_sun = pages().any(|page| page.layer_count() > 0);
        let lamp_layers = pages().map(|page| page.lamp_layer_count).max().unwrap_or(0);
        let sun_layers = pages().flat_map(|page| &page.lanes).map(|lane| lane.layer_count).max().unwrap_or(0);
        let (layers, lanes) = (sun_layers.max(lamp_layers), pages().map(|page| page.lanes.len()).max().unwrap_or(0));
        let has_times = has_sun || lamp_layers > 0;
        let is_soft = has_sun && pages().any(|page| page.layer_count() > 0 && !page.is_point_sun);
        let on_pages = |change| self.saved_on_pages(change);
        vec![
            DrawNeed::new(DrawEffect::SunTimes, has_sun.then(|| on_pages(|page| page.lanes.clear())), Reason::Usual),
            DrawNeed::new(
                DrawEffect::Penumbra,
                is_soft.then(Census::default),
                if has_sun { Reason::Usual } else { Reason::Unread },
            ),
            DrawNeed::new(
                DrawEffect::DiscLanes,
                (lanes > 1).then(|| on_pages(|page| keep_middle_lane(&mut page.lanes))),
                Reason::Count(lanes),
            ),
            DrawNeed::new(
                DrawEffect::SeveralLayers,
                (layers > 1).then(|| on_pages(keep_one_layer)),
                Reason::Count(layers as usize),
            ),
            DrawNeed::new(
                DrawEffect::SixteenBitTimes,
                (has_times && self.scene.bits > 8).then(|| self.saved_by(|scene| scene.bits = 8)),
                if has_times { Reason::Count(self.scene.bits as usize) } else { Reason::Unread },
            ),
            self.lamp(lamp_layers),
            self.tracks(),
        ]
    }

    fn tracks(&self) -> DrawNeed {
        let is_read = self.scene.pages.iter().any(|page| page.variant.reads_tracks());
        let saved = is_read.then(|| self.saved_on_pages(|page| page.has_tracks = false));
        DrawNeed::new(DrawEffect::Tracks, saved, Reason::Usual)
    }

    fn lamp(&self, layers: u32) -> DrawNeed {
        let strip = |scene: &mut SceneNeeds| {
            scene.has_lamp = false;
            scene.pages.iter_mut().for_each(|page| page.variant.lamp_layer_count = 0);
        };
        let saved = self.scene.has_lamp.then(|| self.saved_by(strip));
        let is_unread = self.scene.has_lamp && layers == 0;
        DrawNeed::new(DrawEffect::Lamp, saved, if is_unread { Reason::Unread } else { Reason::Usual })
    }

    fn of_ambient(&self) -> [DrawNeed; 4] {
        use AmbientModel::{Bent, Hemisphere, Occlusion, Sky};
        let models: BTreeSet<AmbientModel> = self.scene.pages.iter().map(|page| page.variant.ambient).collect();
        let has = |model| models.contains(&model);
        let instead = |of: &'static [AmbientModel], by: AmbientModel| {
            self.saved_by(|scene| {
                let variants = scene.pages.iter_mut().map(|page| &mut page.variant);
                variants.filter(|page| of.contains(&page.ambient)).for_each(|page| page.ambient = by);
            })
        };
        let has_backs =
            self.scene.pages.iter().any(|page| page.variant.has_backs && page.variant.ambient != Hemisphere);
        let need = |effect, saved| DrawNeed::new(effect, saved, Reason::Usual);
        [
            need(
                DrawEffect::AmbientOcclusion,
                (has(Occlusion) || has(Bent)).then(|| instead(&[Occlusion, Bent], Hemisphere)),
            ),
            need(DrawEffect::BentNormals, has(Bent).then(|| instead(&[Bent], Occlusion))),
            need(DrawEffect::SkyHarmonics, has(Sky).then(|| instead(&[Sky], Hemisphere))),
            need(DrawEffect::AmbientOfBacks, has_backs.then(|| self.saved_on_pages(|page| page.has_backs = false))),
        ]
    }

    fn walls(&self) -> DrawNeed {
        let has_walls = self.scene.pages.iter().any(|page| page.variant.has_walls);
        let is_read = self.scene.pages.iter().any(|page| page.variant.has_walls && page.variant.reads_texels());
        let saved = is_read.then(|| self.saved_on_pages(|page| page.has_walls = false));
        DrawNeed::new(DrawEffect::Walls, saved, if has_walls && !is_read { Reason::Unread } else { Reason::Usual })
    }

    fn pages(&self) -> DrawNeed {
        let count = self.scene.pages.len();
        // A baked page has many texels; the page of one texel is that of what nothing shades.
        let is_open = |page: &PageNeeds| page.texels == 1;
        let reason = match self.scene.pages.last() {
            Some(last) if count > 1 && is_open(last) => Reason::PagesAndOpenTexel(count - 1),
            _ => Reason::Count(count),
        };
        DrawNeed::new(DrawEffect::SeveralPages, (count > 1).then(|| self.saved_by(join_pages)), reason)
    }
}

/// The passes of every renderer: depths, and what lights.
pub fn of_passes(scene: &SceneNeeds, output: Output, lit_pipelines: usize) -> [DrawNeed; 3] {
    let depth_keys: BTreeSet<BatchKey> = scene.solid(output).map(depth_key).collect();
    let pass = |pipelines| Census { passes: 1, pipelines, targets: 1, ..Census::default() };
    let background = Census { pipelines: 1, ..Census::default() };
    let is_lit = output == Output::Lit;
    let light_reason = if is_lit { Reason::Usual } else { Reason::VisibilityPicture };
    [
        DrawNeed::new(DrawEffect::DepthPass, Some(pass(depth_keys.len())), Reason::Usual),
        DrawNeed::new(DrawEffect::LightPass, Some(pass(lit_pipelines)), light_reason),
        DrawNeed::new(DrawEffect::SkyBackground, is_lit.then_some(background), Reason::Usual),
    ]
}

/// Changes all batches. Those that become alike are one.
pub fn change_keys(scene: &mut SceneNeeds, change: impl Fn(&BatchKey) -> BatchKey) {
    for keys in [&mut scene.batches, &mut scene.hidden] {
        *keys = keys.iter().map(&change).collect();
    }
}

fn keep_middle_lane(lanes: &mut Vec<LaneVariant>) {
    if lanes.len() > 1 {
        let middle = lanes.len() / 2;
        lanes.swap(0, middle);
        lanes.truncate(1);
    }
}

fn keep_one_layer(page: &mut PageVariant) {
    page.lanes.iter_mut().for_each(|lane| lane.layer_count = lane.layer_count.min(1));
    page.lamp_layer_count = page.lamp_layer_count.min(1);
}

/// All pages as one of their total size, read like the first.
fn join_pages(scene: &mut SceneNeeds) {
    let texels = scene.pages.iter().map(|page| page.texels).sum();
    scene.pages.truncate(1);
    scene.pages.iter_mut().for_each(|page| page.texels = texels);
    change_keys(scene, |key| BatchKey { page: 0, ..*key });
}
