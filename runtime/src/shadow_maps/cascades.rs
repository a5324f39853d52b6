//! Cascades: the view is cut into slices by depth, and each has a map of its own (Engel, "Cascaded shadow maps",
//! *ShaderX5*, 2006; Zhang and others, "Parallel-split shadow maps for large-scale virtual environments", VRCIA 2006).
//!
//! *Practical splits*: between equal slices and slices in equal ratio. Each map holds the bounding sphere of its slice
//! and those before it, whose size does not change as the camera turns, and lies on a grid of its own texels, which
//! does not move as the camera does (Valient, "Stable rendering of cascaded shadow maps", *ShaderX6*, 2008). So shadow
//! edges do not shimmer.
//!
//! Nearest and farthest depth are those in any direction, rounded to quarters of an octave, so that splits rarely
//! change. Where a slice's map would not be finer than one map of everything that can be in shadow, that one map
//! replaces it and all slices beyond it. Seen from afar, cascades are one map.

use super::extents::{Extents, Near, ShadowScene};
use super::projection::{LightBounds, MapProjection};
use crate::View;

/// Share of equal slices in practical splits; the rest is slices in equal ratio.
const EQUAL: f64 = 0.12;
/// Ratio of the farthest to the nearest depth above which that share falls: equal slices of a hundred kilometres are
/// useless.
const EQUAL_UP_TO: f64 = 16_384.0;
/// Most octaves between the nearest and the farthest depth. Nearer surfaces belong to the first slice.
const OCTAVES: f64 = 20.0;

/// Depths at which slices end, in metres: `count + 1` of them.
pub fn splits(near_m: f64, far_m: f64, count: usize) -> Vec<f64> {
    let equal_share = EQUAL * (EQUAL_UP_TO * near_m / far_m).min(1.0).powi(4);
    let at = |i: usize| {
        let share = i as f64 / count as f64;
        let in_ratio = near_m * (far_m / near_m).powf(share);
        let equal = near_m + (far_m - near_m) * share;
        (1.0 - equal_share) * in_ratio + equal_share * equal
    };
    (0..=count).map(at).collect()
}

/// Nearest and farthest distance of drawn triangles in any direction, rounded to quarters of an octave.
pub fn depths_m(view: &View, scene: &ShadowScene) -> [f64; 2] {
    let [low, high] = scene.receiver_box_m.unwrap_or_default();
    let eye_m = view.eye_m.as_dvec3();
    let far_m = (0.5 * (low + high)).distance(eye_m) + 0.5 * (high - low).length();
    let far_m = ((far_m.max(1e-30).log2() * 4.0).ceil() / 4.0).exp2();
    let near_m = scene.nearest_m(eye_m).max(far_m * (-OCTAVES).exp2());
    [((near_m.log2() * 4.0).floor() / 4.0).exp2(), far_m]
}

/// The bounding sphere of the view up to a depth: its middle along the camera's axis, and its radius. Starting a slice
/// where the last one ends would gain next to nothing, and where two maps are blended both must hold the point.
fn sphere(view: &View, to_m: f64) -> [f64; 2] {
    let corner = view.ray_first.as_dvec3();
    // Half a picture's diagonal, at a depth of one.
    let across = (corner - view.forward.as_dvec3() * corner.dot(view.forward.as_dvec3())).length();
    let middle_m = (0.5 * to_m * (1.0 + across * across)).min(to_m);
    [middle_m, middle_m.max((to_m - middle_m).hypot(to_m * across))]
}

/// A view's maps, the finest first. Empty where nothing can be in shadow. `margin_texels` are kept around what each
/// must hold.
pub fn cascades(
    view: &View,
    extents: &Extents,
    scene: &ShadowScene,
    count: usize,
    size_texels: u32,
    margin_texels: f64,
    near: Near,
) -> Vec<MapProjection> {
    let Some(shaded) = extents.shaded(near) else { return Vec::new() };
    let whole = MapProjection::orthographic(extents.axes, &shaded, size_texels, margin_texels);
    let whole_texel_m = whole.texel_m(whole.origin_m);
    let [near_m, far_m] = depths_m(view, scene);
    let ends = splits(near_m, far_m, count);
    let mut maps = Vec::new();
    for &end_m in &ends[1..] {
        let map = around(view, extents, sphere(view, end_m), size_texels, margin_texels, near);
        if map.texel_m(map.origin_m) >= whole_texel_m {
            maps.push(whole);
            return maps;
        }
        maps.push(map);
    }
    maps
}

