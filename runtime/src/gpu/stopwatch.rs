//! What passes take, by the GPU's own clock. On a software adapter that clock is the CPU's, and tells what its threads took.

use super::device::{Gpu, GpuError};
use serde::Serialize;

/// Passes of a frame that can be timed.
const MOST_PASSES: u32 = 1024;

/// What a pass is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Depths.
    Depth,
    /// Shadow volumes.
    Volumes,
    /// Shadow maps, and pictures of what casts.
    Maps,
    /// Light.
    Light,
}

/// Seconds that a frame's passes took, and all of it from the first to the last.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameTimes {
    /// Depths.
    pub depth: f64,
    /// Shadow volumes.
    pub volumes: f64,
    /// Shadow maps, and pictures of what casts.
    pub maps: f64,
    /// Light.
    pub light: f64,
    /// From the start of the first pass to the end of the last.
    pub frame: f64,
}

/// Two stamps for each pass of a frame.
pub struct Stopwatch {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    copied: wgpu::Buffer,
    phases: Vec<Phase>,
}

impl Stopwatch {
    /// None where the GPU has no clock.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |label, usage| {
            let size = u64::from(2 * MOST_PASSES * wgpu::QUERY_SIZE);
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stopwatch"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MOST_PASSES,
            }),
            resolved: buffer("stamps", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            copied: buffer("stamps read back", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            phases: Vec::new(),
        })
    }

    /// Forgets the last frame.
    pub fn start(&mut self) {
        self.phases.clear();
    }

    /// Stamps for the next pass; none for those that are too many.
    pub fn time(&mut self, phase: Phase) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let next = 2 * self.phases.len() as u32;
        if next >= 2 * MOST_PASSES {
            return None;
        }
        self.phases.push(phase);
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(next),
            end_of_pass_write_index: Some(next + 1),
        })
    }

    /// What the frame's passes took, once they have been handed over.
    pub fn read(&self, gpu: &Gpu) -> Result<FrameTimes, GpuError> {
        let count = 2 * self.phases.len() as u32;
        if count == 0 {
            return Ok(FrameTimes::default());
        }
        // In submissions of their own: a copy beside the resolve may see what was there before.
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(&self.set, 0..count, &self.resolved, 0);
        gpu.queue.submit([encoder.finish()]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.copied, 0, u64::from(count * wgpu::QUERY_SIZE));
        gpu.queue.submit([encoder.finish()]);
        let bytes = super::readback::map(gpu, &self.copied)?;
        let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes[..(count * wgpu::QUERY_SIZE) as usize]);
        self.copied.unmap();
        let seconds = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        let mut times = FrameTimes::default();
        for (phase, pair) in self.phases.iter().zip(stamps.chunks_exact(2)) {
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
        Ok(times)
    }
}
