//! Counts a frame's passes, and times them by the GPU's own clock. A software GPU's clock is the CPU's.

use super::readback;
use crate::gpu::device::{Gpu, GpuError};
use serde::Serialize;
use std::cell::RefCell;

/// Passes of a frame that can be timed; later ones are not.
const MOST_PASSES: u32 = 1024;

/// What a pass is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Depths.
    Depth,
    /// Shadow volumes.
    Volumes,
    /// Shadow maps, and masks of casters.
    Maps,
    /// Light.
    Light,
}

/// Seconds that a frame's passes took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameTimes {
    /// Depth passes, seconds.
    pub depth: f64,
    /// Passes of shadow volumes, seconds.
    pub volumes: f64,
    /// Passes of shadow maps and masks, seconds.
    pub maps: f64,
    /// Passes that light, seconds.
    pub light: f64,
    /// From the start of the first pass to the end of the last, seconds.
    pub frame: f64,
}

/// Counts a frame's passes and, where asked for, times them.
pub struct PassClock {
    stopwatch: Option<Stopwatch>,
    phases: RefCell<Vec<Phase>>,
}

/// Two time stamps for each pass of a frame.
struct Stopwatch {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    copied: wgpu::Buffer,
}

impl PassClock {
    /// A clock that counts, and times if asked to and if the GPU can.
    pub fn new(gpu: &Gpu, is_timed: bool) -> Self {
        let can = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        Self { stopwatch: (is_timed && can).then(|| Stopwatch::new(gpu)), phases: RefCell::default() }
    }

    /// Starts a frame.
    pub fn start(&self) {
        self.phases.borrow_mut().clear();
    }

    /// Counts a pass that begins. Its time stamps, if it is timed.
    pub fn pass(&self, phase: Phase) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let mut phases = self.phases.borrow_mut();
        let next = 2 * phases.len() as u32;
        phases.push(phase);
        let stopwatch = self.stopwatch.as_ref().filter(|_| next < 2 * MOST_PASSES)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &stopwatch.set,
            beginning_of_pass_write_index: Some(next),
            end_of_pass_write_index: Some(next + 1),
        })
    }

    /// Passes of the frame.
    pub fn passes(&self) -> usize {
        self.phases.borrow().len()
    }

    /// What the frame's passes took, once they have been submitted; none where they are not timed.
    pub fn read(&self, gpu: &Gpu) -> Result<Option<FrameTimes>, GpuError> {
        let phases = self.phases.borrow();
        let timed = &phases[..phases.len().min(MOST_PASSES as usize)];
        self.stopwatch.as_ref().map(|stopwatch| stopwatch.read(gpu, timed)).transpose()
    }
}

impl Stopwatch {
    fn new(gpu: &Gpu) -> Self {
        let buffer = |label, usage| {
            let size = u64::from(2 * MOST_PASSES * wgpu::QUERY_SIZE);
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stopwatch"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MOST_PASSES,
            }),
            resolved: buffer("stamps", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            copied: buffer("stamps read back", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        }
    }

    fn read(&self, gpu: &Gpu, phases: &[Phase]) -> Result<FrameTimes, GpuError> {
        let count = 2 * phases.len() as u32;
        if count == 0 {
            return Ok(FrameTimes::default());
        }
        // In submissions of their own: a copy in the encoder of the resolve may see what was there before.
        let mut encoder = gpu.encoder();
        encoder.resolve_query_set(&self.set, 0..count, &self.resolved, 0);
        gpu.queue.submit([encoder.finish()]);
        let mut encoder = gpu.encoder();
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.copied, 0, u64::from(count * wgpu::QUERY_SIZE));
        gpu.queue.submit([encoder.finish()]);
        let bytes = readback::map(gpu, &self.copied)?;
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes[..(count * wgpu::QUERY_SIZE) as usize]);
        self.copied.unmap();
        let seconds = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        Ok(frame_times(phases, &stamps, seconds))
    }
}

/// Sums of time stamps, by phase. A step of a stamp takes `seconds`.
fn frame_times(phases: &[Phase], stamps: &[u64], seconds: f64) -> FrameTimes {
    let mut times = FrameTimes::default();
    for (phase, pair) in phases.iter().zip(stamps.chunks_exact(2)) {
        let took = pair[1].saturating_sub(pair[0]) as f64 * seconds;
        *match phase {
            Phase::Depth => &mut times.depth,
            Phase::Volumes => &mut times.volumes,
            Phase::Maps => &mut times.maps,
            Phase::Light => &mut times.light,
        } += took;
    }
    let (first, last) = (stamps.iter().min(), stamps.iter().max());
    times.frame = last.zip(first).map_or(0, |(last, first)| last - first) as f64 * seconds;
    times
}
