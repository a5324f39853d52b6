//! Shadow volumes against hard truth on real scenes: four times of day (twelve at full size), six cameras, two of
//! them inside a volume.
//!
//! Outside a band of one pixel around truth's edges every pixel must be right. What rasterising cannot help is
//! counted apart and kept rare: see [`MaskAgreement`]. Leaves are solid here, since volumes do not see alpha masks.

use crate::{june, times};
use libtest_mimic::Trial;
use std::path::Path;
use sunbake::scene::{LoadLimits, load};
use sunbake_runtime::compare::MaskAgreement;
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::technique::{LightKind, Technique, Volumes};
use sunbake_runtime::testing::masks::{
    agreement, all_ways, camera_in_shadow, cameras_around, gpu, mask, with_solid_leaves,
};
use sunbake_runtime::volumes::{Mode, VolumeOptimizations};
use sunbake_runtime::{Camera, Moment, Shot, Stage, View};
use sunbake_tests::needs::{of_gas_station, of_scene};

/// Share of pixels that may show another surface than a ray meets, or lie at an edge that no neighbour shows.
const FEW: f64 = 1e-4;
/// Share of pixels on facets of smooth open meshes that turn away from the light where the mesh does not.
const FEW_FACETS: f64 = 0.001;
/// How near to such a facet rasterising may show it, in pixels: it moves corners by up to a 512th.
const BESIDE_PX: f32 = 1.0 / 64.0;
/// Share of the band that may be wrong: its pixels lie beside an edge, and few of them on it.
const FEW_IN_BAND: f64 = 0.01;

fn stage(scene: &Path) -> Stage {
    let scene = load(scene, &LoadLimits { max_memory_bytes: 8 << 30 }).unwrap();
    Stage::plain(with_solid_leaves(scene), Some(june()))
}

/// Four cameras around a stage, and two inside of volumes.
fn cameras(stage: &Stage, moment: &Moment) -> Vec<Camera> {
    let towards = moment.sun_direction.as_dvec3();
    let inside = [1, 2].map(|pick| camera_in_shadow(stage, towards, pick).expect("something is in shadow"));
    cameras_around(stage).into_iter().chain(inside).collect()
}

fn masks_are_right(scene: &Path, edge_px: u32) {
    let (gpu, stage) = (gpu(), stage(scene));
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    let mut all = MaskAgreement::default();
    for t in times() {
        let moment = Moment::new(stage.path.as_ref(), t);
        for (index, camera) in cameras(&stage, &moment).iter().enumerate() {
            let shot = Shot::new(&stage, View::new(camera, [edge_px; 2], &stage.scene));
            let found = agreement(&mut volumes, &shot, &moment, LightKind::Sun);
            let at: Vec<_> = found.unexplained.iter().map(|i| (i % edge_px as usize, i / edge_px as usize)).collect();
            assert!(at.is_empty(), "at {t:.3}, camera {index}: wrong at {at:?}");
            all.add(&found);
        }
    }
    println!("{}", all.sentence());
    let excused = (all.at_fine_edges + all.of_other_surfaces) as f64 / all.pixels as f64;
    assert!(excused < FEW, "{excused}");
    let on_facets = all.on_turned_facets as f64 / all.pixels as f64;
    assert!(on_facets < FEW_FACETS, "{}", all.sentence());
    assert!((all.wrong_in_band as f64) < FEW_IN_BAND * all.in_band as f64, "{all:?}");
}

/// Drawing a prism for each of a city's triangles, again in each frame, would take minutes.
fn is_quick(way: &VolumeSettings) -> bool {
    way.mode != Mode::Triangles || way.optimizations == VolumeOptimizations::default()
}

