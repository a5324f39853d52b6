// The values of a footprint's texels blended, in the order of `texel_of`: only of those that no wall parts from the
// point. Twin of bake/src/atlas/reach.rs, where it is explained: same names, same order.
@group(1) @binding(7) var wall_map: texture_2d_array<u32>;

const OPEN: u32 = 255u;
const OPEN_MARKED: u32 = 254u;
const MARKED: u32 = 127u;
const PLACES: u32 = 96u;
const HALF_WIDTH: f32 = 1.0 / 64.0;
const STRAIGHT: u32 = 0u;
const BENT: u32 = 1u;
const SQUARE: u32 = 2u;
const ROUND: u32 = 3u;
const STEPS: u32 = 8u;
const APART: u32 = 2u;

// Where the walls on an edge begin and end, from its first texel.
struct Edge {
    has_wall: bool,
    near: f32,
    far: f32,
}

// How the four texels count: by weights, or the darkest of them.
struct Reach {
    weights: vec4<f32>,
    takes_darkest: bool,
}

fn is_marked(code: u32) -> bool {
    return code != OPEN && code >= MARKED;
}

fn unmarked(code: u32) -> u32 {
    if code == OPEN_MARKED {
        return OPEN;
    }
    return select(code, code - MARKED, is_marked(code));
}

fn edge_of(marked: u32) -> Edge {
    let code = unmarked(marked);
    if code < PLACES {
        let place = f32(code) / f32(PLACES - 1u);
        return Edge(true, max(place - HALF_WIDTH, 0.0), min(place + HALF_WIDTH, 1.0));
    }
    var pair = code - PLACES;
    var near = 0u;
    while near + APART < STEPS && pair > STEPS - APART - near {
        pair -= STEPS - APART + 1u - near;
        near++;
    }
    return Edge(code != OPEN, f32(near) / f32(STEPS), f32(near + APART + pair) / f32(STEPS));
}

fn turned(edge: Edge) -> Edge {
    return Edge(edge.has_wall, 1.0 - edge.far, 1.0 - edge.near);
}

fn between(a: Edge, b: Edge, share: f32) -> Edge {
    return Edge(true, mix(a.near, b.near, share), mix(a.far, b.far, share));
}

// The weights of the texels before and behind the wall at a point of the edge.
fn sides(edge: Edge, at: f32) -> vec2<f32> {
    return vec2<f32>(select(0.0, 1.0, at < edge.near), select(0.0, 1.0, at > edge.far));
}

fn plain(at: vec2<f32>) -> vec4<f32> {
    return vec4<f32>((1.0 - at.x) * (1.0 - at.y), at.x * (1.0 - at.y), (1.0 - at.x) * at.y, at.x * at.y);
}

// Where only one edge has a wall: `along` that edge, and `away` from it; `first` and `second` mark its texels.
fn at_wall_end(
    at: vec2<f32>,
    edge: Edge,
    along: f32,
    away: f32,
    first: vec4<f32>,
    second: vec4<f32>,
) -> Reach {
    let side = sides(edge, along);
    if side.x + side.y == 0.0 {
        let apart = edge.far - edge.near;
        let is_corner = apart > 4.0 * HALF_WIDTH && away < apart;
        return Reach(vec4<f32>(0.0), !is_corner);
    }
    let others = plain(at) * (1.0 - first - second);
    return Reach(others + (1.0 - away) * (side.x * first + side.y * second), false);
}

// Where a wall cuts the marked texel off, straight or with a corner: `level` and `upright` are the edges that meet in
// it, and `place` is the point's, seen from it.
fn cut_off(at: vec2<f32>, shape: u32, texel: vec4<f32>, level: Edge, upright: Edge, place: vec2<f32>) -> Reach {
    let near = vec2<f32>(level.near, upright.near);
    let far = vec2<f32>(level.far, upright.far);
    if shape == SQUARE && all(place < near) {
        return Reach(texel, false);
    }
    if shape == STRAIGHT && place.x * upright.near + place.y * level.near < level.near * upright.near {
        return Reach(texel, false);
    }
    var is_outside = dot(place, far.yx) > far.x * far.y;
    if shape == SQUARE {
        is_outside = any(place > far);
    } else if shape == ROUND {
        is_outside = dot(place, place) > dot(place, far);
    }
    if is_outside {
        return Reach(without(at, texel), false);
    }
    return Reach(vec4<f32>(0.0), true);
}

