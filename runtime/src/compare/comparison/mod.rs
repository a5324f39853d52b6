//! A comparison: every technique draws every frame, and each picture is held against the reference's.
//!
//! Contenders are built, drawn and dropped one after the other, so that only one is in memory. Each draws all frames once to warm
//! up, then all of them so many rounds; the least of a frame's times counts. Nothing is kept from frame to frame, as under a sun
//! that moves: shadow maps and silhouettes are found anew.

mod scoring;
mod sets;
mod times;

pub use sets::SetOnDisk;

use super::report::{LeftOut, ReferenceEntry, TechniqueEntry, Times};
use super::score::{Tally, luma};
use super::technique::TechniqueSpec;
use crate::camera::View;
use crate::gpu::{Gpu, GpuError, VolumeSettings};
use crate::image::Raster;
use crate::light::Moment;
use crate::shade::lit_picture;
use crate::shadow_maps::{MapSettings, Means, Variant};
use crate::shot::Shot;
use crate::stage::{Stage, StageError};
use crate::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use crate::volumes::Savings;
use glam::Vec3;
use sets::SetReader;
use std::time::Instant;
use sunbake_shaders::AmbientModel;
use times::{mean_times, timed_frame};

/// What is compared, where and when.
pub struct Comparison<'a> {
    /// Sets to play back; each has another count of lanes.
    pub sets: &'a [SetOnDisk],
    /// What draws; the CPU where there is none.
    pub gpu: Option<&'a Gpu>,
    /// Who takes part.
    pub techniques: &'a [TechniqueSpec],
    /// Whom they are held against.
    pub against: TechniqueSpec,
    /// Through what; all of one size.
    pub views: &'a [View],
    /// When, on the sun's path.
    pub times: &'a [f64],
    /// Edge of shadow maps; as variants have it unless given.
    pub map_size_texels: Option<u32>,
    /// How often each frame is drawn, at least once.
    pub rounds: u32,
}

/// A frame, as it looks with the sun wholly hidden and wholly seen.
pub struct LitFrame {
    /// Index in [`Comparison::views`].
    pub camera: usize,
    /// Index in [`Comparison::times`].
    pub time: usize,
    /// Linear light without the sun.
    pub dark: Raster<Vec3>,
    /// Linear light where every surface that faces the sun sees it.
    pub open: Raster<Vec3>,
    /// What the reference sees of the sun.
    pub reference: Raster<f32>,
}

/// What came of it.
pub struct Outcome {
    /// The frames, cameras in turn at each time.
    pub frames: Vec<LitFrame>,
    /// Who took part, with what they cost and how far they were off.
    pub techniques: Vec<TechniqueEntry>,
    /// What each of them saw, frame by frame.
    pub seen: Vec<Vec<Raster<u8>>>,
    /// Who did not take part.
    pub left_out: Vec<LeftOut>,
    /// The reference.
    pub reference: ReferenceEntry,
}

/// Why there is no outcome.
#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    /// A set cannot be read.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The reference cannot be drawn.
    #[error("{name}, which all are to be held against, cannot be drawn: {reason}")]
    Reference {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
    /// The listener asked to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
}

/// Why a technique drew nothing.
enum Absent {
    Gpu(GpuError),
    Stage(StageError),
    Cancelled,
    Other(String),
}

impl From<GpuError> for Absent {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl From<StageError> for Absent {
    fn from(error: StageError) -> Self {
        Self::Stage(error)
    }
}

/// What a technique drew.
struct Drawn {
    seen: Vec<Raster<f32>>,
    times: Vec<Times>,
    setup_s: f64,
    memory_bytes: u64,
    plan: Vec<String>,
}

/// A shot at a moment.
struct Take<'a, 's> {
    shot: &'a Shot<'s>,
    moment: Moment,
}

impl Comparison<'_> {
    /// Frames that are drawn in all, rounds and warming up counted: what `on_frame` is called for.
    pub fn frame_count(&self) -> u64 {
        let frames = (self.views.len() * self.times.len()) as u64;
        let rounds =
            |one: &TechniqueSpec| if matches!(one, TechniqueSpec::Truth(_)) { 1 } else { u64::from(self.rounds) + 1 };
        self.techniques.iter().chain([&self.against]).map(|one| frames * rounds(one)).sum()
    }

