//! A box on a floor, baked in memory and drawn from above into a texture of a device of our own. Prints the
//! brightness of three pixels of the floor: in the box's shadow, as far from the box on its other side, and far from
//! both.

use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, load};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake_runtime::glam::DVec3;
use sunbake_runtime::gpu::{BakedRenderer, Gpu, Output, PictureTarget};
use sunbake_runtime::{Camera, Filter, Stage, View, wgpu};

/// Pixels each way. A row is 256 bytes, which is what copies to buffers want.
const EDGE_PX: u32 = 64;

/// The sun crosses the zenith from east to west. At t = 1/4 it stands 45 degrees up in the east.
const SUN: &str = r#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 0}, {"direction": [0, 1, 0]},
    {"azimuth_deg": 270, "elevation_deg": 0}]}"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = load("box.gltf".as_ref(), &LoadLimits::default())?;
    let sun = SunRequest::Keyed { json: SUN.into(), north_deg: 0.0 };
    let settings = BakeSettings { page_size_texels: 128, ..BakeSettings::draft(sun) };
    let bake = sunbake::bake_scene(&scene, &settings, &Silent)?;
    let stage = Stage::of_bake(bake)?;

    let (device, queue) = own_device()?;
    let gpu = Gpu::from_device(device.clone(), queue.clone());
    let mut renderer = BakedRenderer::new(&gpu, &stage, Filter::Bilinear)?;
    let texture = texture(&device);
    let target = PictureTarget { view: &texture.create_view(&Default::default()), format: texture.format() };
    let above = DVec3::new(0.0, 14.0, 0.0) - stage.scene.centre_m;
    let camera = Camera::look_at(above, -stage.scene.centre_m, 0.8).ok_or("no camera")?;
    let view = View::new(&camera, [EDGE_PX; 2], &stage.scene);
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.draw_into(&mut encoder, target, Output::Lit, &view, &stage.moment(0.25))?;
    let pixels = read(&device, &queue, encoder, &texture)?;

    // The sun is in the east, towards +x: the shadow of the box, two metres high, lies from x = -1 to -3.
    for (name, x, z) in [("shadow", -2.0, 0.0), ("sunny side", 2.0, 0.0), ("far away", 0.0, 4.0)] {
        let ray = DVec3::new(x, 0.0, z) - stage.scene.centre_m - camera.eye_m;
        let [column, row] = view.pixel_of(ray / ray.dot(camera.forward)).map(|at| at as usize);
        let pixel = &pixels[4 * (row * EDGE_PX as usize + column)..][..3];
        println!("{name}: {}", pixel.iter().map(|&code| u32::from(code)).sum::<u32>() / 3);
    }
    Ok(())
}

fn own_device() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let wanted = wgpu::DeviceDescriptor {
        required_features: adapter.features() & Gpu::WANTED_FEATURES,
        required_limits: adapter.limits(),
        ..Default::default()
    };
    Ok(pollster::block_on(adapter.request_device(&wanted))?)
}

fn texture(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: EDGE_PX, height: EDGE_PX, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Submits what was recorded, and reads the texture back: four codes a pixel, row by row.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: u64::from(4 * EDGE_PX * EDGE_PX),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * EDGE_PX), rows_per_image: None };
    let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, texture.size());
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the buffer can be read"));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(buffer.slice(..).get_mapped_range()?.to_vec())
}
