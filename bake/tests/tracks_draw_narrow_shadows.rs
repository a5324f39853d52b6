//! Shadow tracks: each occluder's shade by itself is exact, and shadows narrower than texels are lines between them.

use glam::{DVec2, DVec3, Vec2, Vec3};
use sunbake::atlas::{Footprint, PageSize, SurfacePoint};
use sunbake::maps::{Bits, PageEncoder, edge_sample, hard_visibility, sharpened, soft_visibility};
use sunbake::progress::Silent;
use sunbake::scene::{Components, Geometry, Scene};
use sunbake::settings::{BakeSettings, SunRequest, TrackChoice};
use sunbake::sun::{DayOutcome, DayRequest, SunPath, day};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake::trace::{Direction, Tracer};
use sunbake::tracks::{Linked, MOST_SPANS, PageTracks, SpanSearch, find_spans, number_tracks, tracked_visibility};
use sunbake::visibility::{ExactEngine, IntervalTable, Intervals, OccluderFinder, lit_at, solve_visibility};
use sunbake::{Bake, bake_scene};

/// Texels a metre, and their number along an edge of the patch behind the fence.
const DENSITY: f64 = 10.0;
const EDGE: u32 = 21;

/// A scene with what it takes to trace it.
struct Traced {
    scene: Scene,
    geometry: Geometry,
    tracer: Tracer,
}

impl Traced {
    fn new(scene: Scene) -> Self {
        let geometry = Geometry::new(&scene);
        let tracer = Tracer::new(&scene, &geometry);
        Self { scene, geometry, tracer }
    }
}

/// A picket of a fence that runs from west to east: 7 cm wide, a gap of 7 cm to the next.
fn picket(index: usize) -> Vec<[Vec3; 3]> {
    let x = -1.4 + 0.14 * index as f32;
    block(Vec3::new(x, 0.0, -0.01), Vec3::new(x + 0.07, 1.0, 0.01))
}

fn rail() -> Vec<[Vec3; 3]> {
    block(Vec3::new(-1.5, 0.6, 0.012), Vec3::new(1.5, 0.68, 0.03))
}

fn ground() -> SceneBuilder {
    SceneBuilder::new().soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
}

/// The ground, and a fence of twenty pickets and a rail in one mesh.
fn fence() -> Traced {
    let soup: Vec<[Vec3; 3]> = (0..20).flat_map(picket).chain(rail()).collect();
    Traced::new(ground().soup(&soup).build())
}

fn request() -> DayRequest {
    DayRequest::new(Some([40.0, 0.0]), Some("2026-12-21".parse().expect("a date"))).expect("a place")
}

fn path() -> SunPath {
    match day(&request()).expect("a day") {
        DayOutcome::Path(path) => path,
        DayOutcome::NoSun { .. } => unreachable!("the sun rises"),
    }
}

fn point(here: &Traced, [x, z]: [f64; 2]) -> SurfacePoint {
    let from = DVec3::new(x, 3.0, z) - here.scene.centre_m;
    let is_ground = |triangle: u32| here.geometry.instance[triangle as usize] == 0;
    let hit = here.tracer.closest_hit_where(from, &Direction::new(-DVec3::Y), is_ground).expect("the ground");
    SurfacePoint::of_triangle(&here.scene, &here.geometry, hit.triangle as usize, hit.barycentric)
}

/// Where a place on the patch lies, in texels from its first one: north of the fence, in whose shade it is at noon.
fn place(x: f64, y: f64) -> [f64; 2] {
    [-1.0 + x / DENSITY, -2.2 + y / DENSITY]
}

struct Patch {
    here: Traced,
    path: SunPath,
    tracks: PageTracks,
}

impl Patch {
    fn new() -> Self {
        let (here, path) = (fence(), path());
        let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(&path));
        let parts = Components::new(&here.scene, &here.geometry);
        let finder = OccluderFinder::new(&engine, &parts);
        let texels: Vec<u32> = (0..EDGE * EDGE).collect();
        let point = |i: u32| point(&here, place(f64::from(i % EDGE), f64::from(i / EDGE)));
        let search = SpanSearch {
            finder: &finder,
            point: &point,
            hiders: &|session, _, point| session.find(point),
            size: size(),
            walls: None,
            least_t: path.width_t(0.5) / 8.0,
        };
        let found = find_spans(&search, &texels, &Silent);
        let tracks = number_tracks(&found, &Linked { size: size(), source: &texels, is_open: &|_, _| true });
        Self { here, path, tracks }
    }

    fn seen(&self, at: DVec2, t: f64) -> f32 {
        tracked_visibility(&self.tracks, &Footprint::new(at, size()), t as f32, self.path.width_t(t) as f32)
    }

    fn lit(&self, engine: &ExactEngine, at: DVec2) -> Intervals {
        lit_at(engine, &point(&self.here, place(at.x, at.y))).swap_remove(0)
    }
}

