//! Maps evaluated on the CPU: twins of the shaders in `wgsl/baked`, `wgsl/ambient` and `wgsl/lamp/baked*.wgsl`, around
//! [`sunbake::maps::soft_visibility`], [`sunbake::maps::hard_visibility`] and [`sunbake::maps::edge_sample`].

use crate::light::{Daylight, LampMoment, Moment};
use glam::{IVec2, Vec2, Vec3};
use sunbake::ambient::harmonics;
use sunbake::atlas::{Footprint, PageSize};
use sunbake::maps::{
    AmbientMaps, AmbientSide, AmbientTextures, Bits, LayerMaps, PageMaps, decode_share, decode_signed, edge_sample,
    hard_visibility, sharpened, soft_visibility,
};
use sunbake::tracks::tracked_visibility;
use sunbake_shaders::{AmbientModel, Filter, LaneVariant, PageVariant};

/// What the programs that read a page depend on. `radius_rad` is the sun's angular radius; 0 is a point sun.
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
        is_point_sun: radius_rad == 0.0 && !page.lanes.is_empty(),
        lamp_layer_count,
        ambient: ambient_model(page),
        has_backs: page.ambient.as_ref().is_some_and(|ambient| ambient.back.is_some()),
        has_walls: page.walls.is_some(),
        has_tracks: false,
    }
}

