//! An edge that runs along the sun's path: one lane leaves it hard, several make it a penumbra. Compared with the
//! circular segment of the disc that the edge leaves free.

use glam::{DVec3, Vec2};
use sunbake::maps::{Bits, Lane};
use sunbake::sun::SunPath;
use sunbake::testing::{SceneBuilder, floor};
use sunbake_runtime::technique::{BakedCpu, Technique};
use sunbake_runtime::testing::{bake_lanes, equinox, view};
use sunbake_runtime::{Filter, Moment, Shot, Stage};

const RADIUS_RAD: f64 = 0.1;
const HEIGHT_M: f64 = 2.0;

/// The sun goes from east to west straight overhead.
fn overhead() -> SunPath {
    let mut path = equinox(0.0);
    path.angular_radius_rad = RADIUS_RAD;
    path
}

/// A floor under a roof that covers its north. The roof's edge runs from east to west, far past the floor.
fn half_roofed(lane_count: usize) -> Stage {
    let roof = floor(Vec2::new(-200.0, -200.0), Vec2::new(200.0, 0.0), HEIGHT_M as f32);
    let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-1.0), Vec2::splat(1.0), 0.0)).soup(&roof).build();
    bake_lanes(scene, Some(overhead()), 160, Bits::Sixteen, lane_count)
}

/// Share of the disc south of an edge, `u` radii north of its centre.
fn free_share(u: f64) -> f64 {
    let u = u.clamp(-1.0, 1.0);
    1.0 - (u.acos() - u * (1.0 - u * u).sqrt()) / std::f64::consts::PI
}

/// What the maps give at noon: each pixel's distance from the shadow's middle, in radii of the disc, and its
/// visibility.
fn penumbra(stage: &Stage) -> Vec<(f64, f64)> {
    let shot = Shot::new(stage, view(stage, DVec3::new(0.0, 1.5, 0.0), DVec3::ZERO, [96, 96]));
    let moment = Moment::new(stage.path.as_ref(), 0.5);
    let seen = BakedCpu::new(stage, Filter::Nearest).visibility(&shot, &moment).unwrap();
    let place = |hit: &sunbake::trace::Hit| stage.geometry.point(hit.triangle as usize, hit.barycentric);
    let south = |hit: &sunbake::trace::Hit| (place(hit) + stage.scene.centre_m).z / HEIGHT_M;
    let pixels = shot.hits().iter().zip(seen.pixels);
    pixels.filter_map(|(hit, v)| Some((south(hit.as_ref()?).atan() / RADIUS_RAD, f64::from(v)))).collect()
}

/// A texel and a half, in radii of the disc: how far a pixel lies from the texel it shows, at most.
const TEXEL: f64 = 1.5 * 2.0 / 157.0 / HEIGHT_M / RADIUS_RAD;

#[test]
fn an_edge_along_the_path_is_as_soft_as_there_are_lanes() {
    for (lane_count, bound) in [(1, 0.5), (3, 0.209), (5, 0.1266)] {
        let found = penumbra(&half_roofed(lane_count));
        let off = |&(u, v): &(f64, f64)| (free_share(u - TEXEL) - v).max(v - free_share(u + TEXEL));
        let worst = found.iter().map(off).fold(0.0, f64::max);
        assert!(worst <= bound, "{lane_count} lanes: {worst}");
        // The bound is nearly reached somewhere: there are steps, as coarse as the number of lanes makes them.
        assert!(worst > 0.6 * bound, "{lane_count} lanes: {worst}");
    }
}

#[test]
fn the_penumbra_starts_and_ends_at_the_outer_lanes() {
    for lane_count in [1, 3, 5] {
        let found = penumbra(&half_roofed(lane_count));
        let outer = Lane::across_disc(lane_count, RADIUS_RAD)[lane_count - 1].offset_rad / RADIUS_RAD;
        let first_lit = found.iter().filter(|(_, v)| *v > 1e-6).map(|(u, _)| *u).fold(f64::INFINITY, f64::min);
        let last_dim = found.iter().filter(|(_, v)| *v < 1.0 - 1e-6).map(|(u, _)| *u).fold(f64::NEG_INFINITY, f64::max);
        for (edge, expected) in [(first_lit, -outer), (last_dim, outer)] {
            assert!((edge - expected).abs() <= TEXEL, "{lane_count} lanes: {edge} for {expected}");
        }
        let steps: std::collections::BTreeSet<u64> = found.iter().map(|(_, v)| (v * 1e4).round() as u64).collect();
        assert_eq!(steps.len(), lane_count + 1, "{lane_count} lanes: {steps:?}");
    }
}
