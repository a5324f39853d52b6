//! Surfaces that lit pictures blend with what lies behind: their triangles are drawn from the farthest to the nearest.
//!
//! Triangles are sorted by the distance of their centres from the eye, since *over* (Porter and Duff, "Compositing
//! digital images", 1984) depends on the order. Where large triangles lie close to one another, or cut through one
//! another, that order is wrong for some of their pixels.

use super::batch::{Batch, BatchKey};
use super::program::{PipelineState, Program, depth_state};
use super::{Output, SceneOnGpu};
use crate::gpu::device::Gpu;
use glam::Vec3;
use std::ops::Range;
use sunbake_shaders::PositionVertex;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Blended triangles and their batches.
pub struct BlendedTriangles {
    /// Draws of blended surfaces.
    pub batches: Vec<Batch>,
    triangles: Vec<BlendedTriangle>,
}

struct BlendedTriangle {
    centre_m: Vec3,
    /// Index in [`BlendedTriangles::batches`].
    batch: usize,
    /// Its first vertex within the batch.
    first: u32,
}

/// Blended triangles as an eye sees them, to be drawn in this order.
pub struct BlendedDraws {
    indices: wgpu::Buffer,
    /// A batch, and which of the indices are its.
    runs: Vec<(usize, Range<u32>)>,
}

impl BlendedTriangles {
    /// Those among drawn batches.
    pub fn new(drawn: &[Batch], positions: &[PositionVertex]) -> Self {
        let batches: Vec<Batch> = drawn.iter().filter(|batch| batch.key.is_blended).cloned().collect();
        let of_batch = |(index, batch): (usize, &Batch)| {
            let first = batch.first as usize;
            let corners = &positions[first..first + batch.vertex_count as usize];
            let triangle = |(corners, k): (&[PositionVertex], u32)| BlendedTriangle {
                centre_m: corners.iter().map(|corner| Vec3::from(corner.position_m)).sum::<Vec3>() / 3.0,
                batch: index,
                first: 3 * k,
            };
            corners.chunks_exact(3).zip(0..).map(triangle).collect::<Vec<_>>()
        };
        let triangles = batches.iter().enumerate().flat_map(of_batch).collect();
        Self { batches, triangles }
    }

    /// Sorts the triangles for an eye. None where there are none.
    pub fn draws(&self, gpu: &Gpu, eye_m: Vec3) -> Option<BlendedDraws> {
        let mut order: Vec<(f32, &BlendedTriangle)> =
            self.triangles.iter().map(|triangle| (triangle.centre_m.distance_squared(eye_m), triangle)).collect();
        // Those as far away as one another keep the order of the scene.
        order.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        let mut runs: Vec<(usize, Range<u32>)> = Vec::new();
        for (place, (_, triangle)) in (0..).zip(&order) {
            let indices = 3 * place..3 * place + 3;
            match runs.last_mut().filter(|(batch, _)| *batch == triangle.batch) {
                Some((_, run)) => run.end = indices.end,
                None => runs.push((triangle.batch, indices)),
            }
        }
        let indices: Vec<u32> = order.iter().flat_map(|(_, triangle)| triangle.first..triangle.first + 3).collect();
        let contents = bytemuck::cast_slice(&indices);
        let descriptor =
            BufferInitDescriptor { label: Some("blended triangles"), contents, usage: wgpu::BufferUsages::INDEX };
        (!indices.is_empty()).then(|| BlendedDraws { indices: gpu.device.create_buffer_init(&descriptor), runs })
    }
}

impl BlendedDraws {
    /// Draws all of them; `prepare` binds what a program reads beyond the scene.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &SceneOnGpu,
        program: impl Fn(&BatchKey) -> &'p Program,
        prepare: impl Fn(&mut wgpu::RenderPass<'_>, &BatchKey),
    ) {
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for (batch, run) in &self.runs {
            let batch = &scene.blended.batches[*batch];
            scene.bind_page(pass, batch);
            prepare(pass, &batch.key);
            scene.bind(pass, batch, program(&batch.key), Some(batch.key.for_output(Output::Lit).textures));
            pass.draw_indexed(run.clone(), 0, 0..1);
        }
    }
}

/// State of pipelines that blend surfaces with what is drawn, where nothing solid lies in front.
pub fn blended_state(
    format: wgpu::TextureFormat,
    depth_format: wgpu::TextureFormat,
    is_two_sided: bool,
) -> PipelineState {
    let depth = depth_state(depth_format, false, wgpu::CompareFunction::GreaterEqual);
    let target = wgpu::ColorTargetState {
        format,
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    };
    PipelineState::new(Some(target), depth, is_two_sided)
}
