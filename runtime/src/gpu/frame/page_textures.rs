//! The maps of an atlas page as textures: one array of rise and one of fall times, with a slice for each layer of
//! each lane; the same for the lamp; and ambient light.

use crate::gpu::device::{Gpu, GpuError};
use std::borrow::Cow;
use sunbake::maps::{AmbientMaps, AmbientSide, Bits, LayerMaps, PageMaps};
use sunbake::tracks::{PageTracks, TrackSpan, span_texture};
use sunbake_shaders::{AmbientModel, PageVariant};

/// A page's textures, bound. No layout and no group where the page has neither times nor ambient light.
pub struct PageTextures {
    pub layout: Option<wgpu::BindGroupLayout>,
    pub bind_group: Option<wgpu::BindGroup>,
    /// Entries of the group.
    pub binding_count: usize,
    /// Textures of stored times.
    pub time_textures: usize,
    /// Textures of ambient light.
    pub ambient_textures: usize,
    /// Textures of what stands between texels.
    pub wall_textures: usize,
    /// Bytes of all of its textures.
    pub bytes: u64,
}

impl PageTextures {
    /// Uploads a page.
    pub fn new(gpu: &Gpu, maps: &PageMaps, bits: Bits, variant: &PageVariant) -> Result<Self, GpuError> {
        let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
        GpuError::check_limit("the longer edge of a page", u64::from(maps.width.max(maps.height)), limit)?;
        let mut textures: Vec<(u32, wgpu::Texture)> = Vec::new();
        if variant.sun_layer_count() > 0 {
            let layers: Vec<&LayerMaps> = maps.lanes.iter().flat_map(|lane| &lane.layers).collect();
            let [rise, fall] = times(gpu, maps, bits, &layers)?;
            textures.extend([(0, rise), (1, fall)]);
        }
        if let Some(ambient) = &maps.ambient {
            textures.extend(ambient_textures(gpu, maps, ambient, variant.ambient));
        }
        if let Some(lamp) = maps.lamp.as_ref().filter(|_| variant.lamp_layer_count > 0) {
            let [rise, fall] = times(gpu, maps, bits, &lamp.iter().collect::<Vec<_>>())?;
            textures.extend([(3, rise), (4, fall)]);
        }
        if let Some(tracks) = maps.tracks.as_ref().filter(|_| variant.reads_tracks()) {
            textures.extend(track_textures(gpu, maps, tracks)?);
        }
        let ambient_and_times = textures.len();
        if let Some(walls) = maps.walls.as_ref().filter(|_| variant.has_walls && variant.reads_texels()) {
            let slice = walls.as_flattened().to_vec();
            textures.push((7, slices_texture(gpu, maps, "walls", wgpu::TextureFormat::Rg8Uint, &[slice])));
        }
        let time_textures = textures.iter().filter(|(binding, _)| [0, 1, 3, 4, 8, 9, 10].contains(binding)).count();
        let (layout, bind_group) = bound(gpu, &textures).unzip();
        Ok(Self {
            layout,
            bind_group,
            binding_count: textures.len(),
            time_textures,
            ambient_textures: ambient_and_times - time_textures,
            wall_textures: textures.len() - ambient_and_times,
            bytes: textures.iter().map(|(_, texture)| texture_bytes(texture)).sum(),
        })
    }
}

/// Bytes of a texture of one level, measured at the texture itself: plans predict them.
fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    let size = texture.size();
    let texel_bytes = texture.format().block_copy_size(None).unwrap_or(0);
    [size.width, size.height, size.depth_or_array_layers, texel_bytes].map(u64::from).iter().product()
}

fn bound(gpu: &Gpu, textures: &[(u32, wgpu::Texture)]) -> Option<(wgpu::BindGroupLayout, wgpu::BindGroup)> {
    if textures.is_empty() {
        return None;
    }
    let layout_entry = |binding: &u32| wgpu::BindGroupLayoutEntry {
        binding: *binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        },
        count: None,
    };
    let layout_entries: Vec<_> = textures.iter().map(|(binding, _)| layout_entry(binding)).collect();
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("page"), entries: &layout_entries };
    let layout = gpu.device.create_bind_group_layout(&descriptor);
    let array =
        wgpu::TextureViewDescriptor { dimension: Some(wgpu::TextureViewDimension::D2Array), ..Default::default() };
    let views: Vec<_> = textures.iter().map(|(binding, texture)| (*binding, texture.create_view(&array))).collect();
    let entries: Vec<_> = views
        .iter()
        .map(|(binding, view)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: wgpu::BindingResource::TextureView(view),
        })
        .collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("page"), layout: &layout, entries: &entries };
    let group = gpu.device.create_bind_group(&descriptor);
    Some((layout, group))
}

/// The codes of a layer's rise or fall times, a texel each.
type CodesOf = fn(&LayerMaps) -> &[[u16; 4]];

