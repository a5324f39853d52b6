//! Where to look from, and when.

use super::super::exit::Failure;
use super::super::place::{CameraChoice, named};
use super::super::when::label;
use super::args::CompareArgs;
use sunbake::scene::Scene;
use sunbake::sun::SunPath;
use sunbake_runtime::camera::{Vantage, vantages};
use sunbake_runtime::compare::report::{CameraEntry, TimeEntry};
use sunbake_runtime::{Moment, Stage, View};

/// When to look, unless told: from a low sun in the morning to one in the evening.
const TIMES: [f64; 5] = [0.08, 0.29, 0.5, 0.71, 0.92];
/// How many cameras, unless told.
const CAMERAS: usize = 3;
/// Most pixels of all frames together.
const MOST_PIXELS: u64 = 1 << 26;

/// Cameras and times.
pub struct Viewpoints {
    pub views: Vec<View>,
    pub times: Vec<f64>,
    pub cameras: Vec<CameraEntry>,
    pub moments: Vec<TimeEntry>,
}

impl Viewpoints {
    pub fn of(args: &CompareArgs, stage: &Stage) -> Result<Self, Failure> {
        check(args, &stage.scene, stage.path.as_ref())?;
        let Some(path) = &stage.path else { return Err(no_sun()) };
        let times = times(args, path)?;
        let vantages = vantages_of(args, stage, &times)?;
        let entry = |Vantage { name, camera }: &Vantage| CameraEntry {
            name: name.clone(),
            eye_m: (camera.eye_m + stage.scene.centre_m).to_array(),
            forward: camera.forward.to_array(),
            fov_deg: camera.fov_y_rad.to_degrees(),
        };
        let moment = |&t: &f64| TimeEntry {
            t,
            clock: label(Some(path), t),
            elevation_deg: path.direction(t).y.clamp(-1.0, 1.0).asin().to_degrees(),
        };
        Ok(Self {
            views: vantages.iter().map(|one| View::new(&one.camera, args.size, &stage.scene)).collect(),
            cameras: vantages.iter().map(entry).collect(),
            moments: times.iter().map(moment).collect(),
            times,
        })
    }
}

/// Whether what is asked for can be had: asked before anything is baked.
pub fn check(args: &CompareArgs, scene: &Scene, path: Option<&SunPath>) -> Result<(), Failure> {
    let times = times(args, path.ok_or_else(no_sun)?)?;
    for choice in &args.camera {
        if let CameraChoice::Named(name) = choice {
            named(scene, name)?;
        }
    }
    let cameras = if args.camera.is_empty() { CAMERAS } else { args.camera.len() };
    check_size(args.size, cameras * times.len())
}

fn no_sun() -> Failure {
    Failure::usage("there is no sun to compare by: choose another --date, or a set that was baked with a sun")
}

fn times(args: &CompareArgs, path: &SunPath) -> Result<Vec<f64>, Failure> {
    match args.at.as_slice() {
        [] => Ok(TIMES.to_vec()),
        given => given.iter().map(|when| when.on(Some(path))).collect(),
    }
}

fn vantages_of(args: &CompareArgs, stage: &Stage, times: &[f64]) -> Result<Vec<Vantage>, Failure> {
    let aspect = f64::from(args.size[0]) / f64::from(args.size[1]);
    if args.camera.is_empty() {
        let moments: Vec<Moment> = times.iter().map(|&t| Moment::new(stage.path.as_ref(), t)).collect();
        return Ok(vantages(stage, &moments, CAMERAS, aspect)?);
    }
    let vantage = |(i, choice): (usize, &CameraChoice)| {
        let name = match choice {
            CameraChoice::Default => "default".into(),
            CameraChoice::Named(name) => name.clone(),
            CameraChoice::LookAt { .. } => format!("camera {}", i + 1),
        };
        Ok(Vantage { name, camera: choice.on(stage, aspect)? })
    };
    args.camera.iter().enumerate().map(vantage).collect()
}

fn check_size(size: [u32; 2], frames: usize) -> Result<(), Failure> {
    let pixels = u64::from(size[0]) * u64::from(size[1]) * frames as u64;
    if pixels <= MOST_PIXELS {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{frames} frames of {}x{} are {pixels} pixels, and {MOST_PIXELS} are the most: give a smaller --size, or fewer --at or \
         --camera",
        size[0], size[1]
    )))
}
