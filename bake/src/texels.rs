//! Lists covered texels of a set with everything that another ray tracer needs to check them: surface point, plane, ray
//! origins, and the stored values.

use crate::atlas::{self, Sample};
use crate::disk::read::BakedSet;
use crate::maps::{AmbientSide, Bits, LaneMaps, decode_share, decode_signed, stored_intervals};
use crate::scene::{LoadError, LoadLimits};
use crate::trace::Tracer;
use crate::visibility::{BuriedPoints, SurfaceSide, ray_starts};
use glam::DVec3;
use serde::Serialize;

/// One covered texel, as `sunbake texels` prints it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Texel {
    /// Index of the atlas page.
    pub atlas: usize,
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Index in the manifest's `instances`.
    pub instance: usize,
    /// Point on the surface, world space, metres.
    pub position: [f64; 3],
    /// Unit normal of the surface's plane, world space.
    pub normal: [f64; 3],
    /// Whether light from behind the plane counts too.
    pub double_sided: bool,
    /// Origin of rays towards suns in front of the plane, world space, metres.
    pub origin: [f64; 3],
    /// Origin of rays towards suns behind the plane, if they count; world space, metres.
    pub origin_back: Option<[f64; 3]>,
    /// Unit shading normal, world space, of a smooth surface. Suns count that are in front of it, in place of the
    /// plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shading_normal: Option<[f64; 3]>,
    /// Origin of rays towards suns in front of the shading normal and behind the plane, if there are such rays; world
    /// space, metres. `origin` is that of suns in front of both.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin_lifted: Option<[f64; 3]>,
    /// The same of the back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin_lifted_back: Option<[f64; 3]>,
    /// Whether the texel is buried, so that its times are what its neighbours agree on.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_filled: bool,
    /// Stored path times (0 to 1) from when to when the texel sees the sun; of several lanes, the middle one's.
    pub lit: Vec<[f64; 2]>,
    /// Every lane's times, if the set has several lanes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lanes: Vec<TexelLane>,
    /// Stored path times (0 to 1) from when to when the texel sees the lamp, if the set has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lamp: Option<Vec<[f64; 2]>>,
    /// Stored ambient visibility of the front, 0 (occluded) to 1, if the set has it.
    pub ao: Option<f64>,
    /// The same of the back, for double-sided surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ao_back: Option<f64>,
    /// Stored bent normal of the front, world space, at most unit length, if the set has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bent: Option<[f64; 3]>,
    /// Stored sky visibility of the front: nine coefficients of spherical harmonics, if the set has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sky: Option<[f64; 9]>,
}

/// One texel's stored times along one lane.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TexelLane {
    /// The lane's declination less the centre's, in degrees.
    pub offset_deg: f64,
    /// Share of the sun's disc, 0 to 1.
    pub weight: f64,
    /// Path times (0 to 1) from when to when the texel sees the lane.
    pub lit: Vec<[f64; 2]>,
}

/// Picks `count` random covered texels (all, if there are fewer), in page and row order. The same seed picks the same
/// texels.
pub fn draw(set: &BakedSet, count: usize, seed: u64) -> Result<Vec<Texel>, LoadError> {
    let scene = set.scene(&LoadLimits::default())?;
    let atlas = set.manifest.atlas(&scene);
    let geometry = set.manifest.geometry(&scene);
    let tracer = Tracer::new(&scene, &geometry);
    let covered: Vec<(usize, Sample)> = (0..set.pages.len())
        .flat_map(|page| {
            let samples = atlas::sample_page(&scene, &geometry, &atlas, page as u32).samples;
            samples.into_iter().map(move |sample| (page, sample))
        })
        .collect();
    let texel_m = atlas.texel_widths_m(&scene);
    let buried = BuriedPoints { scene: &scene, geometry: &geometry, tracer: &tracer, texel_m };
    let describe = |&(page, sample): &(usize, Sample)| describe(set, &buried, page, &sample);
    Ok(pick(covered.len(), count, seed).iter().map(|&i| describe(&covered[i])).collect())
}

