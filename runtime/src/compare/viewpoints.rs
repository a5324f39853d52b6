//! Cameras and times of a comparison.

use super::report::{CameraEntry, TimeEntry};
use super::shadow_edge_cameras::{NamedCamera, shadow_edge_cameras};
use super::{CompareError, CompareSettings};
use crate::camera::{Camera, CameraChoice, View};
use crate::light::{Moment, clock_label};
use crate::stage::Stage;
use sunbake::scene::Scene;
use sunbake::sun::SunPath;

/// Path times, unless given: from a low sun in the morning to one in the evening.
const TIMES: [f64; 5] = [0.08, 0.29, 0.5, 0.71, 0.92];
/// How many cameras, unless given.
const CAMERA_COUNT: usize = 3;
/// Most pixels of all frames together.
const MOST_PIXELS: u64 = 1 << 26;

/// Cameras and times, with what a report says of them.
pub(super) struct Viewpoints {
    pub views: Vec<View>,
    /// Path times, 0 to 1.
    pub times: Vec<f64>,
    pub camera_entries: Vec<CameraEntry>,
    pub time_entries: Vec<TimeEntry>,
}

impl Viewpoints {
    pub fn of(settings: &CompareSettings, stage: &Stage) -> Result<Self, CompareError> {
        check_request(settings, &stage.scene, stage.path.as_ref())?;
        let path = stage.path.as_ref().ok_or(CompareError::NoSun)?;
        let times = path_times(settings, path)?;
        let cameras = named_cameras(settings, stage, &times)?;
        let camera_entry = |NamedCamera { name, camera }: &NamedCamera| CameraEntry {
            name: name.clone(),
            eye_m: (camera.eye_m + stage.scene.centre_m).to_array(),
            forward: camera.forward.to_array(),
            fov_deg: camera.fov_y_rad.to_degrees(),
        };
        let time_entry = |&t: &f64| TimeEntry {
            t,
            clock: clock_label(Some(path), t),
            elevation_deg: path.direction(t).y.clamp(-1.0, 1.0).asin().to_degrees(),
        };
        Ok(Self {
            views: cameras.iter().map(|one| View::new(&one.camera, settings.size, &stage.scene)).collect(),
            camera_entries: cameras.iter().map(camera_entry).collect(),
            time_entries: times.iter().map(time_entry).collect(),
            times,
        })
    }
}

/// Refuses cameras, times and sizes that cannot be had, before anything is baked.
pub(super) fn check_request(
    settings: &CompareSettings,
    scene: &Scene,
    path: Option<&SunPath>,
) -> Result<(), CompareError> {
    let times = path_times(settings, path.ok_or(CompareError::NoSun)?)?;
    for choice in &settings.cameras {
        if let CameraChoice::Named(name) = choice {
            Camera::named(scene, name)?;
        }
    }
    let cameras = if settings.cameras.is_empty() { CAMERA_COUNT } else { settings.cameras.len() };
    check_size(settings.size, cameras * times.len())
}

fn path_times(settings: &CompareSettings, path: &SunPath) -> Result<Vec<f64>, CompareError> {
    match settings.times.as_slice() {
        [] => Ok(TIMES.to_vec()),
        given => Ok(given.iter().map(|time| time.on(Some(path))).collect::<Result<_, _>>()?),
    }
}

fn named_cameras(settings: &CompareSettings, stage: &Stage, times: &[f64]) -> Result<Vec<NamedCamera>, CompareError> {
    let aspect = f64::from(settings.size[0]) / f64::from(settings.size[1]);
    if settings.cameras.is_empty() {
        let moments: Vec<Moment> = times.iter().map(|&t| Moment::new(stage.path.as_ref(), t)).collect();
        return Ok(shadow_edge_cameras(stage, &moments, CAMERA_COUNT, aspect)?);
    }
    let named = |(i, choice): (usize, &CameraChoice)| {
        let name = match choice {
            CameraChoice::Default => "default".into(),
            CameraChoice::Named(name) => name.clone(),
            CameraChoice::LookAt { .. } => format!("camera {}", i + 1),
        };
        Ok(NamedCamera { name, camera: choice.on(stage, aspect)? })
    };
    settings.cameras.iter().enumerate().map(named).collect()
}

fn check_size(size: [u32; 2], frames: usize) -> Result<(), CompareError> {
    let pixels = u64::from(size[0]) * u64::from(size[1]) * frames as u64;
    if pixels <= MOST_PIXELS {
        return Ok(());
    }
    Err(CompareError::TooManyPixels { frames, size, pixels, most: MOST_PIXELS })
}
