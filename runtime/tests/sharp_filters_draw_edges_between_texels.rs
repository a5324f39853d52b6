//! The sharp filter against closed forms: edges of shadows whose times change from texel to texel as they do on a
//! plane.

use glam::{Vec2, Vec3};
use std::f32::consts::TAU;
use sunbake::maps::{Bits, Lane, LaneMaps, LayerMaps, PageMaps, soft_visibility};
use sunbake::testing::pseudo_random;
use sunbake_runtime::playback::Page;
use sunbake_runtime::{Filter, Moment};

const EDGE: usize = 16;
const RADIUS_RAD: f64 = 0.0047;
/// The light's width in path time.
const WIDTH_T: f32 = 0.005;
const MAX_CODE: f32 = 65_535.0;

/// A page from what each texel sees, as times.
fn page(lit: impl Fn(usize, usize) -> Vec<[f32; 2]>) -> PageMaps {
    let (mut rise, mut fall) = (Vec::new(), Vec::new());
    for (y, x) in (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| (y, x))) {
        let mut slots = ([MAX_CODE as u16; 4], [0; 4]);
        for (slot, [start, end]) in lit(x, y).into_iter().enumerate() {
            (slots.0[slot], slots.1[slot]) = ((start * MAX_CODE).round() as u16, (end * MAX_CODE).round() as u16);
        }
        rise.push(slots.0);
        fall.push(slots.1);
    }
    let lanes = vec![LaneMaps { lane: Lane::CENTRE, layers: vec![LayerMaps { rise, fall }] }];
    PageMaps { width: EDGE as u32, height: EDGE as u32, lanes, lamp: None, ambient: None, walls: None, tracks: None }
}

fn seen(maps: &PageMaps, place: Vec2, filter: Filter, t: f32) -> f32 {
    let page = Page::new(maps, Bits::Sixteen, RADIUS_RAD);
    let moment = Moment {
        t,
        width_t: WIDTH_T,
        sun_direction: Vec3::Y,
        sun_radius_rad: RADIUS_RAD as f32,
        inverse_angular_diameter: (0.5 / RADIUS_RAD) as f32,
        ..Moment::new(None, 0.5)
    };
    page.sun_visibility((place + 0.5) / EDGE as f32, Vec3::Y, filter, &moment)
}

/// Mean and largest error of a filter, where the times of edges are known at every place. Half a texel at the rim is
/// left out, where a page has no neighbour to blend with.
fn errors(maps: &PageMaps, filter: Filter, truth: impl Fn(Vec2, f32) -> f32) -> [f32; 2] {
    let (mut sum, mut most, mut count) = (0.0, 0.0f32, 0);
    for step in 0..200 {
        let t = 0.2 + 0.6 * step as f32 / 200.0;
        for k in 0..400 {
            let place = Vec2::new(k as f32 * 0.618_034, k as f32 * 0.754_877_7).fract() * (EDGE - 1) as f32;
            let off = (seen(maps, place, filter, t) - truth(place, t)).abs();
            (sum, most, count) = (sum + off, most.max(off), count + 1);
        }
    }
    [sum / count as f32, most]
}

fn ramp(since_edge_t: f32) -> f32 {
    (0.5 + since_edge_t / WIDTH_T).clamp(0.0, 1.0)
}

#[test]
fn an_edge_between_texels_is_where_it_is_on_the_plane() {
    // A step of time between texels of 3 and 6 times the light's width: bilinear filters show stairs.
    let fall = |place: Vec2| 0.25 + place.x * 0.015 + place.y * 0.0075;
    let maps = page(|x, y| vec![[0.0, fall(Vec2::new(x as f32, y as f32))]]);
    let truth = |place: Vec2, t: f32| ramp(fall(place) - t);
    let [sharp, worst_of_sharp] = errors(&maps, Filter::Sharp, truth);
    let [bilinear, worst_of_bilinear] = errors(&maps, Filter::Bilinear, truth);
    // Times are rounded to codes: 1/131070 of the path, 0.0015 widths.
    assert!(worst_of_sharp < 0.004, "{worst_of_sharp}");
    assert!(worst_of_bilinear > 0.5 && bilinear > 50.0 * sharp, "{bilinear} {sharp}");
}

