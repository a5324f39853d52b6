//! Packets against single rays.

use super::*;
use crate::scene::Geometry;
use crate::testing::{SceneBuilder, block, floor, icosphere, pseudo_random};
use glam::{Vec2, Vec3};

/// Spheres, posts and slivers on a floor; rays from all over it in all directions, sixteen at a time.
fn packets(check: impl Fn(&Tracer, &mut PacketTracer, &[ShadowQuery])) {
    let mut builder = SceneBuilder::new().soup(&floor(Vec2::splat(-6.0), Vec2::splat(6.0), 0.0));
    for i in 0..12 {
        let at = Vec3::new((i % 4) as f32 * 2.0 - 3.0, 0.3, (i / 4) as f32 * 2.0 - 2.0);
        let stone: Vec<[Vec3; 3]> = icosphere(2).iter().map(|t| t.map(|v| v * 0.5 + at)).collect();
        builder = builder.soup(&stone).soup(&block(at + Vec3::X, at + Vec3::new(1.004, 2.0, 0.3)));
    }
    let scene = builder.build();
    let geometry = Geometry::new(&scene);
    let tracer = Tracer::new(&scene, &geometry);
    let mut packet_tracer = PacketTracer::new(&tracer);
    let mut state = 5;
    let mut random = || pseudo_random(&mut state);
    for _ in 0..400 {
        let spread = random();
        let axis = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
        let mut query = || {
            let triangle = (random() * geometry.triangles.len() as f64) as u32;
            let point = geometry.point(triangle as usize, [random() * 0.5, random() * 0.5]);
            let normal = geometry.normal(triangle as usize);
            let near_axis = (axis + spread * DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5)).normalize();
            let direction = if near_axis.dot(normal) < 0.0 { -near_axis } else { near_axis };
            ShadowQuery { origin_m: tracer.lift(point, normal, triangle), direction, triangle }
        };
        let queries: Vec<ShadowQuery> = (0..PACKET).map(|_| query()).collect();
        check(&tracer, &mut packet_tracer, &queries);
    }
}

#[test]
fn packets_are_occluded_where_single_rays_are() {
    packets(|tracer, packet_tracer, queries| {
        let expected = queries.iter().map(|q| tracer.is_occluded(q.origin_m, &Direction::new(q.direction)));
        let expected =
            expected.enumerate().fold(0, |bits, (i, is_occluded_alone)| bits | u32::from(is_occluded_alone) << i);
        for level in [Level::new(), Level::baseline()] {
            packet_tracer.level = level;
            for count in [PACKET, 5] {
                let mut guess = None;
                for _ in 0..2 {
                    let occluded = packet_tracer.occluded(&mut PacketScratch::default(), &queries[..count], &mut guess);
                    assert_eq!(occluded, expected & first_bits(count));
                }
            }
        }
    });
}

#[test]
fn packets_find_the_nearest_hits_of_single_rays() {
    packets(|tracer, packet_tracer, queries| {
        for (level, reach_m) in [(Level::new(), f64::INFINITY), (Level::baseline(), 1.5)] {
            packet_tracer.level = level;
            let found = packet_tracer.nearest(&mut PacketScratch::default(), queries, reach_m);
            for (query, found) in queries.iter().zip(found) {
                let hit = tracer.closest_hit(query.origin_m, &Direction::new(query.direction));
                let expected = hit.filter(|hit| hit.distance_m <= reach_m).map(|hit| hit.distance_m);
                let off = expected.zip(found).map(|(expected, found)| (expected - found.distance_m).abs());
                assert_eq!(expected.is_some(), found.is_some(), "{expected:?} {found:?}");
                assert!(off.is_none_or(|off| off < 1e-4), "{expected:?} {found:?}");
            }
        }
    });
}