/// The map that holds a sphere on the camera's axis, on the grid of its own texels.
fn around(
    view: &View,
    extents: &Extents,
    [depth_m, radius_m]: [f64; 2],
    size_texels: u32,
    margin_texels: f64,
    near: Near,
) -> MapProjection {
    // Moving on to the grid takes up to one more texel.
    let inner = f64::from(size_texels) - 2.0 * (margin_texels + 1.0);
    let texel_m = 2.0 * radius_m / inner.max(1.0);
    let at = extents.axes.along(view.eye_m.as_dvec3() + view.forward.as_dvec3() * depth_m);
    let snapped = (at / texel_m).round() * texel_m;
    let reach_m = radius_m + texel_m;
    let mut bounds = LightBounds { low: snapped - reach_m, high: snapped + reach_m };
    // All heights: points on the map outside of the sphere are looked up too.
    (bounds.low.z, bounds.high.z) = (extents.receivers.low.z, extents.high_m(near));
    MapProjection::orthographic(extents.axes, &bounds, size_texels, margin_texels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;
    use crate::stage::Stage;
    use glam::{DVec3, Vec2, Vec3};
    use sunbake::testing::{SceneBuilder, floor};

    fn stage() -> Stage {
        let ground = floor(Vec2::splat(-100.0), Vec2::splat(100.0), 0.0);
        Stage::plain(
            SceneBuilder::new()
                .soup(&ground)
                .block(Vec3::new(-100.0, 0.0, -100.0), Vec3::new(-99.0, 5.0, 100.0))
                .block(Vec3::new(99.0, 0.0, -100.0), Vec3::new(100.0, 5.0, 100.0))
                .build(),
            None,
        )
    }

    fn maps(stage: &Stage, eye_m: DVec3, target_m: DVec3) -> Vec<MapProjection> {
        let scene = ShadowScene::new(stage);
        let view = View::new(&Camera::look_at(eye_m, target_m, 0.8).unwrap(), [64, 48], &stage.scene);
        let extents = scene.extents(DVec3::new(0.4, 0.8, 0.2));
        cascades(&view, &extents, &scene, 4, 1024, 4.0, Near::Receivers)
    }

    #[test]
    fn practical_splits_lie_between_equal_ones_and_those_in_ratio() {
        let found = splits(1.0, 1000.0, 3);
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[3] - 1000.0).abs() < 1e-9);
        assert!(found[1] > 10.0 && found[1] < 334.0 && found[2] > 100.0 && found[2] < 667.0, "{found:?}");
    }

    #[test]
    fn every_slice_lies_on_its_map_and_maps_grow() {
        let stage = stage();
        let (eye, target) = (DVec3::new(0.0, 0.0, 0.0), DVec3::new(30.0, -1.0, 10.0));
        let found = maps(&stage, eye, target);
        assert!(found.len() > 2, "{}", found.len());
        let view = View::new(&Camera::look_at(eye, target, 0.8).unwrap(), [64, 48], &stage.scene);
        let [near_m, far_m] = depths_m(&view, &ShadowScene::new(&stage));
        let ends = splits(near_m, far_m, 4);
        for (map, pair) in found.iter().zip(ends.windows(2)).take(found.len() - 1) {
            for corner in [(0, 0), (63, 0), (0, 47), (63, 47)] {
                let at = |depth_m: f64| view.eye_m.as_dvec3() + view.ray(corner.0, corner.1).as_dvec3() * depth_m;
                assert!(map.holds(at(pair[0]), 4.0) && map.holds(at(pair[1]), 4.0), "{pair:?}");
            }
        }
        let texels: Vec<f64> = found.iter().map(|map| map.texel_m(map.origin_m)).collect();
        assert!(texels.windows(2).all(|pair| pair[0] < pair[1]), "{texels:?}");
    }

    #[test]
    fn a_map_moves_by_whole_texels_and_does_not_change_its_size() {
        let stage = stage();
        let target = DVec3::new(30.0, -1.0, 10.0);
        let point = DVec3::new(6.0, -2.0, 3.0);
        let texel_of = |eye: DVec3, target: DVec3| {
            let map = maps(&stage, eye, target)[0];
            let clip = map.clip(point);
            let texel_m = map.texel_m(point);
            ([clip.x, clip.y].map(|x| (x * 0.5 + 0.5) * f64::from(map.size_texels)), texel_m)
        };
        let (here, texel_m) = texel_of(DVec3::ZERO, target);
        for step in 1..8 {
            let moved = DVec3::new(0.3, 0.1, 0.2) * texel_m * f64::from(step);
            let (there, same_m) = texel_of(moved, target + DVec3::Y * f64::from(step));
            assert!((same_m / texel_m - 1.0).abs() < 1e-6);
            for k in 0..2 {
                let shift = there[k] - here[k];
                assert!((shift - shift.round()).abs() < 2e-3, "step {step}: {shift}");
            }
        }
    }

    #[test]
    fn from_afar_cascades_are_one_map() {
        let found = maps(&stage(), DVec3::new(900.0, 600.0, 900.0), DVec3::ZERO);
        assert_eq!(found.len(), 1);
    }
}
