//! The atlas of a set that was baked before: its manifest says where instances lie, its scene holds their coordinates.

use super::{Atlas, Layout, LayoutOrigin, PageSize, Placement};
use crate::disk::manifest::{InstanceEntry, Manifest};
use crate::scene::{Mesh, Scene};
use glam::Vec2;
use std::collections::HashMap;

impl Atlas {
    /// The atlas that `manifest` describes for `scene`, which was loaded from the same set.
    pub fn of_set(scene: &Scene, manifest: &Manifest) -> Self {
        let place = |entry: &InstanceEntry| ((entry.node, entry.primitive), placement(entry));
        let by_place: HashMap<_, _> = manifest.instances.iter().map(place).collect();
        let find = |i: &crate::scene::Instance| {
            by_place.get(&(i.node, scene.meshes[i.mesh].gltf.1)).copied().unwrap_or(Placement::EMPTY)
        };
        Self {
            pages: manifest.atlases.iter().map(|a| PageSize { width: a.width, height: a.height }).collect(),
            layouts: scene.meshes.iter().map(layout).collect(),
            placements: scene.instances.iter().map(find).collect(),
            texels_per_metre: manifest.scene.texels_per_metre,
            chart_count: manifest.stats.charts as usize,
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

fn layout(mesh: &Mesh) -> Layout {
    let count = mesh.positions.len();
    Layout {
        origin: LayoutOrigin::File,
        vertices: (0..count as u32).collect(),
        uvs: mesh.texcoords[1].clone().unwrap_or_else(|| vec![Vec2::ZERO; count]),
        indices: mesh.indices.clone(),
    }
}
