//! The maps as textures: per page one array of rise and one of fall times, a slice for each layer of each lane.

use super::device::{Gpu, GpuError};
use crate::playback::ambient_bytes;
use std::borrow::Cow;
use sunbake::maps::{AmbientMaps, AmbientSide, Bits, PageMaps};
use sunbake_shaders::{AmbientModel, PageVariant};

/// A page's textures and how programs read them. None where the page has neither a sun nor ambient light.
pub struct PageTextures {
    /// The layout of its bindings.
    pub layout: Option<wgpu::BindGroupLayout>,
    /// Its bindings.
    pub bind_group: Option<wgpu::BindGroup>,
    /// Slots of these.
    pub slots: usize,
    /// Textures with stored times.
    pub time_textures: usize,
    /// Textures with ambient light.
    pub ambient_textures: usize,
    /// Bytes of all of its textures.
    pub bytes: u64,
}

impl PageTextures {
    /// Uploads a page.
    pub fn new(gpu: &Gpu, maps: &PageMaps, bits: Bits, variant: &PageVariant) -> Result<Self, GpuError> {
        let limits = gpu.device.limits();
        let edge = u64::from(maps.width.max(maps.height));
        GpuError::check_limit("the longer edge of a page", edge, u64::from(limits.max_texture_dimension_2d))?;
        let layers = variant.layer_count();
        let limit = u64::from(limits.max_texture_array_layers);
        GpuError::check_limit("the number of a page's layers", u64::from(layers), limit)?;
        let mut bindings: Vec<(u32, wgpu::TextureView, wgpu::TextureViewDimension)> = Vec::new();
        let mut bytes = 0;
        if layers > 0 {
            let all = || maps.lanes.iter().flat_map(|lane| &lane.layers);
            let rise = times(gpu, maps, bits, layers, all().map(|layer| layer.rise.as_slice()));
            let fall = times(gpu, maps, bits, layers, all().map(|layer| layer.fall.as_slice()));
            bindings.push((0, rise, wgpu::TextureViewDimension::D2Array));
            bindings.push((1, fall, wgpu::TextureViewDimension::D2Array));
            bytes += maps.texel_count() * u64::from(layers) * u64::from(bits.count());
        }
        if let Some(ambient) = &maps.ambient {
            let views = ambient_views(gpu, maps, ambient, variant.ambient);
            bindings.extend(views.into_iter().map(|(place, view)| (place, view, wgpu::TextureViewDimension::D2Array)));
            bytes += maps.texel_count() * ambient_bytes(variant);
        }
        let lamp_layers = variant.lamp_layer_count;
        if let Some(lamp) = maps.lamp.as_ref().filter(|_| lamp_layers > 0) {
            GpuError::check_limit("the number of a page's layers", u64::from(lamp_layers), limit)?;
            let rise = times(gpu, maps, bits, lamp_layers, lamp.iter().map(|layer| layer.rise.as_slice()));
            let fall = times(gpu, maps, bits, lamp_layers, lamp.iter().map(|layer| layer.fall.as_slice()));
            bindings.push((3, rise, wgpu::TextureViewDimension::D2Array));
            bindings.push((4, fall, wgpu::TextureViewDimension::D2Array));
            bytes += maps.texel_count() * u64::from(lamp_layers) * u64::from(bits.count());
        }
        let time_textures = 2 * (usize::from(layers > 0) + usize::from(lamp_layers > 0));
        let ambient_textures = bindings.len() - time_textures;
        let (layout, bind_group) = bound(gpu, &bindings).unzip();
        Ok(Self { layout, bind_group, slots: bindings.len(), time_textures, ambient_textures, bytes })
    }
}

trait TexelCount {
    fn texel_count(&self) -> u64;
}

impl TexelCount for PageMaps {
    fn texel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

fn bound(
    gpu: &Gpu,
    bindings: &[(u32, wgpu::TextureView, wgpu::TextureViewDimension)],
) -> Option<(wgpu::BindGroupLayout, wgpu::BindGroup)> {
    if bindings.is_empty() {
        return None;
    }
    let layout_entries: Vec<_> = bindings
        .iter()
        .map(|&(binding, _, view_dimension)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Uint,
                view_dimension,
                multisampled: false,
            },
            count: None,
        })
        .collect();
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("page"), entries: &layout_entries };
    let layout = gpu.device.create_bind_group_layout(&descriptor);
    let entries: Vec<_> = bindings
        .iter()
        .map(|(binding, view, _)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: wgpu::BindingResource::TextureView(view),
        })
        .collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("page"), layout: &layout, entries: &entries };
    let group = gpu.device.create_bind_group(&descriptor);
    Some((layout, group))
}