// Plain weights of all texels but one.
fn without(at: vec2<f32>, texel: vec4<f32>) -> vec4<f32> {
    let others = plain(at) * (1.0 - texel);
    return others / dot(others, vec4<f32>(1.0));
}

fn reach(footprint: Footprint) -> Reach {
    let first = textureLoad(wall_map, texel_of(footprint, 0), 0, 0).xy;
    let second = textureLoad(wall_map, texel_of(footprint, 1), 0, 0).y;
    let third = textureLoad(wall_map, texel_of(footprint, 2), 0, 0).x;
    let at = footprint.weight;
    if all(vec4<u32>(first, second, third) == vec4<u32>(OPEN)) {
        return Reach(plain(at), false);
    }
    let top = edge_of(first.x);
    let bottom = edge_of(third);
    let left = edge_of(first.y);
    let right = edge_of(second);
    let upper_left = vec4<f32>(1.0, 0.0, 0.0, 0.0);
    let upper_right = vec4<f32>(0.0, 1.0, 0.0, 0.0);
    let lower_left = vec4<f32>(0.0, 0.0, 1.0, 0.0);
    let lower_right = vec4<f32>(0.0, 0.0, 0.0, 1.0);
    let back = 1.0 - at;
    let walls = vec4<bool>(top.has_wall, bottom.has_wall, left.has_wall, right.has_wall);
    let count = dot(select(vec4<f32>(0.0), vec4<f32>(1.0), walls), vec4<f32>(1.0));
    let shape = u32(is_marked(first.x)) + 2u * u32(is_marked(first.y));
    if shape == BENT || (count > 2.0 && shape != SQUARE) || count > 3.0 {
        return Reach(vec4<f32>(0.25), true);
    }
    if count == 3.0 {
        let level = sides(between(top, bottom, at.y), at.x);
        let upright = sides(between(left, right, at.x), at.y);
        let open = select(vec4<f32>(1.0), vec4<f32>(0.0), walls);
        let upper_lower = open.xxyy * upright.xxyy * vec4<f32>(back.x, at.x, back.x, at.x);
        let left_right = open.zwzw * level.xyxy * vec4<f32>(back.y, back.y, at.y, at.y);
        let weights = upper_lower + left_right;
        return Reach(weights, all(weights == vec4<f32>(0.0)));
    }
    if count == 0.0 {
        return Reach(plain(at), false);
    }
    if walls.x && walls.y {
        let side = sides(between(top, bottom, at.y), at.x);
        return Reach(vec4<f32>(side * back.y, side * at.y), side.x + side.y == 0.0);
    }
    if walls.z && walls.w {
        let side = sides(between(left, right, at.x), at.y);
        let level = vec2<f32>(back.x, at.x);
        return Reach(vec4<f32>(side.x * level, side.y * level), side.x + side.y == 0.0);
    }
    if walls.x && walls.z {
        return cut_off(at, shape, upper_left, top, left, at);
    }
    if walls.x && walls.w {
        return cut_off(at, shape, upper_right, turned(top), right, vec2<f32>(back.x, at.y));
    }
    if walls.y && walls.z {
        return cut_off(at, shape, lower_left, bottom, turned(left), vec2<f32>(at.x, back.y));
    }
    if walls.y && walls.w {
        return cut_off(at, shape, lower_right, turned(bottom), turned(right), back);
    }
    if walls.x {
        return at_wall_end(at, top, at.x, at.y, upper_left, upper_right);
    }
    if walls.y {
        return at_wall_end(at, bottom, at.x, back.y, lower_left, lower_right);
    }
    if walls.z {
        return at_wall_end(at, left, at.y, at.x, upper_left, lower_left);
    }
    return at_wall_end(at, right, at.y, back.x, upper_right, lower_right);
}

fn blended(at: Footprint, values: vec4<f32>) -> f32 {
    let share = reach(at);
    let darkest = min(min(values.x, values.y), min(values.z, values.w));
    return select(dot(share.weights, values), darkest, share.takes_darkest);
}

// The same for colours.
fn blended_colors(at: Footprint, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> vec3<f32> {
    let share = reach(at);
    let weights = share.weights;
    let sum = a * weights.x + b * weights.y + c * weights.z + d * weights.w;
    return select(sum, min(min(a, b), min(c, d)), share.takes_darkest);
}