    /// Draws and compares on a stage that holds no times. `on_frame` is called after each frame, and returns false to stop.
    pub fn run(&self, stage: Stage, on_frame: &dyn Fn() -> bool) -> Result<Outcome, ComparisonError> {
        let lit = self.lit_frames(&stage);
        // What techniques keep of ambient light is nothing that they are compared by.
        let stage = stage.with_ambient(AmbientModel::Hemisphere);
        let shots: Vec<Shot> = self.views.iter().map(|view| Shot::new(&stage, *view)).collect();
        let takes: Vec<Take> = self
            .places()
            .map(|(camera, time)| Take {
                shot: &shots[camera],
                moment: Moment::new(stage.path.as_ref(), self.times[time]),
            })
            .collect();
        // Which surface a pixel shows is found once, and is no part of what tracing takes.
        for shot in &shots {
            shot.hits();
        }
        let mut reader = SetReader { sets: self.sets, current: None };
        let reference = self.draw(self.against, &stage, &mut reader, &takes, on_frame);
        let reference = reference.map_err(|absent| self.no_reference(absent))?;
        let hard = self.hard_truths(&takes)?;
        let lumas: Vec<Raster<u8>> =
            lit.iter().zip(&reference.seen).map(|(frame, seen)| luma(&lit_by(frame, seen))).collect();
        let entry = self.reference_entry(&takes, &reference)?;
        let mut outcome = Outcome {
            frames: lit
                .into_iter()
                .zip(reference.seen)
                .map(|(frame, seen)| LitFrame { reference: seen, ..frame })
                .collect(),
            techniques: Vec::new(),
            seen: Vec::new(),
            left_out: Vec::new(),
            reference: entry,
        };
        for &technique in self.techniques {
            match self.draw(technique, &stage, &mut reader, &takes, on_frame) {
                Ok(drawn) => {
                    let entry = self.judged(technique, &drawn, &outcome.frames, &lumas, hard.as_deref(), &takes);
                    outcome.techniques.push(entry);
                    outcome.seen.push(drawn.seen.iter().map(codes).collect());
                }
                Err(Absent::Cancelled) => return Err(ComparisonError::Cancelled),
                Err(Absent::Stage(error)) => return Err(error.into()),
                Err(Absent::Gpu(error)) => outcome.left_out.push(left_out(technique, error.to_string())),
                Err(Absent::Other(reason)) => outcome.left_out.push(left_out(technique, reason)),
            }
        }
        Ok(outcome)
    }

