//! Perspective shadow maps (Stamminger and Drettakis, SIGGRAPH 2002; Kozlov, "Perspective shadow maps: care and feeding", *GPU
//! Gems* chapter 14): the map is taken of the scene as the camera's own projection bends it, so that what is near to the eye gets
//! more of it.
//!
//! In that space the sun is a point (or, where it stands across the view, a direction), which may lie before the camera or
//! behind it, where rays run backwards through infinity. The chapter draws each case with a matrix of its own, one of them with
//! an inverted depth range that sees past infinity, so that casters behind the eye are on the map and the virtual camera need
//! not slide back. Here all cases are one formula. Let `q` be a point after the camera's projection and `l` the sun's
//! direction after it, both homogeneous; then
//!
//! ```text
//! v(q) = l.w q.xyz - q.w l.xyz
//! ```
//!
//! points away from the sun, is linear in the point, never jumps as `l.w` passes through zero, and does not change along the
//! light. A map that looks along an axis has `w = axis . v`, which stays positive for whatever shades a receiver, however far
//! behind the eye. What the inverse matrix is for has dropped out.
//!
//! * The map is fitted to the part of the scene's box that is in view (the chapter's unit cube clipping).
//! * How strongly space is bent depends on how far the virtual camera stands behind the eye (Wimmer and others, "Light space
//!   perspective shadow maps", EGSR 2004). That, and where the map looks, are chosen among a few, by the size of the texels that
//!   pixels fall into; and if none of them gains anything, the map is straight.
//! * Bias is in metres and texels, as everywhere: depth is metres along the light, over `w` ([`super::projection`]).
//! * Where the sun stands in view, one map would have to open to half of all directions. The *cube* form has up to six, at
//!   right angles, around the sun; each is fitted to what it sees, with a margin over its neighbours.

use super::extents::{Extents, Near};
use super::polyhedron::Polyhedron;
use super::projection::MapProjection;
use crate::View;
use glam::{DMat3, DVec2, DVec3, DVec4};

/// How far behind the eye the virtual camera is tried, as shares of the farthest depth.
const BACK_SHARES: [f64; 8] = [0.0, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 0.25, 0.5, 1.0];
/// How far between the middle of what is seen and straight away from the plane at infinity axes are tried.
const TURNS: [f64; 3] = [0.0, 0.4, 0.7];
/// Least share of the greatest `w` that a corner of what is fitted may have.
const LEAST_W: f64 = 1e-3;
/// How nearly the sun may stand across the view before a cube is one map.
const ACROSS: f64 = 1e-5;
/// Share of a pixel below which finer texels gain nothing.
const FINE_PX: f64 = 0.5;

/// What maps of a view must hold.
pub struct Seen<'a> {
    /// The view.
    pub view: &'a View,
    /// What casts and receives.
    pub extents: &'a Extents,
    /// The box of what is drawn.
    pub receiver_box_m: [DVec3; 2],
    /// Points that stand for what is drawn.
    pub samples_m: &'a [DVec3],
    /// Edge of a map.
    pub size_texels: u32,
    /// What is kept around what each map must hold.
    pub margin_texels: f64,
    /// Where depths begin.
    pub near: Near,
}

/// Maps of a view, as few as hold what is in view: one, or with `is_cube` up to six. None where nothing is in view or in shadow.
pub fn perspective(seen: &Seen<'_>, is_cube: bool) -> Vec<MapProjection> {
    let Some(shaded) = seen.extents.shaded(seen.near) else { return Vec::new() };
    let region = seen.region();
    if region.is_empty() {
        return Vec::new();
    }
    let mut samples = seen.samples();
    if samples.is_empty() {
        samples.extend(region.corners());
    }
    let mut best: Option<(f64, Vec<MapProjection>)> = None;
    for warp in seen.warps(&region) {
        let maps = if is_cube { warp.cube(seen, &region) } else { warp.single(seen, &region).into_iter().collect() };
        let score = seen.score(&maps, &samples);
        if !maps.is_empty() && best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, maps));
        }
    }
    let straight = MapProjection::orthographic(seen.extents.axes, &shaded, seen.size_texels, seen.margin_texels);
    // A view that bends nothing to its gain is better served by a straight map.
    match best {
        Some((score, maps)) if score <= seen.score(std::slice::from_ref(&straight), &samples) => maps,
        _ => vec![straight],
    }
}

