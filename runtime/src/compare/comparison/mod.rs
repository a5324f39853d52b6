//! A comparison: every technique draws every frame, and each picture is compared with the reference's.
//!
//! Techniques are built, drawn with and dropped one after the other, so that only one is in memory. Each draws all
//! frames once to warm up, and then all of them again in each round; the least of a frame's times counts. Nothing is
//! kept from frame to frame, as under a sun that moves: shadow maps and silhouettes are computed again.

mod drawing;
mod lit_frame;
mod not_drawn;
mod scoring;
mod set_reader;
mod times;

pub use lit_frame::{LitFrame, lit_picture_of, visibility_codes};
pub use set_reader::SetOnDisk;

use super::CompareError;
use super::report::{LeftOut, ReferenceEntry, TechniqueEntry};
use super::score::{Tally, luma};
use super::technique::TechniqueSpec;
use crate::camera::View;
use crate::gpu::Gpu;
use crate::image::Raster;
use crate::light::Moment;
use crate::shot::Shot;
use crate::stage::Stage;
use crate::technique::{Technique, Truth};
use drawing::DrawnFrames;
use lit_frame::lit_frames;
use not_drawn::NotDrawn;
use set_reader::SetReader;
use sunbake_shaders::AmbientModel;
use times::mean_times;

/// What is compared: techniques, cameras and times.
pub struct Comparison<'a> {
    /// Sets to play back, each with another count of lanes.
    pub sets: &'a [SetOnDisk],
    /// What draws. Without it the CPU draws what it can.
    pub gpu: Option<&'a Gpu>,
    /// Techniques to compare.
    pub techniques: &'a [TechniqueSpec],
    /// What every technique is compared with.
    pub against: TechniqueSpec,
    /// Cameras, all with pictures of one size.
    pub views: &'a [View],
    /// Times on the sun's path, 0 to 1.
    pub times: &'a [f64],
    /// Edge of shadow maps. None: as each variant has it.
    pub map_size_texels: Option<u32>,
    /// How often each frame is drawn after warming up, at least once.
    pub rounds: u32,
}

/// What a comparison found.
pub struct Outcome {
    /// The frames: all cameras at the first time, then at the next.
    pub frames: Vec<LitFrame>,
    /// Techniques that were compared, with costs and errors.
    pub techniques: Vec<TechniqueEntry>,
    /// Visibility by each technique in each frame, 0 to 255: `visibility[technique][frame]`.
    pub visibility: Vec<Vec<Raster<u8>>>,
    /// Techniques that could not be drawn.
    pub left_out: Vec<LeftOut>,
    /// The reference with its own cost and noise.
    pub reference: ReferenceEntry,
}

/// A camera at a time of day.
struct FrameRequest<'a, 's> {
    shot: &'a Shot<'s>,
    moment: Moment,
}

