//! Tests of the measured errors: known answers first, then a whole bake against a sparse one.

use super::budget::Budget;
use super::metric::disc_visibility;
use super::playback::{self, Filter, PlayedMaps};
use super::settings::CostSettings;
use super::sparse_bake::sparse_bake;
use super::truth::{GroundTruth, SurfaceSample};
use super::workload::Workload;
use crate::atlas::{self, AtlasSettings, Footprint, SurfacePoint};
use crate::maps::{Bits, Lane, LaneMaps, PageEncoder, PageMaps};
use crate::progress::Silent;
use crate::scene::Scene;
use crate::settings::{BakeSettings, SunRequest};
use crate::sun::{DayOutcome, DayRequest, SunPath, day};
use crate::testing::{SceneBuilder, block, floor};
use crate::tracks::{PageTracks, TrackSpan};
use crate::visibility::Intervals;
use crate::{bake, disk, glb};
use glam::{DVec2, DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

fn summer() -> DayRequest {
    DayRequest::new(Some([40.0, 0.0]), Some("2026-06-21".parse().unwrap())).unwrap()
}

fn summer_path() -> SunPath {
    match day(&summer()).unwrap() {
        DayOutcome::Path(path) => path,
        other => panic!("{other:?}"),
    }
}

/// Minutes of error at a point amid four texels with these times, given the true times.
fn minutes_wrong(texels: [&[[f64; 2]]; 4], truth: &[[f64; 2]]) -> f64 {
    minutes_by_filter(texels, None, truth)[&Filter::Bilinear]
}

/// The same by each filter.
fn minutes_by_filter(texels: [&[[f64; 2]]; 4], tracks: Option<PageTracks>, truth: &[[f64; 2]]) -> HashMap<Filter, f64> {
    let path = summer_path();
    let surface =
        SurfacePoint { position_m: DVec3::ZERO, normal: DVec3::Y, is_double_sided: false, triangle: 0, smooth: None };
    let place = SurfaceSample { surface, barycentric: [0.3; 2], is_back: false, start: 0.37, shading_normal: DVec3::Y };
    let lit = Intervals::from_unsorted(truth.to_vec());
    let sun = disc_visibility(&[lit], &[Lane::CENTRE], &path, place.start);
    let truth = GroundTruth { points: vec![place], sun: vec![sun], ambient: vec![0.0], buried: 0 };
    let mut encoder = PageEncoder::new(4, Bits::Sixteen, 4);
    for (texel, lit) in texels.iter().enumerate() {
        encoder.set(texel, &Intervals::from_unsorted(lit.to_vec()));
    }
    let lanes = vec![LaneMaps { lane: Lane::CENTRE, layers: encoder.finish() }];
    let page = PageMaps { width: 2, height: 2, lanes, lamp: None, ambient: None, walls: None, tracks };
    let blend = Footprint { texels: [0, 1, 2, 3], fraction: DVec2::splat(0.5), reach: None };
    let played = PlayedMaps { pages: &[page], bits: Bits::Sixteen, path: Some(&path) };
    let minutes = |(filter, errors_t): (Filter, Vec<f64>)| (filter, errors_t[0] * path.duration_min);
    played.errors(&truth, &[(0, blend)]).sun_t.into_iter().map(minutes).collect()
}

#[test]
fn the_truth_has_no_error() {
    let day: &[[f64; 2]] = &[[0.2, 0.4], [0.5, 0.8]];
    let minutes = minutes_wrong([day; 4], day);
    // Codes are 0.8 seconds apart.
    assert!(minutes < 0.03, "{minutes}");
}

#[test]
fn times_that_are_late_by_some_minutes_are_wrong_by_as_many() {
    let duration_min = summer_path().duration_min;
    for late_min in [1.0, 7.0, 30.0] {
        let late = late_min / duration_min;
        let day: &[[f64; 2]] = &[[0.2, 0.6]];
        let evening: &[[f64; 2]] = &[[0.2, 0.6 + late]];
        let both: &[[f64; 2]] = &[[0.2 + late, 0.6 + late]];
        // One moment is 0.9 minutes, of which a ramp as wide as the sun leaves little.
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 0.1, "{found} for {expected}");
        close(minutes_wrong([evening; 4], day), late_min);
        close(minutes_wrong([both; 4], day), 2.0 * late_min);
    }
}

#[test]
fn one_wrong_texel_counts_by_its_weight() {
    let day: &[[f64; 2]] = &[[0.25, 0.75]];
    let expected = 0.25 * 0.5 * summer_path().duration_min;
    for wrong in 0..4 {
        let mut texels = [day; 4];
        texels[wrong] = &[];
        let minutes = minutes_wrong(texels, day);
        assert!((minutes - expected).abs() < 0.5, "{minutes} for {expected}");
    }
}