impl Seen<'_> {
    /// What is in view of the box.
    fn region(&self) -> Polyhedron {
        let rows = self.view.clip_from_eye().as_dmat4().transpose();
        let eye_m = self.view.eye_m.as_dvec3();
        let about_eye = |row: DVec4| row.truncate().extend(row.w - row.truncate().dot(eye_m));
        let [x, y, w] = [rows.x_axis, rows.y_axis, rows.w_axis];
        let near = w - DVec4::W * f64::from(self.view.near_m());
        let planes = [w + x, w - x, w + y, w - y, near];
        planes.iter().fold(Polyhedron::of_box(self.receiver_box_m), |body, plane| body.cut(about_eye(*plane)))
    }

    /// Points in view that stand for what is seen.
    fn samples(&self) -> Vec<DVec3> {
        let eye_m = self.view.eye_m.as_dvec3();
        let [width, height] = self.view.size.map(f64::from);
        let is_in_view = |p: &&DVec3| {
            let [x, y] = {
                let ray = **p - eye_m;
                let depth_m = ray.dot(self.view.forward.as_dvec3());
                if depth_m <= 0.0 { [-1.0; 2] } else { self.view.pixel_of(ray / depth_m) }
            };
            (0.0..width).contains(&x) && (0.0..height).contains(&y)
        };
        self.samples_m.iter().filter(is_in_view).copied().collect()
    }

    /// Mean of the logarithms of texels' edges in pixels, over points in view; less is better.
    fn score(&self, maps: &[MapProjection], samples_m: &[DVec3]) -> f64 {
        let eye_m = self.view.eye_m.as_dvec3();
        let of_sample = |p: &DVec3| {
            let pixel_m = p.distance(eye_m) * f64::from(self.view.pixel_angle_rad);
            match maps.iter().find(|map| map.holds(*p, 0.0)) {
                Some(map) => (map.texel_m(*p) / pixel_m).max(FINE_PX).ln(),
                // Never in shadow: it needs no texel.
                None => FINE_PX.ln(),
            }
        };
        samples_m.iter().map(of_sample).sum::<f64>() / samples_m.len().max(1) as f64
    }

    /// Virtual cameras that are tried.
    fn warps(&self, region: &Polyhedron) -> Vec<Warp> {
        let (eye_m, forward) = (self.view.eye_m.as_dvec3(), self.view.forward.as_dvec3());
        let depths = region.corners().map(|p| (p - eye_m).dot(forward));
        let [near_m, far_m] = depths.fold([f64::INFINITY, 0.0], |[low, high], d| [d.min(low), d.max(high)]);
        let range_m = [near_m.clamp(1e-6 * far_m, 0.999 * far_m), far_m];
        let towards = self.extents.axes.towards;
        let warps = |share: f64| Warp::around(self.view, towards, region, range_m, share * far_m);
        BACK_SHARES.into_iter().flat_map(warps).collect()
    }
}

/// The scene as a virtual camera bends it, with an axis along which a map of it looks.
struct Warp {
    eye_m: DVec3,
    towards: DVec3,
    /// Rows of the virtual camera's projection, about the eye: x, y, z and w.
    q: [DVec4; 4],
    /// The sun after it.
    l: DVec4,
    /// Unit vectors after it: the last points from the sun to the middle of what is seen.
    frame: DMat3,
    /// A point after it through which the axis passes.
    middle: DVec3,
}

impl Warp {
    /// The warps of a virtual camera that stands behind the eye, for each axis that is tried.
    fn around(view: &View, towards: DVec3, region: &Polyhedron, range_m: [f64; 2], back_m: f64) -> Vec<Self> {
        let rows = view.clip_from_eye().as_dmat4().transpose();
        let forward = view.forward.as_dvec3();
        let [near_m, far_m] = range_m.map(|depth_m| depth_m + back_m);
        let k = far_m / (far_m - near_m);
        let depth = forward.extend(back_m);
        let q = [rows.x_axis, rows.y_axis, depth * k - DVec4::W * (near_m * k), depth];
        let l = DVec4::from_array(q.map(|row| row.truncate().dot(towards)));
        let eye_m = view.eye_m.as_dvec3();
        let places = region.corners().map(|p| {
            let q = q.map(|row| row.dot((p - eye_m).extend(1.0)));
            let place = DVec3::new(q[0], q[1], q[2]) / q[3].max(1e-12 * far_m);
            place.clamp(DVec3::new(-1.0, -1.0, 0.0), DVec3::ONE)
        });
        let (low, high) =
            places.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let middle = 0.5 * (low + high);
        let axis = |turn: f64| {
            // A sun that stands across the view is seen along one axis alone.
            let straight = if l.w.abs() > ACROSS { DVec3::new(l.x / l.w, l.y / l.w, middle.z) } else { middle };
            Self::with_axis(eye_m, towards, q, l, middle.lerp(straight, turn))
        };
        TURNS.into_iter().filter_map(axis).collect()
    }

    fn with_axis(eye_m: DVec3, towards: DVec3, q: [DVec4; 4], l: DVec4, middle: DVec3) -> Option<Self> {
        let axis = (middle * l.w - l.truncate()).try_normalize()?;
        let (across, up) = axis.any_orthonormal_pair();
        Some(Self { eye_m, towards, q, l, frame: DMat3::from_cols(across, up, axis), middle })
    }

