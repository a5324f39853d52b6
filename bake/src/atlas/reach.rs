//! Filtering beside walls: of the four texels around a point, those count that lie on the point's own side.
//!
//! Theory: a bilinear filter blends texels inside a room with texels outside, where the floor runs on under the wall.
//! What stands between two neighbouring texels is known to the baker ([`super::walls`]), so a filter can leave out
//! texels that the point does not reach.
//!
//! Practice: a *wall code* says what stands on the way from a texel's point to its neighbour's: nothing ([`OPEN`]), a
//! wall at one of [`PLACES`] places, or two surfaces at least a quarter of the way apart (a thick wall, or the corner
//! of a room), to an eighth of the way. Within the wall the darkest of the four texels counts. A footprint has four
//! such ways: its edges. Walls are taken to be straight within it. Where the baker found another shape, a code has a
//! mark ([`marked`]): the left edge's where a filter can still tell sides (a corner along rows and columns; a straight
//! wall beside an open edge), the upper edge's where it cannot, both for a corner at another angle.
//!
//! * No edge has a wall: plain weights.
//! * Two opposite edges have one: it runs across, and the two texels on the point's side remain.
//! * Two edges that meet have one: it cuts off the texel between them. On its side of the wall that texel counts
//!   alone, on the other side the other three. Where it turns a corner along rows and columns, that texel's side is the
//!   rectangle between it and the two places where the wall meets the edges. At an angle all that is known is that the
//!   wall lies within the circle around them (Thales' circle: a right angle lies on it): within that the darkest of the
//!   four counts, outside the other three.
//! * One edge has one: the wall ends within the footprint. On that edge one texel counts, on the opposite edge both do,
//!   and in between they are blended. Between two walls that are well apart it is dark: a corner of a room narrower
//!   than a texel.
//! * Three edges have one, and beside the open edge the wall runs straight: that edge's two texels on their side.
//! * Else the darkest of the four counts. Light never leaks; shade may, by a part of a texel.
//!
//! Twin: `shaders/src/wgsl/baked/blend_beside_walls.wgsl`.

/// The code of a way with nothing on it.
pub const OPEN: u8 = 0xFF;

/// The same with a mark.
const OPEN_MARKED: u8 = 0xFE;

/// Codes from here on, up to the open ones, have a mark; without it, they are less by this number.
const MARKED: u8 = 127;

/// Places where a wall may stand, from the first texel of a way to the second.
const PLACES: u8 = 96;

/// Half the width of a wall at a place: rounding, and what a straight wall may be off.
const HALF_WIDTH: f32 = 1.0 / 64.0;

/// What a wall may be off the place or the line that filters take it to be at, as a share of the way.
pub const MOST_OFF: f64 = 1.0 / 512.0;

/// From which end of a way one sees into a solid, or a room without inner faces: nobody looks from there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HiddenEnd {
    /// From neither, or both.
    None,
    /// From the first.
    First,
    /// From the second.
    Second,
}

/// Steps of the way, and the fewest between two surfaces that are apart. There are 28 such pairs.
const STEPS: u8 = 8;
const APART: u8 = 2;

/// How the four texels of a footprint count: upper left, upper right, lower left, lower right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Weights that add up to one, or to zero where it is dark.
    pub weights: [f32; 4],
    /// Instead of the weights: the least of the four values.
    pub takes_darkest: bool,
}

/// The code of a way on which the first surface stands at these shares of it, 0 to 1, seen from the first end and from
/// the second. Within a wall's width filters take the darkest texel. It lies on the hidden side, if there is one: there
/// is no dark line on the other.
pub fn wall_code(from_first: f64, from_second: f64, hidden: HiddenEnd) -> u8 {
    let (near, far) = (from_first.clamp(0.0, 1.0), 1.0 - from_second.clamp(0.0, 1.0));
    if (far - near) * f64::from(STEPS) < f64::from(APART) {
        let spare = f64::from(HALF_WIDTH) - MOST_OFF;
        let place = |share: f64| (share * f64::from(PLACES - 1)).clamp(0.0, f64::from(PLACES - 1));
        return match hidden {
            HiddenEnd::None => place((near + far) * 0.5).round(),
            HiddenEnd::First => place(far - spare).ceil(),
            HiddenEnd::Second => place(near + spare).floor(),
        } as u8;
    }
    let near = (near * f64::from(STEPS)).floor() as u8;
    let far = ((far * f64::from(STEPS)).ceil() as u8).min(STEPS);
    PLACES + pairs_before(near) + (far - near - APART)
}