#[test]
fn a_shadow_wider_than_a_texel_keeps_its_width() {
    // Passing over each texel for 0.08, and from one to the next in 0.03.
    let start = |place: Vec2| 0.3 + place.x * 0.03;
    let maps = page(|x, y| {
        let start = start(Vec2::new(x as f32, y as f32));
        vec![[0.0, start], [start + 0.08, 1.0]]
    });
    let truth = |place: Vec2, t: f32| ramp(start(place) - t) + ramp(t - start(place) - 0.08);
    let [sharp, worst_of_sharp] = errors(&maps, Filter::Sharp, truth);
    let [bilinear, _] = errors(&maps, Filter::Bilinear, truth);
    assert!(worst_of_sharp < 0.005 && bilinear > 50.0 * sharp, "{worst_of_sharp} {bilinear} {sharp}");
}

/// Intervals without any order from texel to texel.
fn noise() -> PageMaps {
    let mut state = 5;
    let mut lists: Vec<Vec<[f32; 2]>> = Vec::new();
    for _ in 0..EDGE * EDGE {
        let mut edges: Vec<f32> = (0..8).map(|_| pseudo_random(&mut state) as f32).collect();
        edges.sort_by(f32::total_cmp);
        let count = (pseudo_random(&mut state) * 5.0) as usize;
        lists.push(edges.chunks(2).take(count).map(|pair| [pair[0], pair[1]]).collect());
    }
    page(|x, y| lists[y * EDGE + x].clone())
}

#[test]
fn texel_centres_keep_what_they_see() {
    let maps = noise();
    for (y, x) in (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| (y, x))) {
        for t in (0..60).map(|i| (i as f32 + 0.5) / 60.0) {
            let stored = soft_visibility(&maps.lanes[0].layers, y * EDGE + x, Bits::Sixteen, t, WIDTH_T);
            let sharp = seen(&maps, Vec2::new(x as f32, y as f32), Filter::Sharp, t);
            assert!((sharp - stored).abs() < 1e-4, "({x}, {y}) at {t}: {sharp}, stored {stored}");
        }
    }
}

#[test]
fn nothing_pops_in_time_or_from_quad_to_quad() {
    let maps = noise();
    let step = WIDTH_T / 20.0;
    let place = |k: usize| Vec2::new(k as f32 * 0.618_034, k as f32 * 0.754_877_7).fract() * (EDGE - 1) as f32;
    for k in 0..60 {
        let mut before = seen(&maps, place(k), Filter::Sharp, 0.1);
        for i in 1..3000 {
            let now = seen(&maps, place(k), Filter::Sharp, 0.1 + i as f32 * step);
            assert!((now - before).abs() <= 0.1, "{} at step {i}: {before}, then {now}", place(k));
            before = now;
        }
        // Across a column of texel centres.
        let column = place(k).x.round();
        for t in [0.3, 0.4, 0.5, 0.6] {
            let [left, right] = [-1e-4, 1e-4].map(|off| {
                seen(&maps, Vec2::new((column + off).clamp(0.0, (EDGE - 1) as f32), place(k).y), Filter::Sharp, t)
            });
            assert!((left - right).abs() < 0.03, "column {column} at {t}: {left} and {right}");
        }
    }
}

#[test]
fn light_and_shade_without_an_edge_stay_what_they_are() {
    // A texel that always sees the sun beside one that never does has no edge in time: it is blended.
    let maps = page(|x, _| if x < EDGE / 2 { Vec::new() } else { vec![[0.0, 1.0]] });
    for k in 0..200 {
        let turn = TAU * k as f32 / 200.0;
        let place = Vec2::new(7.5 + 7.0 * turn.cos(), 7.5 + 7.0 * turn.sin());
        let [sharp, bilinear] = [Filter::Sharp, Filter::Bilinear].map(|filter| seen(&maps, place, filter, 0.5));
        let is_between = (7.0..8.0).contains(&place.x);
        let is_whole = sharp.min((1.0 - sharp).abs()) < 1e-5 && (sharp - bilinear).abs() < 1e-5;
        assert!(is_between || is_whole, "{place}: {sharp}, {bilinear}");
        assert!((0.0..=1.0).contains(&sharp));
    }
}
