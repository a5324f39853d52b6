//! Maps evaluated on the CPU: twins of `filter_nearest.wgsl`, `filter_bilinear.wgsl`, `sun_baked.wgsl`,
//! `lamp_baked.wgsl` and `openness_baked.wgsl`, around [`sunbake::maps::soft_visibility`].

use crate::light::{LampMoment, Moment};
use glam::{IVec2, Vec2, Vec3};
use sunbake::maps::{Bits, PageMaps, soft_visibility};
use sunbake_shaders::{Filter, LaneVariant, PageVariant};

/// What programs that read a page must know of it. `radius_rad` is the sun's angular radius.
pub fn page_variant(page: &PageMaps, bits: Bits, radius_rad: f64) -> PageVariant {
    let lane = |lane: &sunbake::maps::LaneMaps| LaneVariant {
        layer_count: lane.layers.len() as u32,
        weight: lane.lane.weight as f32,
        chord: lane.lane.chord(radius_rad) as f32,
    };
    let lamp_layer_count = page.lamp.as_ref().map_or(0, |layers| layers.len() as u32);
    PageVariant {
        max_code: bits.max_code(),
        lanes: page.lanes.iter().map(lane).collect(),
        lamp_layer_count,
        has_ao: page.ao.is_some(),
    }
}

/// A page ready to be evaluated.
#[derive(Debug, Clone)]
pub struct Page<'a> {
    maps: &'a PageMaps,
    bits: Bits,
    variant: PageVariant,
}

impl<'a> Page<'a> {
    /// Prepares a page for a sun of a given angular radius.
    pub fn new(maps: &'a PageMaps, bits: Bits, radius_rad: f64) -> Self {
        Self { maps, bits, variant: page_variant(maps, bits, radius_rad) }
    }

    fn disc_visibility(&self, texel: IVec2, moment: &Moment) -> f32 {
        let index = texel.y as usize * self.maps.width as usize + texel.x as usize;
        let mut seen = 0.0;
        for (lane, variant) in self.maps.lanes.iter().zip(&self.variant.lanes).filter(|(l, _)| !l.layers.is_empty()) {
            let width_t = moment.width_t * variant.chord;
            seen += variant.weight * soft_visibility(&lane.layers, index, self.bits, moment.t, width_t);
        }
        seen
    }

    fn page_visibility(&self, page_uv: Vec2, filter: Filter, moment: &Moment) -> f32 {
        let last = IVec2::new(self.maps.width as i32, self.maps.height as i32) - 1;
        match filter {
            Filter::Nearest => {
                let texel = (page_uv * (last + 1).as_vec2()).floor().as_ivec2();
                self.disc_visibility(texel.clamp(IVec2::ZERO, last), moment)
            }
            Filter::Bilinear => bilinear(page_uv, last, |texel| self.disc_visibility(texel, moment)),
        }
    }

    /// The sun as the maps tell it, no more than the share of its disc that stands before the surface's plane.
    pub fn sun_visibility(&self, page_uv: Vec2, face: Vec3, filter: Filter, moment: &Moment) -> f32 {
        if self.variant.layer_count() == 0 {
            return 0.0;
        }
        let disc_share = (0.5 + face.dot(moment.sun_direction) * moment.discs_per_radian).clamp(0.0, 1.0);
        if disc_share <= 0.0 {
            return 0.0;
        }
        disc_share.min(self.page_visibility(page_uv, filter, moment))
    }

    /// The lamp as the maps tell it, no more than the share of its ball that stands before the surface's plane; `way_m`
    /// leads to it. Twin of `lamp_baked.wgsl`.
    pub fn lamp_visibility(&self, page_uv: Vec2, face: Vec3, way_m: Vec3, filter: Filter, lamp: &LampMoment) -> f32 {
        let Some(layers) = self.maps.lamp.as_ref().filter(|layers| !layers.is_empty()) else { return 0.0 };
        let ball_share = (0.5 + face.dot(way_m) * lamp.balls_per_metre()).clamp(0.0, 1.0);
        if ball_share <= 0.0 {
            return 0.0;
        }
        let last = IVec2::new(self.maps.width as i32, self.maps.height as i32) - 1;
        let seen = |texel: IVec2| {
            let index = texel.y as usize * self.maps.width as usize + texel.x as usize;
            soft_visibility(layers, index, self.bits, lamp.t, lamp.width_t)
        };
        ball_share.min(match filter {
            Filter::Nearest => seen((page_uv * (last + 1).as_vec2()).floor().as_ivec2().clamp(IVec2::ZERO, last)),
            Filter::Bilinear => bilinear(page_uv, last, seen),
        })
    }

    /// How much of the sky is seen; all of it where there is no ambient occlusion map.
    pub fn openness(&self, page_uv: Vec2) -> f32 {
        let Some(ao) = &self.maps.ao else { return 1.0 };
        let last = IVec2::new(self.maps.width as i32, self.maps.height as i32) - 1;
        let at =
            |texel: IVec2| f32::from(ao[texel.y as usize * self.maps.width as usize + texel.x as usize]) / 65_535.0;
        bilinear(page_uv, last, at)
    }
}

/// Four texels evaluated, then blended.
fn bilinear(page_uv: Vec2, last: IVec2, value: impl Fn(IVec2) -> f32) -> f32 {
    let place = page_uv * (last + 1).as_vec2() - 0.5;
    let base = place.floor();
    let weight = place - base;
    let low = base.as_ivec2().clamp(IVec2::ZERO, last);
    let high = (base.as_ivec2() + 1).clamp(IVec2::ZERO, last);
    let mix = |a: f32, b: f32, weight: f32| a * (1.0 - weight) + b * weight;
    let top = mix(value(low), value(IVec2::new(high.x, low.y)), weight.x);
    let bottom = mix(value(IVec2::new(low.x, high.y)), value(high), weight.x);
    mix(top, bottom, weight.y)
}