/// The most detailed model that a page's maps of ambient light allow.
fn ambient_model(page: &PageMaps) -> AmbientModel {
    match AmbientTextures::of(page) {
        AmbientTextures::None => AmbientModel::Hemisphere,
        AmbientTextures::Occlusion => AmbientModel::Occlusion,
        AmbientTextures::Bent => AmbientModel::Bent,
        AmbientTextures::Sky => AmbientModel::Sky,
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

    /// Lanes that store any time.
    fn lanes(&self) -> impl Iterator<Item = (&[LayerMaps], &LaneVariant)> {
        let lanes = self.maps.lanes.iter().zip(&self.variant.lanes);
        lanes.map(|(lane, variant)| (lane.layers.as_slice(), variant)).filter(|(layers, _)| !layers.is_empty())
    }

    fn disc_visibility(&self, texel: usize, moment: &Moment) -> f32 {
        let mut visibility = 0.0;
        for (layers, variant) in self.lanes() {
            visibility += variant.weight
                * match self.variant.is_point_sun {
                    true => hard_visibility(layers, texel, self.bits, moment.t),
                    false => soft_visibility(layers, texel, self.bits, moment.t, moment.width_t * variant.chord),
                };
        }
        visibility
    }

    fn page_visibility(&self, page_uv: Vec2, filter: Filter, moment: &Moment) -> f32 {
        match filter {
            Filter::Nearest => self.disc_visibility(self.nearest_texel(page_uv), moment),
            Filter::Tracks if !self.variant.is_point_sun && self.maps.tracks.is_some() => {
                let footprint = self.footprint(page_uv);
                let of_tracks = |tracks| tracked_visibility(tracks, &footprint, moment.t, moment.width_t);
                self.maps.tracks.as_ref().map_or(0.0, of_tracks)
            }
            Filter::Bilinear => self.footprint(page_uv).blend(|texel| self.disc_visibility(texel, moment)),
            Filter::Sharp | Filter::Tracks => {
                let footprint = self.footprint(page_uv);
                let mut visibility = 0.0;
                for (layers, variant) in self.lanes() {
                    let width_t = if self.variant.is_point_sun { 0.0 } else { moment.width_t * variant.chord };
                    visibility += variant.weight * self.sharp_visibility(layers, &footprint, moment.t, width_t);
                }
                visibility
            }
        }
    }

    fn sharp_visibility(&self, layers: &[LayerMaps], footprint: &Footprint, t: f32, width_t: f32) -> f32 {
        sharpened(footprint.blend(|texel| edge_sample(layers, texel, self.bits, t, width_t)))
    }

    fn nearest_texel(&self, page_uv: Vec2) -> usize {
        let last = IVec2::new(self.maps.width as i32, self.maps.height as i32) - 1;
        let texel = (page_uv * (last + 1).as_vec2()).floor().as_ivec2().clamp(IVec2::ZERO, last);
        texel.y as usize * self.maps.width as usize + texel.x as usize
    }

    fn footprint(&self, page_uv: Vec2) -> Footprint {
        let size = PageSize { width: self.maps.width, height: self.maps.height };
        // In `f32`, as the shaders do it.
        let point = page_uv * Vec2::new(size.width as f32, size.height as f32) - 0.5;
        let footprint = Footprint::new(point.as_dvec2(), size);
        match &self.maps.walls {
            Some(codes) => footprint.beside_walls(codes),
            None => footprint,
        }
    }

    /// Visibility of the sun by the maps, 0 to 1, and no more than the share of its disc above the surface's plane.
    /// `gate_normal` is that plane's, on the side that the eye is on: [`crate::stage::Stage::gate_normal`].
    pub fn sun_visibility(&self, page_uv: Vec2, gate_normal: Vec3, filter: Filter, moment: &Moment) -> f32 {
        if self.variant.layer_count() == 0 {
            return 0.0;
        }
        if self.variant.is_point_sun {
            let is_in_front = gate_normal.dot(moment.sun_direction) > 0.0;
            return if is_in_front { self.page_visibility(page_uv, filter, moment) } else { 0.0 };
        }
        let disc_share = moment.open_visibility(gate_normal);
        if disc_share <= 0.0 {
            return 0.0;
        }
        disc_share.min(self.page_visibility(page_uv, filter, moment))
    }

    /// Visibility of the lamp by the maps, 0 to 1, and no more than the share of its sphere above the surface's plane;
    /// `to_lamp_m` leads from the surface to the lamp. Twin of `lamp/baked.wgsl`.
    pub fn lamp_visibility(
        &self,
        page_uv: Vec2,
        gate_normal: Vec3,
        to_lamp_m: Vec3,
        filter: Filter,
        lamp: &LampMoment,
    ) -> f32 {
        let Some(layers) = self.maps.lamp.as_ref().filter(|layers| !layers.is_empty()) else { return 0.0 };
        let sphere_share = lamp.open_visibility(gate_normal, to_lamp_m);
        if sphere_share <= 0.0 {
            return 0.0;
        }
        let of_texel = |texel| soft_visibility(layers, texel, self.bits, lamp.t, lamp.width_t);
        let visibility = match filter {
            Filter::Nearest => of_texel(self.nearest_texel(page_uv)),
            Filter::Bilinear => self.footprint(page_uv).blend(of_texel),
            Filter::Sharp | Filter::Tracks => {
                self.sharp_visibility(layers, &self.footprint(page_uv), lamp.t, lamp.width_t)
            }
        };
        sphere_share.min(visibility)
    }

    /// Ambient light on a surface, linear. `normal` is turned to the eye; `is_back` says that the eye is behind the
    /// surface. Twin of the shaders in `wgsl/ambient`.
    pub fn ambient_light(&self, page_uv: Vec2, normal: Vec3, is_back: bool, sky: &AmbientSky) -> Vec3 {
        let light = sky.daylight;
        let hemisphere = |share: f32| light.ground_light.lerp(light.sky_light, share);
        let share_of_normal = 0.5 + 0.5 * normal.y;
        let Some(ambient) = &self.maps.ambient else { return hemisphere(share_of_normal) };
        let side = ambient_side(ambient, is_back);
        let footprint = self.footprint(page_uv);
        let occlusion = || footprint.blend(|texel| decode_share(side.visibility[texel]));
        match (&side.sky, &side.bent) {
            (Some(codes), _) => {
                let light_at = |texel: usize| {
                    let pairs = codes[texel].iter().zip(&sky.harmonics);
                    pairs.map(|(&code, &light)| light * decode_signed(code)).sum::<Vec3>()
                };
                footprint.blend(light_at).max(Vec3::ZERO)
            }
            (None, Some(bent)) => {
                let height = footprint.blend(|texel| decode_signed(bent[texel][1]));
                hemisphere((0.5 + 0.75 * height).clamp(0.0, 1.0)) * occlusion()
            }
            (None, None) => hemisphere(share_of_normal) * occlusion(),
        }
    }
}

/// Ambient light at a moment, before any surface.
#[derive(Debug, Clone, Copy)]
pub struct AmbientSky<'a> {
    daylight: &'a Daylight,
    /// The sky's radiance in spherical harmonics; zero where no page needs it.
    harmonics: [Vec3; harmonics::COUNT],
}

impl<'a> AmbientSky<'a> {
    /// Computes what these pages need.
    pub fn new(moment: &'a Moment, pages: &[Page]) -> Self {
        let is_needed = pages.iter().any(|page| page.variant.ambient == AmbientModel::Sky);
        let harmonics = if is_needed { moment.sky_harmonics() } else { Default::default() };
        Self { daylight: &moment.daylight, harmonics }
    }
}

/// The maps of the side that the eye is on.
fn ambient_side(ambient: &AmbientMaps, is_back: bool) -> &AmbientSide {
    ambient.back.as_ref().filter(|_| is_back).unwrap_or(&ambient.front)
}