/// Pairs of surfaces of which the first stands before this step.
fn pairs_before(near: u8) -> u8 {
    (0..near).map(|before| STEPS - APART + 1 - before).sum()
}

/// A code with a mark about the walls within the footprint below and to the right of its way. On the way to the right:
/// they are bent. On the way down: they turn a corner around the texel that they cut off, or run straight beside the
/// only open edge. On both: a corner at an angle.
pub fn marked(code: u8) -> u8 {
    if code == OPEN { OPEN_MARKED } else { code + MARKED }
}

/// Whether nothing stands on a way.
pub fn is_open(code: u8) -> bool {
    unmarked(code) == OPEN
}

fn is_marked(code: u8) -> bool {
    code != OPEN && code >= MARKED
}

/// A code without its mark.
fn unmarked(code: u8) -> u8 {
    match code {
        OPEN_MARKED => OPEN,
        code if is_marked(code) => code - MARKED,
        code => code,
    }
}

/// Where the walls on an edge begin and end, from its first texel.
#[derive(Clone, Copy)]
struct Edge {
    has_wall: bool,
    near: f32,
    far: f32,
}

impl Edge {
    fn new(code: u8) -> Self {
        let code = unmarked(code);
        if code < PLACES {
            let place = f32::from(code) / f32::from(PLACES - 1);
            let (near, far) = ((place - HALF_WIDTH).max(0.0), (place + HALF_WIDTH).min(1.0));
            return Self { has_wall: true, near, far };
        }
        let mut pair = code - PLACES;
        let mut near = 0;
        while near + APART < STEPS && pair > STEPS - APART - near {
            pair -= STEPS - APART + 1 - near;
            near += 1;
        }
        let share = |step: u8| f32::from(step) / f32::from(STEPS);
        Self { has_wall: code != OPEN, near: share(near), far: share(near + APART + pair.min(STEPS)) }
    }

    /// The same, from its second texel.
    fn turned(self) -> Self {
        Self { near: 1.0 - self.far, far: 1.0 - self.near, ..self }
    }

    /// Between two opposite edges.
    fn between(self, other: Self, share: f32) -> Self {
        let mix = |a: f32, b: f32| a * (1.0 - share) + b * share;
        Self { has_wall: true, near: mix(self.near, other.near), far: mix(self.far, other.far) }
    }

    /// The weights of the texels before and behind the wall at a point of the edge: one at most is not zero.
    fn sides(self, at: f32) -> [f32; 2] {
        [if at < self.near { 1.0 } else { 0.0 }, if at > self.far { 1.0 } else { 0.0 }]
    }
}

