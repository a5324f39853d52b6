//! What draws: the technique that was asked for, on the hardware that is there.

use super::args::{FilterChoice, LightChoice, LookArgs, OutputChoice, RendererChoice, TechniqueChoice};
use super::no_effect;
use clap::ValueEnum;
use std::path::Path;
use sunbake::console::{Command, Failure, ObjectArgs, SunArgs, tell, warn, warn_all};
use sunbake::scene::LoadLimits;
use sunbake::{BakeError, Warning};
use sunbake_runtime::gpu::{Gpu, GpuError, Output, VolumeSettings};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::stage::MAX_SCENE_BYTES;
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Volumes};
use sunbake_runtime::{AmbientModel, DrawPlan, Filter, Moment, Raster, Shot, Stage, View};

/// Most samples of a picture: one of 16384 by 16384.
const MOST_SAMPLES: u64 = 1 << 28;

/// Opens the GPU if the technique wants one. None: the CPU draws.
pub fn open_gpu(look: &LookArgs, quiet: bool) -> Result<Option<Gpu>, Failure> {
    match (look.renderer, look.technique) {
        (RendererChoice::Gpu, TechniqueChoice::Truth(_)) => {
            return Err(Failure::usage(
                "truth is traced on the CPU: leave --renderer gpu out, or draw --technique baked",
            ));
        }
        (RendererChoice::Cpu, technique) if live(technique).is_some() => {
            return Err(Failure::usage(format!(
                "{} by a GPU: leave --renderer cpu out, or draw --technique {}",
                live(technique).unwrap_or_default(),
                instead(technique)
            )));
        }
        (_, TechniqueChoice::Truth(_)) | (RendererChoice::Cpu, _) => return Ok(None),
        _ => {}
    }
    let Some(live) = live(look.technique) else { return open_adapter(look.renderer, quiet) };
    match Gpu::open() {
        Ok(gpu) => Ok(Some(gpu)),
        Err(GpuError::NoAdapter { reason }) => Err(Failure::unavailable(format!(
            "{live} by a GPU, and no adapter was found ({reason}): install a Vulkan driver (Mesa's lavapipe will do), \
             or draw --technique {}",
            instead(look.technique)
        ))),
        Err(error) => Err(error.into()),
    }
}

/// Opens the GPU, if it is wanted and there is one. None: the CPU draws.
pub fn open_adapter(renderer: RendererChoice, quiet: bool) -> Result<Option<Gpu>, Failure> {
    if renderer == RendererChoice::Cpu {
        return Ok(None);
    }
    match Gpu::open() {
        Ok(gpu) => Ok(Some(gpu)),
        Err(GpuError::NoAdapter { .. }) if renderer == RendererChoice::Auto => {
            if !quiet {
                tell("no GPU adapter found: drawing on the CPU");
            }
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

/// What a GPU does for a technique that the CPU has no twin of; nothing for the others.
fn live(technique: TechniqueChoice) -> Option<&'static str> {
    match technique {
        TechniqueChoice::Volumes(_) => Some("shadow volumes are counted"),
        TechniqueChoice::Map(_) => Some("shadow maps are drawn"),
        TechniqueChoice::Baked | TechniqueChoice::Truth(_) => None,
    }
}

/// What to draw in its place, and why that.
fn instead(technique: TechniqueChoice) -> &'static str {
    match technique {
        TechniqueChoice::Map(variant) if variant.is_soft() => "truth:soft, which they come near to",
        TechniqueChoice::Map(_) => "truth:hard, which they come near to",
        _ => "truth:hard, which finds the same shadows",
    }
}

/// The shadow maps that were asked for.
fn map_settings(look: &LookArgs, variant: Variant) -> MapSettings {
    let settings = MapSettings::new(variant);
    MapSettings {
        size_texels: look.map_size.unwrap_or(settings.size_texels),
        cascades: look.cascades.map_or(settings.cascades, |n| n as usize),
        bias: look.bias.unwrap_or(settings.bias),
        lamp_filter: look.filter.map_or(Filter::Bilinear, Into::into),
        ..settings
    }
}

/// Whoever baked tracks wants to see them.
fn usual_filter(stage: &Stage) -> Filter {
    if has_tracks(stage) { Filter::Tracks } else { Filter::Bilinear }
}

fn has_tracks(stage: &Stage) -> bool {
    stage.pages.iter().any(|page| page.tracks.is_some())
}

/// The technique that was asked for, ready to draw a stage.
pub fn technique<'a>(
    gpu: Option<&'a Gpu>,
    stage: &'a Stage,
    look: &LookArgs,
) -> Result<Box<dyn Technique + 'a>, Failure> {
    let filter = look.filter.map_or_else(|| usual_filter(stage), Into::into);
    Ok(match (gpu, look.technique) {
        (Some(gpu), TechniqueChoice::Baked) => Box::new(BakedGpu::new(gpu, stage, filter)?),
        (None, TechniqueChoice::Baked) => Box::new(BakedCpu::new(stage, filter)),
        (Some(gpu), TechniqueChoice::Volumes(mode)) => {
            let settings = VolumeSettings { mode, sun_samples: look.sun_samples, ..VolumeSettings::default() };
            Box::new(Volumes::new(gpu, stage, settings)?)
        }
        (Some(gpu), TechniqueChoice::Map(variant)) => {
            Box::new(ShadowMaps::new(gpu, stage, map_settings(look, variant))?)
        }
        (None, TechniqueChoice::Volumes(_) | TechniqueChoice::Map(_)) => {
            return Err(Failure::unavailable(format!("{} by a GPU", live(look.technique).unwrap_or_default())));
        }
        (_, TechniqueChoice::Truth(truth)) => Box::new(truth),
    })
}

