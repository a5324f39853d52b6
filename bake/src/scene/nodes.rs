//! The node hierarchy of the drawn scene, with matrices composed in `f64`.
//!
//! Map coordinates have seven digits before the decimal point and matter to the millimetre, so translations are read as
//! `f64` straight from the JSON and are never rounded. The walk has its own stack, so a chain of a million nodes does
//! not overflow the program's.

use super::{
    LoadError, Node,
    accessors::Reader,
    document::{self, Document, place},
    instancing,
    limits::WarningLog,
};
use glam::{DMat4, DQuat, DVec3, DVec4};

/// Nodes of the drawn scene, parents before children, with their origin in the file.
#[derive(Default)]
pub(super) struct NodeTree {
    pub nodes: Vec<Node>,
    /// For each node, the mesh of the file that it draws.
    pub mesh: Vec<Option<usize>>,
    /// All nodes of the file.
    pub file: Vec<document::JsonNode>,
}

/// Volume of a matrix's unit columns at and below which it counts as singular.
const SINGULAR: f64 = 1e-12;

/// Reads the default scene, else the first, else every node that has no parent.
pub(super) fn read(reader: Reader, log: &mut WarningLog) -> Result<NodeTree, LoadError> {
    let doc = reader.doc;
    let count = doc.count::<document::JsonNode>();
    let file: Vec<document::JsonNode> = (0..count).map(|index| doc.get(index)).collect::<Result<_, _>>()?;
    let roots = roots(doc, &file)?;
    walk(reader, file, roots, log)
}

fn roots(doc: &Document, file: &[document::JsonNode]) -> Result<Vec<usize>, LoadError> {
    let scene = doc.root.get("scene").and_then(serde_json::Value::as_u64).unwrap_or(0) as usize;
    if doc.count::<document::JsonSceneRoots>() > 0 {
        let roots = doc.get::<document::JsonSceneRoots>(scene);
        let roots = roots.map_err(|error| error.used_as("default scene", "the file"))?;
        return Ok(roots.nodes.unwrap_or_default());
    }
    let mut is_child = vec![false; file.len()];
    for child in file.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(flag) = is_child.get_mut(*child) {
            *flag = true;
        }
    }
    let roots: Vec<usize> = (0..file.len()).filter(|&i| is_child.get(i) == Some(&false)).collect();
    match (roots.is_empty(), file.is_empty()) {
        (true, false) => Err(LoadError::NodeCycle { node: 0, parent: parent_of(file, 0) }),
        _ => Ok(roots),
    }
}

fn parent_of(file: &[document::JsonNode], child: usize) -> usize {
    file.iter().position(|node| node.children.iter().flatten().any(|&c| c == child)).unwrap_or(child)
}

/// State of a node of the file during the walk.
#[derive(Clone, Copy, PartialEq)]
enum Visit {
    Unseen,
    /// An ancestor of the node that is being read, or that node.
    Open,
    Done,
}

/// An entry of the walk's stack.
enum WalkStep {
    Enter { index: usize, parent: Option<usize> },
    Leave { index: usize },
}

fn walk(
    reader: Reader,
    file: Vec<document::JsonNode>,
    roots: Vec<usize>,
    log: &mut WarningLog,
) -> Result<NodeTree, LoadError> {
    let mut tree = NodeTree { file, ..NodeTree::default() };
    let mut marks = vec![Visit::Unseen; tree.file.len()];
    let enter = |index, parent| WalkStep::Enter { index, parent };
    let mut steps: Vec<WalkStep> = roots.into_iter().rev().map(|root| enter(root, None)).collect();
    while let Some(step) = steps.pop() {
        let (index, parent) = match step {
            WalkStep::Enter { index, parent } => (index, parent),
            WalkStep::Leave { index } => {
                marks.get_mut(index).into_iter().for_each(|mark| *mark = Visit::Done);
                continue;
            }
        };
        let above = parent.and_then(|node| tree.nodes.get(node)).map(|node| node.gltf);
        match marks.get_mut(index) {
            None => return Err(missing(&tree, index, above)),
            Some(Visit::Open) => return Err(LoadError::NodeCycle { node: index, parent: above.unwrap_or(index) }),
            Some(Visit::Done) => log.warn(SECOND_PARENT, place::<document::JsonNode>(index)),
            Some(mark) => {
                *mark = Visit::Open;
                steps.push(WalkStep::Leave { index });
                if let Some(node) = tree.add(reader, index, parent, log)? {
                    let children = tree.file.get(index).and_then(|node| node.children.as_deref()).unwrap_or(&[]);
                    steps.extend(children.iter().rev().map(|&child| enter(child, Some(node))));
                }
            }
        }
    }
    Ok(tree)
}

const SECOND_PARENT: &str = "it has more than one parent, and is drawn under the first only";

fn missing(tree: &NodeTree, index: usize, parent: Option<usize>) -> LoadError {
    let place = parent.map_or_else(|| "the scene that is drawn".to_owned(), place::<document::JsonNode>);
    LoadError::structure(place, format!("it has the node {index}, and there are only {}", tree.file.len()))
}

