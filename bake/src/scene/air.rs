//! Surfaces that are not there: neither drawn nor traced nor baked.

use super::{Alpha, Material, Mesh, Scene};
use std::collections::{BTreeMap, BTreeSet};

impl Scene {
    /// Turns the materials of instances into air. Where others have the same material, they get one copy of it; where
    /// others draw the same mesh, one copy of that mesh.
    pub(crate) fn turn_into_air(&mut self, instances: &[usize]) {
        let mut draws_of_mesh = vec![0; self.meshes.len()];
        self.instances.iter().for_each(|instance| draws_of_mesh[instance.mesh] += 1);
        let chosen: BTreeSet<usize> = instances.iter().copied().collect();
        let kept: BTreeSet<usize> = (0..self.instances.len())
            .filter(|index| !chosen.contains(index))
            .map(|index| self.meshes[self.instances[index].mesh].material)
            .collect();
        let mut by_mesh: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        instances.iter().for_each(|&one| by_mesh.entry(self.instances[one].mesh).or_default().push(one));
        let mut air_of_material = BTreeMap::new();
        for (mesh, instances) in by_mesh {
            let material = self.meshes[mesh].material;
            if self.materials[material].alpha == Alpha::Invisible {
                continue;
            }
            if !kept.contains(&material) {
                self.materials[material].alpha = Alpha::Invisible;
                continue;
            }
            let air = *air_of_material.entry(material).or_insert_with(|| {
                self.materials.push(Material { alpha: Alpha::Invisible, ..self.materials[material].clone() });
                self.materials.len() - 1
            });
            if instances.len() < draws_of_mesh[mesh] {
                let copy = self.meshes.len();
                self.meshes.push(Mesh { material: air, ..self.meshes[mesh].clone() });
                instances.into_iter().for_each(|one| self.instances[one].mesh = copy);
            } else {
                self.meshes[mesh].material = air;
            }
        }
    }
}
