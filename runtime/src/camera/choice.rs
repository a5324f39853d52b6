//! Which camera to look through, as it is asked for before a scene is known.

use super::Camera;
use crate::stage::Stage;
use glam::DVec3;
use sunbake::scene::Scene;

/// A camera, as asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraChoice {
    /// The scene's first camera or, if it has none, one that shows most of the scene.
    Default,
    /// One of the scene's own, by name.
    Named(String),
    /// From a point towards a point, both in world space.
    LookAt {
        /// Where the camera stands, in metres.
        eye_m: DVec3,
        /// What it looks at, in metres.
        target_m: DVec3,
        /// Vertical field of view, in degrees.
        fov_deg: f64,
    },
}

/// Why a camera cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// The scene has no camera of that name.
    #[error("there is no camera named {name}: {}", known_names(known))]
    NoSuchCamera {
        /// The name that was asked for.
        name: String,
        /// Names of the scene's cameras.
        known: Vec<String>,
    },
    /// The eye is where the target is.
    #[error("the camera's two points are too close")]
    PointsTooClose,
}

fn known_names(known: &[String]) -> String {
    if known.is_empty() { "the scene has none".into() } else { format!("it has {}", known.join(", ")) }
}

impl CameraChoice {
    /// The camera that is meant, on a stage. `aspect` is the picture's width over its height.
    pub fn on(&self, stage: &Stage, aspect: f64) -> Result<Camera, CameraError> {
        match self {
            Self::Default => Ok(Camera::default_of(stage, aspect)),
            Self::Named(name) => Camera::named(&stage.scene, name),
            Self::LookAt { eye_m, target_m, fov_deg } => {
                let centre_m = stage.scene.centre_m;
                let camera = Camera::look_at(*eye_m - centre_m, *target_m - centre_m, fov_deg.to_radians());
                camera.ok_or(CameraError::PointsTooClose)
            }
        }
    }
}

impl Camera {
    /// A camera of a scene by its name.
    pub fn named(scene: &Scene, name: &str) -> Result<Self, CameraError> {
        let named = |camera: &&sunbake::scene::SceneCamera| camera.name.as_deref() == Some(name);
        scene.cameras.iter().find(named).map(Self::from_scene).ok_or_else(|| CameraError::NoSuchCamera {
            name: name.to_owned(),
            known: scene.cameras.iter().filter_map(|camera| camera.name.clone()).collect(),
        })
    }
}
