//! Making a stage: from a set on disk, or from a scene alone.

use super::{Chart, Stage};
use glam::Vec2;
use std::collections::HashMap;
use std::path::Path;
use sunbake::disk::manifest::InstanceEntry;
use sunbake::maps::{Bits, PageMaps};
use sunbake::scene::{LoadError, LoadLimits, Scene};
use sunbake::sun::SunPath;

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
    #[error("{file} is missing from the set (its SHA-256 was {}): put it back, or bake the scene again", sha256.as_deref().unwrap_or("not kept"))]
    NoScene {
        /// Where it was.
        file: String,
        /// The SHA-256 that the set recorded, if any.
        sha256: Option<String>,
    },
    /// The set's scene has changed since it was baked.
    #[error(
        "{file} is not the scene that the set was baked with: its SHA-256 is {found}, and was {baked}; bake it again"
    )]
    Changed {
        /// Which file.
        file: String,
        /// Its SHA-256 now.
        found: String,
        /// Its SHA-256 when the set was baked.
        baked: String,
    },
    /// The manifest and the scene do not agree.
    #[error("the set's scene and its manifest disagree: {reason}; bake the scene again")]
    Mismatch {
        /// Where they disagree.
        reason: String,
    },
}

impl Stage {
    /// Reads a baked set and its scene.
    pub fn read(folder: &Path) -> Result<Self, StageError> {
        let set = sunbake::disk::read::read(folder)?;
        let (file, baked) = (set.scene_file(), set.manifest.scene.sha256);
        if !file.is_file() {
            return Err(StageError::NoScene { file: file.display().to_string(), sha256: baked });
        }
        let scene = sunbake::scene::load(&file, &LoadLimits { max_memory_bytes: MAX_SCENE_BYTES })?;
        if let Some(baked) = baked.filter(|baked| *baked != scene.source.sha256) {
            let (file, found) = (file.display().to_string(), scene.source.sha256);
            return Err(StageError::Changed { file, found, baked });
        }
        let stage = Self::new(scene, &set.manifest.instances, set.pages, set.bits, set.path)?;
        Ok(stage.with_lamp(set.lamp.as_ref()))
    }

    /// A scene for which nothing was baked: it can be drawn and traced, and its maps are empty.
    pub fn plain(scene: Scene, path: Option<SunPath>) -> Self {
        let chart = Chart { page: 0, uv_set: 0, scale: Vec2::ZERO, offset: Vec2::ZERO };
        let charts = vec![Some(chart); scene.instances.len()];
        let page = PageMaps { width: 1, height: 1, lanes: Vec::new(), lamp: None, ambient: None };
        Self::with_charts(scene, charts, vec![page], Bits::Eight, path)
    }

    /// Joins a scene with what was baked for it.
    pub fn new(
        scene: Scene,
        instances: &[InstanceEntry],
        pages: Vec<PageMaps>,
        bits: Bits,
        path: Option<SunPath>,
    ) -> Result<Self, StageError> {
        let charts = charts(&scene, instances, pages.len())?;
        Ok(Self::with_charts(scene, charts, pages, bits, path))
    }
}

/// Where the texels of each instance lie.
fn charts(scene: &Scene, entries: &[InstanceEntry], page_count: usize) -> Result<Vec<Option<Chart>>, StageError> {
    let entry_of: HashMap<(usize, usize), &InstanceEntry> =
        entries.iter().map(|e| ((e.node, e.primitive), e)).collect();
    let mismatch = |reason: String| StageError::Mismatch { reason };
    let chart = |instance: &sunbake::scene::Instance| {
        let mesh = &scene.meshes[instance.mesh];
        let key = (instance.node, mesh.gltf.1);
        let entry = entry_of
            .get(&key)
            .ok_or_else(|| mismatch(format!("the manifest has no entry for node {}, primitive {}", key.0, key.1)))?;
        let Some(page) = entry.atlas else { return Ok(None) };
        let uv_set = entry.uv_set as usize;
        let has_uvs = mesh.texcoords.get(uv_set).is_some_and(Option::is_some);
        if !has_uvs || page as usize >= page_count {
            let reason = format!("node {}, primitive {} has no TEXCOORD_{uv_set} or no page {page}", key.0, key.1);
            return Err(mismatch(reason));
        }
        Ok(Some(Chart { page, uv_set, scale: entry.uv_scale.into(), offset: entry.uv_offset.into() }))
    };
    scene.instances.iter().map(chart).collect()
}
