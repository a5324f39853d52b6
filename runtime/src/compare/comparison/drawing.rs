//! Building a technique, and drawing every frame with it.

use super::super::report::Times;
use super::super::technique::TechniqueSpec;
use super::not_drawn::NotDrawn;
use super::set_reader::SetReader;
use super::times::timed_frame;
use super::{Comparison, FrameRequest};
use crate::gpu::VolumeSettings;
use crate::image::Raster;
use crate::shadow_maps::{MapOptimizations, MapSettings, Variant};
use crate::stage::Stage;
use crate::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Volumes};
use crate::volumes::VolumeOptimizations;
use std::time::Instant;

/// What a technique drew, frame by frame, and what it cost.
pub(super) struct DrawnFrames {
    /// Visibility of the sun, 0 to 1.
    pub visibility: Vec<Raster<f32>>,
    pub times: Vec<Times>,
    pub setup_s: f64,
    pub memory_bytes: u64,
    pub plan: Vec<String>,
}

impl Comparison<'_> {
    /// Builds a technique, draws every frame and drops it again.
    pub(super) fn draw(
        &self,
        technique: TechniqueSpec,
        stage: &Stage,
        reader: &mut SetReader,
        frames: &[FrameRequest],
        on_frame: &dyn Fn() -> bool,
    ) -> Result<DrawnFrames, NotDrawn> {
        let start = Instant::now();
        match (technique, self.gpu) {
            (TechniqueSpec::Truth(truth), _) => draw_frames(&mut { truth }, 0, start, frames, on_frame),
            (TechniqueSpec::Baked(playback), gpu) => {
                let played = reader.stage(playback)?;
                let start = Instant::now();
                let mut technique: Box<dyn Technique> = match gpu {
                    Some(gpu) => Box::new(BakedGpu::new(gpu, played, playback.filter)?.timed()),
                    None => Box::new(BakedCpu::new(played, playback.filter)),
                };
                draw_frames(technique.as_mut(), self.rounds, start, frames, on_frame)
            }
            (TechniqueSpec::Volumes(_) | TechniqueSpec::Map(_), None) => {
                Err(NotDrawn::Unsupported("needs a GPU adapter, and there is none here".into()))
            }
            (TechniqueSpec::Volumes(mode), Some(gpu)) => {
                let optimizations = VolumeOptimizations { cache: false, ..VolumeOptimizations::default() };
                let settings = VolumeSettings { mode, optimizations, is_timed: true, ..VolumeSettings::default() };
                draw_frames(&mut Volumes::new(gpu, stage, settings)?, self.rounds, start, frames, on_frame)
            }
            (TechniqueSpec::Map(variant), Some(gpu)) => {
                let mut technique = ShadowMaps::new(gpu, stage, self.map_settings(variant))?;
                draw_frames(&mut technique, self.rounds, start, frames, on_frame)
            }
        }
    }

    /// How a variant of shadow maps is drawn.
    fn map_settings(&self, variant: Variant) -> MapSettings {
        let settings = MapSettings::new(variant);
        let optimizations = MapOptimizations { cache: false, ..MapOptimizations::default() };
        let size_texels = self.map_size_texels.unwrap_or(settings.size_texels);
        MapSettings { optimizations, is_timed: true, size_texels, ..settings }
    }
}

/// Draws all frames once, then in each round again. `start` is when building the technique began. Without rounds the
/// first drawing is the only one, and counts.
fn draw_frames(
    technique: &mut dyn Technique,
    rounds: u32,
    start: Instant,
    frames: &[FrameRequest],
    on_frame: &dyn Fn() -> bool,
) -> Result<DrawnFrames, NotDrawn> {
    let (mut visibility, mut all_times, mut setup_s) = (Vec::new(), Vec::new(), 0.0);
    for frame in frames {
        let (seen, times) = timed_frame(technique, frame)?;
        if visibility.is_empty() && rounds > 0 {
            setup_s = start.elapsed().as_secs_f64() - times.frame_ms * 1e-3;
        }
        visibility.push(seen);
        all_times.push(times);
        stop_if_asked(on_frame)?;
    }
    for round in 0..rounds {
        for (frame, least) in frames.iter().zip(&mut all_times) {
            let times = timed_frame(technique, frame)?.1;
            if round == 0 || times.frame_ms < least.frame_ms {
                *least = times;
            }
            stop_if_asked(on_frame)?;
        }
    }
    let (memory_bytes, plan) = (technique.bytes(), technique.notes());
    Ok(DrawnFrames { visibility, times: all_times, setup_s, memory_bytes, plan })
}

fn stop_if_asked(on_frame: &dyn Fn() -> bool) -> Result<(), NotDrawn> {
    if on_frame() { Ok(()) } else { Err(NotDrawn::Cancelled) }
}