impl NodeTree {
    /// Adds a node of the file; `None` if neither it nor any node below it is drawn.
    fn add(
        &mut self,
        reader: Reader,
        index: usize,
        parent: Option<usize>,
        log: &mut WarningLog,
    ) -> Result<Option<usize>, LoadError> {
        let Some(node) = self.file.get(index) else { return Ok(None) };
        if is_hidden(node) {
            return Ok(None);
        }
        let parent_from_node = local_matrix(node);
        let world_from_parent = parent.and_then(|p| self.nodes.get(p)).map_or(DMat4::IDENTITY, |p| p.world_from_node);
        let world_from_node = world_from_parent * parent_from_node;
        if !is_invertible(&world_from_node) {
            log.warn("its matrix is singular, so it was left out with all nodes below it", label(node, index));
            return Ok(None);
        }
        let copies = instancing::copies(reader, node, index)?;
        let mesh = node.mesh;
        let added = self.nodes.len();
        let named = Node { name: node.name.clone(), gltf: index, parent, parent_from_node, world_from_node };
        self.push(named, mesh.filter(|_| copies.is_none()));
        for parent_from_node in copies.into_iter().flatten() {
            let world_from_node = world_from_node * parent_from_node;
            if is_invertible(&world_from_node) {
                let copy = Node { name: None, gltf: index, parent: Some(added), parent_from_node, world_from_node };
                self.push(copy, mesh);
            } else {
                log.warn("a copy of its mesh has a singular matrix; left out", place::<document::JsonNode>(index));
            }
        }
        Ok(Some(added))
    }

    fn push(&mut self, node: Node, mesh: Option<usize>) {
        self.nodes.push(node);
        self.mesh.push(mesh);
    }

    /// The node of the file that a node stands for; of a copy, the node whose mesh it draws.
    pub fn file_node(&self, node: &Node) -> Option<&document::JsonNode> {
        self.file.get(node.gltf)
    }

    /// World matrices of all nodes of the file, drawn or not, since a skin's joints may be anywhere.
    pub fn world_from_file_nodes(&self) -> Vec<DMat4> {
        let mut worlds: Vec<DMat4> = self.file.iter().map(local_matrix).collect();
        let mut is_child = vec![false; worlds.len()];
        for &child in self.file.iter().flat_map(|node| node.children.iter().flatten()) {
            is_child.get_mut(child).into_iter().for_each(|flag| *flag = true);
        }
        let mut stack: Vec<(usize, DMat4)> =
            (0..worlds.len()).filter(|&i| is_child.get(i) == Some(&false)).map(|i| (i, DMat4::IDENTITY)).collect();
        let mut is_done = vec![false; worlds.len()];
        while let Some((index, world_from_parent)) = stack.pop() {
            let (Some(world), Some(done)) = (worlds.get_mut(index), is_done.get_mut(index)) else { continue };
            if !std::mem::replace(done, true) {
                *world = world_from_parent * *world;
                let children = self.file.get(index).and_then(|node| node.children.as_deref()).unwrap_or(&[]);
                stack.extend(children.iter().map(|&child| (child, *world)));
            }
        }
        worlds
    }
}

/// Whether `KHR_node_visibility` hides the node.
fn is_hidden(node: &document::JsonNode) -> bool {
    let visibility = node.extensions.as_ref().and_then(|all| all.get("KHR_node_visibility"));
    visibility.and_then(|v| v.get("visible")) == Some(&serde_json::Value::Bool(false))
}

/// A node's place and name, for messages: `nodes[7] "Wall"`.
pub(super) fn label(node: &document::JsonNode, index: usize) -> String {
    match &node.name {
        Some(name) => format!("{} \"{name}\"", place::<document::JsonNode>(index)),
        None => place::<document::JsonNode>(index),
    }
}

fn local_matrix(node: &document::JsonNode) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        // The file's last row is ignored: an affine matrix has (0, 0, 0, 1).
        let [a, b, c, _, d, e, f, _, g, h, i, _, x, y, z, _] = *matrix;
        let column = |x, y, z, w| DVec4::new(x, y, z, w);
        return DMat4::from_cols(
            column(a, b, c, 0.0),
            column(d, e, f, 0.0),
            column(g, h, i, 0.0),
            column(x, y, z, 1.0),
        );
    }
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    let turn = node.rotation.map_or(DVec4::W, DVec4::from_array).try_normalize().unwrap_or(DVec4::W);
    DMat4::from_scale_rotation_translation(scale, DQuat::from_vec4(turn), translation)
}

/// Decided by the matrix's shape, independent of its scale.
fn is_invertible(matrix: &DMat4) -> bool {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|c| c.truncate());
    let lengths = columns.map(DVec3::length);
    let is_sound = matrix.is_finite() && lengths.iter().all(|&l| l > 1e-30 && l < 1e30);
    let [x, y, z] = columns.map(DVec3::normalize_or_zero);
    is_sound && x.cross(y).dot(z).abs() > SINGULAR
}