    /// Cameras in turn at each time.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let cameras = self.views.len();
        (0..self.times.len()).flat_map(move |time| (0..cameras).map(move |camera| (camera, time)))
    }

    fn lit_frames(&self, stage: &Stage) -> Vec<LitFrame> {
        let shots: Vec<Shot> = self.views.iter().map(|view| Shot::new(stage, *view)).collect();
        let frame = |(camera, time): (usize, usize)| {
            let shot = &shots[camera];
            let moment = Moment::new(stage.path.as_ref(), self.times[time]);
            let [dark, open] = [0.0, 1.0].map(|seen| {
                let seen = Raster::filled(shot.view.size, seen);
                lit_picture(shot, &moment, &seen, None)
            });
            LitFrame { camera, time, dark, open, reference: Raster { size: [0, 0], pixels: Vec::new() } }
        };
        self.places().map(frame).collect()
    }

    /// Truths of the sun's centre, if somebody takes the sun for a point and is held against its disc.
    fn hard_truths(&self, takes: &[Take]) -> Result<Option<Vec<Raster<f32>>>, ComparisonError> {
        let is_wanted = matches!(self.against, TechniqueSpec::Truth(Truth::Soft { .. }))
            && self.techniques.iter().any(TechniqueSpec::is_hard);
        let truth = |take: &Take| Truth::Hard.visibility(take.shot, &take.moment);
        let all = || takes.iter().map(truth).collect::<Result<Vec<_>, _>>();
        is_wanted.then(all).transpose().map_err(|error| self.no_reference(Absent::Gpu(error)))
    }

    fn no_reference(&self, absent: Absent) -> ComparisonError {
        let name = self.against.to_string();
        match absent {
            Absent::Cancelled => ComparisonError::Cancelled,
            Absent::Stage(error) => error.into(),
            Absent::Gpu(error) => ComparisonError::Reference { name, reason: error.to_string() },
            Absent::Other(reason) => ComparisonError::Reference { name, reason },
        }
    }

    fn reference_entry(&self, takes: &[Take], drawn: &Drawn) -> Result<ReferenceEntry, ComparisonError> {
        let noise = match self.against {
            TechniqueSpec::Truth(Truth::Soft { rays }) => {
                let in_penumbra =
                    |seen: &Raster<f32>| seen.pixels.iter().filter(|&&seen| seen > 0.0 && seen < 1.0).count();
                let most = (0..takes.len()).max_by_key(|&i| in_penumbra(&drawn.seen[i]));
                most.map(|i| {
                    let finer = Truth::Soft { rays: 4 * rays }.visibility(takes[i].shot, &takes[i].moment);
                    finer.map(|finer| {
                        let hits = takes[i].shot.hits();
                        let mut tally = Tally::default();
                        tally.add(&drawn.seen[i], &finer, |pixel| hits[pixel].is_some());
                        tally.score().mean
                    })
                })
                .transpose()
                .map_err(|error| self.no_reference(Absent::Gpu(error)))?
            }
            _ => None,
        };
        Ok(ReferenceEntry { name: self.against.to_string(), frame_ms: mean_times(&drawn.times).frame_ms, noise })
    }

    /// Builds a technique, draws every frame and drops it again.
    fn draw(
        &self,
        technique: TechniqueSpec,
        stage: &Stage,
        reader: &mut SetReader,
        takes: &[Take],
        on_frame: &dyn Fn() -> bool,
    ) -> Result<Drawn, Absent> {
        let start = Instant::now();
        match (technique, self.gpu) {
            (TechniqueSpec::Truth(truth), _) => self.draw_with(&mut { truth }, 0, start, takes, on_frame),
            (TechniqueSpec::Baked(playback), gpu) => {
                let played = reader.stage(playback)?;
                let start = Instant::now();
                let mut technique: Box<dyn Technique> = match gpu {
                    Some(gpu) => Box::new(BakedGpu::new(gpu, played, playback.filter)?.timed()),
                    None => Box::new(BakedCpu::new(played, playback.filter)),
                };
                self.draw_with(technique.as_mut(), self.rounds, start, takes, on_frame)
            }
            (TechniqueSpec::Volumes(_) | TechniqueSpec::Map(_), None) => {
                Err(Absent::Other("needs a GPU adapter, and there is none here".into()))
            }
            (TechniqueSpec::Volumes(mode), Some(gpu)) => {
                let savings = Savings { cache: false, ..Savings::default() };
                let settings = VolumeSettings { mode, savings, is_timed: true, ..VolumeSettings::default() };
                self.draw_with(&mut Volumes::new(gpu, stage, settings)?, self.rounds, start, takes, on_frame)
            }
            (TechniqueSpec::Map(variant), Some(gpu)) => {
                let mut technique = ShadowMaps::new(gpu, stage, self.map_settings(variant))?;
                self.draw_with(&mut technique, self.rounds, start, takes, on_frame)
            }
        }
    }

    /// How a variant of shadow maps is drawn.
    fn map_settings(&self, variant: Variant) -> MapSettings {
        let settings = MapSettings::new(variant);
        let means = Means { cache: false, ..Means::default() };
        let size_texels = self.map_size_texels.unwrap_or(settings.size_texels);
        MapSettings { means, is_timed: true, size_texels, ..settings }
    }

    /// Without rounds, what is drawn to warm up is all that there is.
    fn draw_with(
        &self,
        technique: &mut dyn Technique,
        rounds: u32,
        start: Instant,
        takes: &[Take],
        on_frame: &dyn Fn() -> bool,
    ) -> Result<Drawn, Absent> {
        let mut drawn = Drawn { seen: Vec::new(), times: Vec::new(), setup_s: 0.0, memory_bytes: 0, plan: Vec::new() };
        for take in takes {
            let (seen, times) = timed_frame(technique, take)?;
            if drawn.seen.is_empty() && rounds > 0 {
                drawn.setup_s = start.elapsed().as_secs_f64() - times.frame_ms * 1e-3;
            }
            drawn.seen.push(seen);
            drawn.times.push(times);
            go_on(on_frame)?;
        }
        for round in 0..rounds {
            for (take, least) in takes.iter().zip(&mut drawn.times) {
                let times = timed_frame(technique, take)?.1;
                if round == 0 || times.frame_ms < least.frame_ms {
                    *least = times;
                }
                go_on(on_frame)?;
            }
        }
        Ok(Drawn { memory_bytes: technique.bytes(), plan: technique.plan(), ..drawn })
    }
}

fn go_on(on_frame: &dyn Fn() -> bool) -> Result<(), Absent> {
    if on_frame() { Ok(()) } else { Err(Absent::Cancelled) }
}

fn left_out(technique: TechniqueSpec, reason: String) -> LeftOut {
    LeftOut { name: technique.to_string(), reason }
}

/// A frame's light, given how much of the sun each pixel sees. What is no number is shown as sun.
pub fn lit_by(frame: &LitFrame, seen: &Raster<f32>) -> Raster<Vec3> {
    let pixels = frame.dark.pixels.iter().zip(&frame.open.pixels).zip(&seen.pixels);
    let light =
        |((dark, open), &seen): ((&Vec3, &Vec3), &f32)| dark.lerp(*open, if seen.is_nan() { 1.0 } else { seen });
    Raster { size: frame.dark.size, pixels: pixels.map(light).collect() }
}

/// Visibility in 256 steps.
pub fn codes(seen: &Raster<f32>) -> Raster<u8> {
    let code = |&seen: &f32| (seen.clamp(0.0, 1.0) * 255.0).round() as u8;
    Raster { size: seen.size, pixels: seen.pixels.iter().map(code).collect() }
}