/// Rise and fall times of these layers.
fn times(gpu: &Gpu, maps: &PageMaps, bits: Bits, layers: &[&LayerMaps]) -> Result<[wgpu::Texture; 2], GpuError> {
    let limit = u64::from(gpu.device.limits().max_texture_array_layers);
    GpuError::check_limit("the number of a page's layers", layers.len() as u64, limit)?;
    let format = match bits {
        Bits::Eight => wgpu::TextureFormat::Rgba8Uint,
        Bits::Sixteen => wgpu::TextureFormat::Rgba16Uint,
    };
    let codes_of: [CodesOf; 2] = [|layer| &layer.rise, |layer| &layer.fall];
    Ok(codes_of.map(|codes_of| {
        let size = [maps.width, maps.height];
        let texture = texture(gpu, "times", size, layers.len() as u32, format, FILLED_AND_READ);
        for (slice, layer) in layers.iter().enumerate() {
            let codes = codes_of(layer);
            let bytes: Cow<[u8]> = match bits {
                Bits::Eight => codes.iter().flatten().map(|&code| code as u8).collect(),
                Bits::Sixteen => Cow::Borrowed(bytemuck::cast_slice(codes)),
            };
            upload(gpu, &texture, 0, slice as u32, size, bits.count() / 2, &bytes);
        }
        texture
    }))
}

/// The lists of texels, and the spans row after row and slice after slice: numbers of tracks, and starts and ends.
fn track_textures(gpu: &Gpu, maps: &PageMaps, tracks: &PageTracks) -> Result<[(u32, wgpu::Texture); 3], GpuError> {
    let limits = gpu.device.limits();
    let [width, rows, slices] = span_texture(tracks.spans.len() as u64);
    GpuError::check_limit("the rows of a page's spans", u64::from(rows), limits.max_texture_dimension_2d.into())?;
    GpuError::check_limit("the slices of a page's spans", u64::from(slices), limits.max_texture_array_layers.into())?;
    let lists: Vec<u8> = tracks.lists().flat_map(u32::to_ne_bytes).collect();
    let lists = slices_texture(gpu, maps, "track lists", wgpu::TextureFormat::R32Uint, &[lists]);
    let spans = |label, format: wgpu::TextureFormat, codes_of: fn(&TrackSpan) -> [u16; 2]| {
        let texture = texture(gpu, label, [width, rows], slices, format, FILLED_AND_READ);
        let texel_bytes = format.block_copy_size(None).unwrap_or(0);
        let used = texel_bytes as usize / size_of::<u16>();
        let in_slice = width as usize * rows as usize;
        for (slice, spans) in tracks.spans.chunks(in_slice).enumerate() {
            let mut codes: Vec<u16> = spans.iter().flat_map(|span| codes_of(span).into_iter().take(used)).collect();
            codes.resize(in_slice * used, 0);
            upload(gpu, &texture, 0, slice as u32, [width, rows], texel_bytes, bytemuck::cast_slice(&codes));
        }
        texture
    };
    let numbers = spans("tracks", wgpu::TextureFormat::R16Uint, |span| [span.track, 0]);
    let shades = spans("shades", wgpu::TextureFormat::Rg16Uint, |span| [span.start, span.end]);
    Ok([(8, lists), (9, numbers), (10, shades)])
}

/// The textures that a model of ambient light reads, with their bindings.
fn ambient_textures(
    gpu: &Gpu,
    maps: &PageMaps,
    ambient: &AmbientMaps,
    model: AmbientModel,
) -> Vec<(u32, wgpu::Texture)> {
    let sides: Vec<&AmbientSide> = std::iter::once(&ambient.front).chain(&ambient.back).collect();
    let open = || {
        let slices: Vec<_> = sides.iter().map(|side| bytemuck::cast_slice(&side.visibility).to_vec()).collect();
        (2, slices_texture(gpu, maps, "ambient occlusion", wgpu::TextureFormat::R16Uint, &slices))
    };
    let in_rgba =
        |label, slices: Vec<Vec<u8>>| slices_texture(gpu, maps, label, wgpu::TextureFormat::Rgba16Uint, &slices);
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

/// Three codes a texel, padded to RGBA.
fn padded(texels: impl Iterator<Item = [u16; 3]>) -> Vec<u8> {
    texels.flat_map(|[r, g, b]| [r, g, b, 0]).flat_map(u16::to_ne_bytes).collect()
}

/// An array texture of these slices.
fn slices_texture(
    gpu: &Gpu,
    maps: &PageMaps,
    label: &str,
    format: wgpu::TextureFormat,
    slices: &[Vec<u8>],
) -> wgpu::Texture {
    let size = [maps.width, maps.height];
    let texture = texture(gpu, label, size, slices.len() as u32, format, FILLED_AND_READ);
    let texel_bytes = format.block_copy_size(None).unwrap_or(0);
    for (slice, bytes) in slices.iter().enumerate() {
        upload(gpu, &texture, 0, slice as u32, size, texel_bytes, bytes);
    }
    texture
}

/// Usage of a page's textures.
const FILLED_AND_READ: wgpu::TextureUsages = wgpu::TextureUsages::TEXTURE_BINDING.union(wgpu::TextureUsages::COPY_DST);

/// A texture of one level.
pub fn texture(
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
pub fn upload(
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