fn size() -> PageSize {
    PageSize { width: EDGE, height: EDGE }
}

/// The share of a window that lies in intervals.
fn soft(lit: &Intervals, t: f64, width_t: f64) -> f64 {
    let window = Intervals::from_unsorted(vec![[t - 0.5 * width_t, t + 0.5 * width_t]]);
    lit.intersection(&window).lit_length() / width_t
}

fn differ(a: &Intervals, b: &Intervals) -> f64 {
    a.without(b).lit_length() + b.without(a).lit_length()
}

#[test]
fn each_part_alone_hides_what_it_hides_in_a_scene_without_the_others() {
    let (here, path) = (fence(), path());
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(&path));
    let parts = Components::new(&here.scene, &here.geometry);
    let finder = OccluderFinder::new(&engine, &parts);
    assert_eq!(parts.count, 22, "the ground, twenty pickets and a rail");
    let mut session = finder.session();
    let mut shaded = 0;
    for part in [1, 8, 15, 20, 21] {
        let soup = if part == 21 { rail() } else { picket(part - 1) };
        let only = Traced::new(ground().soup(&soup).build());
        let only_engine = ExactEngine::new(&only.tracer, std::slice::from_ref(&path));
        for k in 0..60 {
            let at = place(f64::from(k % 10) * 2.03, f64::from(k / 10) * 3.7);
            let alone = session.alone(&point(&here, at), &[part as u32]).lit.swap_remove(0);
            let expected = lit_at(&only_engine, &point(&only, at)).swap_remove(0);
            // The scenes' coordinates are rounded about different centres.
            assert!(differ(&alone, &expected) < 1e-5, "part {part} at {at:?}: {alone:?} {expected:?}");
            shaded += usize::from(alone.as_slice().len() > 1);
        }
    }
    assert!(shaded > 30, "only {shaded} answers hold a shadow");
}

#[test]
fn a_bakes_own_query_notes_the_parts_that_hide_the_sun() {
    let (here, path) = (fence(), path());
    let parts = Components::new(&here.scene, &here.geometry);
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(&path)).noting(&parts);
    let point = |k: usize| point(&here, place((k % 10) as f64 * 2.03, (k / 10) as f64 * 1.97));
    let solved = solve_visibility(&engine, 100, point, |_| true).expect("nothing stops it");
    let lit: Vec<Intervals> = solved.tables.iter().flat_map(IntervalTable::iter).collect();
    let finder = OccluderFinder::new(&engine, &parts);
    let mut session = finder.session();
    let mut hidden = 0;
    for (k, lit) in lit.iter().enumerate() {
        let alone = session.alone(&point(k), solved.hiders.of_point(k));
        let together = alone.lit.iter().fold(alone.facing.clone(), |lit, alone| lit.intersection(alone));
        assert!(differ(&together, lit) < 1e-9, "point {k}: {together:?} {lit:?}");
        hidden += usize::from(differ(&alone.facing, lit) > 0.01);
    }
    assert!(hidden > 30, "only {hidden} points are hidden from the sun");
    let silent = ExactEngine::new(&here.tracer, std::slice::from_ref(&path));
    assert!(solve_visibility(&silent, 100, point, |_| true).is_some_and(|solved| solved.hiders.is_empty()));
}

#[test]
fn all_parts_together_hide_what_the_engine_finds() {
    let (here, path) = (fence(), path());
    let engine = ExactEngine::new(&here.tracer, std::slice::from_ref(&path));
    let parts = Components::new(&here.scene, &here.geometry);
    let finder = OccluderFinder::new(&engine, &parts);
    let mut session = finder.session();
    for k in 0..100 {
        let point = point(&here, place(f64::from(k % 10) * 2.03, f64::from(k / 10) * 1.97));
        let (lit, found) = session.find(&point);
        let expected = lit_at(&engine, &point).swap_remove(0);
        assert!(differ(&lit, &expected) < 1e-12);
        let alone = session.alone(&point, &found);
        let together = alone.lit.iter().fold(alone.facing.clone(), |lit, alone| lit.intersection(alone));
        assert!(differ(&together, &expected) < 1e-9, "{found:?}: {together:?} {expected:?}");
    }
}

