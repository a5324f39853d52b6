//! Perspective shadow maps (Stamminger and Drettakis, SIGGRAPH 2002; Kozlov, "Perspective shadow maps: care and
//! feeding", *GPU Gems* chapter 14): the map is drawn in the space after the camera's projection, so that surfaces near
//! the eye get more texels.
//!
//! In that space the sun is a point or, where it stands across the view, a direction. The point may lie in front of the
//! camera or behind it; then rays run backwards through infinity. *GPU Gems* chapter 14 has a matrix for each case, one
//! of them with an inverted depth range that sees past infinity, so that casters behind the eye are on the map and the
//! virtual camera need not move back. Here one formula covers all cases. Let `q` be a point after the camera's
//! projection and `l` the sun's direction after it, both homogeneous; then
//!
//! ```text
//! v(q) = l.w q.xyz - q.w l.xyz
//! ```
//!
//! points away from the sun, is linear in the point, is continuous as `l.w` passes through zero, and is constant along
//! the light. A map that looks along an axis has `w = axis . v`, which stays positive for any caster that shades a
//! receiver, however far behind the eye. So the inverted matrix is not needed.
//!
//! * The map is fitted to the part of the scene's box that is in view (chapter 14's unit cube clipping).
//! * The strength of the warp depends on how far the virtual camera stands behind the eye (Wimmer and others, "Light
//!   space perspective shadow maps", EGSR 2004). A few distances and axes are tried ([`super::warp`]); the one with the
//!   smallest texels in pixels wins, and if none is better than an orthographic map, that is used.
//! * Bias is in metres and texels, as for all variants: depth is metres along the light, over `w`
//!   ([`super::projection`]).
//! * Where the sun stands in view, one map would have to cover half of all directions. The *cube* form has up to six
//!   maps around the sun, at right angles; each is fitted to the part that it sees, with a margin over its neighbours.

use super::map_request::MapRequest;
use super::polyhedron::Polyhedron;
use super::projection::MapProjection;
use super::warp::Warp;

/// Distances of the virtual camera behind the eye that are tried, as shares of the greatest depth.
const BACK_SHARES: [f64; 8] = [0.0, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 0.25, 0.5, 1.0];
/// The maps of a view: one, or with `is_cube` up to six. Empty where nothing is in view or nothing can be in shadow.
pub fn perspective(request: &MapRequest<'_>, is_cube: bool) -> Vec<MapProjection> {
    let Some(shaded) = request.extents.shaded(request.near) else { return Vec::new() };
    let region = request.region();
    if region.is_empty() {
        return Vec::new();
    }
    let mut samples = request.samples();
    if samples.is_empty() {
        samples.extend(region.corners());
    }
    let mut best: Option<(f64, Vec<MapProjection>)> = None;
    for warp in warps(request, &region) {
        let maps =
            if is_cube { warp.cube(request, &region) } else { warp.single(request, &region).into_iter().collect() };
        let log_texel_px = request.mean_log_texel_px(&maps, &samples);
        if !maps.is_empty() && best.as_ref().is_none_or(|(least, _)| log_texel_px < *least) {
            best = Some((log_texel_px, maps));
        }
    }
    let orthographic =
        MapProjection::orthographic(request.extents.axes, &shaded, request.size_texels, request.margin_texels);
    // Without a gain the orthographic map is used.
    match best {
        Some((log_texel_px, maps))
            if log_texel_px <= request.mean_log_texel_px(std::slice::from_ref(&orthographic), &samples) =>
        {
            maps
        }
        _ => vec![orthographic],
    }
}

