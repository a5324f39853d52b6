//! Draws a bake into a texture of one's own, with a device of one's own.
//!
//!     cargo run --example own_device -- box.png
//!
//! Bakes a box above a floor in memory, draws it as it stands in the afternoon, and writes a PNG. A renderer with a
//! window does the same, but passes the view of its window's frame.

mod common;

use common::{Anything, write};
use std::path::Path;
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, Scene, parse};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::DayRequest;
use sunbake_runtime::gpu::{BakedRenderer, Gpu, Output, PictureTarget};
use sunbake_runtime::{Camera, Filter, Raster, Stage, View, glam::DVec3, wgpu};

/// Size of the picture, in pixels.
const SIZE: [u32; 2] = [320, 192];
/// What `Output::Lit` draws is linear light: an sRGB format encodes it for a screen.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

fn main() -> Result<(), Anything> {
    let file = std::env::args().nth(1).ok_or("give a file to write")?;

    // Bake: when does each texel see the sun on a day in June?
    let day = DayRequest::new(Some([48.2, 16.4]), Some("2026-06-21".parse()?))?;
    let settings = BakeSettings { page_size_texels: 256, ..BakeSettings::draft(SunRequest::Day(day)) };
    let bake = sunbake::bake_scene(&box_on_floor()?, &settings, &Silent)?;
    let stage = Stage::of_bake(bake)?;

    // A device of our own, as a renderer has it already.
    let (device, queue) = open()?;
    let gpu = Gpu::from_device(device.clone(), queue.clone());
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("frame"),
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let frame = texture.create_view(&Default::default());

    // Where we look from. Cameras are in bake space: the world, with the scene's centre as its origin.
    let [eye_m, target_m] = [DVec3::new(3.5, 2.5, 4.5), DVec3::ZERO];
    let camera = Camera::look_at(eye_m, target_m, 0.7).ok_or("a camera looks from one point to another")?;
    let view = View::new(&camera, SIZE, &stage.scene);

    // Each frame: choose a path time from 0 (sunrise) to 1 (sunset), record, submit.
    let mut renderer = BakedRenderer::new(&gpu, &stage, Filter::Bilinear)?;
    let mut encoder = device.create_command_encoder(&Default::default());
    let target = PictureTarget { view: &frame, format: FORMAT };
    renderer.draw_into(&mut encoder, target, Output::Lit, &view, &stage.moment(0.75))?;
    let pixels = copy_out(&device, &mut encoder, &texture);
    queue.submit([encoder.finish()]);

    write(Path::new(&file), &read_back(&device, &pixels)?)
}

/// A device with what sunbake can use, and the caller's own needs.
fn open() -> Result<(wgpu::Device, wgpu::Queue), Anything> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let descriptor =
        wgpu::DeviceDescriptor { required_features: Gpu::WANTED_FEATURES & adapter.features(), ..Default::default() };
    Ok(pollster::block_on(adapter.request_device(&descriptor))?)
}

/// A box above a floor. Scenes are read from glTF, so we write the bytes of a small GLB file.
fn box_on_floor() -> Result<Scene, Anything> {
    let quad =
        |corner: DVec3, u: DVec3, v: DVec3| [corner, corner + u, corner + u + v, corner, corner + u + v, corner + v];
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let (low, high) = (DVec3::new(-0.5, 0.3, -0.5), DVec3::new(0.5, 1.3, 0.5));
    let quads = [
        quad(DVec3::new(-2.0, 0.0, 2.0), 4.0 * x, -4.0 * z),
        quad(low, x, z),
        quad(low, y, x),
        quad(low, z, y),
        quad(high, -z, -x),
        quad(high, -x, -y),
        quad(high, -y, -z),
    ];
    let positions: Vec<[f32; 3]> = quads.iter().flatten().map(|p| p.as_vec3().to_array()).collect();
    let bytes: &[u8] = bytemuck::cast_slice(&positions);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.45,0.4,1]}}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count},
        "min":[-2,0,-2],"max":[2,1.3,2]}}],
        "bufferViews":[{{"buffer":0,"byteLength":{length}}}],"buffers":[{{"byteLength":{length}}}]}}"#,
        count = positions.len(),
        length = bytes.len()
    );
    let json = format!("{json:<width$}", width = json.len().next_multiple_of(4));
    let mut glb = Vec::new();
    let total = 12 + 8 + json.len() + 8 + bytes.len();
    [0x4654_6c67, 2, total as u32].iter().for_each(|word: &u32| glb.extend(word.to_le_bytes()));
    for (kind, chunk) in [(0x4e4f_534a_u32, json.as_bytes()), (0x004e_4942, bytes)] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind.to_le_bytes());
        glb.extend(chunk);
    }
    Ok(parse(Path::new("box.glb"), &glb, &LoadLimits::default())?)
}

/// Records a copy of the texture into a buffer. Rows of 320 pixels are multiples of 256 bytes, as copies need.
fn copy_out(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixels"),
        size: u64::from(4 * SIZE[0] * SIZE[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE[0]), rows_per_image: None };
    let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
    buffer
}

fn read_back(device: &wgpu::Device, pixels: &wgpu::Buffer) -> Result<Raster<[u8; 3]>, Anything> {
    pixels.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer made for reading is mapped"));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let rgba = pixels.get_mapped_range(..)?;
    Ok(Raster { size: SIZE, pixels: rgba.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect() })
}
