//! Lit pictures on the CPU, from any technique's visibility: twin of `surface/lit_fragment.wgsl`,
//! `surface/surface.wgsl` and what they call.

mod reflection;

pub use reflection::Reflector;

use crate::image::Raster;
use crate::light::Moment;
use crate::playback::{AmbientSky, Page};
use crate::shot::Shot;
use crate::stage::{CornerAttributes, Stage, mapped_normal};
use crate::texture::{Encoding, MipChain};
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use sunbake::scene::TextureRef;
use sunbake::scene::alpha::blend;
use sunbake::trace::Hit;

/// Linear light of every pixel, given the visibility of the sun, 0 to 1, and of the lamp, if there is one. Each pixel
/// shows one surface: that of [`Shot::hits`].
pub fn lit_picture(
    shot: &Shot,
    moment: &Moment,
    visibility: &Raster<f32>,
    lamp_visibility: Option<&Raster<f32>>,
) -> Raster<Vec3> {
    let lit = lit_surfaces(shot, moment, visibility, lamp_visibility).into_iter().zip(0..);
    let pixels = lit.map(|(lit, pixel)| lit.map_or_else(|| background(shot, moment, pixel), |lit| lit.light));
    Raster { size: shot.view.size, pixels: pixels.collect() }
}

/// Visibility of the sun and, if there is one, of the lamp at each pixel of a shot.
pub type Visibilities = (Raster<f32>, Option<Raster<f32>>);

/// Linear light of every pixel, with blended surfaces in front of what lies behind them. `visible` finds visibility at
/// the surfaces of a shot.
///
/// # Errors
///
/// Where `visible` fails.
pub fn blended_picture<E>(
    shot: &Shot,
    moment: &Moment,
    mut visible: impl FnMut(&Shot) -> Result<Visibilities, E>,
) -> Result<Raster<Vec3>, E> {
    let Some((solid, blended)) = shot.layers() else {
        let (sun, lamp) = visible(shot)?;
        return Ok(lit_picture(shot, moment, &sun, lamp.as_ref()));
    };
    let (sun, lamp) = visible(&solid)?;
    let mut picture = lit_picture(&solid, moment, &sun, lamp.as_ref());
    for layer in blended {
        let (sun, lamp) = visible(&layer)?;
        let lit = lit_surfaces(&layer, moment, &sun, lamp.as_ref());
        for (pixel, lit) in picture.pixels.iter_mut().zip(lit) {
            *pixel = lit.map_or(*pixel, |lit| pixel.lerp(lit.light, lit.opacity));
        }
    }
    Ok(picture)
}

/// Visibility of each light at a pixel, 0 to 1.
struct PixelVisibility {
    sun: f32,
    lamp: f32,
}

/// A surface at a pixel, lit.
#[derive(Debug, Clone, Copy)]
struct LitSurface {
    light: Vec3,
    /// 1, but of blended surfaces.
    opacity: f32,
}

fn background(shot: &Shot, moment: &Moment, pixel: usize) -> Vec3 {
    moment.sky_color(shot.ray(pixel).normalize())
}

fn lit_surfaces(
    shot: &Shot,
    moment: &Moment,
    visibility: &Raster<f32>,
    lamp_visibility: Option<&Raster<f32>>,
) -> Vec<Option<LitSurface>> {
    let visible = |pixel: usize| PixelVisibility {
        sun: visibility.pixels[pixel],
        lamp: lamp_visibility.map_or(0.0, |visibility| visibility.pixels[pixel]),
    };
    let pages: Vec<Page> = shot.stage.pages.iter().map(|maps| Page::new(maps, shot.stage.bits, 0.0)).collect();
    let sky = AmbientSky::new(moment, &pages);
    let light = |(pixel, hit): (usize, &Option<Hit>)| {
        hit.as_ref().map(|hit| lit_surface(shot, moment, (&pages, &sky), pixel, hit, &visible(pixel)))
    };
    shot.hits().par_iter().enumerate().with_min_len(64).map(light).collect()
}