/// The view that was asked for, with all its samples.
pub fn view(stage: &Stage, look: &LookArgs, output: OutputChoice) -> Result<View, Failure> {
    let size = look.size.map(|edge| edge * look.samples(output));
    let samples = u64::from(size[0]) * u64::from(size[1]);
    if samples > MOST_SAMPLES {
        let text = format!("a picture of {samples} samples is too large: give a smaller --size or --supersample");
        return Err(Failure::usage(text));
    }
    let camera = look.camera.on(stage, f64::from(size[0]) / f64::from(size[1]))?;
    Ok(View::new(&camera, size, &stage.scene))
}

/// The set in a folder, with those of its maps that the lights and the model of ambient light call for; or a scene that
/// is not baked, under a sun.
pub fn stage(
    from: &Path,
    sun: &SunArgs,
    objects: &ObjectArgs,
    look: &LookArgs,
    output: OutputChoice,
) -> Result<Stage, Failure> {
    let is_baked = look.technique == TechniqueChoice::Baked;
    no_effect::check(look, output)?;
    if !from.exists() {
        return Err(Failure::io(format!("{} is not there: check its name", from.display())));
    }
    if from.is_file() {
        if look.ambient.model().is_some_and(|(model, _)| model != AmbientModel::Hemisphere) {
            return Err(Failure::usage(
                "a scene that is not baked has ambient light by its normals only: leave --ambient out",
            ));
        }
        if is_baked {
            return Err(Failure::usage(format!(
                "{} is a file and no set, and nothing was baked for it: bake it with sunbake, or draw --technique \
                 volumes, map or truth:hard",
                from.display()
            )));
        }
        no_effect::check_filter(look, output, false)?;
        return plain_stage(from, sun, objects, output);
    }
    if sun.is_given() || objects.is_given() {
        return Err(Failure::usage(
            "a set has the sun and the objects that it was baked with: leave --place, --date, --utc-offset, --north, \
             --leave-out, --no-cast and --no-receive out",
        ));
    }
    no_effect::check_sky_of_set(look)?;
    // Nothing that only looks need is read for a picture of visibility.
    let read = if output == OutputChoice::Visibility { Stage::read_without_looks } else { Stage::read };
    let stage = warned(read(from)?);
    no_effect::check_filter(look, output, stage.lamp.is_some())?;
    if look.filter == Some(FilterChoice::Tracks) && !has_tracks(&stage) {
        return Err(Failure::usage("this set has no shadow tracks: bake it with --tracks, or give another --filter"));
    }
    let stage = match look.technique {
        TechniqueChoice::Baked => stage,
        // A lamp's shadows are those of the bake.
        TechniqueChoice::Map(_) => stage.without_sun(),
        TechniqueChoice::Volumes(_) | TechniqueChoice::Truth(_) => stage.without_times(),
    };
    let shows_sun_alone =
        output == OutputChoice::Visibility && look.light != LightChoice::Lamp || look.light == LightChoice::Sun;
    let has_times = stage.pages.iter().any(|page| !page.lanes.is_empty());
    if is_baked && shows_sun_alone && stage.path.is_some() && !has_times {
        return Err(Failure::usage(
            "this set has no times of the sun, which would be dark everywhere: bake it with --only intervals,ao",
        ));
    }
    let best = stage.best_ambient();
    let is_lit = output != OutputChoice::Visibility && matches!(look.light, LightChoice::Both | LightChoice::Sky);
    let model = match look.ambient.model() {
        _ if !is_lit => AmbientModel::Hemisphere,
        None => best,
        Some((model, _)) if model <= best => model,
        Some((_, flag)) => {
            return Err(Failure::usage(format!(
                "this set's maps do not allow --ambient {}: bake it with {flag}, or leave --ambient out",
                look.ambient.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
            )));
        }
    };
    let stage = stage.with_ambient(model);
    let is_visibility = output == OutputChoice::Visibility;
    Ok(match look.light {
        LightChoice::Sky if !is_visibility => stage.without_sun().without_lamp(),
        LightChoice::Sun => stage.without_lamp(),
        _ => stage,
    })
}