impl Comparison<'_> {
    /// Frames that are drawn in all, warming up and rounds included: how often `on_frame` is called.
    pub fn frame_count(&self) -> u64 {
        let frames = (self.views.len() * self.times.len()) as u64;
        let rounds =
            |one: &TechniqueSpec| if matches!(one, TechniqueSpec::Truth(_)) { 1 } else { u64::from(self.rounds) + 1 };
        self.techniques.iter().chain([&self.against]).map(|one| frames * rounds(one)).sum()
    }

    /// Draws and compares on a stage that holds no times. `on_frame` is called after each frame, and returns false to
    /// stop.
    pub fn run(&self, stage: Stage, on_frame: &dyn Fn() -> bool) -> Result<Outcome, CompareError> {
        let lit = lit_frames(&stage, self.views, self.times);
        // Only visibility is compared, so techniques need no maps of ambient light.
        let stage = stage.with_ambient(AmbientModel::Hemisphere);
        let shots: Vec<Shot> = self.views.iter().map(|view| Shot::new(&stage, *view)).collect();
        let frame = |(camera, time): (usize, usize)| FrameRequest {
            shot: &shots[camera],
            moment: Moment::new(stage.path.as_ref(), self.times[time]),
        };
        let frames: Vec<FrameRequest> = frame_indices(self.views.len(), self.times.len()).map(frame).collect();
        // Which surface a pixel shows is found here, once, so that it is no part of tracing's time.
        for shot in &shots {
            shot.hits();
        }
        let mut reader = SetReader { sets: self.sets, current: None };
        let reference = self.draw(self.against, &stage, &mut reader, &frames, on_frame);
        let reference = reference.map_err(|reason| self.no_reference(reason))?;
        let hard_truths = self.hard_truths(&frames)?;
        let entry = self.reference_entry(&frames, &reference)?;
        let with_reference = |(frame, reference)| LitFrame { reference, ..frame };
        let lit: Vec<LitFrame> = lit.into_iter().zip(reference.visibility).map(with_reference).collect();
        let lumas: Vec<Raster<u8>> = lit.iter().map(|frame| luma(&lit_picture_of(frame, &frame.reference))).collect();
        let mut outcome =
            Outcome { frames: lit, techniques: vec![], visibility: vec![], left_out: vec![], reference: entry };
        for &technique in self.techniques {
            match self.draw(technique, &stage, &mut reader, &frames, on_frame) {
                Ok(drawn) => {
                    let entry =
                        self.scored(technique, &drawn, &outcome.frames, &lumas, hard_truths.as_deref(), &frames);
                    outcome.techniques.push(entry);
                    outcome.visibility.push(drawn.visibility.iter().map(visibility_codes).collect());
                }
                Err(NotDrawn::Cancelled) => return Err(CompareError::Cancelled),
                Err(NotDrawn::Stage(error)) => return Err(error.into()),
                Err(NotDrawn::Gpu(error)) => outcome.left_out.push(left_out(technique, error.to_string())),
                Err(NotDrawn::Unsupported(reason)) => outcome.left_out.push(left_out(technique, reason)),
            }
        }
        Ok(outcome)
    }

    /// Truths of the sun's centre. None unless some technique takes the sun for a point and the reference is soft
    /// truth.
    fn hard_truths(&self, frames: &[FrameRequest]) -> Result<Option<Vec<Raster<f32>>>, CompareError> {
        let is_wanted = matches!(self.against, TechniqueSpec::Truth(Truth::Soft { .. }))
            && self.techniques.iter().any(TechniqueSpec::is_hard);
        let truth = |frame: &FrameRequest| Truth::Hard.visibility(frame.shot, &frame.moment);
        let all = || frames.iter().map(truth).collect::<Result<Vec<_>, _>>();
        is_wanted.then(all).transpose().map_err(|error| self.no_reference(NotDrawn::Gpu(error)))
    }

    fn no_reference(&self, reason: NotDrawn) -> CompareError {
        let name = self.against.to_string();
        match reason {
            NotDrawn::Cancelled => CompareError::Cancelled,
            NotDrawn::Stage(error) => error.into(),
            NotDrawn::Gpu(error) => CompareError::Reference { name, reason: error.to_string() },
            NotDrawn::Unsupported(reason) => CompareError::Reference { name, reason },
        }
    }

    fn reference_entry(&self, frames: &[FrameRequest], drawn: &DrawnFrames) -> Result<ReferenceEntry, CompareError> {
        let noise = match self.against {
            TechniqueSpec::Truth(Truth::Soft { rays }) => self.noise(rays, frames, drawn)?,
            _ => None,
        };
        Ok(ReferenceEntry { name: self.against.to_string(), frame_ms: mean_times(&drawn.times).frame_ms, noise })
    }

    /// The mean error of soft truth against four times as many rays, in the frame with most penumbra. None without
    /// frames.
    fn noise(&self, rays: u32, frames: &[FrameRequest], drawn: &DrawnFrames) -> Result<Option<f64>, CompareError> {
        let penumbra = |seen: &Raster<f32>| seen.pixels.iter().filter(|&&seen| seen > 0.0 && seen < 1.0).count();
        let Some(softest) = (0..frames.len()).max_by_key(|&i| penumbra(&drawn.visibility[i])) else {
            return Ok(None);
        };
        let FrameRequest { shot, moment } = &frames[softest];
        let finer = Truth::Soft { rays: 4 * rays }.visibility(shot, moment);
        let finer = finer.map_err(|error| self.no_reference(NotDrawn::Gpu(error)))?;
        let mut tally = Tally::default();
        tally.add(&drawn.visibility[softest], &finer, |pixel| shot.hits()[pixel].is_some());
        Ok(Some(tally.score().mean))
    }
}

/// Indices of camera and time of each frame: all cameras at the first time, then at the next.
fn frame_indices(camera_count: usize, time_count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..time_count).flat_map(move |time| (0..camera_count).map(move |camera| (camera, time)))
}

fn left_out(technique: TechniqueSpec, reason: String) -> LeftOut {
    LeftOut { name: technique.to_string(), reason }
}
