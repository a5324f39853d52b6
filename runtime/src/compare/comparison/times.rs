//! How long a frame takes.

use super::super::report::{Passes, Times};
use super::FrameRequest;
use crate::gpu::{FrameTimes, GpuError};
use crate::image::Raster;
use crate::technique::Technique;
use std::time::Instant;

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

/// Means, field by field.
pub(super) fn mean_times(all: &[Times]) -> Times {
    let mean = |of: fn(&Times) -> f64| all.iter().map(of).sum::<f64>() / all.len().max(1) as f64;
    let pass = |of: fn(&Passes) -> f64| {
        all.iter().filter_map(|times| times.passes.as_ref()).map(of).sum::<f64>() / all.len().max(1) as f64
    };
    let are_timed = !all.is_empty() && all.iter().all(|times| times.passes.is_some());
    let passes = are_timed.then(|| Passes {
        depth_ms: pass(|p| p.depth_ms),
        volumes_ms: pass(|p| p.volumes_ms),
        maps_ms: pass(|p| p.maps_ms),
        light_ms: pass(|p| p.light_ms),
        all_ms: pass(|p| p.all_ms),
    });
    Times { frame_ms: mean(|t| t.frame_ms), passes, cpu_ms: mean(|t| t.cpu_ms), wall_ms: mean(|t| t.wall_ms) }
}
