//! Making a stage: from a set on disk, from a bake in memory, or from a scene alone.

use super::{Chart, Stage};
use glam::Vec2;
use std::collections::HashMap;
use std::path::Path;
use sunbake::Bake;
use sunbake::disk::manifest::{InstanceEntry, Manifest};
use sunbake::maps::{Bits, LaneMaps, PageEncoder, PageMaps};
use sunbake::scene::{LoadError, LoadLimits, Scene};
use sunbake::sun::SunPath;
use sunbake::visibility::Intervals;

/// Memory that loading a scene may take, in bytes.
pub const MAX_SCENE_BYTES: u64 = 16 << 30;

/// Why there is no stage of a set.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// The folder is no baked set.
    #[error(transparent)]
    Set(#[from] sunbake::disk::read::ReadError),
    /// The set's scene cannot be read.
    #[error("the set's scene cannot be read: {0}")]
    Scene(#[from] LoadError),
    /// The set's scene is missing.
    #[error(
        "{file} is missing from the set (its SHA-256 was {}): put it back, or bake the scene again",
        sha256.as_deref().unwrap_or("not kept")
    )]
    NoScene {
        /// Path where the file was expected.
        file: String,
        /// The SHA-256 that the set recorded, if any.
        sha256: Option<String>,
    },
    /// The set's scene has changed since it was baked.
    #[error(
        "{file} is not the scene that the set was baked with: its SHA-256 is {found}, and was {baked}; bake it again"
    )]
    Changed {
        /// Name of the file that changed.
        file: String,
        /// Its SHA-256 now.
        found: String,
        /// Its SHA-256 when the set was baked.
        baked: String,
    },
    /// The manifest and the scene do not agree.
    #[error("the set's scene and its manifest disagree: {reason}; bake the scene again")]
    Mismatch {
        /// What they disagree about.
        reason: String,
    },
}

impl Stage {
    /// Reads a baked set and its scene.
    pub fn read(folder: &Path) -> Result<Self, StageError> {
        Self::read_as(folder, true)
    }

    /// The same with plain looks, as [`Stage::without_looks`]: images that only looks need are not decoded.
    pub fn read_without_looks(folder: &Path) -> Result<Self, StageError> {
        Self::read_as(folder, false)
    }

    fn read_as(folder: &Path, has_looks: bool) -> Result<Self, StageError> {
        let set = sunbake::disk::read::read(folder)?;
        let (file, baked) = (set.scene_file(), set.manifest.scene.sha256.clone());
        if !file.is_file() {
            return Err(StageError::NoScene { file: file.display().to_string(), sha256: baked });
        }
        let mut scene = sunbake::scene::load(&file, &LoadLimits { max_memory_bytes: MAX_SCENE_BYTES })?;
        if let Some(baked) = baked.filter(|baked| *baked != scene.source.sha256) {
            let (file, found) = (file.display().to_string(), scene.source.sha256);
            return Err(StageError::Changed { file, found, baked });
        }
        set.manifest.apply_roles(&mut scene);
        scene.file = scene.file.filter(|_| has_looks);
        let stage = Self::new(scene, &set.manifest.instances, set.pages, set.bits, set.path)?;
        Ok(stage.with_geometry_of(&set.manifest).with_lamp(set.lamp.as_ref()))
    }

    /// A bake that was never written: what [`sunbake::bake_scene`] gives, ready to be drawn.
    pub fn of_bake(bake: Bake) -> Result<Self, StageError> {
        let scene = bake.scene(&LoadLimits { max_memory_bytes: MAX_SCENE_BYTES })?;
        let pages = bake.pages.into_iter().map(|page| page.maps).collect();
        let stage = Self::new(scene, &bake.manifest.instances, pages, bake.bits.times, bake.path)?;
        Ok(stage.with_geometry_of(&bake.manifest).with_lamp(bake.lamp.as_ref()))
    }

    /// A scene for which nothing was baked: it can be drawn and traced, and its maps are empty. It has the looks of its
    /// file; one without a file has plain ones.
    pub fn plain(scene: Scene, path: Option<SunPath>) -> Self {
        let chart = Chart { page: 0, uv_set: 0, scale: Vec2::ZERO, offset: Vec2::ZERO };
        let charts = vec![Some(chart); scene.instances.len()];
        let page =
            PageMaps { width: 1, height: 1, lanes: Vec::new(), lamp: None, ambient: None, walls: None, tracks: None };
        Self::with_charts(scene, charts, vec![page], Bits::Eight, path)
    }

    /// The stage with light that ends on smooth surfaces as it does in the set.
    fn with_geometry_of(mut self, manifest: &Manifest) -> Self {
        self.geometry = manifest.geometry(&self.scene);
        self
    }

    /// Joins a scene with what was baked for it.
    pub fn new(
        scene: Scene,
        instances: &[InstanceEntry],
        pages: Vec<PageMaps>,
        bits: Bits,
        path: Option<SunPath>,
    ) -> Result<Self, StageError> {
        let mut charts = charts(&scene, instances, pages.len())?;
        let pages = with_open_page(&scene, &mut charts, pages, bits);
        Ok(Self::with_charts(scene, charts, pages, bits, path))
    }
}

