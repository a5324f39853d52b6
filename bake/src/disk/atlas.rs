//! A baked set's scene and atlas: placements from its manifest, texture coordinates from its scene.

use super::manifest::{InstanceEntry, Manifest, SMOOTH_TERMINATOR};
use crate::atlas::{Atlas, Layout, PageSize, Placement};
use crate::scene::{Geometry, Instance, Role, Scene};
use glam::Vec2;
use std::collections::HashMap;

impl Manifest {
    /// The entries of a scene's instances. `scene` was loaded from the set that this manifest describes.
    pub fn entries(&self, scene: &Scene) -> Vec<Option<&InstanceEntry>> {
        let entries: HashMap<_, _> = self.instances.iter().map(|e| ((e.node, e.primitive), e)).collect();
        let find = |instance: &Instance| {
            let key = (scene.nodes[instance.node].gltf, scene.meshes[instance.mesh].gltf.1);
            entries.get(&key).copied()
        };
        scene.instances.iter().map(find).collect()
    }

    /// Gives the instances of the set's scene the roles that they were baked in, and takes away what the bake left
    /// out: what could be shaded and has no page.
    pub fn apply_roles(&self, scene: &mut Scene) {
        let entries: Vec<Option<[bool; 3]>> = self.entries(scene).iter().map(|entry| entry.map(roles)).collect();
        let mut left_out = Vec::new();
        for (index, entry) in entries.into_iter().enumerate() {
            let Some([casts, receives, is_there]) = entry else { continue };
            let role = &mut scene.instances[index].role;
            *role = Role { casts, receives, ..*role };
            left_out.extend((!is_there).then_some(index));
        }
        scene.turn_into_air(&left_out);
    }

    /// The triangles of the set's scene, as the set was baked: with or without the smooth shapes of which they are
    /// facets.
    pub fn geometry(&self, scene: &Scene) -> Geometry {
        match self.has_effect(SMOOTH_TERMINATOR) {
            true => Geometry::new(scene),
            false => Geometry::faceted(scene),
        }
    }

    /// Whether an effect was baked, by its name. Sets that are older than the effect do not have it.
    pub fn has_effect(&self, name: &str) -> bool {
        self.effects.iter().any(|entry| entry.on && entry.effect == name)
    }

    /// The atlas for the set's scene.
    pub fn atlas(&self, scene: &Scene) -> Atlas {
        let entries = self.entries(scene);
        let mut uv_sets = vec![1; scene.meshes.len()];
        for (instance, entry) in scene.instances.iter().zip(&entries) {
            uv_sets[instance.mesh] = entry.map_or(1, |entry| entry.uv_set as usize);
        }
        Atlas {
            pages: self.atlases.iter().map(|a| PageSize { width: a.width, height: a.height }).collect(),
            layouts: scene.meshes.iter().zip(uv_sets).map(|(mesh, set)| Layout::of_file(mesh, set)).collect(),
            placements: entries.iter().map(|entry| entry.map_or(Placement::EMPTY, placement)).collect(),
            texels_per_metre: self.scene.texels_per_metre,
            chart_count: self.stats.charts as usize,
            warnings: Vec::new(),
        }
    }
}

/// Whether an instance casts, receives, and is there at all.
fn roles(entry: &InstanceEntry) -> [bool; 3] {
    [entry.casts, entry.receives, entry.atlas.is_some() || !entry.receives]
}

fn placement(entry: &InstanceEntry) -> Placement {
    entry.atlas.map_or(Placement::EMPTY, |page| Placement {
        page,
        scale: Vec2::from_array(entry.uv_scale),
        offset: Vec2::from_array(entry.uv_offset),
    })
}