    /// The row that tells how far a point lies along a vector, from the axis, after the camera's projection.
    fn beside(&self, vector: DVec3) -> DVec4 {
        let [x, y, z, w] = self.q;
        x * vector.x + y * vector.y + z * vector.z - w * vector.dot(self.middle)
    }

    /// The row of `vector . v`.
    fn away(&self, vector: DVec3) -> DVec4 {
        let [x, y, z, w] = self.q;
        (x * vector.x + y * vector.y + z * vector.z) * self.l.w - w * vector.dot(self.l.truncate())
    }

    /// One map of the region; none where one cannot see all of it.
    fn single(&self, seen: &Seen<'_>, region: &Polyhedron) -> Option<MapProjection> {
        let rows = [self.beside(self.frame.x_axis), self.beside(self.frame.y_axis), self.away(self.frame.z_axis)];
        self.fit(seen, region, rows)
    }

    /// The faces of a cube around the sun that see anything of the region.
    fn cube(&self, seen: &Seen<'_>, region: &Polyhedron) -> Vec<MapProjection> {
        if self.l.w.abs() < ACROSS {
            return self.single(seen, region).into_iter().collect();
        }
        let [a, b, c] = [self.frame.x_axis, self.frame.y_axis, self.frame.z_axis];
        let faces = [[a, b, c], [b, c, a], [c, a, b], [b, c, -a], [c, a, -b], [a, b, -c]];
        let mut maps = Vec::new();
        for [across, up, axis] in faces {
            let rows @ [x, y, w] = [self.away(across), self.away(up), self.away(axis)];
            let sides = [w + x, w - x, w + y, w - y].map(|side| self.about_eye(side));
            let part = sides.iter().fold(region.clone(), |body, plane| body.cut(*plane));
            if part.is_empty() {
                continue;
            }
            match self.fit(seen, &part, rows) {
                Some(map) => maps.push(map),
                None => return Vec::new(),
            }
        }
        maps
    }

    /// A row about the eye as one about the centre.
    fn about_eye(&self, row: DVec4) -> DVec4 {
        row.truncate().extend(row.w - row.truncate().dot(self.eye_m))
    }

    /// Scales rows of x, y and w so that a region fills the map, and adds depth.
    fn fit(&self, seen: &Seen<'_>, region: &Polyhedron, [x, y, w]: [DVec4; 3]) -> Option<MapProjection> {
        let corners: Vec<DVec4> = region.corners().map(|p| (p - self.eye_m).extend(1.0)).collect();
        let most_w = corners.iter().map(|p| w.dot(*p)).fold(0.0, f64::max);
        let (x, y, w) = (x / most_w, y / most_w, w / most_w);
        if most_w <= 0.0 || corners.iter().any(|p| w.dot(*p) < LEAST_W) {
            return None;
        }
        let place = |p: &DVec4| DVec2::new(x.dot(*p), y.dot(*p)) / w.dot(*p);
        let places = corners.iter().map(place);
        let (low, high) =
            places.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let inner = f64::from(seen.size_texels) / (f64::from(seen.size_texels) - 2.0 * seen.margin_texels).max(1.0);
        let half = 0.5 * (high - low).max(DVec2::splat(1e-9)) * inner;
        let middle = 0.5 * (low + high);
        // Heights towards the sun are told from the eye. The top is that of all that is drawn: a plane may rise out of view.
        let top_m = seen.extents.high_m(seen.near) - self.towards.dot(self.eye_m);
        let depth = (-self.towards).extend(top_m);
        let deepest = corners.iter().map(|p| depth.dot(*p) / w.dot(*p)).fold(0.0, f64::max);
        let z = depth / (deepest * (1.0 + 1e-6)).max(1e-30);
        let rows = [(x - w * middle.x) / half.x, (y - w * middle.y) / half.y, z, w];
        // A mirrored frame would turn triangles over, but both sides cast.
        Some(MapProjection::new(seen.extents.axes, self.eye_m, rows, seen.size_texels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;
    use crate::shadow_maps::ShadowScene;
    use crate::stage::Stage;
    use glam::{Vec2, Vec3};
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
        (view, perspective(&seen(case, &view, &extents), is_cube))
    }

    fn seen<'a>(case: &'a Case, view: &'a View, extents: &'a Extents) -> Seen<'a> {
        Seen {
            view,
            extents,
            receiver_box_m: case.scene.receiver_box_m.unwrap(),
            samples_m: &case.scene.samples_m,
            size_texels: 1024,
            margin_texels: 4.0,
            near: Near::Receivers,
        }
    }

    /// Suns before the camera, behind it, beside it and overhead, and one on either side of where they change over.
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
            let seen = seen(&case, &view, &extents);
            let region = seen.region();
            let warp = Warp::around(&view, towards, &region, [2.0, 100.0], 10.0).swap_remove(0);
            warp.single(&seen, &region).unwrap().texel_m(point)
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
        let seen = seen(&case, &view, &extents);
        assert!(perspective(&seen, false).is_empty() && perspective(&seen, true).is_empty());
    }
}
