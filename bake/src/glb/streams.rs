//! How the vertices of a primitive are split, so that each chart has its own on its border.
//!
//! A vertex keeps its index: the first chart that needs it takes it, and others get copies behind the file's last
//! vertex. Whatever refers to vertices by index, unknown extensions as well, stays right. Only where several primitives
//! share one array of vertices does each get its own, of the vertices that it uses, in their old order.

use crate::atlas::Layout;
use crate::scene::Mesh;

/// The vertices of a primitive as they are written.
pub(super) struct Stream {
    /// For each layout vertex, its index in the written primitive.
    pub slots: Vec<u32>,
    /// Number of vertices.
    pub len: usize,
    /// What changes; nothing if the primitive's own vertices and triangles stay.
    pub split: Option<Split>,
}

/// New vertices and triangles of a primitive.
pub(super) struct Split {
    /// For each written vertex, the file's vertex that it is or copies.
    pub sources: Vec<u32>,
    /// Three per triangle.
    pub indices: Vec<u32>,
    /// Number of the file's vertices.
    pub file_count: usize,
    /// Whether some of the file's vertices are not among them.
    pub is_part: bool,
}

const FREE: u32 = u32::MAX;

impl Stream {
    /// `triangles` are the file's, degenerate ones as well; `shares` says whether other primitives use the same array
    /// of `vertex_count` vertices.
    pub fn new(
        mesh: &Mesh,
        layout: &Layout,
        vertex_count: usize,
        shares: bool,
        triangles: impl FnOnce() -> Vec<u32>,
    ) -> Self {
        let mut is_taken = vec![false; mesh.positions.len()];
        let is_split = layout.vertices.iter().any(|&v| std::mem::replace(&mut is_taken[v as usize], true));
        let file_vertex = |&vertex: &u32| mesh.file_vertex(vertex);
        if !is_split && (!shares || mesh.positions.len() == vertex_count) {
            let slots = layout.vertices.iter().map(file_vertex).collect();
            return Self { slots, len: vertex_count, split: None };
        }
        let triangles = triangles();
        let mut sources: Vec<u32> = match shares {
            false => (0..vertex_count as u32).collect(),
            true => {
                let mut used: Vec<u32> = triangles.clone();
                used.extend((0..mesh.positions.len() as u32).map(|vertex| mesh.file_vertex(vertex)));
                used.sort_unstable();
                used.dedup();
                used
            }
        };
        let mut base = vec![FREE; vertex_count];
        (0..).zip(&sources).for_each(|(slot, &source)| base[source as usize] = slot);
        let mut is_taken = vec![false; sources.len()];
        let mut slot_of = |vertex: &u32| {
            let source = mesh.file_vertex(*vertex);
            let own = base[source as usize];
            if !std::mem::replace(&mut is_taken[own as usize], true) {
                return own;
            }
            sources.push(source);
            sources.len() as u32 - 1
        };
        let slots: Vec<u32> = layout.vertices.iter().map(&mut slot_of).collect();
        let indices = renumbered(mesh, layout, &triangles, &slots, &base);
        let split = Split { sources, indices, file_count: vertex_count, is_part: shares };
        Self { len: split.sources.len(), slots, split: Some(split) }
    }
}

/// The file's triangles with new indices: those of the mesh with their layout's, degenerate ones with the first of each
/// vertex.
fn renumbered(mesh: &Mesh, layout: &Layout, triangles: &[u32], slots: &[u32], base: &[u32]) -> Vec<u32> {
    let mut ours = mesh.indices.as_chunks::<3>().0.iter().zip(layout.indices.as_chunks::<3>().0).peekable();
    let mut renumber = |triangle: &[u32; 3]| {
        let is_ours = |(of_mesh, _): &(&[u32; 3], &[u32; 3])| of_mesh.map(|v| mesh.file_vertex(v)) == *triangle;
        match ours.next_if(is_ours) {
            Some((_, of_layout)) => of_layout.map(|v| slots[v as usize]),
            None => triangle.map(|v| base[v as usize]),
        }
    };
    let all: Vec<u32> = triangles.as_chunks::<3>().0.iter().flat_map(&mut renumber).collect();
    match ours.peek() {
        None => all,
        // The mesh is not the file's any more.
        Some(_) => layout.indices.iter().map(|&v| slots[v as usize]).collect(),
    }
}