#[test]
fn texels_centres_show_what_they_see() {
    let patch = Patch::new();
    let engine = ExactEngine::new(&patch.here.tracer, std::slice::from_ref(&patch.path));
    let (mut worst, mut sum, mut count) = (0.0f64, 0.0, 0);
    for texel in (0..EDGE * EDGE).step_by(5) {
        let at = DVec2::new(f64::from(texel % EDGE), f64::from(texel / EDGE));
        let lit = patch.lit(&engine, at);
        for t in (0..200).map(|k| (f64::from(k) + 0.5) / 200.0) {
            let error = (f64::from(patch.seen(at, t)) - soft(&lit, t, patch.path.width_t(t))).abs();
            (worst, sum, count) = (worst.max(error), sum + error, count + 1);
        }
    }
    // Two edges within one of the parts that the sun's width is cut into hide more together than they should.
    assert!(worst < 0.13 && sum / f64::from(count) < 0.002, "{worst} at worst, {} on average", sum / f64::from(count));
}

/// B20: all day, tracks err a fraction of what filters do that know no occluders.
#[test]
fn pickets_narrower_than_texels_cast_lines() {
    let patch = Patch::new();
    let engine = ExactEngine::new(&patch.here.tracer, std::slice::from_ref(&patch.path));
    let mut encoder = PageEncoder::new((EDGE * EDGE) as usize, Bits::Sixteen, 64);
    for texel in 0..EDGE * EDGE {
        let at = DVec2::new(f64::from(texel % EDGE), f64::from(texel / EDGE));
        encoder.set(texel as usize, &patch.lit(&engine, at));
    }
    let layers = encoder.finish();
    let mut errors = [0.0f64; 3];
    let mut count = 0;
    for k in 0..1500 {
        let share = |base: f64| (f64::from(k) * base).fract();
        let at = DVec2::new(share(0.754_877_666_2), share(0.569_840_290_9)) * f64::from(EDGE - 1);
        let lit = patch.lit(&engine, at);
        let footprint = Footprint::new(at, size());
        for t in [0.3, 0.4, 0.5, 0.6, 0.7] {
            let width_t = patch.path.width_t(t);
            let truth = soft(&lit, t, width_t);
            let (time, width) = (t as f32, width_t as f32);
            let plain = footprint.blend(|texel| soft_visibility(&layers, texel, Bits::Sixteen, time, width));
            let sharp = footprint.blend(|texel| edge_sample(&layers, texel, Bits::Sixteen, time, width));
            for (error, seen) in errors.iter_mut().zip([plain, sharpened(sharp), patch.seen(at, t)]) {
                *error += (f64::from(seen) - truth).abs();
            }
            count += 1;
        }
    }
    let [plain, sharp, tracked] = errors.map(|sum| sum / f64::from(count));
    println!("mean errors: bilinear {plain:.4}, sharp {sharp:.4}, tracks {tracked:.4}");
    assert!(plain > 0.05, "the shadows are not narrow: {plain}");
    assert!(tracked < 0.3 * plain.min(sharp), "bilinear {plain}, sharp {sharp}, tracks {tracked}");
}

/// B20: behind the fence, in steps of a twentieth of the sun's width.
#[test]
fn nothing_pops_in_time_or_between_quads() {
    let patch = Patch::new();
    for k in 0..40 {
        let share = |base: f64| (f64::from(k) * base).fract();
        let at = DVec2::new(share(0.754_877_666_2), share(0.569_840_290_9)) * f64::from(EDGE - 1);
        let step_t = patch.path.width_t(0.5) / 20.0;
        let times: Vec<f64> = (0..(1.0 / step_t) as usize).map(|i| i as f64 * step_t).collect();
        for pair in times.windows(2) {
            let [before, after] = [0, 1].map(|i| patch.seen(at, pair[i]));
            assert!((before - after).abs() < 0.1, "{at} at {}: {before} to {after}", pair[0]);
        }
        // Across the line between two quads.
        for t in [0.3, 0.5, 0.7] {
            let on = DVec2::new(at.x.round().clamp(1.0, f64::from(EDGE - 2)), at.y);
            let [left, right] = [-1e-6, 1e-6].map(|off| patch.seen(on + DVec2::X * off, t));
            assert!((left - right).abs() < 1e-3, "{on} at {t}: {left} and {right}");
        }
    }
}

