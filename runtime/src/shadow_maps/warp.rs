//! One virtual camera of a perspective shadow map, and the maps that look along an axis of its space. The theory is in
//! [`super::perspective`].

use super::map_request::MapRequest;
use super::polyhedron::Polyhedron;
use super::projection::MapProjection;
use crate::camera::View;
use glam::{DMat3, DVec2, DVec3, DVec4};

/// Axes that are tried, from the middle of what is in view (0) to straight away from the plane at infinity (1).
const TURNS: [f64; 3] = [0.0, 0.4, 0.7];
/// Least `w` of a corner that is fitted, as a share of the greatest.
const LEAST_W: f64 = 1e-3;
/// Least `l.w` for which the sun counts as a point. Below it the sun stands across the view, and a cube is one map.
const LEAST_POINT_SUN_W: f64 = 1e-5;

/// The space of a virtual camera, and an axis in it along which a map looks.
pub(super) struct Warp {
    eye_m: DVec3,
    towards: DVec3,
    /// Rows of the virtual camera's projection, for points relative to the eye: x, y, z and w.
    q: [DVec4; 4],
    /// The sun's direction after that projection.
    l: DVec4,
    /// Unit vectors after the projection: the last points from the sun to the middle of what is in view.
    frame: DMat3,
    /// A point on the axis, after the projection.
    middle: DVec3,
}

impl Warp {
    /// The warps of a virtual camera `back_m` behind the eye, one for each axis that is tried. `range_m` are the least
    /// and the greatest depth in view.
    pub fn around(view: &View, towards: DVec3, region: &Polyhedron, range_m: [f64; 2], back_m: f64) -> Vec<Self> {
        let rows = view.clip_from_eye().as_dmat4().transpose();
        let forward = view.forward.as_dvec3();
        let [near_m, far_m] = range_m.map(|depth_m| depth_m + back_m);
        let k = far_m / (far_m - near_m);
        let depth = forward.extend(back_m);
        let q = [rows.x_axis, rows.y_axis, depth * k - DVec4::W * (near_m * k), depth];
        let l = DVec4::from_array(q.map(|row| row.truncate().dot(towards)));
        let eye_m = view.eye_m.as_dvec3();
        let positions = region.corners().map(|p| {
            let q = q.map(|row| row.dot((p - eye_m).extend(1.0)));
            let position = DVec3::new(q[0], q[1], q[2]) / q[3].max(1e-12 * far_m);
            position.clamp(DVec3::new(-1.0, -1.0, 0.0), DVec3::ONE)
        });
        let (low, high) =
            positions.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let middle = 0.5 * (low + high);
        let axis = |turn: f64| {
            // For a sun across the view there is only one axis.
            let straight =
                if l.w.abs() > LEAST_POINT_SUN_W { DVec3::new(l.x / l.w, l.y / l.w, middle.z) } else { middle };
            Self::with_axis(eye_m, towards, q, l, middle.lerp(straight, turn))
        };
        TURNS.into_iter().filter_map(axis).collect()
    }

    fn with_axis(eye_m: DVec3, towards: DVec3, q: [DVec4; 4], l: DVec4, middle: DVec3) -> Option<Self> {
        let axis = (middle * l.w - l.truncate()).try_normalize()?;
        let (across, up) = axis.any_orthonormal_pair();
        Some(Self { eye_m, towards, q, l, frame: DMat3::from_cols(across, up, axis), middle })
    }

    /// The row that gives a point's distance from the axis along a vector, after the projection.
    fn beside(&self, vector: DVec3) -> DVec4 {
        let [x, y, z, w] = self.q;
        x * vector.x + y * vector.y + z * vector.z - w * vector.dot(self.middle)
    }

    /// The row of `vector . v`.
    fn away(&self, vector: DVec3) -> DVec4 {
        let [x, y, z, w] = self.q;
        (x * vector.x + y * vector.y + z * vector.z) * self.l.w - w * vector.dot(self.l.truncate())
    }

    /// One map of the region. None where one map cannot hold all of it.
    pub fn single(&self, request: &MapRequest<'_>, region: &Polyhedron) -> Option<MapProjection> {
        let rows = [self.beside(self.frame.x_axis), self.beside(self.frame.y_axis), self.away(self.frame.z_axis)];
        self.fit(request, region, rows)
    }

    /// The faces of a cube around the sun that see some of the region.
    pub fn cube(&self, request: &MapRequest<'_>, region: &Polyhedron) -> Vec<MapProjection> {
        if self.l.w.abs() < LEAST_POINT_SUN_W {
            return self.single(request, region).into_iter().collect();
        }
        let [a, b, c] = [self.frame.x_axis, self.frame.y_axis, self.frame.z_axis];
        let faces = [[a, b, c], [b, c, a], [c, a, b], [b, c, -a], [c, a, -b], [a, b, -c]];
        let mut maps = Vec::new();
        for [across, up, axis] in faces {
            let rows @ [x, y, w] = [self.away(across), self.away(up), self.away(axis)];
            let sides = [w + x, w - x, w + y, w - y].map(|side| self.about_eye(side));
            let part = sides.iter().fold(region.clone(), |body, plane| body.clipped_by(*plane));
            if part.is_empty() {
                continue;
            }
            match self.fit(request, &part, rows) {
                Some(map) => maps.push(map),
                None => return Vec::new(),
            }
        }
        maps
    }

    /// Turns a row for points relative to the eye into one for points of bake space.
    fn about_eye(&self, row: DVec4) -> DVec4 {
        row.truncate().extend(row.w - row.truncate().dot(self.eye_m))
    }

    /// Scales rows of x, y and w so that a region fills the map, and adds depth.
    fn fit(&self, request: &MapRequest<'_>, region: &Polyhedron, [x, y, w]: [DVec4; 3]) -> Option<MapProjection> {
        let corners: Vec<DVec4> = region.corners().map(|p| (p - self.eye_m).extend(1.0)).collect();
        let most_w = corners.iter().map(|p| w.dot(*p)).fold(0.0, f64::max);
        let (x, y, w) = (x / most_w, y / most_w, w / most_w);
        if most_w <= 0.0 || corners.iter().any(|p| w.dot(*p) < LEAST_W) {
            return None;
        }
        let on_map = |p: &DVec4| DVec2::new(x.dot(*p), y.dot(*p)) / w.dot(*p);
        let positions = corners.iter().map(on_map);
        let (low, high) =
            positions.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let inner =
            f64::from(request.size_texels) / (f64::from(request.size_texels) - 2.0 * request.margin_texels).max(1.0);
        let half = 0.5 * (high - low).max(DVec2::splat(1e-9)) * inner;
        let middle = 0.5 * (low + high);
        // Heights towards the sun are relative to the eye. The top is that of everything drawn: a plane may rise out of
        // view.
        let top_m = request.extents.high_m(request.near) - self.towards.dot(self.eye_m);
        let depth = (-self.towards).extend(top_m);
        let deepest = corners.iter().map(|p| depth.dot(*p) / w.dot(*p)).fold(0.0, f64::max);
        let z = depth / (deepest * (1.0 + 1e-6)).max(1e-30);
        let rows = [(x - w * middle.x) / half.x, (y - w * middle.y) / half.y, z, w];
        // The frame may be mirrored, which turns triangles over; both sides cast.
        Some(MapProjection::new(request.extents.axes, self.eye_m, rows, request.size_texels))
    }
}
