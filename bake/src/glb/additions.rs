//! What a bake adds to a scene's file.

use super::Occlusion;
use crate::atlas::Layout;
use crate::scene::Scene;
use crate::settings::VertexAttribute;
use glam::Vec2;
use std::borrow::Cow;

/// What is added.
pub(super) enum Additions<'a> {
    /// Nothing.
    Nothing,
    /// Texture coordinates: those of the layouts, which all instances of a mesh share; or, with occlusion textures,
    /// page coordinates of each instance.
    Coordinates { layouts: &'a [Layout], occlusion: Option<Occlusion<'a>> },
    /// Ambient visibility, 0 to 1, of every instance's vertices.
    VertexVisibility { attribute: VertexAttribute, visibility: &'a [Vec<f32>] },
}

impl Additions<'_> {
    /// Whether each instance of a mesh gets something of its own.
    pub fn is_per_instance(&self) -> bool {
        !matches!(self, Self::Nothing | Self::Coordinates { occlusion: None, .. })
    }

    /// Whether an instance gets anything.
    pub fn concern(&self, scene: &Scene, instance: usize) -> bool {
        match self {
            Self::Nothing => false,
            Self::Coordinates { occlusion: Some(occlusion), .. } => occlusion.page(instance).is_some(),
            Self::Coordinates { .. } => scene.receives(instance),
            Self::VertexVisibility { .. } => true,
        }
    }

    /// The layout that decides how a mesh's vertices are split.
    pub fn layout(&self, scene: &Scene, mesh: usize) -> Cow<'_, Layout> {
        match self {
            Self::Coordinates { layouts, .. } => Cow::Borrowed(&layouts[mesh]),
            Self::Nothing | Self::VertexVisibility { .. } => Cow::Owned(Layout::of_mesh(&scene.meshes[mesh])),
        }
    }

    /// Texture coordinates for a mesh, or for an instance of it if they are its own: one for each vertex of the layout.
    pub fn coordinates(&self, scene: &Scene, mesh: usize, instance: Option<usize>) -> Cow<'_, [Vec2]> {
        match (self, instance) {
            (Self::Coordinates { occlusion: Some(occlusion), .. }, Some(instance)) => {
                Cow::Owned(occlusion.page_uvs(scene, instance))
            }
            (Self::Coordinates { layouts, .. }, _) => Cow::Borrowed(&layouts[mesh].uvs),
            (Self::Nothing | Self::VertexVisibility { .. }, _) => Cow::Borrowed(&[]),
        }
    }
}