fn lit_surface(
    shot: &Shot,
    moment: &Moment,
    (pages, sky): (&[Page], &AmbientSky),
    pixel: usize,
    hit: &Hit,
    visible: &PixelVisibility,
) -> LitSurface {
    let stage = shot.stage;
    let triangle = hit.triangle as usize;
    let at = Footprint { shot, hit, front: stage.geometry.normal(triangle).as_vec3(), ray: shot.ray(pixel) };
    let (material, look) = (stage.material(triangle), stage.look_of(triangle));
    let corners = stage.corners(triangle);
    let base_color = material.base_color * blend(corners.color, at.weights()) * at.base_texture(&corners);
    let is_blended = stage.is_blended(stage.geometry.instance[triangle] as usize);
    let opacity = if is_blended { base_color.w * (1.0 - look.transmission) } else { 1.0 };
    if material.is_unlit {
        return LitSurface { light: base_color.xyz(), opacity };
    }
    let normal = towards_eye(at.shading_normal(&corners), at.front, at.ray);
    let ambient = match stage.chart(stage.geometry.instance[triangle] as usize) {
        Some(chart) => {
            let page_uv = blend(corners.page_uv, at.weights());
            pages[chart.page as usize].ambient_light(page_uv, normal, at.front.dot(at.ray) > 0.0, sky)
        }
        None => moment.hemisphere_light(normal),
    };
    let (base_color, to_eye) = (base_color.xyz(), -at.ray.normalize());
    let reflector = Reflector { base_color, metal: at.metal(), normal, to_eye };
    let light = reflector.shade(moment, visible.sun, ambient) + material.emissive * at.emissive_texture();
    let of_lamp = moment.lamp.map(|lamp| {
        let to_lamp_m = lamp.position_m - stage.geometry.point(triangle, hit.barycentric).as_vec3();
        lamp.on(&reflector, to_lamp_m, visible.lamp)
    });
    LitSurface { light: light + of_lamp.unwrap_or(Vec3::ZERO), opacity }
}

/// A normal turned to the side that the eye is on.
pub fn towards_eye(normal: Vec3, front: Vec3, ray: Vec3) -> Vec3 {
    if front.dot(ray) > 0.0 { -normal } else { normal }
}

/// What a pixel covers of a surface.
struct Footprint<'a> {
    shot: &'a Shot<'a>,
    hit: &'a Hit,
    /// Unit front normal of the triangle.
    front: Vec3,
    /// From the eye, of any length.
    ray: Vec3,
}

impl Footprint<'_> {
    fn triangle(&self) -> usize {
        self.hit.triangle as usize
    }

    fn weights(&self) -> [f32; 2] {
        self.hit.barycentric.map(|b| b as f32)
    }

    fn stage(&self) -> &Stage {
        self.shot.stage
    }

    /// A texture's level of detail. Twin of `surface/level.wgsl`.
    fn level(&self, texels_per_metre: f32) -> f32 {
        let slant = self.front.dot(self.ray.normalize()).abs().max(0.01);
        let texels = texels_per_metre * self.hit.distance_m as f32 * self.shot.view.pixel_angle_rad / slant.sqrt();
        texels.max(1.0).log2()
    }

    fn base_texture(&self, corners: &CornerAttributes) -> Vec4 {
        let Some(texture) = self.stage().material(self.triangle()).base_color_texture else { return Vec4::ONE };
        let Some(mips) = self.stage().mips(texture.image) else { return Vec4::ONE };
        let level = self.level(self.stage().texels_per_metre(self.triangle(), corners.image_uv));
        mips.sample(blend(corners.image_uv, self.weights()), level, texture.wrap)
    }

    /// A texture beside the base colour; none where the material has none.
    fn sampled(&self, texture: Option<TextureRef>, encoding: Encoding) -> Option<Vec3> {
        let texture = texture?;
        let mips: &MipChain = self.stage().look_texture(texture.image, encoding)?;
        let size = Vec2::new(mips.levels[0].width as f32, mips.levels[0].height as f32);
        let image_uv = self.stage().image_uvs(self.triangle(), &texture);
        let level = self.level(self.stage().texels_per_metre_of(self.triangle(), image_uv, size));
        Some(mips.sample(blend(image_uv, self.weights()), level, texture.wrap).truncate())
    }

    /// Metal and roughness; none where the surface only scatters light.
    fn metal(&self) -> Option<[f32; 2]> {
        let look = self.stage().look_of(self.triangle());
        let texel = self.sampled(look.metallic_roughness_texture, Encoding::Linear).unwrap_or(Vec3::ONE);
        (!look.is_diffuse()).then_some([look.metallic * texel.z, look.roughness * texel.y])
    }

    fn emissive_texture(&self) -> Vec3 {
        let look = self.stage().look_of(self.triangle());
        self.sampled(look.emissive_texture, Encoding::Srgb).unwrap_or(Vec3::ONE)
    }

    /// The unit shading normal of the front, with the normal map.
    fn shading_normal(&self, corners: &CornerAttributes) -> Vec3 {
        let normal = blend(corners.normal, self.weights()).normalize_or(self.front);
        let look = self.stage().look_of(self.triangle());
        match self.sampled(look.normal_texture, Encoding::Linear) {
            Some(texel) => {
                let tangents = self.stage().tangents(self.triangle());
                let tangent = blend(tangents, self.weights()).truncate().extend(tangents[0].w);
                mapped_normal(normal, tangent, texel, look.normal_scale)
            }
            None => normal,
        }
    }
}