/// At one time of day, or two at full size: one camera of those around the scene, and both in shadow.
fn all_ways_of_drawing_agree(scene: &Path, edge_px: u32) {
    let (gpu, stage) = (gpu(), stage(scene));
    let mut ways: Vec<Volumes> =
        all_ways().into_iter().filter(is_quick).map(|way| Volumes::new(&gpu, &stage, way).unwrap()).collect();
    let (mut compared, mut on_turned_facets) = (0, 0);
    // Every sixth of 12 times is two, of 4 times one.
    for t in times().step_by(6) {
        let moment = Moment::new(stage.path.as_ref(), t);
        for (index, camera) in cameras(&stage, &moment).iter().enumerate().skip(3) {
            let shot = Shot::new(&stage, View::new(camera, [edge_px; 2], &stage.scene));
            let expected = mask(&mut ways[0], &shot, &moment, LightKind::Sun);
            for other in &mut ways[1..] {
                let found = mask(other, &shot, &moment, LightKind::Sun);
                let pairs = found.pixels.iter().zip(&expected.pixels).enumerate();
                let differing: Vec<usize> = pairs.filter(|(_, (a, b))| a != b).map(|(pixel, _)| pixel).collect();
                let (turned, differ): (Vec<usize>, Vec<usize>) =
                    differing.into_iter().partition(|&pixel| is_on_turned_facet(&shot, &moment, pixel));
                assert!(differ.is_empty(), "at {t:.3}, camera {index}, {}: {differ:?}", other.name());
                on_turned_facets += turned.len();
                compared += found.pixels.len();
            }
        }
    }
    println!("{compared} pixels compared between ways of drawing them, {on_turned_facets} on turned facets differ");
    assert!((on_turned_facets as f64) < FEW_FACETS * compared as f64);
}

/// Whether a pixel shows a facet of something smooth that turns away from the sun, or lies beside one. The volume of an
/// open mesh starts there, within rounding of what is seen. That of a solid spares the facet; right at its silhouette,
/// where rounding may leave the facet out of the volume, what is taken back is what another solid has counted.
fn is_on_turned_facet(shot: &Shot, moment: &Moment, pixel: usize) -> bool {
    let (centre, view, geometry) = (shot.ray(pixel), &shot.view, &shot.stage.geometry);
    let [right, down] = [view.ray_per_column, view.ray_per_row].map(|step| step * BESIDE_PX);
    [centre, centre + right, centre - right, centre + down, centre - down].into_iter().any(|ray| {
        let hit = shot.stage.primary_hit(view.eye_m.as_dvec3(), ray.as_dvec3());
        let is_turned = |triangle: usize| {
            let front = geometry.normal(triangle).as_vec3();
            let seen = if front.dot(ray) > 0.0 { -front } else { front };
            geometry.is_smooth(triangle) && seen.dot(moment.sun_direction) <= 0.0
        };
        hit.is_some_and(|hit| is_turned(hit.triangle as usize))
    })
}

/// Scenes, with the edge of their pictures in pixels: of masks beside truth, and of ways of drawing beside each other.
const SHARED: [(&str, [u32; 2]); 4] = [
    ("osrf_city/osrf_city.glb", [128, 64]),
    ("gazebo_thin/tower_crane.glb", [192, 96]),
    ("gazebo_thin/ladder_60deg_2rails.glb", [192, 96]),
    ("two_cylinder_engine/2CylinderEngine.glb", [192, 96]),
];

pub fn trials() -> Vec<Trial> {
    let (right, agree) = ("masks_of_volumes_are_right", "all_ways_of_drawing_volumes_agree");
    let mut trials = vec![
        of_gas_station(right, |file| masks_are_right(file, 192)),
        of_gas_station(agree, |file| all_ways_of_drawing_agree(file, 128)),
    ];
    for (scene, [truth_px, ways_px]) in SHARED {
        trials.push(of_scene(right, scene, move |file| masks_are_right(file, truth_px)));
        trials.push(of_scene(agree, scene, move |file| all_ways_of_drawing_agree(file, ways_px)));
    }
    trials
}