#[test]
fn a_bake_finds_the_same_tracks_with_one_thread_and_with_two() {
    let standard = BakeSettings::standard(SunRequest::Day(request()));
    let settings = BakeSettings { page_size_texels: 96, ambient: None, tracks: TrackChoice::Auto, ..standard };
    let baked = |threads| {
        let settings = BakeSettings { threads, ..settings.clone() };
        bake_scene(&fence().scene, &settings, &Silent).expect("a bake")
    };
    let [one, two] = [1, 2].map(baked);
    let tracks = |bake: &Bake| bake.pages.iter().map(|page| page.maps.tracks.clone()).collect::<Vec<_>>();
    assert_eq!(tracks(&one), tracks(&two));
    let found = one.manifest.stats.tracks.expect("tracks were asked for");
    assert!(found.texels > 100 && found.crowded_texels == 0, "{found:?}");
    let without = bake_scene(&fence().scene, &BakeSettings { tracks: TrackChoice::Off, ..settings.clone() }, &Silent);
    let without = without.expect("a bake");
    assert!(tracks(&without).iter().all(Option::is_none) && without.manifest.stats.tracks.is_none());
    assert_eq!(without.pages[0].maps.lanes, one.pages[0].maps.lanes, "the times are the same");
}

/// B14: of more shadows than a list holds those are merged that matter least.
#[test]
fn of_more_shadows_than_a_list_holds_the_least_are_merged() {
    let wire = |index: usize| {
        let x = -3.9 + 0.07 * index as f32;
        block(Vec3::new(x, 0.0, -0.005), Vec3::new(x + 0.02, 1.0, 0.005))
    };
    let soup: Vec<[Vec3; 3]> = (0..111).flat_map(wire).collect();
    let settings = BakeSettings {
        page_size_texels: 80,
        ambient: None,
        tracks: TrackChoice::On,
        layer_cap: 64,
        ..BakeSettings::standard(SunRequest::Day(request()))
    };
    let bake = bake_scene(&ground().soup(&soup).build(), &settings, &Silent).expect("a bake");
    let found = bake.manifest.stats.tracks.expect("tracks were asked for");
    assert!(found.crowded_texels > 100, "{found:?}");
    let (path, maps) = (path(), &bake.pages[0].maps);
    let (size, layers) = (PageSize { width: maps.width, height: maps.height }, &maps.lanes[0].layers);
    let tracks = maps.tracks.as_ref().expect("tracks were found");
    let (mut wrong, mut least, mut dark) = (0.0, 0.0, 0.0);
    for texel in 0..tracks.ranges.len() {
        // Each wire's shade lasts about as long: what no list of spans could hold follows from their number.
        let moments = || (0..4_000).map(|i| i as f32 / 4_000.0);
        let lit: Vec<bool> = moments().map(|t| hard_visibility(layers, texel, bake.bits.times, t) > 0.5).collect();
        let shadows = lit.windows(2).filter(|pair| pair[0] && !pair[1]).count();
        if shadows <= MOST_SPANS {
            continue;
        }
        assert!(tracks.of_texel(texel).len() <= MOST_SPANS);
        let at = DVec2::new((texel % size.width as usize) as f64, (texel / size.width as usize) as f64);
        let mut texel_dark = 0.0;
        for t in (1..400).map(|i| f64::from(i) / 400.0) {
            let (moment, width_t) = (t as f32, path.width_t(t) as f32);
            let seen = tracked_visibility(tracks, &Footprint::new(at, size), moment, width_t);
            let stored = soft_visibility(layers, texel, bake.bits.times, moment, width_t);
            wrong += f64::from((seen - stored).abs());
            texel_dark += f64::from(1.0 - stored);
        }
        dark += texel_dark;
        least += texel_dark * (1.0 - MOST_SPANS as f64 / shadows as f64);
    }
    let [wrong, least] = [wrong, least].map(|sum| sum / dark);
    println!("{wrong:.4} of the shade of crowded texels is wrong, about {least:.4} must be");
    assert!(wrong < 1.5 * least, "{wrong} of {least}");
}
