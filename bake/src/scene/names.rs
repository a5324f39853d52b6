//! What a user calls parts of a scene.
//!
//! A name means every material, node and mesh that has it; in it, `*` stands for any text. A node stands for itself and
//! all nodes below it. What has no name of its own has an index in its file: `material:3`, `node:12`, `mesh:0`.

use super::Scene;
use serde_json::Value;
use std::borrow::Borrow;
use std::collections::BTreeSet;

/// Parts of a scene that a text names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// Indices in [`Scene::materials`], ascending.
    pub materials: Vec<usize>,
    /// Indices in [`Scene::instances`] of what selected nodes and meshes draw, ascending.
    pub instances: Vec<usize>,
}

impl Selection {
    /// What a text names in a scene.
    pub fn new(scene: &Scene, text: &str) -> Self {
        let index = named_index(text);
        let of_kind = |kind: &str| index.filter(|of| of.0 == kind).map(|of| of.1);
        let [material, node, mesh] = KINDS.map(of_kind);
        let is_index = index.is_some();
        let is_named = |name: &Option<String>| !is_index && name.as_ref().is_some_and(|name| matches(text, name));
        let mut is_below = Vec::with_capacity(scene.nodes.len());
        for one in &scene.nodes {
            let is_parent = one.parent.is_some_and(|parent| is_below[parent]);
            is_below.push(is_parent || node == Some(one.gltf) || is_named(&one.name));
        }
        let is_mesh = |index: usize| {
            let one = &scene.meshes[index];
            mesh == Some(one.gltf.0) || is_named(&one.name)
        };
        let is_material = |index: &usize| {
            let one = &scene.materials[*index];
            (material.is_some() && material == one.gltf) || is_named(&one.name)
        };
        let is_instance = |index: &usize| {
            let one = &scene.instances[*index];
            is_below[one.node] || is_mesh(one.mesh)
        };
        Self {
            materials: (0..scene.materials.len()).filter(is_material).collect(),
            instances: (0..scene.instances.len()).filter(is_instance).collect(),
        }
    }

    /// Instances that it means, those that have one of its materials included.
    pub fn all_instances(&self, scene: &Scene) -> BTreeSet<u32> {
        let has_material = |index: &usize| {
            let material = scene.meshes[scene.instances[*index].mesh].material;
            self.materials.binary_search(&material).is_ok()
        };
        let of_materials = (0..scene.instances.len()).filter(has_material);
        self.instances.iter().copied().chain(of_materials).map(|index| index as u32).collect()
    }

    /// Whether the text names nothing.
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty() && self.instances.is_empty()
    }
}

/// What has an index of its own.
const KINDS: [&str; 3] = ["material", "node", "mesh"];

/// The kind and the index that a text names, if it is one: `node:12`.
pub(super) fn named_index(text: &str) -> Option<(&'static str, usize)> {
    let (kind, index) = text.split_once(':')?;
    let kind = KINDS.into_iter().find(|known| *known == kind)?;
    Some((kind, index.parse().ok()?))
}

/// A list of the scene's file; empty where the scene was made without one.
fn list_in_file<'a>(scene: &'a Scene, kind: &str) -> &'a [Value] {
    let list = if kind == "mesh" { "meshes".to_owned() } else { format!("{kind}s") };
    let json = scene.file.as_ref().and_then(|file| file.json().get(list));
    json.and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// How many materials, nodes or meshes there are in the file, drawn or not.
pub(super) fn count_in_file(scene: &Scene, kind: &str) -> usize {
    let drawn = match kind {
        "node" => scene.nodes.iter().map(|node| node.gltf + 1).max(),
        "mesh" => scene.meshes.iter().map(|mesh| mesh.gltf.0 + 1).max(),
        _ => scene.materials.iter().filter_map(|material| Some(material.gltf? + 1)).max(),
    };
    list_in_file(scene, kind).len().max(drawn.unwrap_or(0))
}

/// Whether the file has something of this name, drawn or not.
pub(super) fn is_in_file(scene: &Scene, text: &str) -> bool {
    let name = |value: &Value| value.get("name").and_then(Value::as_str).is_some_and(|name| matches(text, name));
    KINDS.into_iter().any(|kind| list_in_file(scene, kind).iter().any(name))
}

/// What a message calls instances, and a text that selects them and nothing else; of what cannot be told apart, a text
/// that selects more.
pub(crate) fn label_of(scene: &Scene, instances: &BTreeSet<u32>) -> (String, String) {
    let first = instances.first().map_or(0, |&index| index as usize);
    let instance = &scene.instances[first];
    let (node, mesh) = (&scene.nodes[instance.node], &scene.meshes[instance.mesh]);
    let material = scene.material(first);
    let of_node = (instances.len() == 1).then_some(("node", &node.name, Some(node.gltf)));
    let of_mesh = (instances.len() == 1).then_some(("mesh", &mesh.name, Some(mesh.gltf.0)));
    let kinds = [of_node, of_mesh, Some(("material", &material.name, material.gltf))].into_iter().flatten();
    let by_name = |(kind, name, _): (&str, &Option<String>, _)| {
        name.as_ref().map(|name| (format!("{kind} \"{name}\""), name.clone()))
    };
    let by_index = |(kind, _, index): (&str, _, Option<usize>)| {
        index.map(|index| (format!("{kind} {index}"), format!("{kind}:{index}")))
    };
    let names = kinds.clone().filter_map(by_name);
    let all: Vec<(String, String)> = names.chain(kinds.filter_map(by_index)).collect();
    let selecting = all.iter().find(|(_, text)| Selection::new(scene, text).all_instances(scene) == *instances);
    selecting.or(all.first()).cloned().unwrap_or_default()
}