/// Gives what nothing shades a page of one texel that always sees every light, so that it is drawn as everything else.
fn with_open_page(scene: &Scene, charts: &mut [Option<Chart>], mut pages: Vec<PageMaps>, bits: Bits) -> Vec<PageMaps> {
    let page = pages.len() as u32;
    let is_open = |index: usize| scene.is_there(index) && !scene.receives(index);
    let chart = Chart { page, uv_set: 0, scale: Vec2::ZERO, offset: Vec2::splat(0.5) };
    (0..charts.len()).filter(|&index| is_open(index)).for_each(|index| charts[index] = Some(chart));
    if charts.iter().flatten().any(|chart| chart.page == page) {
        let lit = || {
            let mut encoder = PageEncoder::new(1, bits, 1);
            encoder.set(0, &Intervals::always());
            encoder.finish()
        };
        let lanes = pages.iter().map(|page| &page.lanes).find(|lanes| !lanes.is_empty());
        let lanes = lanes.into_iter().flatten().map(|lane| LaneMaps { lane: lane.lane, layers: lit() }).collect();
        let lamp = pages.iter().any(|page| page.lamp.is_some()).then(lit);
        pages.push(PageMaps { width: 1, height: 1, lanes, lamp, ambient: None, walls: None, tracks: None });
    }
    pages
}

/// Where the texels of each instance lie.
fn charts(scene: &Scene, entries: &[InstanceEntry], page_count: usize) -> Result<Vec<Option<Chart>>, StageError> {
    let entry_of: HashMap<(usize, usize), &InstanceEntry> =
        entries.iter().map(|e| ((e.node, e.primitive), e)).collect();
    let mismatch = |reason: String| StageError::Mismatch { reason };
    let chart = |instance: &sunbake::scene::Instance| {
        let mesh = &scene.meshes[instance.mesh];
        let key = (scene.nodes[instance.node].gltf, mesh.gltf.1);
        let entry = entry_of
            .get(&key)
            .ok_or_else(|| mismatch(format!("the manifest has no entry for node {}, primitive {}", key.0, key.1)))?;
        let Some(page) = entry.atlas else { return Ok(None) };
        let uv_set = entry.uv_set as usize;
        let has_uvs = mesh.texcoord_set(uv_set).is_some();
        if !has_uvs || page as usize >= page_count {
            let reason = format!("node {}, primitive {} has no TEXCOORD_{uv_set} or no page {page}", key.0, key.1);
            return Err(mismatch(reason));
        }
        Ok(Some(Chart { page, uv_set, scale: entry.uv_scale.into(), offset: entry.uv_offset.into() }))
    };
    scene.instances.iter().map(chart).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shot::Shot;
    use crate::technique::{BakedCpu, Technique};
    use crate::testing::view;
    use glam::{DVec3, Vec3};
    use sunbake::progress::Silent;
    use sunbake::settings::{AmbientRequest, BakeSettings, SunRequest};
    use sunbake::sun::DayRequest;
    use sunbake::testing::{SceneBuilder, floor};
    use sunbake_shaders::{AmbientModel, Filter};

    /// A lit picture at noon, on the CPU.
    fn noon(stage: &Stage) -> Vec<Vec3> {
        let shot = Shot::new(stage, view(stage, DVec3::new(3.0, 4.0, 5.0), DVec3::ZERO, [48, 32]));
        BakedCpu::new(stage, Filter::Bilinear).color(&shot, &stage.moment(0.4)).unwrap().pixels
    }

    #[test]
    fn a_bake_in_memory_is_drawn_as_the_set_that_is_written_of_it() {
        let scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))
            .block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.5, 0.5))
            .build();
        let settings = BakeSettings {
            page_size_texels: 64,
            lane_count: 3,
            ambient: Some(AmbientRequest::with_rays(64)),
            threads: 1,
            ..BakeSettings::standard(SunRequest::Day(DayRequest::new(None, None).unwrap()))
        };
        let bake = sunbake::bake_scene(&scene, &settings, &Silent).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        bake.write(&target, false).unwrap();
        let [in_memory, on_disk] =
            [Stage::of_bake(bake).unwrap(), Stage::read(&target).unwrap()].map(|stage| noon(&stage));
        assert!(in_memory.iter().any(|light| *light != in_memory[0]), "the picture shows something");
        // The manifest keeps angles in degrees, so that those of a path may differ in their last bit.
        let worst = in_memory.iter().zip(&on_disk).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn what_takes_no_shadow_leaves_the_rest_its_ambient_light() {
        let mut scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))
            .block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.5, 0.5))
            .build();
        scene.instances[1].role.receives = false;
        let settings = BakeSettings {
            page_size_texels: 64,
            ambient: Some(AmbientRequest::with_rays(16)),
            threads: 1,
            ..BakeSettings::standard(SunRequest::Day(DayRequest::new(None, None).unwrap()))
        };
        let stage = Stage::of_bake(sunbake::bake_scene(&scene, &settings, &Silent).unwrap()).unwrap();
        assert_eq!(stage.best_ambient(), AmbientModel::Occlusion);
        let kept = stage.with_ambient(AmbientModel::Occlusion);
        assert!(kept.pages.iter().any(|page| page.ambient.is_some()));
    }
}
