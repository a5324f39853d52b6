//! The point of a triangle that is nearest to another point.

use glam::DVec3;

/// Barycentric weights of a triangle's second and third corner at its point nearest to `point` (Ericson, *Real-Time
/// Collision Detection*, 5.1.5).
pub fn nearest(&[a, b, c]: &[DVec3; 3], point: DVec3) -> [f64; 2] {
    let (ab, ac) = (b - a, c - a);
    let along = |from: DVec3| (ab.dot(point - from), ac.dot(point - from));
    let ((d1, d2), (d3, d4), (d5, d6)) = (along(a), along(b), along(c));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let share = |part: f64, rest: f64| if part + rest > 0.0 { part / (part + rest) } else { 0.0 };
    if d1 <= 0.0 && d2 <= 0.0 {
        [0.0, 0.0]
    } else if d3 >= 0.0 && d4 <= d3 {
        [1.0, 0.0]
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        [share(d1, -d3), 0.0]
    } else if d6 >= 0.0 && d5 <= d6 {
        [0.0, 1.0]
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        [0.0, share(d2, -d6)]
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = share(d4 - d3, d5 - d6);
        [1.0 - w, w]
    } else {
        [vb / (va + vb + vc), vc / (va + vb + vc)]
    }
}

/// Distance from a point to a triangle, in metres.
pub fn distance_m(corners: &[DVec3; 3], from_m: DVec3) -> f64 {
    let [u, v] = nearest(corners, from_m);
    let [a, b, c] = corners;
    from_m.distance(a * (1.0 - u - v) + b * u + c * v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_a_corner_on_an_edge_or_within() {
        let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        let cases = [
            (DVec3::new(-1.0, -1.0, 0.0), [0.0, 0.0], 2f64.sqrt()),
            (DVec3::new(4.0, -1.0, 0.0), [1.0, 0.0], 5f64.sqrt()),
            (DVec3::new(-1.0, 5.0, 0.0), [0.0, 1.0], 10f64.sqrt()),
            (DVec3::new(1.0, -3.0, 4.0), [0.5, 0.0], 5.0),
            (DVec3::new(-3.0, 1.0, 4.0), [0.0, 0.5], 5.0),
            (DVec3::new(2.0, 2.0, 0.0), [0.5, 0.5], 2f64.sqrt()),
            (DVec3::new(0.5, 0.5, -7.0), [0.25, 0.25], 7.0),
        ];
        for (point, place, distance) in cases {
            assert_eq!(nearest(&corners, point), place, "{point}");
            assert!((distance_m(&corners, point) - distance).abs() < 1e-12, "{point}");
        }
    }
}
