//! How long a frame takes.

use super::super::report::{Passes, Times};
use super::FrameRequest;
use crate::gpu::{FrameTimes, GpuError};
use crate::image::Raster;
use crate::technique::Technique;
use std::time::Instant;
use sunbake::statistics::mean;

/// Draws a frame, and says how long that took.
pub(super) fn timed_frame(
    technique: &mut dyn Technique,
    frame: &FrameRequest,
) -> Result<(Raster<f32>, Times), GpuError> {
    let start = Instant::now();
    let seen = technique.visibility(frame.shot, &frame.moment)?;
    let wall_ms = start.elapsed().as_secs_f64() * 1e3;
    let cost = technique.cost();
    let passes = cost.passes.map(passes_of);
    let cpu_ms = cost.cpu_seconds * 1e3;
    let frame_ms = passes.map_or(wall_ms, |passes| passes.all_ms + cpu_ms);
    Ok((seen, Times { frame_ms, passes, cpu_ms, wall_ms }))
}

fn passes_of(times: FrameTimes) -> Passes {
    let [depth_ms, volumes_ms, maps_ms, light_ms, all_ms] =
        [times.depth, times.volumes, times.maps, times.light, times.frame].map(|seconds| seconds * 1e3);
    Passes { depth_ms, volumes_ms, maps_ms, light_ms, all_ms }
}

/// Means, field by field. Passes have means where every frame's passes are timed.
pub(super) fn mean_times(all: &[Times]) -> Times {
    let of_frames = |value: fn(&Times) -> f64| mean(all.iter().map(value));
    let timed: Vec<Passes> = all.iter().filter_map(|times| times.passes).collect();
    let of_passes = |value: fn(&Passes) -> f64| mean(timed.iter().map(value));
    let passes = (!all.is_empty() && timed.len() == all.len()).then(|| Passes {
        depth_ms: of_passes(|p| p.depth_ms),
        volumes_ms: of_passes(|p| p.volumes_ms),
        maps_ms: of_passes(|p| p.maps_ms),
        light_ms: of_passes(|p| p.light_ms),
        all_ms: of_passes(|p| p.all_ms),
    });
    Times {
        frame_ms: of_frames(|t| t.frame_ms),
        passes,
        cpu_ms: of_frames(|t| t.cpu_ms),
        wall_ms: of_frames(|t| t.wall_ms),
    }
}