impl Reach {
    /// Without walls.
    pub fn plain([x, y]: [f32; 2]) -> Self {
        Self::of([(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y])
    }

    fn of(weights: [f32; 4]) -> Self {
        Self { weights, takes_darkest: false }
    }

    fn darkest() -> Self {
        Self { weights: [0.25; 4], takes_darkest: true }
    }

    /// With walls on the upper, lower, left and right edge. `at` is the point's place between the texels, 0 to 1.
    pub fn new(at @ [x, y]: [f32; 2], codes: [u8; 4]) -> Self {
        let [top, bottom, left, right] = codes.map(Edge::new);
        let cut_off = match [is_marked(codes[0]), is_marked(codes[2])] {
            [false, false] => cut_off,
            [false, true] => cut_off_by_square,
            [true, true] => cut_off_by_circle,
            [true, false] => return Self::darkest(),
        };
        match [top, bottom, left, right].map(|edge| edge.has_wall) {
            [false, false, false, false] => Self::plain(at),
            [true, true, false, false] => {
                let [l, r] = top.between(bottom, y).sides(x);
                if l + r == 0.0 { Self::darkest() } else { Self::of([l * (1.0 - y), r * (1.0 - y), l * y, r * y]) }
            }
            [false, false, true, true] => {
                let [u, d] = left.between(right, x).sides(y);
                if u + d == 0.0 { Self::darkest() } else { Self::of([u * (1.0 - x), u * x, d * (1.0 - x), d * x]) }
            }
            [true, false, true, false] => cut_off(at, 0, top, left, [x, y]),
            [true, false, false, true] => cut_off(at, 1, top.turned(), right, [1.0 - x, y]),
            [false, true, true, false] => cut_off(at, 2, bottom, left.turned(), [x, 1.0 - y]),
            [false, true, false, true] => cut_off(at, 3, bottom.turned(), right.turned(), [1.0 - x, 1.0 - y]),
            [true, false, false, false] => at_wall_end(at, top, x, y, [0, 1]),
            [false, true, false, false] => at_wall_end(at, bottom, x, 1.0 - y, [2, 3]),
            [false, false, true, false] => at_wall_end(at, left, y, x, [0, 2]),
            [false, false, false, true] => at_wall_end(at, right, y, 1.0 - x, [1, 3]),
            _ if !is_marked(codes[2]) => Self::darkest(),
            [false, true, true, true] => beside_open_edge(left.between(right, x).sides(y)[0], [0, 1], x),
            [true, false, true, true] => beside_open_edge(left.between(right, x).sides(y)[1], [2, 3], x),
            [true, true, false, true] => beside_open_edge(top.between(bottom, y).sides(x)[0], [0, 2], y),
            [true, true, true, false] => beside_open_edge(top.between(bottom, y).sides(x)[1], [1, 3], y),
            [true, true, true, true] => Self::darkest(),
        }
    }
}

/// Where only one edge has a wall: `along` that edge, and `away` from it; `ends` are the edge's texels. The edge's own
/// blend is a step; the opposite edge's is plain.
fn at_wall_end(at: [f32; 2], edge: Edge, along: f32, away: f32, ends: [usize; 2]) -> Reach {
    let [before, behind] = edge.sides(along);
    if before + behind == 0.0 {
        let apart = edge.far - edge.near;
        let is_corner = apart > 4.0 * HALF_WIDTH && away < apart;
        return if is_corner { Reach::of([0.0; 4]) } else { Reach::darkest() };
    }
    let mut weights = Reach::plain(at).weights;
    weights[ends[0]] = (1.0 - away) * before;
    weights[ends[1]] = (1.0 - away) * behind;
    Reach::of(weights)
}

/// Where a wall cuts one texel off: `level` and `upright` are the edges that meet in it, and `u`, `v` the point's place
/// seen from it.
fn cut_off(at: [f32; 2], texel: usize, level: Edge, upright: Edge, [u, v]: [f32; 2]) -> Reach {
    if u * upright.near + v * level.near < level.near * upright.near {
        return Reach::of(only(texel));
    }
    if u * upright.far + v * level.far > level.far * upright.far {
        return Reach::of(without(at, texel));
    }
    Reach::darkest()
}

/// Where only one edge has no wall: `is_there` is 1 on that edge's side of the wall, `ends` are its texels, and `along`
/// is the place along it.
fn beside_open_edge(is_there: f32, ends: [usize; 2], along: f32) -> Reach {
    if is_there == 0.0 {
        return Reach::darkest();
    }
    let mut weights = [0.0; 4];
    (weights[ends[0]], weights[ends[1]]) = (1.0 - along, along);
    Reach::of(weights)
}

/// As [`cut_off`], where the wall turns a corner along rows and columns.
fn cut_off_by_square(at: [f32; 2], texel: usize, level: Edge, upright: Edge, [u, v]: [f32; 2]) -> Reach {
    if u < level.near && v < upright.near {
        return Reach::of(only(texel));
    }
    if u > level.far || v > upright.far {
        return Reach::of(without(at, texel));
    }
    Reach::darkest()
}

/// The same where it turns one at another angle.
fn cut_off_by_circle(at: [f32; 2], texel: usize, level: Edge, upright: Edge, [u, v]: [f32; 2]) -> Reach {
    if u * u + v * v <= u * level.far + v * upright.far {
        return Reach::darkest();
    }
    Reach::of(without(at, texel))
}

fn only(texel: usize) -> [f32; 4] {
    [0, 1, 2, 3].map(|other| if other == texel { 1.0 } else { 0.0 })
}

/// Plain weights of all texels but one.
fn without(at: [f32; 2], texel: usize) -> [f32; 4] {
    let mut weights = Reach::plain(at).weights;
    weights[texel] = 0.0;
    let sum: f32 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside_only(reach: Reach, inside: [bool; 4]) -> bool {
        let lit = inside.map(|is_inside| if is_inside { 0.0 } else { 1.0 });
        let blended: f32 = reach.weights.iter().zip(lit).map(|(w, v)| w * v).sum();
        let darkest = lit.into_iter().fold(1.0, f32::min);
        (if reach.takes_darkest { darkest } else { blended }) == 0.0
    }

    #[test]
    fn without_walls_it_is_a_bilinear_filter() {
        assert_eq!(Reach::new([0.25, 0.5], [OPEN; 4]).weights, [0.375, 0.125, 0.375, 0.125]);
    }

    /// A straight line through the footprint at every angle and place, as a thin sheet and as a thick wall: what is on
    /// its one side takes no light from the other, and points of either side read something.
    #[test]
    fn no_light_passes_a_straight_wall() {
        for (step, thickness) in [(0, 0.0), (1, 0.05), (2, 0.3)] {
            for angle in (0..360).step_by(7) {
                let (sin, cos) = (f64::from(angle) + 0.3 * f64::from(step)).to_radians().sin_cos();
                for offset in [0.05, 0.2, 0.45, 0.6, 0.9, 1.1] {
                    let depth = |x: f64, y: f64| x * cos + y * sin - offset;
                    let corner = |k: usize| depth((k % 2) as f64, (k / 2) as f64);
                    if (0..4).any(|k| corner(k).abs() < 1e-3 || (-thickness..=0.0).contains(&corner(k))) {
                        continue;
                    }
                    let is_inside = |depth: f64| depth < -thickness;
                    let code = |a: usize, b: usize| match is_inside(corner(a)) == is_inside(corner(b)) {
                        true => OPEN,
                        false => {
                            let crossing = |depth: f64| (corner(a) - depth) / (corner(a) - corner(b));
                            let [near, far] = [crossing(0.0), crossing(-thickness)];
                            wall_code(near.min(far), 1.0 - near.max(far), HiddenEnd::None)
                        }
                    };
                    let codes = [code(0, 1), code(2, 3), code(0, 2), code(1, 3)];
                    let inside = [0, 1, 2, 3].map(|k| is_inside(corner(k)));
                    for i in 0..=40 {
                        for j in 0..=40 {
                            let (x, y) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
                            let reach = Reach::new([x as f32, y as f32], codes);
                            if is_inside(depth(x, y)) {
                                let said = format!("{angle} {offset} at {x}, {y}: {reach:?} {codes:?}");
                                assert!(inside_only(reach, inside), "{said}");
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn codes_hold_the_walls_they_were_made_of() {
        for i in 0..=40 {
            for j in 0..=40 - i {
                let [near, from_second] = [i, j].map(|k| f64::from(k) / 40.0);
                let code = wall_code(near, from_second, HiddenEnd::None);
                assert!(code < MARKED && !is_open(code), "{near} {from_second}: {code}");
                let (plain, bent) = (Edge::new(code), Edge::new(marked(code)));
                assert!(is_marked(marked(code)) && !is_marked(code));
                assert_eq!((plain.near, plain.far), (bent.near, bent.far), "{near} {from_second}");
                let (near, far) = (near as f32, 1.0 - from_second as f32);
                // A quarter itself may be taken either way.
                if i + j > 30 {
                    let middle = 0.5 * (near + far);
                    let [low, high] = [(middle - 0.01).max(0.0), (middle + 0.01).min(1.0)];
                    assert!(plain.near <= low && plain.far >= high, "{near} {far}");
                } else if i + j < 30 {
                    assert!(plain.near <= near && plain.far >= far, "{near} {far}: {} {}", plain.near, plain.far);
                    assert!(plain.near > near - 0.13 && plain.far < far + 0.13, "{near} {far}");
                }
            }
        }
        assert!(is_marked(marked(OPEN)) && is_open(marked(OPEN)) && !is_marked(OPEN) && is_open(OPEN));
        assert!(Reach::new([0.5, 0.5], [marked(OPEN), OPEN, OPEN, OPEN]).takes_darkest);
        for edge in 1..4 {
            let codes = [0, 1, 2, 3].map(|k| if k == edge { marked(OPEN) } else { OPEN });
            assert!(!Reach::new([0.5, 0.5], codes).takes_darkest);
        }
    }

    /// Corners of a right angle around each of the four texels, turned and moved: no light passes, and what is darkest
    /// for want of knowledge lies within the rectangle or the circle.
    #[test]
    fn no_light_passes_a_corner_and_little_beside_it_is_dark() {
        let (mut dark, mut footprints) = ([0; 2], [0; 2]);
        for degrees in (-80..=80).step_by(5) {
            let [level, upright] =
                [0.0, 90.0].map(|more: f64| (f64::from(degrees) / 2.0 + more).to_radians().sin_cos());
            for (x, y) in (1..10).flat_map(|x| (1..10).map(move |y| (f64::from(x) / 10.0, f64::from(y) / 10.0))) {
                // Inside is where both of these are below 0.
                let depths = |u: f64, v: f64| [level, upright].map(|(sin, cos)| (u - x) * cos + (v - y) * sin);
                let is_inside = |u: f64, v: f64| depths(u, v).iter().all(|depth| *depth < 0.0);
                if !is_inside(0.0, 0.0) || is_inside(1.0, 0.0) || is_inside(0.0, 1.0) || is_inside(1.0, 1.0) {
                    continue;
                }
                let leaves =
                    |u: f64, v: f64| (0..=2000).map(|i| f64::from(i) / 2000.0).find(|s| !is_inside(s * u, s * v));
                let [p, q] = [leaves(1.0, 0.0), leaves(0.0, 1.0)].map(|place| place.unwrap_or(1.0));
                let is_round = x > p + 1e-3 || y > q + 1e-3;
                for texel in 0..4 {
                    let [flips_x, flips_y] = [texel % 2 == 1, texel / 2 == 1];
                    let [p, q] = [wall_code_from(p, flips_x), wall_code_from(q, flips_y)];
                    let [upper, lower] = if flips_y { [OPEN, p] } else { [p, OPEN] };
                    let upper = if is_round { marked(upper) } else { upper };
                    let sides = if flips_x { [marked(OPEN), q] } else { [marked(q), OPEN] };
                    let inside = [0, 1, 2, 3].map(|k| k == texel);
                    footprints[usize::from(is_round)] += 1;
                    for (u, v) in
                        (0..=20).flat_map(|u| (0..=20).map(move |v| (f64::from(u) / 20.0, f64::from(v) / 20.0)))
                    {
                        let flip = |place: f64, flips: bool| if flips { 1.0 - place } else { place };
                        let at = [flip(u, flips_x) as f32, flip(v, flips_y) as f32];
                        let reach = Reach::new(at, [upper, lower, sides[0], sides[1]]);
                        if is_inside(u, v) {
                            assert!(inside_only(reach, inside), "{degrees} {x} {y} at {u} {v}: {reach:?}");
                        } else {
                            dark[usize::from(is_round)] += usize::from(reach.takes_darkest);
                        }
                    }
                }
            }
        }
        let mean_texels = [0, 1].map(|shape: usize| dark[shape] as f64 / f64::from(footprints[shape] * 21 * 21));
        assert!(mean_texels[0] < 0.03 && mean_texels[1] < 0.2, "texels outside that are dark: {mean_texels:?}");
    }

    #[test]
    fn beside_an_open_edge_its_two_texels_count() {
        let [middle, any] = [wall_code(0.5, 0.5, HiddenEnd::None), wall_code(0.2, 0.7, HiddenEnd::None)];
        for open in 0..4 {
            let mut codes = [any; 4];
            (codes[if open < 2 { 2 } else { 0 }], codes[if open < 2 { 3 } else { 1 }]) = (middle, middle);
            codes[open] = OPEN;
            codes[2] = marked(codes[2]);
            let at = |depth: f32| [[0.25, depth], [0.25, 1.0 - depth], [depth, 0.25], [1.0 - depth, 0.25]][open];
            let reach = Reach::new(at(0.3), codes);
            let ends = [[0, 1], [2, 3], [0, 2], [1, 3]][open];
            assert!(
                !reach.takes_darkest && ends.map(|texel| reach.weights[texel]) == [0.75, 0.25],
                "{open}: {reach:?}"
            );
            assert!(Reach::new(at(0.6), codes).takes_darkest);
            codes[2] = unmarked(codes[2]);
            assert!(Reach::new(at(0.3), codes).takes_darkest);
        }
    }

    #[test]
    fn the_width_of_a_wall_lies_on_its_hidden_side() {
        for place in (0..=1000).map(|i| f64::from(i) / 1000.0) {
            let edge = |hidden| Edge::new(wall_code(place, 1.0 - place, hidden));
            let [first, second] = [HiddenEnd::First, HiddenEnd::Second].map(edge);
            let [beyond, before] = [f64::from(first.far) - place, place - f64::from(second.near)];
            for (visible, width) in [(beyond, first.far - first.near), (before, second.far - second.near)] {
                let at_end = width < 2.0 * HALF_WIDTH - 1e-6;
                assert!(visible >= 0.0 && (at_end || visible <= MOST_OFF + 1.0 / 95.0), "{place}: {visible}");
            }
        }
    }

    fn wall_code_from(place: f64, is_turned: bool) -> u8 {
        let place = if is_turned { 1.0 - place } else { place };
        wall_code(place, 1.0 - place, HiddenEnd::None)
    }

    #[test]
    fn neighbouring_footprints_agree_on_their_common_edge() {
        // The lower edge of one is the upper of the next, whatever the other edges have.
        for code in [OPEN, wall_code(0.3, 0.6, HiddenEnd::None), wall_code(0.0, 0.9, HiddenEnd::None)] {
            for upper in [
                [OPEN; 3],
                [wall_code(0.4, 0.5, HiddenEnd::None), OPEN, OPEN],
                [OPEN, OPEN, wall_code(0.2, 0.7, HiddenEnd::None)],
            ] {
                for lower in [
                    [OPEN; 3],
                    [wall_code(0.9, 0.05, HiddenEnd::None), OPEN, OPEN],
                    [OPEN, wall_code(0.5, 0.4, HiddenEnd::None), OPEN],
                ] {
                    for i in 0..=20 {
                        let x = i as f32 / 20.0;
                        let above = Reach::new([x, 1.0], [upper[0], code, upper[1], upper[2]]);
                        let below = Reach::new([x, 0.0], [code, lower[0], lower[1], lower[2]]);
                        if !above.takes_darkest && !below.takes_darkest {
                            let [.., a, b] = above.weights;
                            let [c, d, ..] = below.weights;
                            assert!((a - c).abs() + (b - d).abs() < 1e-6, "{x} {code} {upper:?} {lower:?}");
                        }
                    }
                }
            }
        }
    }
}