/// All warps that are tried.
fn warps(request: &MapRequest<'_>, region: &Polyhedron) -> Vec<Warp> {
    let (eye_m, forward) = (request.view.eye_m.as_dvec3(), request.view.forward.as_dvec3());
    let depths = region.corners().map(|p| (p - eye_m).dot(forward));
    let [near_m, far_m] = depths.fold([f64::INFINITY, 0.0], |[low, high], d| [d.min(low), d.max(high)]);
    let range_m = [near_m.clamp(1e-6 * far_m, 0.999 * far_m), far_m];
    let towards = request.extents.axes.towards;
    let warps = |share: f64| Warp::around(request.view, towards, region, range_m, share * far_m);
    BACK_SHARES.into_iter().flat_map(warps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::camera::View;
    use crate::shadow_maps::ShadowScene;
    use crate::shadow_maps::{Extents, Near};
    use crate::stage::Stage;
    use glam::{DVec3, Vec2, Vec3};
    use sunbake::testing::{SceneBuilder, floor};

    struct Case {
        stage: Stage,
        scene: ShadowScene,
    }

    fn case() -> Case {
        let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-60.0), Vec2::splat(60.0), 0.0));
        for i in 0..40u32 {
            let (x, z) = (f64::from(i * 37 % 110) as f32 - 55.0, f64::from(i * 61 % 110) as f32 - 55.0);
            builder = builder.block(Vec3::new(x, 0.0, z), Vec3::new(x + 2.0, 4.0, z + 2.0));
        }
        let stage = Stage::plain(builder.build(), None);
        let scene = ShadowScene::new(&stage);
        Case { stage, scene }
    }

    const EYE: DVec3 = DVec3::new(-50.0, 1.0, 3.0);

    fn maps(case: &Case, towards: DVec3, is_cube: bool) -> (View, Vec<MapProjection>) {
        let camera = Camera::look_at(EYE, DVec3::new(40.0, -3.0, -5.0), 0.9).unwrap();
        let view = View::new(&camera, [96, 64], &case.stage.scene);
        let extents = case.scene.extents(towards);
        (view, perspective(&request(case, &view, &extents), is_cube))
    }

    fn request<'a>(case: &'a Case, view: &'a View, extents: &'a Extents) -> MapRequest<'a> {
        MapRequest {
            view,
            extents,
            receiver_box_m: case.scene.receiver_box_m.unwrap(),
            samples_m: &case.scene.samples_m,
            size_texels: 1024,
            margin_texels: 4.0,
            near: Near::Receivers,
        }
    }

    /// Suns in front of the camera, behind it, beside it and overhead, and one on either side of where they change
    /// over.
    fn suns(case: &Case) -> Vec<DVec3> {
        let (view, _) = maps(case, DVec3::Y, false);
        let forward = view.forward.as_dvec3();
        let level = DVec3::new(forward.x, 0.0, forward.z).normalize();
        let aside = level.cross(DVec3::Y);
        let high = DVec3::Y * 0.4;
        let across = (DVec3::Y - forward * forward.y).normalize();
        let mut all = vec![level + high, high - level, aside + high, high - aside, DVec3::Y, level * 0.2 + DVec3::Y];
        all.extend([0.0, 1e-3, -1e-3, 1e-7, -1e-7].map(|turn| across + forward * turn));
        all.iter().map(|sun| sun.normalize()).collect()
    }

    #[test]
    fn what_is_in_view_is_on_a_map_and_so_is_all_that_shades_it() {
        let case = case();
        for (i, sun) in suns(&case).into_iter().enumerate() {
            for is_cube in [false, true] {
                let (view, maps) = maps(&case, sun, is_cube);
                assert!(!maps.is_empty() && (is_cube || maps.len() == 1), "sun {i}");
                for (column, row) in [(0, 63), (95, 63), (48, 40), (3, 34), (90, 50)] {
                    let ray = view.ray(column, row).as_dvec3();
                    let floor_m = -case.stage.scene.centre_m.y;
                    let point = view.eye_m.as_dvec3() + ray * ((floor_m - f64::from(view.eye_m.y)) / ray.y);
                    if ray.y >= 0.0 || point.abs().max_element() > 59.0 {
                        continue;
                    }
                    let map = maps.iter().find(|map| map.holds(point, 3.5));
                    let map = map.unwrap_or_else(|| panic!("sun {i}, cube {is_cube}: {point} is on no map"));
                    let at = map.clip(point);
                    let depth = at.z / at.w;
                    assert!((-1e-6..=1.0).contains(&depth), "sun {i}: {depth}");
                    // Far along the light, behind the eye too, a caster is on the same texel, nearer to the light.
                    for away_m in [1.0, 50.0, 1e4] {
                        let caster = map.clip(point + sun * away_m);
                        let scale = 1e-9 * away_m.max(1.0) * at.w.recip();
                        assert!((caster.x / caster.w - at.x / at.w).abs() < scale.max(1e-9), "sun {i}");
                        assert!((caster.w - at.w).abs() < 1e-9 * away_m.max(1.0) && caster.z / caster.w < depth);
                    }
                }
            }
        }
    }

    #[test]
    fn texels_do_not_jump_where_the_sun_changes_from_a_direction_to_a_point() {
        let case = case();
        let point = DVec3::new(-38.0, -2.0, 2.0);
        let (view, _) = maps(&case, DVec3::Y, false);
        let forward = view.forward.as_dvec3();
        let across = (DVec3::Y - forward * forward.y).normalize();
        // Of the cameras that are tried, always the same.
        let texel_m = |turn: f64| {
            let towards = (across + forward * turn).normalize();
            let extents = case.scene.extents(towards);
            let request = request(&case, &view, &extents);
            let region = request.region();
            let warp = Warp::around(&view, towards, &region, [2.0, 100.0], 10.0).swap_remove(0);
            warp.single(&request, &region).unwrap().texel_m(point)
        };
        for turn in [1e-4, 1e-6, 1e-9, 1e-12] {
            let [before, after, at] = [texel_m(turn), texel_m(-turn), texel_m(0.0)];
            assert!(
                (before / at - 1.0).abs() < 0.02 && (after / at - 1.0).abs() < 0.02,
                "{turn}: {before} {at} {after}"
            );
        }
    }

    #[test]
    fn what_is_near_gets_finer_texels_than_a_straight_map_gives() {
        let case = case();
        let near = DVec3::new(-46.0, -2.0, 2.6);
        for sun in [DVec3::new(0.1, 1.0, 0.5), DVec3::new(-0.3, 0.8, -0.5)] {
            let (_, maps) = maps(&case, sun, false);
            let shaded = case.scene.extents(sun).shaded(Near::Receivers).unwrap();
            let straight = MapProjection::orthographic(maps[0].axes, &shaded, 1024, 4.0);
            assert!(maps[0].texel_m(near) < 0.5 * straight.texel_m(near), "{}", maps[0].texel_m(near));
        }
    }

    #[test]
    fn a_view_of_nothing_has_no_map() {
        let case = case();
        let camera = Camera::look_at(DVec3::new(0.0, 50.0, 0.0), DVec3::new(0.0, 90.0, 1.0), 0.5).unwrap();
        let view = View::new(&camera, [64, 64], &case.stage.scene);
        let extents = case.scene.extents(DVec3::Y);
        let request = request(&case, &view, &extents);
        assert!(perspective(&request, false).is_empty() && perspective(&request, true).is_empty());
    }
}
