// A surface point on a shadow map, moved by the bias that keeps it from shading itself: see
// runtime/src/shadow_maps/bias.rs.

struct Receiver {
    map: i32,
    uv: vec2<f32>,
    depth: f32,
    // How the depth of its plane changes over the map: a plane stays a plane in any projection.
    depth_per_uv: vec2<f32>,
    // Across the light, metres to a unit of u and of v.
    metres_per_uv: vec2<f32>,
    // Away from its surface across the light, unit length, where it is moved off its plane; else 0.
    outward: vec2<f32>,
}

// Steps of f32 that places and depths are off by.
const ROUNDING: f32 = 4.8e-7;
// The least depth of a receiver, above 0: casters above the map are clamped to 0. Empty texels hold 1.
const LEAST_DEPTH: f32 = 3.8e-6;

// Where a point, relative to the eye, lies on a map: from -1 to 1 in x and y if it does, and w.
fn place_on_map(map: i32, from_eye_m: vec3<f32>) -> vec3<f32> {
    let point_m = from_eye_m + shadow_maps.maps[map].eye_from_origin_m;
    let clip = shadow_maps.maps[map].clip_from_point * vec4<f32>(point_m, 1.0);
    return vec3<f32>(clip.xy / clip.w, clip.w);
}

fn is_on_map(place: vec3<f32>, margin_texels: f32) -> bool {
    let most = 1.0 - 2.0 * margin_texels / f32(textureDimensions(shadow_depths).x);
    return place.z > 0.0 && max(abs(place.x), abs(place.y)) <= most;
}

// `off_plane`: moved along its normal instead of compared with its plane.
fn receiver_on_map(
    map: i32,
    place: vec3<f32>,
    from_eye_m: vec3<f32>,
    geometric_normal: vec3<f32>,
    off_plane: bool,
) -> Receiver {
    let matrix = shadow_maps.maps[map].clip_from_point;
    let rows = transpose(matrix);
    let sun = frame.sun_direction;
    let texel = 1.0 / f32(textureDimensions(shadow_depths).x);
    // Across the light, what a unit of u and of v is in metres, and which way.
    let u_per_metre = (rows[0].xyz - rows[3].xyz * place.x) * (0.5 / place.z);
    let v_per_metre = (rows[1].xyz - rows[3].xyz * place.y) * (-0.5 / place.z);
    let area = dot(cross(u_per_metre, v_per_metre), sun);
    let step_u = cross(v_per_metre, sun) / area;
    let step_v = cross(sun, u_per_metre) / area;
    // How far a corner one texel away, in u and in v, is from the receiver's plane.
    let corner_m = (abs(dot(geometric_normal, step_u)) + abs(dot(geometric_normal, step_v))) * texel;
    let texel_m = max(length(step_u), length(step_v)) * texel;
    let facing = max(dot(geometric_normal, sun), 1.0 / 4096.0);
    let raster_m = corner_m / 128.0 + length(from_eye_m) * (frame.pixel_angle_rad / 256.0 + ROUNDING);
    let normal_reach = select(BIAS_NORMAL * BIAS_REACH, BIAS_REACH_OFF_PLANE, off_plane);
    let off_surface_m = normal_reach * corner_m + raster_m;
    let towards_sun_m = BIAS_CONSTANT_M + BIAS_CONSTANT_TEXELS * texel_m + BIAS_SLOPE * BIAS_REACH * corner_m / facing;
    let unbiased_m = from_eye_m + shadow_maps.maps[map].eye_from_origin_m;
    let point_m = unbiased_m + geometric_normal * off_surface_m + sun * towards_sun_m;
    let clip = matrix * vec4<f32>(point_m, 1.0);
    var at: Receiver;
    at.map = map;
    at.uv = vec2<f32>(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    at.depth = clip.z / clip.w;
    let along_u = step_u - sun * (dot(geometric_normal, step_u) / facing);
    let along_v = step_v - sun * (dot(geometric_normal, step_v) / facing);
    let depth_row = rows[2].xyz - rows[3].xyz * at.depth;
    at.depth_per_uv = vec2<f32>(dot(depth_row, along_u), dot(depth_row, along_v)) / clip.w;
    at.outward = vec2<f32>(0.0);
    if off_plane {
        at.depth_per_uv = vec2<f32>(0.0);
        let rise = vec2<f32>(dot(geometric_normal, step_u), dot(geometric_normal, step_v));
        at.outward = normalize(rise / vec2<f32>(length(step_u), length(step_v)));
    }
    at.depth -= ROUNDING * (1.0 + abs(at.depth_per_uv.x) + abs(at.depth_per_uv.y));
    at.metres_per_uv = vec2<f32>(length(step_u), length(step_v));
    return at;
}

// The depth to compare with at a place of the map.
fn depth_at(at: Receiver, uv: vec2<f32>) -> f32 {
    let on_plane = select(0.0, dot(at.depth_per_uv, uv - at.uv), BIAS_HAS_PLANE);
    return clamp(at.depth + on_plane, LEAST_DEPTH, 1.0);
}
