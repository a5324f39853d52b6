//! Lit pictures on the CPU, from any technique's visibility: twin of `surface/lit_fragment.wgsl` and
//! `surface/shade.wgsl`.

use crate::image::Raster;
use crate::light::Moment;
use crate::playback::{AmbientSky, Page};
use crate::shot::Shot;
use crate::stage::{CornerAttributes, Stage};
use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use sunbake::scene::Material;
use sunbake::scene::alpha::blend;
use sunbake::trace::Hit;

/// Linear light of every pixel, given the visibility of the sun, 0 to 1, and of the lamp, if there is one.
pub fn lit_picture(
    shot: &Shot,
    moment: &Moment,
    visibility: &Raster<f32>,
    lamp_visibility: Option<&Raster<f32>>,
) -> Raster<Vec3> {
    let visible = |pixel: usize| PixelVisibility {
        sun: visibility.pixels[pixel],
        lamp: lamp_visibility.map_or(0.0, |visibility| visibility.pixels[pixel]),
    };
    let pages: Vec<Page> = shot.stage.pages.iter().map(|maps| Page::new(maps, shot.stage.bits, 0.0)).collect();
    let sky = AmbientSky::new(moment, &pages);
    let light = |(pixel, hit): (usize, &Option<Hit>)| match hit {
        None => moment.sky_color(shot.ray(pixel).normalize()),
        Some(hit) => lit_surface(shot, moment, (&pages, &sky), pixel, hit, &visible(pixel)),
    };
    let pixels = shot.hits().par_iter().enumerate().with_min_len(64).map(light).collect();
    Raster { size: shot.view.size, pixels }
}

/// Visibility of each light at a pixel, 0 to 1.
struct PixelVisibility {
    sun: f32,
    lamp: f32,
}

fn lit_surface(
    shot: &Shot,
    moment: &Moment,
    (pages, sky): (&[Page], &AmbientSky),
    pixel: usize,
    hit: &Hit,
    visible: &PixelVisibility,
) -> Vec3 {
    let stage = shot.stage;
    let triangle = hit.triangle as usize;
    let ray = shot.ray(pixel);
    let material = stage.material(triangle);
    let corners = stage.corners(triangle);
    let weights = hit.barycentric.map(|b| b as f32);
    let front = stage.geometry.normal(triangle).as_vec3();
    let texture = texture_color(shot, &corners, hit, front, ray);
    let base_color = material.base_color * blend(corners.color, weights) * texture;
    let normal = towards_eye(blend(corners.normal, weights).normalize_or(front), front, ray);
    let ambient = match stage.chart(stage.geometry.instance[triangle] as usize) {
        Some(chart) => {
            let page_uv = blend(corners.page_uv, weights);
            pages[chart.page as usize].ambient_light(page_uv, normal, front.dot(ray) > 0.0, sky)
        }
        None => moment.daylight.ground_light.lerp(moment.daylight.sky_light, 0.5 + 0.5 * normal.y),
    };
    let light = shade(material, base_color.xyz(), normal, moment, visible.sun, ambient);
    let of_lamp = moment.lamp.filter(|_| !material.is_unlit).map(|lamp| {
        let to_lamp_m = lamp.position_m - stage.geometry.point(triangle, hit.barycentric).as_vec3();
        lamp.on(base_color.xyz(), normal, to_lamp_m, visible.lamp)
    });
    light + of_lamp.unwrap_or(Vec3::ZERO)
}

/// A normal turned to the side that the eye is on.
pub fn towards_eye(normal: Vec3, front: Vec3, ray: Vec3) -> Vec3 {
    if front.dot(ray) > 0.0 { -normal } else { normal }
}

fn texture_color(shot: &Shot, corners: &CornerAttributes, hit: &Hit, front: Vec3, ray: Vec3) -> Vec4 {
    let stage: &Stage = shot.stage;
    let triangle = hit.triangle as usize;
    let Some(texture) = stage.material(triangle).base_color_texture else { return Vec4::ONE };
    let Some(mips) = stage.mips(texture.image) else { return Vec4::ONE };
    let slant = front.dot(ray.normalize()).abs().max(0.01);
    let texels_per_metre = stage.texels_per_metre(triangle, corners.image_uv);
    let texels = texels_per_metre * hit.distance_m as f32 * shot.view.pixel_angle_rad / slant.sqrt();
    let image_uv = blend(corners.image_uv, hit.barycentric.map(|b| b as f32));
    mips.sample(image_uv, texels.max(1.0).log2(), texture.wrap)
}

/// Light that a diffuse surface reflects or emits: from the sun, as far as it is visible, and ambient light.
fn shade(material: &Material, base_color: Vec3, normal: Vec3, moment: &Moment, visibility: f32, ambient: Vec3) -> Vec3 {
    if material.is_unlit {
        return base_color + material.emissive;
    }
    let sun = moment.daylight.sun_light * (visibility * normal.dot(moment.sun_direction).max(0.0));
    base_color * (sun + ambient) + material.emissive
}
