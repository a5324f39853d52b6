//! What is written to the file: meshes, nodes that place them, cameras.

use glam::{DMat3, DQuat, DVec3};

use crate::shapes::turn_about;
use crate::soup::Soup;
use crate::weld::{Primitive, weld};

/// A mesh's place in the list of meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MeshId(pub(crate) usize);

/// Triangles that nodes can share.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    pub(crate) name: String,
    pub(crate) primitives: Vec<Primitive>,
    /// Whether every part is a closed surface: each edge between exactly two triangles.
    pub(crate) closed: bool,
}

/// What a node carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Content {
    Mesh(MeshId),
    /// A perspective camera that looks along the node's -Z, with this vertical field of view in degrees.
    Camera {
        fov_deg: f64,
    },
}

/// One placed thing. Its position is in the station's frame, in metres.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) content: Content,
    pub(crate) at_m: DVec3,
    pub(crate) turn: DQuat,
    pub(crate) scale: DVec3,
}

/// The whole scene.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scene {
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) nodes: Vec<Node>,
    /// How far the station's frame is turned counter-clockwise (seen from above) in the world, in degrees.
    pub(crate) turn_deg: f64,
}

/// A turn around +Y, counter-clockwise seen from above.
pub(crate) fn yaw(degrees: f64) -> DQuat {
    DQuat::from_mat3(&turn_about(DVec3::Y, degrees))
}

impl Scene {
    /// Welds a soup of closed parts into a mesh.
    pub(crate) fn closed(&mut self, name: &str, soup: &Soup) -> MeshId {
        self.mesh(name, soup, true)
    }

    /// Welds a soup that has open edges (cloth, leaves, the ground) into a mesh.
    pub(crate) fn open(&mut self, name: &str, soup: &Soup) -> MeshId {
        self.mesh(name, soup, false)
    }

    fn mesh(&mut self, name: &str, soup: &Soup, closed: bool) -> MeshId {
        self.meshes.push(Mesh { name: name.to_owned(), primitives: weld(soup), closed });
        MeshId(self.meshes.len() - 1)
    }

    /// Places a mesh without turning it.
    pub(crate) fn place(&mut self, name: &str, mesh: MeshId, at_m: DVec3) {
        self.place_turned(name, mesh, at_m, 0.0);
    }

    /// Places a mesh turned by `degrees` around +Y.
    pub(crate) fn place_turned(&mut self, name: &str, mesh: MeshId, at_m: DVec3, degrees: f64) {
        self.place_scaled(name, mesh, at_m, degrees, DVec3::ONE);
    }

    /// Places a mesh turned around +Y and scaled; a negative factor mirrors it.
    pub(crate) fn place_scaled(&mut self, name: &str, mesh: MeshId, at_m: DVec3, degrees: f64, scale: DVec3) {
        let node = Node { name: name.to_owned(), content: Content::Mesh(mesh), at_m, turn: yaw(degrees), scale };
        self.nodes.push(node);
    }

    /// Adds a camera at `eye_m` that looks at `target_m`.
    pub(crate) fn camera(&mut self, name: &str, eye_m: DVec3, target_m: DVec3, fov_deg: f64) {
        let back = (eye_m - target_m).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let turn = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
        let content = Content::Camera { fov_deg };
        self.nodes.push(Node { name: name.to_owned(), content, at_m: eye_m, turn, scale: DVec3::ONE });
    }
}
