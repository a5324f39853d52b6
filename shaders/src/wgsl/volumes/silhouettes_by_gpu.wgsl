// Volumes whose silhouettes the vertex shader finds: every edge is drawn, and those that are no silhouette collapse
// to a point.

// An edge and two triangles along it: twice a triangle's index, plus 1 where its corners run from high to low.
struct Wall {
    low: u32,
    high: u32,
    first: u32,
    second: u32,
}

@group(1) @binding(2) var<storage, read> walls: array<Wall>;
@group(1) @binding(3) var<storage, read> triangles: array<u32>;
// How each triangle's prism counts (-1, 0 or 1) plus 1, two bits each. 3: not at all, and the triangle is spared.
@group(1) @binding(4) var<storage, read> facings: array<u32>;

const NO_TRIANGLE: u32 = 0xffffffffu;
const NOWHERE = vec4<f32>(0.0, 0.0, 0.0, 1.0);

const SPARED: u32 = 3u;

fn facing_code(triangle: u32) -> u32 {
    return (facings[triangle >> 4u] >> (2u * (triangle & 15u))) & 3u;
}

fn facing(triangle: u32) -> i32 {
    let code = facing_code(triangle);
    return select(i32(code) - 1, 0, code == SPARED);
}

// What a triangle along an edge adds to the winding of the edge's wall.
fn winding_of_use(edge_use: u32) -> i32 {
    if edge_use == NO_TRIANGLE {
        return 0;
    }
    return select(facing(edge_use >> 1u), -facing(edge_use >> 1u), (edge_use & 1u) == 1u);
}

// Instance k draws the walls that are there more than k times.
@vertex
fn wall_vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) copy: u32,
) -> @builtin(position) @invariant vec4<f32> {
    let wall = walls[index / WALL_CORNERS];
    let winding = winding_of_use(wall.first) + winding_of_use(wall.second);
    if u32(abs(winding)) <= copy {
        return NOWHERE;
    }
    return corner(wall_corner(wall, index % WALL_CORNERS, winding > 0));
}

// A corner of the cap that lies at a triangle (`extruded` 0), or at what is extruded from it and looks the other way
// (1).
fn cap_corner(index: u32, extruded: u32) -> vec4<f32> {
    let cap_facing = facing(index / 3u);
    if cap_facing == 0 {
        return NOWHERE;
    }
    let k = index % 3u;
    let is_turned = (cap_facing < 0) != (extruded == 1u);
    return corner(extruded * point_count() + triangles[index - k + select(k, (3u - k) % 3u, is_turned)]);
}

@vertex
fn cap_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) @invariant vec4<f32> {
    return cap_corner(index, 0u);
}

// A triangle that its own volume is not to shade.
@vertex
fn spared_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) @invariant vec4<f32> {
    if facing_code(index / 3u) != SPARED {
        return NOWHERE;
    }
    return corner(triangles[index]);
}
