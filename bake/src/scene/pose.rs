//! Skins and morph targets, in the file's rest pose (no animation applied).
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, sections 3.7.2.2 (morph targets) and 3.7.3.3 (skinned meshes).
//! The specification places a skinned mesh by its joints alone and ignores the matrix of its node. Here the inverse of
//! that matrix is multiplied in, so the mesh stays in its node's object space like every other one, and `scene.glb` can
//! hold it as an ordinary mesh under the same node.

use super::{
    LoadError,
    accessors::Reader,
    document::{self, JsonPrimitive},
    nodes::{NodeTree, label},
};
use glam::{DMat3, DMat4, Vec3};

/// A node's skin and morph weights.
#[derive(Default)]
pub(super) struct Pose {
    /// Node's object space from mesh space, one per joint; empty without a skin.
    object_from_bind: Vec<DMat4>,
    /// One per morph target; missing ones count as 0.
    weights: Vec<f32>,
}

/// World matrices of joints, computed once and only if there is a skin.
#[derive(Default)]
pub(super) struct Skeletons {
    world_from_file_node: Option<Vec<DMat4>>,
}

impl Skeletons {
    fn world_from_file_nodes(&mut self, tree: &NodeTree) -> &[DMat4] {
        self.world_from_file_node.get_or_insert_with(|| tree.world_from_file_nodes())
    }
}

/// Joints and weights of every vertex, in sets of four (`JOINTS_n`, `WEIGHTS_n`).
type Influences = Vec<(Vec<[u32; 4]>, Vec<[f32; 4]>)>;

impl Pose {
    /// The pose of the mesh under node `node` of the tree.
    pub fn of_node(
        reader: Reader,
        tree: &NodeTree,
        skeletons: &mut Skeletons,
        node: usize,
        mesh: &document::JsonMesh,
    ) -> Result<Self, LoadError> {
        let Some((file, drawn)) = tree.nodes.get(node).and_then(|drawn| Some((tree.file_node(drawn)?, drawn))) else {
            return Ok(Self::default());
        };
        let weights = file.weights.clone().or_else(|| mesh.weights.clone()).unwrap_or_default();
        let object_from_world = drawn.world_from_node.inverse();
        let object_from_bind = match file.skin {
            Some(skin) => joint_matrices(reader, skin, skeletons.world_from_file_nodes(tree))
                .map_err(|error| error.used_as("skin", label(file, drawn.gltf)))?
                .into_iter()
                .map(|world_from_bind| object_from_world * world_from_bind)
                .collect(),
            None => Vec::new(),
        };
        Ok(Self { object_from_bind, weights })
    }

    /// The mesh's own default morph weights, and no skin.
    pub fn of_mesh(mesh: &document::JsonMesh) -> Self {
        Self { object_from_bind: Vec::new(), weights: mesh.weights.clone().unwrap_or_default() }
    }

    /// Applies morph targets, then the skin, to positions and normals.
    pub fn apply(
        &self,
        reader: Reader,
        primitive: &JsonPrimitive,
        positions: &mut [Vec3],
        normals: Option<&mut Vec<Vec3>>,
    ) -> Result<(), LoadError> {
        let normals = normals.map(Vec::as_mut_slice).unwrap_or_default();
        for (target, &weight) in primitive.targets.iter().flatten().zip(&self.weights) {
            if weight != 0.0 {
                add_target(reader, target.get("POSITION"), weight, positions)?;
                add_target(reader, target.get("NORMAL"), weight, normals)?;
            }
        }
        if !self.object_from_bind.is_empty() {
            self.skin(&influences(reader, primitive)?, positions, normals);
        }
        Ok(())
    }

    fn skin(&self, influences: &Influences, positions: &mut [Vec3], normals: &mut [Vec3]) {
        for (vertex, position) in positions.iter_mut().enumerate() {
            let Some(object_from_bind) = self.blended(influences, vertex) else { continue };
            *position = object_from_bind.transform_point3(position.as_dvec3()).as_vec3();
            if let Some(normal) = normals.get_mut(vertex) {
                let turn = DMat3::from_mat4(object_from_bind).inverse().transpose();
                *normal = (turn * normal.as_dvec3()).normalize_or_zero().as_vec3();
            }
        }
    }

    /// The weighted mean of a vertex's joint matrices. Some exporters do not normalise weights, so the sum divides
    /// them.
    fn blended(&self, influences: &Influences, vertex: usize) -> Option<DMat4> {
        let mut sum = 0.0;
        let mut blend = DMat4::ZERO;
        for (joints, weights) in influences {
            let (joints, weights) = joints.get(vertex).zip(weights.get(vertex))?;
            for (&joint, &weight) in joints.iter().zip(weights) {
                if let Some(matrix) = self.object_from_bind.get(joint as usize).filter(|_| weight > 0.0) {
                    sum += f64::from(weight);
                    blend += *matrix * f64::from(weight);
                }
            }
        }
        match sum > 0.0 {
            true => Some(blend * (1.0 / sum)),
            false => self.object_from_bind.get(influences.first()?.0.get(vertex)?[0] as usize).copied(),
        }
    }
}

fn joint_matrices(reader: Reader, skin: usize, world_from_file_node: &[DMat4]) -> Result<Vec<DMat4>, LoadError> {
    let place = document::place::<document::JsonSkin>(skin);
    let skin: document::JsonSkin = reader.doc.get(skin)?;
    let inverse_bind = match skin.inverse_bind_matrices {
        Some(accessor) => {
            reader.floats::<16>(accessor).map_err(|error| error.used_as("inverseBindMatrices", &place))?
        }
        None => Vec::new(),
    };
    reader.budget.take(skin.joints.len() as u64, size_of::<DMat4>() as u64, || place.clone())?;
    let matrix = |(at, &joint): (usize, &usize)| {
        let world_from_joint = world_from_file_node
            .get(joint)
            .ok_or_else(|| LoadError::structure(&place, format!("its joint {joint} is not a node")))?;
        let joint_from_bind =
            inverse_bind.get(at).map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m.map(f64::from)));
        Ok(*world_from_joint * joint_from_bind)
    };
    skin.joints.iter().enumerate().map(matrix).collect()
}

fn influences(reader: Reader, primitive: &JsonPrimitive) -> Result<Influences, LoadError> {
    let set = |n: usize| {
        let joints = primitive.attributes.get(&format!("JOINTS_{n}"))?;
        primitive.attributes.get(&format!("WEIGHTS_{n}")).map(|weights| (*joints, *weights))
    };
    let sets = (0..).map_while(set);
    sets.map(|(joints, weights)| Ok((reader.integers::<4>(joints)?, reader.floats::<4>(weights)?))).collect()
}

fn add_target(reader: Reader, accessor: Option<&usize>, weight: f32, values: &mut [Vec3]) -> Result<(), LoadError> {
    let Some(&accessor) = accessor.filter(|_| !values.is_empty()) else { return Ok(()) };
    for (value, delta) in values.iter_mut().zip(reader.floats::<3>(accessor)?) {
        *value += Vec3::from_array(delta) * weight;
    }
    Ok(())
}
