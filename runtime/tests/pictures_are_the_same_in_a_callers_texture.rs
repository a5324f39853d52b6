//! Each renderer records into an encoder and a texture of the caller's what it draws by itself. These tests need a GPU
//! adapter.

use glam::{DVec3, Vec2, Vec3};
use sunbake::maps::Bits;
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::{
    BakedRenderer, Gpu, GpuError, MapRenderer, Output, PictureTarget, VolumeRenderer, VolumeSettings,
};
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, standing_sun, view, with_lamp};
use sunbake_runtime::{Filter, Moment, Stage, View, wgpu};

const SIZE: [u32; 2] = [64, 24];

fn stage() -> Stage {
    let builder = SceneBuilder::new().soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0));
    let scene = builder.soup(&block(Vec3::new(0.0, 0.3, 0.0), Vec3::new(1.0, 1.3, 1.0))).build();
    let path = standing_sun(DVec3::new(0.3, 1.0, 0.2), 0.02);
    with_lamp(bake(scene, Some(path), 6, Bits::Sixteen), &lamp_at(DVec3::new(-0.6, 2.5, 0.4)), 6)
}

/// Two views, so that what is written for the second must not reach the first.
fn views(stage: &Stage) -> [View; 2] {
    let target = DVec3::new(0.4, 0.3, 0.2);
    [DVec3::new(4.0, 3.0, 5.0), DVec3::new(-3.0, 5.0, 2.0)].map(|eye| view(stage, eye, target, SIZE))
}

fn texture(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the caller's"),
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The bytes of a texture whose rows are multiples of 256 bytes.
fn bytes(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
    let row_bytes = SIZE[0] * texture.format().block_copy_size(None).unwrap();
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row_bytes * SIZE[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes), rows_per_image: None };
    let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    buffer.get_mapped_range(..).unwrap().to_vec()
}

type Draw<'a> = &'a mut dyn FnMut(&mut wgpu::CommandEncoder, PictureTarget<'_>, &View, &Moment) -> Result<(), GpuError>;

/// What a renderer records of both views into one encoder.
fn recorded(gpu: &Gpu, stage: &Stage, format: wgpu::TextureFormat, draw: Draw<'_>) -> [Vec<u8>; 2] {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let textures = views(stage).map(|view| {
        let texture = texture(gpu, format);
        let target = PictureTarget { view: &texture.create_view(&Default::default()), format };
        draw(&mut encoder, target, &view, &stage.moment(0.5)).unwrap();
        texture
    });
    gpu.queue.submit([encoder.finish()]);
    textures.map(|texture| bytes(gpu, &texture))
}

fn rgb(bytes: &[u8]) -> Vec<Vec3> {
    let float = |four: &[u8]| f32::from_le_bytes(four.try_into().unwrap());
    bytes.chunks_exact(16).map(|c| Vec3::new(float(&c[..4]), float(&c[4..8]), float(&c[8..12]))).collect()
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

#[test]
fn baked_pictures_are_the_same_in_a_callers_texture() {
    let (gpu, stage) = (gpu(), stage());
    let mut renderer = BakedRenderer::new(&gpu, &stage, Filter::Bilinear).unwrap();
    let found = recorded(&gpu, &stage, FORMAT, &mut |e, target, v, m| renderer.draw_into(e, target, Output::Lit, v, m));
    for (found, view) in found.iter().zip(&views(&stage)) {
        assert_eq!(rgb(found), renderer.lit(view, &stage.moment(0.5)).unwrap());
    }
    assert_ne!(found[0], found[1]);
}

#[test]
fn pictures_under_volumes_are_the_same_in_a_callers_texture() {
    let (gpu, stage) = (gpu(), stage());
    // Three suns and a lamp: what is written for one light must not reach another.
    let settings = VolumeSettings { sun_samples: 3, ..VolumeSettings::default() };
    let mut renderer = VolumeRenderer::new(&gpu, &stage, settings).unwrap();
    let found = recorded(&gpu, &stage, FORMAT, &mut |e, target, v, m| renderer.draw_into(e, target, Output::Lit, v, m));
    for (found, view) in found.iter().zip(&views(&stage)) {
        assert_eq!(rgb(found), renderer.lit(view, &stage.moment(0.5)).unwrap());
    }
}

#[test]
fn pictures_under_maps_are_the_same_in_a_callers_texture() {
    let (gpu, stage) = (gpu(), stage());
    for variant in [Variant::Cascades, Variant::Ground, Variant::Planar] {
        let settings = MapSettings { size_texels: 64, ..MapSettings::new(variant) };
        let mut renderer = MapRenderer::new(&gpu, &stage, settings).unwrap();
        let found =
            recorded(&gpu, &stage, FORMAT, &mut |e, target, v, m| renderer.draw_into(e, target, Output::Lit, v, m));
        for (found, view) in found.iter().zip(&views(&stage)) {
            assert_eq!(rgb(found), renderer.lit(view, &stage.moment(0.5)).unwrap(), "{variant}");
        }
    }
}

#[test]
fn pictures_are_drawn_in_the_formats_of_screens() {
    let (gpu, stage) = (gpu(), stage());
    let mut renderer = BakedRenderer::new(&gpu, &stage, Filter::Bilinear).unwrap();
    let [linear, _] =
        recorded(&gpu, &stage, FORMAT, &mut |e, target, v, m| renderer.draw_into(e, target, Output::Lit, v, m));
    let pipelines = renderer.census().pipelines;
    for format in [wgpu::TextureFormat::Rgba8UnormSrgb, wgpu::TextureFormat::Bgra8UnormSrgb] {
        let [found, _] =
            recorded(&gpu, &stage, format, &mut |e, target, v, m| renderer.draw_into(e, target, Output::Lit, v, m));
        let is_bgra = format == wgpu::TextureFormat::Bgra8UnormSrgb;
        for (code, light) in found.chunks_exact(4).zip(rgb(&linear)) {
            let red = if is_bgra { code[2] } else { code[0] };
            let expected = 255.0 * sunbake_runtime::texture::srgb_from_linear(light.x.clamp(0.0, 1.0));
            assert!((f32::from(red) - expected).abs() <= 1.0, "{format:?}: {red} for {light}");
        }
    }
    // Depths are shared; each format has pipelines of surfaces and of the sky.
    let depth_pipelines = 1;
    assert_eq!(renderer.census().pipelines, depth_pipelines + 3 * (pipelines - depth_pipelines));
}