fn times<'a>(
    gpu: &Gpu,
    maps: &PageMaps,
    bits: Bits,
    layers: u32,
    slices: impl Iterator<Item = &'a [[u16; 4]]>,
) -> wgpu::TextureView {
    let format = match bits {
        Bits::Eight => wgpu::TextureFormat::Rgba8Uint,
        Bits::Sixteen => wgpu::TextureFormat::Rgba16Uint,
    };
    let texture = texture(gpu, "times", [maps.width, maps.height], layers, format, FILLED_AND_READ);
    for (layer, codes) in slices.enumerate() {
        let bytes: Cow<[u8]> = match bits {
            Bits::Eight => codes.iter().flatten().map(|&code| code as u8).collect(),
            Bits::Sixteen => Cow::Borrowed(bytemuck::cast_slice(codes)),
        };
        upload(gpu, &texture, 0, layer as u32, [maps.width, maps.height], bits.count() / 2, &bytes);
    }
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// The textures that a model of ambient light reads, and their places.
fn ambient_views(
    gpu: &Gpu,
    maps: &PageMaps,
    ambient: &AmbientMaps,
    model: AmbientModel,
) -> Vec<(u32, wgpu::TextureView)> {
    let sides: Vec<&AmbientSide> = std::iter::once(&ambient.front).chain(&ambient.back).collect();
    let open = || {
        let slices = sides.iter().map(|side| bytemuck::cast_slice(&side.open).to_vec());
        (2, slices_view(gpu, maps, "ambient occlusion", wgpu::TextureFormat::R16Uint, &slices.collect::<Vec<_>>()))
    };
    let in_rgba = |label, slices: Vec<Vec<u8>>| slices_view(gpu, maps, label, wgpu::TextureFormat::Rgba16Uint, &slices);
    match model {
        AmbientModel::Hemisphere => Vec::new(),
        AmbientModel::Occlusion => vec![open()],
        AmbientModel::Bent => {
            let bent = sides.iter().flat_map(|side| &side.bent).map(|bent| padded(bent.iter().copied()));
            vec![open(), (5, in_rgba("bent normals", bent.collect()))]
        }
        AmbientModel::Sky => {
            let of_side = |sky: &Vec<[u16; 9]>| {
                [0, 1, 2].map(|k| padded(sky.iter().map(|codes| [codes[3 * k], codes[3 * k + 1], codes[3 * k + 2]])))
            };
            vec![(6, in_rgba("sky", sides.iter().flat_map(|side| &side.sky).flat_map(of_side).collect()))]
        }
    }
}

/// Three codes a texel as bytes of four.
fn padded(texels: impl Iterator<Item = [u16; 3]>) -> Vec<u8> {
    texels.flat_map(|[r, g, b]| [r, g, b, 0]).flat_map(u16::to_ne_bytes).collect()
}

/// An array texture of these slices.
fn slices_view(
    gpu: &Gpu,
    maps: &PageMaps,
    label: &str,
    format: wgpu::TextureFormat,
    slices: &[Vec<u8>],
) -> wgpu::TextureView {
    let size = [maps.width, maps.height];
    let texture = texture(gpu, label, size, slices.len() as u32, format, FILLED_AND_READ);
    let texel_bytes = if format == wgpu::TextureFormat::R16Uint { 2 } else { 8 };
    for (slice, bytes) in slices.iter().enumerate() {
        upload(gpu, &texture, 0, slice as u32, size, texel_bytes, bytes);
    }
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// What maps are for.
const FILLED_AND_READ: wgpu::TextureUsages = wgpu::TextureUsages::TEXTURE_BINDING.union(wgpu::TextureUsages::COPY_DST);

/// A texture of one level.
pub(super) fn texture(
    gpu: &Gpu,
    label: &str,
    size: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Writes one level of one array slice.
pub(super) fn upload(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    level: u32,
    slice: u32,
    [width, height]: [u32; 2],
    texel_bytes: u32,
    bytes: &[u8],
) {
    let place = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: level,
        origin: wgpu::Origin3d { x: 0, y: 0, z: slice },
        aspect: wgpu::TextureAspect::All,
    };
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * texel_bytes), rows_per_image: None };
    let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    gpu.queue.write_texture(place, bytes, layout, extent);
}