fn describe(set: &BakedSet, buried: &BuriedPoints, page: usize, sample: &Sample) -> Texel {
    let &BuriedPoints { scene, geometry, tracer, .. } = buried;
    let maps = &set.pages[page];
    let point = atlas::surface_point(scene, geometry, sample);
    let world = |p: DVec3| (p + scene.centre_m).to_array();
    let starts = ray_starts(&point);
    let origin = |side: SurfaceSide, is_lifted: bool| {
        let start = starts.iter().find(|start| start.side == side && start.is_lifted() == is_lifted);
        start.map(|start| world(start.origin_m(tracer, &point)))
    };
    let lanes: Vec<TexelLane> = maps.lanes.iter().map(|lane| of_lane(lane, sample.texel as usize, set.bits)).collect();
    let texel = sample.texel as usize;
    let is_filled = lanes.iter().any(|lane| !lane.lit.is_empty()) && buried.is_buried(&point, 0.0);
    let front = maps.ambient.as_ref().map(|ambient| &ambient.front);
    let back = maps.ambient.as_ref().and_then(|ambient| ambient.back.as_ref());
    Texel {
        atlas: page,
        x: sample.texel % maps.width,
        y: sample.texel / maps.width,
        instance: geometry.surface(sample.triangle as usize).instance,
        position: world(point.position_m),
        normal: point.normal.to_array(),
        double_sided: point.is_double_sided,
        origin: origin(SurfaceSide::Front, false).unwrap_or_else(|| world(point.position_m)),
        origin_back: origin(SurfaceSide::Back, false),
        shading_normal: point.smooth.map(|smooth| smooth.normal.to_array()),
        origin_lifted: origin(SurfaceSide::Front, true),
        origin_lifted_back: origin(SurfaceSide::Back, true),
        is_filled,
        lit: lanes.get(lanes.len() / 2).map(|lane| lane.lit.clone()).unwrap_or_default(),
        lanes: if lanes.len() > 1 { lanes } else { Vec::new() },
        lamp: maps.lamp.as_ref().map(|layers| stored_intervals(layers, sample.texel as usize, set.bits)),
        ao: front.map(|side| ambient_visibility(side, texel)),
        ao_back: back.filter(|_| point.is_double_sided).map(|side| ambient_visibility(side, texel)),
        bent: front.and_then(|side| side.bent.as_ref()).map(|bent| bent[texel].map(decoded)),
        sky: front.and_then(|side| side.sky.as_ref()).map(|sky| sky[texel].map(decoded)),
    }
}

fn ambient_visibility(side: &AmbientSide, texel: usize) -> f64 {
    f64::from(decode_share(side.visibility[texel]))
}

fn decoded(code: u16) -> f64 {
    f64::from(decode_signed(code))
}

fn of_lane(LaneMaps { lane, layers }: &LaneMaps, texel: usize, bits: Bits) -> TexelLane {
    TexelLane {
        offset_deg: lane.offset_rad.to_degrees(),
        weight: lane.weight,
        lit: stored_intervals(layers, texel, bits),
    }
}

/// `count` different random numbers below `total`, ascending. Based on: selection sampling (Knuth, *The Art of Computer
/// Programming*, volume 2, algorithm 3.4.2 S).
fn pick(total: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut state = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut picked = Vec::with_capacity(count.min(total));
    for index in 0..total {
        let wanted = (count - picked.len().min(count)) as f64;
        if uniform(&mut state) * ((total - index) as f64) < wanted {
            picked.push(index);
        }
    }
    picked
}

/// The next number in [0, 1) of SplitMix64 (Steele, Lea and Flood, 2014).
pub(crate) fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picked_numbers_are_different_and_as_many_as_possible() {
        for (total, count) in [(0, 5), (3, 5), (5, 5), (1000, 10), (1000, 0)] {
            let picked = pick(total, count, 42);
            assert_eq!(picked.len(), count.min(total));
            assert!(picked.windows(2).all(|w| w[0] < w[1]) && picked.iter().all(|&i| i < total));
        }
        assert_ne!(pick(1000, 10, 1), pick(1000, 10, 2));
    }
}
