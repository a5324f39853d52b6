//! Hard cases of shadow tracks between two texels, from spans that are written down: B15, B20, and what they may meet.

use glam::DVec2;
use sunbake::atlas::{Footprint, PageSize};
use sunbake::tracks::{FoundSpan, FoundSpans, Linked, PageTracks, number_tracks, tracked_visibility};

/// Width of the sun in path time.
const WIDTH_T: f32 = 0.004;

/// Two texels side by side, twice, one row above the other.
struct Pair {
    tracks: PageTracks,
}

impl Pair {
    /// Spans of the left and the right texel: the occluder, and its shade in path time.
    fn new(left: &[(u32, [f64; 2])], right: &[(u32, [f64; 2])]) -> Self {
        Self::with_way(left, right, true)
    }

    fn with_way(left: &[(u32, [f64; 2])], right: &[(u32, [f64; 2])], is_open: bool) -> Self {
        let mut found = FoundSpans::default();
        for spans in [left, right, left, right] {
            found.push(spans.iter().map(|&(part, shade)| FoundSpan::new(part, shade)));
        }
        let is_way_open = |_: usize, way: usize| is_open || way == 1;
        Self { tracks: number_tracks(&found, &Linked { size: SIZE, source: &[0, 1, 2, 3], is_open: &is_way_open }) }
    }

    /// What is seen from 0 at the left texel's centre to 1 at the right one's.
    fn seen(&self, x: f64, t: f64) -> f32 {
        tracked_visibility(&self.tracks, &Footprint::new(DVec2::new(x, 0.5), SIZE), t as f32, WIDTH_T)
    }

    /// When it is darker than half there, in thousandths of the path.
    fn dark(&self, x: f64) -> Vec<u32> {
        (0..=1000).filter(|&t| self.seen(x, f64::from(t) / 1000.0) < 0.5).collect()
    }
}

const SIZE: PageSize = PageSize { width: 2, height: 2 };

fn thousandths(spans: &[[u32; 2]]) -> Vec<u32> {
    spans.iter().flat_map(|&[start, end]| start..=end).collect()
}

/// B20: the shadow of a post that moves by more than it is wide is in between, once.
#[test]
fn a_shadow_between_texels_is_midway_in_time() {
    let pair = Pair::new(&[(3, [0.2995, 0.3205])], &[(3, [0.4995, 0.5205])]);
    assert_eq!(pair.dark(0.0), thousandths(&[[300, 320]]));
    assert_eq!(pair.dark(0.5), thousandths(&[[400, 420]]));
    assert_eq!(pair.dark(1.0), thousandths(&[[500, 520]]));
}

/// B20: where two shadows cross, each goes its own way.
#[test]
fn shadows_that_cross_in_time_pass_through_each_other() {
    let pair =
        Pair::new(&[(1, [0.2995, 0.3205]), (2, [0.3995, 0.4205])], &[(1, [0.3995, 0.4205]), (2, [0.2995, 0.3205])]);
    assert_eq!(pair.dark(0.2), thousandths(&[[320, 340], [380, 400]]));
    assert_eq!(pair.dark(0.5), thousandths(&[[350, 370]]));
    assert_eq!(pair.dark(0.8), thousandths(&[[320, 340], [380, 400]]));
}

/// B20: what hides the sun three times a day does so between texels.
#[test]
fn an_occluder_that_returns_keeps_its_times_apart() {
    let shade = |shift: f64| [0.1995, 0.4995, 0.7995].map(|t| (9, [t + shift, t + shift + 0.021]));
    let pair = Pair::new(&shade(0.0), &shade(0.06));
    assert_eq!(pair.dark(0.5), thousandths(&[[230, 250], [530, 550], [830, 850]]));
    // Of two and three those match whose times do.
    let pair = Pair::new(&shade(0.0), &shade(0.06)[1..]);
    assert_eq!(pair.dark(0.5)[..42], thousandths(&[[530, 550], [830, 850]]));
}