/// An edge passes two texels an hour after the others: in the middle it passes half an hour after. Evaluated at texels,
/// half of the disc is wrong for that hour, less while the true edge crosses it; the nearest is wrong for half an hour.
#[test]
fn an_edge_between_texels_is_where_sharp_filters_have_it() {
    let hour = 60.0 / summer_path().duration_min;
    let until = |hours: f64| [[0.2, 0.6 + hours * hour]];
    let [early, middle, late] = [0.0, 0.5, 1.0].map(until);
    let codes = |from: f64, to: f64| [from, to].map(|t| Bits::Sixteen.encode(t));
    let spans = [0.6, 0.6 + hour].map(|end| {
        let [[_, night], [end, last]] = [codes(0.0, 0.2), codes(end, 1.0)];
        [TrackSpan { track: 0, start: 0, end: night }, TrackSpan { track: 1, start: end, end: last }]
    });
    let tracks = PageTracks { ranges: [0, 2, 0, 2].map(|first| [first, 2]).to_vec(), spans: spans.concat() };
    let found = minutes_by_filter([&early, &late, &early, &late], Some(tracks), &middle);
    let width_min = summer_path().width_t(0.6) * summer_path().duration_min;
    let bilinear = 30.0 - 0.25 * width_min;
    let expected = [(Filter::Nearest, 30.0), (Filter::Bilinear, bilinear), (Filter::Sharp, 0.0), (Filter::Tracks, 0.0)];
    for (filter, expected) in expected {
        assert!((found[&filter] - expected).abs() < 0.2, "{filter:?}: {} for {expected}", found[&filter]);
    }
    // Without tracks there is no such row.
    assert!(!minutes_by_filter([&early; 4], None, &early).contains_key(&Filter::Tracks));
}

/// The scene as a file.
fn file(scene: &Scene, folder: &Path) -> PathBuf {
    let settings = AtlasSettings { page_size_texels: 64, ..AtlasSettings::default() };
    let atlas = atlas::build(scene, &settings, &|_| true).unwrap();
    let path = folder.join("scene.glb");
    std::fs::write(&path, glb::write_glb(scene, &atlas.layouts, None).unwrap().bytes).unwrap();
    path
}

fn settings() -> CostSettings {
    CostSettings {
        sun: SunRequest::Day(summer()),
        objects: Default::default(),
        page_size_texels: 64,
        budget_s: 1000.0,
        threads: 1,
        max_memory_bytes: None,
    }
}

/// Errors of a small bake at 300 points, from its files and from the texels around the points.
fn both_ways(scene: &Scene, lane_count: usize) -> [playback::PlaybackErrors; 2] {
    let folder = tempfile::tempdir().unwrap();
    let file = file(scene, folder.path());
    let settings = settings();
    let budget = Budget::new(settings.budget_s, &Silent);
    let workload = Workload::new(&file, &settings, &budget).unwrap();
    let truth = GroundTruth::find(&workload, 300, &budget).unwrap();
    let standard = settings.preset(BakeSettings::standard);
    let asked = BakeSettings { page_size_texels: 64, lane_count, ..standard };
    bake(&file, &folder.path().join("set"), false, &asked, &Silent).unwrap();
    let set = disk::read::read(&folder.path().join("set")).unwrap();
    let whole = playback::errors(&set, &truth, workload.scene()).unwrap();
    let sampled = sparse_bake(&workload, &truth, &asked, &budget).unwrap().unwrap();
    assert_eq!(sampled.texels, set.manifest.stats.texels);
    [whole, sampled.errors]
}

#[test]
fn an_open_floor_has_next_to_no_error() {
    let scene = SceneBuilder::new().soup(&floor(Vec2::ZERO, Vec2::splat(10.0), 0.0)).build();
    let [whole, _] = both_ways(&scene, 1);
    let duration_min = summer_path().duration_min;
    let bilinear = whole.sun_t.iter().find(|(filter, _)| *filter == Filter::Bilinear);
    let sun_t = &bilinear.expect("sets are blended").1;
    let worst = sun_t.iter().fold(0.0, |worst: f64, t| worst.max(t * duration_min));
    // What remains is sunrise and sunset, where one lane and the plane's share of the disc differ from seventeen lanes.
    assert!(sun_t.len() == 300 && worst < 1.5, "{worst}");
    assert!(whole.ambient.unwrap().iter().all(|&error| error < 1e-4));
}

#[test]
fn a_sparse_bake_shows_what_the_whole_bake_shows() {
    let mut triangles = floor(Vec2::ZERO, Vec2::splat(10.0), 0.0);
    triangles.extend(block(Vec3::new(3.0, 0.5, 3.0), Vec3::new(4.0, 4.0, 7.0)));
    let scene = SceneBuilder::new().soup(&triangles).build();
    for lane_count in [1, 3] {
        let [whole, sampled] = both_ways(&scene, lane_count);
        assert_eq!(whole.sun_t, sampled.sun_t);
        let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
        let [a, b] = [whole.ambient.unwrap(), sampled.ambient.unwrap()].map(|errors| mean(&errors));
        assert!((a - b).abs() < 0.004, "{a} {b}");
        for (filter, errors_t) in &whole.sun_t {
            assert!(mean(errors_t) > 1e-4, "{filter:?}: a block casts a shadow that texels this large cannot show");
        }
    }
}