/// Names that a scene's parts have, each once: of materials, of nodes that draw, of meshes.
pub fn names(scene: &Scene) -> [Vec<&str>; 3] {
    let materials = scene.materials.iter().filter_map(|m| m.name.as_deref());
    let nodes = scene.instances.iter().filter_map(|i| scene.nodes[i.node].name.as_deref());
    let meshes = scene.meshes.iter().filter_map(|m| m.name.as_deref());
    [materials.collect(), nodes.collect(), meshes.collect()].map(each_once)
}

/// The first of equal entries.
pub(crate) fn each_once<T: Clone + Ord>(mut all: Vec<T>) -> Vec<T> {
    let mut seen = BTreeSet::new();
    all.retain(|one| seen.insert(one.clone()));
    all
}

/// The first so many of a list, and how many more there are: `a, b and 7 more`.
pub(crate) fn first_of<S: Borrow<str>>(list: &[S], most: usize) -> String {
    match list.get(..most) {
        Some(first) if list.len() > most => format!("{} and {} more", first.join(", "), list.len() - most),
        _ => list.join(", "),
    }
}

/// Whether a name fits a pattern, in which `*` stands for any text. A name that holds a `*` fits itself.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(mut left) = name.strip_prefix(start) else { return false };
    let mut parts = rest.split('*').peekable();
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            return left.ends_with(part);
        }
        // The first place will do: what follows has the most room then.
        let Some(at) = left.find(part) else { return false };
        left = &left[at + part.len()..];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::testing::{SceneBuilder, block, opaque};
    use glam::Vec3;

    #[test]
    fn long_lists_are_cut_and_counted() {
        let list = ["a", "b", "c"];
        assert_eq!(
            [0, 2, 3, 4].map(|most| first_of(&list, most)),
            [" and 3 more", "a, b and 1 more", "a, b, c", "a, b, c"]
        );
        assert_eq!(each_once(vec!["b", "a", "b", "a"]), ["b", "a"]);
    }

    #[test]
    fn a_star_stands_for_any_text() {
        for (pattern, name, fits) in [
            ("wall", "wall", true),
            ("wall", "Wall", false),
            ("wall*", "wall_3", true),
            ("*_3", "wall_3", true),
            ("*", "", true),
            ("w*l*3", "wall_3", true),
            ("a*a", "a", false),
            ("*ab", "aab", true),
            ("*a*b*", "xbxa", false),
            ("**", "any", true),
            ("", "any", false),
            ("UCX_*", "UCX_crate", true),
            ("a*b", "a*b", true),
        ] {
            assert_eq!(matches(pattern, name), fits, "{pattern} {name}");
        }
    }

    /// Two blocks: `crate` under a node `yard`, with the material `wood`; and one without names, of mesh 7.
    fn scene() -> Scene {
        let wood = Material { name: Some("wood".into()), gltf: Some(3), ..opaque() };
        let mut scene = SceneBuilder::new()
            .soup_of(&block(Vec3::ZERO, Vec3::ONE), wood)
            .soup_of(&block(Vec3::splat(2.0), Vec3::splat(3.0)), opaque())
            .build();
        scene.nodes[0].name = Some("yard".into());
        scene.nodes[1].parent = Some(0);
        scene.nodes[1].gltf = 12;
        scene.meshes[0].name = Some("crate".into());
        scene.meshes[1].gltf = (7, 0);
        scene
    }

    #[test]
    fn materials_nodes_and_meshes_have_names_or_indices() {
        let scene = scene();
        let wood = scene.meshes[0].material;
        for (text, materials, instances) in [
            ("wood", vec![wood], vec![]),
            ("material:3", vec![wood], vec![]),
            ("crate", vec![], vec![0]),
            ("cr*", vec![], vec![0]),
            ("mesh:7", vec![], vec![1]),
            ("node:12", vec![], vec![1]),
            ("yard", vec![], vec![0, 1]),
            ("*", vec![wood], vec![0, 1]),
            ("node:5", vec![], vec![]),
            ("barn", vec![], vec![]),
        ] {
            assert_eq!(Selection::new(&scene, text), Selection { materials, instances }, "{text}");
        }
        assert_eq!(names(&scene), [vec!["wood"], vec!["yard"], vec!["crate"]]);
    }
}
