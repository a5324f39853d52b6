//! Who refers to accessors, views and extensions.

use super::index;
use serde_json::Value;
use std::collections::BTreeSet;

/// Accessors and views that nothing refers to once some primitives are rewritten.
#[derive(Default)]
pub(super) struct Free {
    pub accessors: BTreeSet<usize>,
    pub views: Vec<usize>,
}

/// Uses of an element of a list: all, and those that go away.
#[derive(Clone, Copy, Default)]
struct Uses {
    all: u32,
    ending: u32,
}

impl Uses {
    fn is_free(&self) -> bool {
        self.all > 0 && self.all == self.ending
    }
}

/// What becomes free when the accessors of some primitives (mesh and primitive) are replaced.
pub(super) fn free(
    root: &Value,
    accessors: &[Value],
    view_count: usize,
    is_replaced: impl Fn(usize, usize, usize) -> bool,
) -> Free {
    let mut of_accessors = vec![Uses::default(); accessors.len()];
    for (mesh, primitive, value) in primitives(root) {
        for accessor in accessors_of(value) {
            if let Some(uses) = of_accessors.get_mut(accessor) {
                uses.all += 1;
                uses.ending += u32::from(is_replaced(mesh, primitive, accessor));
            }
        }
    }
    for accessor in other_accessors(root) {
        of_accessors.get_mut(accessor).into_iter().for_each(|uses| uses.all += 1);
    }
    let mut of_views = vec![Uses::default(); view_count];
    for (accessor, uses) in accessors.iter().zip(&of_accessors) {
        let sparse = accessor.get("sparse");
        let parts = ["indices", "values"].map(|part| sparse.and_then(|sparse| sparse.get(part)));
        for view in parts.into_iter().flatten().chain([accessor]).filter_map(|part| index(part, "bufferView")) {
            if let Some(of_view) = of_views.get_mut(view) {
                of_view.all += 1;
                of_view.ending += u32::from(uses.is_free());
            }
        }
    }
    let pictures = items(root, "images").filter_map(|image| index(image, "bufferView"));
    let compressed =
        primitives(root).filter_map(|(.., value)| index(value.get("extensions")?.get(DRACO)?, "bufferView"));
    for view in pictures.chain(compressed) {
        of_views.get_mut(view).into_iter().for_each(|uses| uses.all += 1);
    }
    let free = |list: &[Uses]| (0..list.len()).filter(|&at| list[at].is_free()).collect::<Vec<_>>();
    let mut views = free(&of_views);
    views.reverse();
    Free { accessors: free(&of_accessors).into_iter().collect(), views }
}

/// The extension that compresses a primitive's vertices.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// Elements of a list at the top level.
pub(super) fn items<'a>(root: &'a Value, name: &str) -> impl Iterator<Item = &'a Value> {
    root.get(name).and_then(Value::as_array).into_iter().flatten()
}

/// Every primitive of every mesh, with the indices of both.
pub(super) fn primitives(root: &Value) -> impl Iterator<Item = (usize, usize, &Value)> {
    items(root, "meshes").enumerate().flat_map(|(mesh, value)| {
        items(value, "primitives").enumerate().map(move |(primitive, value)| (mesh, primitive, value))
    })
}

/// The accessors of a primitive.
pub(super) fn accessors_of(primitive: &Value) -> impl Iterator<Item = usize> {
    let targets = items(primitive, "targets");
    let maps = primitive.get("attributes").into_iter().chain(targets).filter_map(Value::as_object);
    let attributes = maps.flat_map(serde_json::Map::values).filter_map(Value::as_u64).map(|at| at as usize);
    attributes.chain(index(primitive, "indices"))
}

/// Accessors of skins, animations and instances.
fn other_accessors(root: &Value) -> impl Iterator<Item = usize> {
    let skins = items(root, "skins").filter_map(|skin| index(skin, "inverseBindMatrices"));
    let samplers = items(root, "animations").flat_map(|animation| items(animation, "samplers"));
    let animations = samplers.flat_map(|sampler| [index(sampler, "input"), index(sampler, "output")]).flatten();
    let instances = items(root, "nodes").flat_map(|node| {
        let extension = node.get("extensions").and_then(|all| all.get(crate::scene::GPU_INSTANCING));
        let attributes = extension.and_then(|extension| extension.get("attributes")).and_then(Value::as_object);
        attributes.into_iter().flat_map(serde_json::Map::values).filter_map(Value::as_u64).map(|at| at as usize)
    });
    skins.chain(animations).chain(instances)
}

/// Takes extensions that a bake may remove from the lists of extensions, where nothing has them any more.
pub(super) fn list_extensions(root: &mut Value) {
    let has = |value: &Value, name: &str| value.get("extensions").is_some_and(|all| all.get(name).is_some());
    let mut gone = vec![];
    if !items(root, "nodes").any(|node| has(node, crate::scene::GPU_INSTANCING)) {
        gone.push(crate::scene::GPU_INSTANCING);
    }
    if !primitives(root).any(|(.., value)| has(value, DRACO)) {
        gone.push(DRACO);
    }
    for name in super::binary::COMPRESSIONS {
        let of_buffers = items(root, "buffers").chain(items(root, "bufferViews"));
        if !of_buffers.into_iter().any(|value| has(value, name)) {
            gone.push(name);
        }
    }
    for list in ["extensionsUsed", "extensionsRequired"] {
        let Some(names) = root.get_mut(list).and_then(Value::as_array_mut) else { continue };
        names.retain(|name| !name.as_str().is_some_and(|name| gone.contains(&name)));
        if names.is_empty() {
            root.as_object_mut().into_iter().for_each(|root| drop(root.remove(list)));
        }
    }
}
