//! Reads pictures back from the GPU. Rows are copied at multiples of 256 bytes, and the padding is dropped.

use super::target::{DepthBuffer, OwnPicture};
use crate::gpu::device::{Gpu, GpuError};
use glam::Vec3;

/// Colours from the floats of a picture of four channels.
pub fn colors(floats: &[f32]) -> Vec<Vec3> {
    floats.chunks_exact(4).map(|c| Vec3::new(c[0], c[1], c[2])).collect()
}

/// The picture's floats, `channels` a pixel, in row order, once the encoder's commands have run.
pub fn read(
    gpu: &Gpu,
    picture: &OwnPicture,
    channels: u32,
    encoder: wgpu::CommandEncoder,
) -> Result<Vec<f32>, GpuError> {
    floats(gpu, picture.texture.as_image_copy(), picture.size, channels, encoder)
}

/// Depths as they are stored, in row order: the near plane's distance over the surface's, 0 where there is none.
pub fn read_depths(gpu: &Gpu, depth: &DepthBuffer) -> Result<Vec<f32>, GpuError> {
    let source = wgpu::TexelCopyTextureInfo { aspect: wgpu::TextureAspect::DepthOnly, ..depth.texture.as_image_copy() };
    floats(gpu, source, depth.size, 1, gpu.encoder())
}

fn floats(
    gpu: &Gpu,
    source: wgpu::TexelCopyTextureInfo<'_>,
    [width, height]: [u32; 2],
    channels: u32,
    mut encoder: wgpu::CommandEncoder,
) -> Result<Vec<f32>, GpuError> {
    let row_bytes = width * channels * 4;
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(padded_bytes) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_bytes), rows_per_image: Some(height) };
    encoder.copy_texture_to_buffer(
        source,
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = map(gpu, &buffer)?;
    let rows = bytes.chunks_exact(padded_bytes as usize);
    Ok(rows.flat_map(|row| bytemuck::pod_collect_to_vec::<u8, f32>(&row[..row_bytes as usize])).collect())
}

/// What a buffer holds once all submitted work is done.
pub fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let (sender, receiver) = std::sync::mpsc::channel();
    // The receiver outlives the callback, so sending cannot fail.
    buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    let wrong = |e: &dyn std::fmt::Display| GpuError::failed("reading back", e);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| wrong(&e))?;
    receiver.recv().map_err(|e| wrong(&e))?.map_err(|e| wrong(&e))?;
    let mapped = buffer.get_mapped_range(..).map_err(|e| wrong(&e))?;
    Ok(mapped.to_vec())
}
