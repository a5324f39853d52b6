//! What draws: the technique that was asked for, on the hardware that is there.

use super::args::{LightChoice, LookArgs, OutputChoice, RendererChoice, TechniqueChoice};
use super::exit::Failure;
use clap::ValueEnum;
use std::path::Path;
use sunbake_runtime::gpu::{Gpu, GpuError};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, Technique};
use sunbake_runtime::{AmbientModel, Filter, Moment, Raster, Shot, Stage, View};

/// Most samples of a picture: one of 16384 by 16384.
const MOST_SAMPLES: u64 = 1 << 28;

/// Opens the GPU if the technique wants one. None: the CPU draws.
pub fn open_gpu(look: &LookArgs, quiet: bool) -> Result<Option<Gpu>, Failure> {
    let wants_gpu = look.technique == TechniqueChoice::Baked && look.renderer != RendererChoice::Cpu;
    if !wants_gpu {
        return match (look.renderer, look.technique) {
            (RendererChoice::Gpu, TechniqueChoice::Truth(_)) => {
                Err(Failure::usage("truth is traced on the CPU: leave --renderer gpu out, or draw --technique baked"))
            }
            _ => Ok(None),
        };
    }
    match Gpu::open() {
        Ok(gpu) => Ok(Some(gpu)),
        Err(GpuError::NoAdapter { .. }) if look.renderer == RendererChoice::Auto => {
            if !quiet {
                eprintln!("no GPU adapter found: drawing on the CPU");
            }
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

/// The technique that was asked for, ready to draw a stage.
pub fn technique<'a>(
    gpu: Option<&'a Gpu>,
    stage: &'a Stage,
    look: &LookArgs,
) -> Result<Box<dyn Technique + 'a>, Failure> {
    let filter: Filter = look.filter.into();
    Ok(match (gpu, look.technique) {
        (Some(gpu), TechniqueChoice::Baked) => Box::new(BakedGpu::new(gpu, stage, filter)?),
        (None, TechniqueChoice::Baked) => Box::new(BakedCpu::new(stage, filter)),
        (_, TechniqueChoice::Truth(truth)) => Box::new(truth),
    })
}

/// The view that was asked for, with all its samples.
pub fn view(stage: &Stage, look: &LookArgs) -> Result<View, Failure> {
    let size = look.size.map(|edge| edge * look.supersample);
    let samples = u64::from(size[0]) * u64::from(size[1]);
    if samples > MOST_SAMPLES {
        let text = format!("a picture of {samples} samples is too large: give a smaller --size or --supersample");
        return Err(Failure::usage(text));
    }
    let camera = look.camera.on(stage, f64::from(size[0]) / f64::from(size[1]))?;
    Ok(View::new(&camera, size, &stage.scene))
}

/// The set in a folder, with those of its maps that the lights and the model of ambient light call for.
pub fn stage(folder: &Path, look: &LookArgs, output: OutputChoice) -> Result<Stage, Failure> {
    let stage = Stage::read(folder)?;
    let best = stage.best_ambient();
    let is_lit = output == OutputChoice::Color && matches!(look.light, LightChoice::Both | LightChoice::Sky);
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

/// The moment `t` with the lights that are to be on.
pub fn moment(stage: &Stage, look: &LookArgs, t: f64) -> Result<Moment, Failure> {
    match look.light {
        LightChoice::Both => Ok(stage.moment(t)),
        LightChoice::Sun => Ok(Moment::new(stage.path.as_ref(), t).without_sky()),
        LightChoice::Sky => Ok(Moment::new(stage.path.as_ref(), t).without_sun()),
        LightChoice::Lamp if stage.lamp.is_some() => {
            Ok(Moment::new(None, t).without_sky().with_lamp(stage.lamp_moment(t)))
        }
        LightChoice::Lamp => {
            Err(Failure::usage("this set has no lamp: bake one with --lamp FILE, or leave --light lamp out"))
        }
    }
}

/// What a frame is made of.
pub enum Picture {
    /// Linear light.
    Color(Raster<glam::Vec3>),
    /// Share of the sun.
    Visibility(Raster<f32>),
}

/// Draws a frame.
pub fn draw(
    technique: &mut dyn Technique,
    shot: &Shot,
    moment: &Moment,
    output: OutputChoice,
) -> Result<Picture, Failure> {
    Ok(match output {
        OutputChoice::Color => Picture::Color(technique.color(shot, moment)?),
        OutputChoice::Visibility if moment.is_lit_by_lamp_alone() => {
            Picture::Visibility(technique.lamp_visibility(shot, moment)?)
        }
        OutputChoice::Visibility => Picture::Visibility(technique.visibility(shot, moment)?),
    })
}

/// Sets the number of threads that draw.
pub fn set_threads(threads: usize) -> Result<(), Failure> {
    if threads == 0 {
        return Ok(());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|e| Failure::unsupported(format!("cannot start {threads} threads: {e}; give a smaller --threads")))
}