/// A scene that is not baked, under a sun.
fn plain_stage(file: &Path, sun: &SunArgs, objects: &ObjectArgs, output: OutputChoice) -> Result<Stage, Failure> {
    let mut scene = sunbake::scene::load(file, &LoadLimits { max_memory_bytes: MAX_SCENE_BYTES })?;
    objects.wishes().apply_to(&mut scene).map_err(BakeError::Objects)?;
    if !(0..scene.instances.len()).any(|instance| scene.is_there(instance)) {
        warn("everything is left out, so the picture is empty: give fewer --leave-out");
    }
    let request = sun.request(None)?;
    let mut warnings = Vec::new();
    let path = sunbake::sun_path(&request, &scene, &mut warnings)?;
    warn_all(&warnings, Command::Sunplay);
    scene.file = scene.file.filter(|_| output != OutputChoice::Visibility);
    Ok(warned(Stage::plain(scene, path)))
}

/// A stage, once it has been told what could not be read of its looks.
fn warned(stage: Stage) -> Stage {
    let warnings: Vec<Warning> = stage.look_warnings().iter().cloned().map(Warning::Scene).collect();
    warn_all(&warnings, Command::Sunplay);
    stage
}

/// The moment `t` with the lights that are to be on.
pub fn moment(stage: &Stage, look: &LookArgs, t: f64) -> Result<Moment, Failure> {
    if look.lamp_range.is_some() && stage.lamp.is_none() {
        return Err(Failure::usage("there is no lamp: leave --lamp-range out"));
    }
    let mut moment = lights(stage, look, t)?;
    if let (Some(lamp), Some(range_m)) = (&mut moment.lamp, look.lamp_range) {
        lamp.range_m = range_m;
    }
    Ok(moment)
}

fn lights(stage: &Stage, look: &LookArgs, t: f64) -> Result<Moment, Failure> {
    match look.light {
        LightChoice::Both => Ok(stage.moment(t)),
        LightChoice::Sun => Ok(Moment::new(stage.path.as_ref(), t).without_sky()),
        LightChoice::Sky => Ok(Moment::new(stage.path.as_ref(), t).without_sun()),
        LightChoice::Lamp if stage.lamp.is_some() => {
            Ok(Moment::new(None, t).without_sky().with_lamp(stage.lamp_moment(t)))
        }
        LightChoice::Lamp => {
            Err(Failure::usage("there is no lamp: bake one with --lamp FILE, or leave --light lamp out"))
        }
    }
}

/// Which picture [`draw`] asks a technique for.
pub fn kind_of(moment: &Moment, output: OutputChoice) -> Output {
    match output {
        OutputChoice::Color | OutputChoice::Volumes => Output::Lit,
        OutputChoice::Visibility if moment.is_lit_by_lamp_alone() => Output::LampVisibility,
        OutputChoice::Visibility => Output::Visibility,
    }
}

/// Prints which effects a picture calls for, and what its technique decided.
pub fn explain(technique: &dyn Technique, effects: &DrawPlan) {
    eprint!("{}", effects.in_words());
    technique.notes().iter().for_each(|line| eprintln!("{line}"));
}

/// What a frame is made of.
pub enum Picture {
    /// Linear light, before the tone curve.
    Color(Raster<glam::Vec3>),
    /// Share of the sun.
    Visibility(Raster<f32>),
}

/// Draws what `output` asks for.
pub fn draw(
    technique: &mut dyn Technique,
    shot: &Shot,
    moment: &Moment,
    output: OutputChoice,
) -> Result<Picture, Failure> {
    Ok(match output {
        OutputChoice::Color => Picture::Color(technique.color(shot, moment)?),
        OutputChoice::Volumes => match technique.debug_picture(shot, moment)? {
            Some(picture) => Picture::Color(picture),
            None => return Err(Failure::usage("this technique has nothing to show: draw --technique volumes")),
        },
        OutputChoice::Visibility if moment.is_lit_by_lamp_alone() => {
            Picture::Visibility(technique.lamp_visibility(shot, moment)?)
        }
        OutputChoice::Visibility => Picture::Visibility(technique.visibility(shot, moment)?),
    })
}
