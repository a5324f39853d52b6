//! What is decided before a bake: the scene, its lights, the effect plan.

use super::error::BakeError;
use crate::lamp::{self, LampPath};
use crate::plan::{Effect, EffectPlan, NoSun};
use crate::progress::{BakeStep, Progress};
use crate::scene::{self, Geometry, LoadLimits, Scene, each_once};
use crate::settings::{BakeSettings, SunRequest};
use crate::sun::{self, DayOutcome, SunPath};
use crate::warning::Warning;
use std::path::Path;
use std::time::Instant;

/// A scene with its lights and its plan, before anything is baked.
#[derive(Debug)]
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// The sun's path, if it rises.
    pub path: Option<SunPath>,
    /// The lamp's path, world space, if one is asked for.
    pub lamp: Option<LampPath>,
    /// What will be baked and why.
    pub plan: EffectPlan,
    /// What a caller should know.
    pub warnings: Vec<Warning>,
    /// Seconds that reading the scene took.
    pub(crate) load_seconds: f64,
}

impl Prepared {
    /// The scene's triangles, with the smooth shapes of which they are facets if the plan has those.
    pub(crate) fn geometry(&self) -> Geometry {
        match self.plan.is_on(Effect::SmoothTerminator) {
            true => Geometry::new(&self.scene),
            false => Geometry::faceted(&self.scene),
        }
    }
}

/// Reads the scene and decides what to bake.
pub fn prepare(scene_file: &Path, settings: &BakeSettings, progress: &dyn Progress) -> Result<Prepared, BakeError> {
    progress.start(BakeStep::Load, 0);
    let started = Instant::now();
    if !cfg!(feature = "exr") && (settings.loss_map || settings.ambient.is_some_and(|request| request.exr)) {
        return Err(BakeError::NoExr);
    }
    let limits = LoadLimits { max_memory_bytes: settings.max_memory_bytes };
    let prepared = prepare_scene(scene::load(scene_file, &limits)?, settings)?;
    Ok(Prepared { load_seconds: started.elapsed().as_secs_f64(), ..prepared })
}

/// Decides what to bake of a scene.
pub(super) fn prepare_scene(mut scene: Scene, settings: &BakeSettings) -> Result<Prepared, BakeError> {
    settings.objects.apply_to(&mut scene)?;
    let mut warnings: Vec<Warning> = scene.warnings.iter().cloned().map(Warning::Scene).collect();
    warnings.extend(clear_warning(&scene));
    warnings.extend(nothing_warning(&scene));
    let is_lamp_alone = matches!(&settings.sun, SunRequest::Keyed { json, .. } if lamp::is_lamp(json));
    let path = if is_lamp_alone { None } else { sun_path(&settings.sun, &scene, &mut warnings)? };
    let lamp = lamp_path(settings, path.as_ref())?.filter(|_| settings.bakes_intervals);
    let no_sun = if is_lamp_alone { NoSun::LampInstead } else { NoSun::DoesNotRise };
    let plan = EffectPlan::new(&scene, path.as_ref(), lamp.as_ref(), settings, no_sun);
    Ok(Prepared { scene, path, lamp, plan, warnings, load_seconds: 0.0 })
}

/// A word about a scene in which nothing is left that can be shaded.
fn nothing_warning(scene: &Scene) -> Option<Warning> {
    let any = |has: fn(&Scene, usize) -> bool| (0..scene.instances.len()).any(|instance| has(scene, instance));
    let is_empty = !any(Scene::is_there);
    (!any(Scene::receives)).then_some(Warning::NothingToBake { is_empty })
}

/// A word about panes that let the light through.
fn clear_warning(scene: &Scene) -> Option<Warning> {
    let is_clear = |index: &usize| scene.is_there(*index) && scene.material(*index).is_clear && !scene.casts(*index);
    let label = |index: usize| {
        let material = scene.material(index);
        let index = material.gltf.map_or_else(|| "a material".to_owned(), |gltf| format!("materials[{gltf}]"));
        material.name.as_ref().map_or(index, |name| format!("\"{name}\""))
    };
    let materials = each_once((0..scene.instances.len()).filter(is_clear).map(label).collect());
    (!materials.is_empty()).then_some(Warning::Clear { materials })
}

/// The lamp that is asked for, beside the sun or instead of it. Beside a sun its path lasts as long as the sun's.
fn lamp_path(settings: &BakeSettings, sun: Option<&SunPath>) -> Result<Option<LampPath>, BakeError> {
    let instead = match &settings.sun {
        SunRequest::Keyed { json, .. } if lamp::is_lamp(json) => Some(json),
        _ => None,
    };
    let json = match (&settings.lamp, instead) {
        (None, None) => return Ok(None),
        (Some(_), Some(_)) => return Err(BakeError::TwoLamps),
        (Some(json), None) | (None, Some(json)) => json,
    };
    if !settings.engine.finds_lamps() {
        return Err(BakeError::LampEngine(settings.engine));
    }
    let lamp = lamp::parse_lamp(json)?;
    Ok(Some(match sun {
        Some(sun) => lamp.lasting(sun.duration_min)?,
        None => lamp,
    }))
}

/// The sun's path over a scene. Where the sun does not rise there is none, and a warning is added.
pub fn sun_path(
    request: &SunRequest,
    scene: &Scene,
    warnings: &mut Vec<Warning>,
) -> Result<Option<SunPath>, BakeError> {
    let request = match (request, scene.sun_direction) {
        (SunRequest::Keyed { json, north_deg }, _) => return Ok(Some(sun::parse_keyed(json, *north_deg)?)),
        (SunRequest::SceneOr(day), Some(direction)) => {
            if day.north_deg != 0.0 {
                warnings.push(Warning::NorthUnused { north_deg: day.north_deg });
            }
            let radius_rad = sun::SUN_ANGULAR_RADIUS_DEG.to_radians();
            return Ok(Some(sun::fixed_light(direction, radius_rad)?));
        }
        (SunRequest::Day(request) | SunRequest::SceneOr(request), _) => request,
    };
    match sun::day(request)? {
        DayOutcome::Path(path) => Ok(Some(path)),
        DayOutcome::NoSun { highest_elevation_deg, .. } => {
            let (latitude_deg, date) = (request.latitude_deg, request.date);
            warnings.push(Warning::NoSunrise { latitude_deg, date, highest_elevation_deg });
            Ok(None)
        }
    }
}