/// B20: an occluder that only one texel knows fades with that texel's weight; one that enters does not jump.
#[test]
fn an_occluder_that_enters_fades_in() {
    let always = (1, [0.6, 0.7]);
    let pair = Pair::new(&[always, (5, [0.3, 0.4])], &[always]);
    for step in 0..=20 {
        let x = f64::from(step) / 20.0;
        assert!((f64::from(pair.seen(x, 0.35)) - x).abs() < 1e-4, "at {x}: {}", pair.seen(x, 0.35));
        assert_eq!(pair.seen(x, 0.65), 0.0);
        assert!((pair.seen(x, 0.2) - 1.0).abs() < 1e-4);
    }
}

/// B20: a texel with twenty spans beside one that sees the sun all day.
#[test]
fn a_texel_without_spans_meets_one_with_twenty() {
    let many: Vec<(u32, [f64; 2])> =
        (0..20).map(|k| (k, [0.04 * f64::from(k) + 0.1, 0.04 * f64::from(k) + 0.12])).collect();
    let pair = Pair::new(&many, &[]);
    for (_, [start, end]) in &many {
        let t = 0.5 * (start + end);
        assert!(pair.seen(0.0, t) < 1e-4 && pair.seen(1.0, t) > 0.9999);
        let mut before = pair.seen(0.0, t);
        for step in 1..=100 {
            let seen = pair.seen(f64::from(step) / 100.0, t);
            assert!((before - 1e-5..before + 0.05).contains(&seen), "{before} to {seen} at {step}");
            before = seen;
        }
    }
}

/// B15: shade from the path's start and up to its end, and a sun that is half up.
#[test]
fn shade_at_the_paths_ends_is_blended_as_any_other() {
    let pair = Pair::new(&[(1, [0.0, 0.1]), (2, [0.9, 1.0])], &[(1, [0.0, 0.2]), (2, [0.8, 1.0])]);
    for (t, expected) in [(0.0, 0.0), (0.149, 0.25), (0.15, 0.5), (0.1525, 1.0), (0.5, 1.0), (0.85, 0.5), (1.0, 0.0)] {
        let seen = pair.seen(0.5, t);
        assert!((seen - expected).abs() < 0.01, "at {t}: {seen}");
    }
    let pair = Pair::new(&[(1, [0.5, 0.6])], &[(1, [0.5, 0.6])]);
    for (t, expected) in [(0.0, 0.5), (0.001, 0.75), (0.003, 1.0), (0.999, 0.75), (1.0, 0.5)] {
        assert!((pair.seen(0.5, t) - expected).abs() < 0.01, "at {t}: {}", pair.seen(0.5, t));
    }
}

/// B20: across a cut, one occluder's times are two tracks, and neither is midway.
#[test]
fn times_are_not_blended_across_a_cut() {
    let spans = |start: f64| [(3, [start, start + 0.021])];
    let pair = Pair::with_way(&spans(0.2995), &spans(0.4995), false);
    for (t, expected) in [(0.31, 0.5), (0.41, 1.0), (0.51, 0.5)] {
        assert!((pair.seen(0.5, t) - expected).abs() < 1e-3, "at {t}: {}", pair.seen(0.5, t));
    }
}

/// B20: however many tracks end at once, a twentieth of the sun's width changes no more than a twelfth of the light.
#[test]
fn tracks_that_end_together_do_not_pop() {
    let many: Vec<(u32, [f64; 2])> = (0..30).map(|part| (part, [0.3, 0.5])).collect();
    let pair = Pair::new(&many, &many);
    let step = f64::from(WIDTH_T) / 20.0;
    let times = (0..(0.02 / step) as u32).map(|i| 0.49 + f64::from(i) * step);
    let seen: Vec<f32> = times.map(|t| pair.seen(0.3, t)).collect();
    let largest = seen.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(seen[0] < 1e-4 && seen[seen.len() - 1] > 0.9999);
    assert!((0.05..0.09).contains(&largest), "{largest}");
}
