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
    /// One of the scene's own, by name or by index ([`Camera::named`]).
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
    #[error("there is no camera named {name}: {}", known_cameras(known))]
    NoSuchCamera {
        /// The name that was asked for.
        name: String,
        /// The scene's cameras, as they can be asked for.
        known: Vec<String>,
    },
    /// The eye is where the target is.
    #[error("the camera's two points are too close")]
    PointsTooClose,
}

fn known_cameras(known: &[String]) -> String {
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
    /// A camera of a scene: `camera:2` is the one at index 2 of [`Scene::cameras`], anything else the first of that
    /// name.
    pub fn named(scene: &Scene, name: &str) -> Result<Self, CameraError> {
        let found = index_in(name).or_else(|| with_name(scene, name)).and_then(|index| scene.cameras.get(index));
        found.map(Self::from_scene).ok_or_else(|| CameraError::NoSuchCamera {
            name: name.to_owned(),
            known: (0..scene.cameras.len()).map(|index| described(scene, index)).collect(),
        })
    }

    /// What [`Camera::named`] finds a camera of a scene by: its name if it is the first with it, else `camera:2`.
    pub fn label(scene: &Scene, index: usize) -> String {
        let name = scene.cameras.get(index).and_then(|camera| camera.name.clone());
        let finds_it = |name: &String| index_in(name).is_none() && with_name(scene, name) == Some(index);
        name.filter(finds_it).unwrap_or_else(|| format!("camera:{index}"))
    }
}

/// The index in `camera:2`.
fn index_in(name: &str) -> Option<usize> {
    name.strip_prefix("camera:")?.parse().ok()
}

/// Index of the first camera with a name.
fn with_name(scene: &Scene, name: &str) -> Option<usize> {
    scene.cameras.iter().position(|camera| camera.name.as_deref() == Some(name))
}

/// A camera's label, with its name where the label is an index.
fn described(scene: &Scene, index: usize) -> String {
    let label = Camera::label(scene, index);
    match scene.cameras[index].name.as_ref().filter(|name| **name != label) {
        Some(name) => format!("{label} (also named {name})"),
        None => label,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, Vec3};
    use sunbake::scene::SceneCamera;
    use sunbake::testing::SceneBuilder;

    /// Cameras whose fields of view grow with their indices.
    fn scene_with_cameras(names: &[Option<&str>]) -> Scene {
        let mut scene = SceneBuilder::new().block(Vec3::ZERO, Vec3::ONE).build();
        let camera = |(index, name): (usize, &Option<&str>)| SceneCamera {
            name: name.map(str::to_owned),
            node: 0,
            bake_from_camera: DMat4::IDENTITY,
            fov_y_rad: 0.5 + index as f64 / 100.0,
        };
        scene.cameras = names.iter().enumerate().map(camera).collect();
        scene
    }

    #[test]
    fn every_camera_has_a_label_that_finds_it() {
        let names = [Some("Camera"), Some("Camera"), None, Some("camera:1"), Some("hero"), Some("")];
        let scene = scene_with_cameras(&names);
        let labels: Vec<String> = (0..names.len()).map(|index| Camera::label(&scene, index)).collect();
        assert_eq!(labels, ["Camera", "camera:1", "camera:2", "camera:3", "hero", ""]);
        for (camera, label) in scene.cameras.iter().zip(&labels) {
            let found = Camera::named(&scene, label).unwrap_or_else(|error| panic!("{label}: {error}"));
            assert_eq!(found.fov_y_rad, camera.fov_y_rad, "{label}");
        }
    }

    #[test]
    fn an_unknown_camera_is_answered_with_all_that_there_are() {
        let scene = scene_with_cameras(&[Some("Camera"), Some("Camera"), None]);
        for name in ["Kamera", "camera:3", "camera:", "camera:-1"] {
            let message = Camera::named(&scene, name).expect_err(name).to_string();
            assert!(message.ends_with("it has Camera, camera:1 (also named Camera), camera:2"), "{message}");
        }
    }
}
