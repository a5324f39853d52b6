//! Restores the atlas of a baked set: placements from its manifest, texture coordinates from its scene.

use super::manifest::{InstanceEntry, Manifest};
use crate::atlas::{Atlas, Layout, PageSize, Placement};
use crate::scene::{Instance, Scene};
use glam::Vec2;
use std::collections::HashMap;

impl Manifest {
    /// The atlas for `scene`, which was loaded from the set that this manifest describes.
    pub fn atlas(&self, scene: &Scene) -> Atlas {
        let keyed = |entry: &InstanceEntry| ((entry.node, entry.primitive), placement(entry));
        let placements: HashMap<_, _> = self.instances.iter().map(keyed).collect();
        let find = |instance: &Instance| {
            let primitive = scene.meshes[instance.mesh].gltf.1;
            placements.get(&(instance.node, primitive)).copied().unwrap_or(Placement::EMPTY)
        };
        Atlas {
            pages: self.atlases.iter().map(|a| PageSize { width: a.width, height: a.height }).collect(),
            layouts: scene.meshes.iter().map(Layout::of_file).collect(),
            placements: scene.instances.iter().map(find).collect(),
            texels_per_metre: self.scene.texels_per_metre,
            chart_count: self.stats.charts as usize,
            warnings: Vec::new(),
        }
    }
}

fn placement(entry: &InstanceEntry) -> Placement {
    entry.atlas.map_or(Placement::EMPTY, |page| Placement {
        page,
        scale: Vec2::from_array(entry.uv_scale),
        offset: Vec2::from_array(entry.uv_offset),
    })
}
