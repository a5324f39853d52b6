// Ambient light on metal and highlights. Theory and sources: runtime/src/shade/reflection.rs, its twin.

// Light from around a mirror's direction: the sky's colour, or the ground's, the more blurred the rougher it is.
fn mirrored_light(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let sharp = mix(air_color(direction), frame.ground_light, smoothstep(-0.1, 0.1, -direction.y));
    let blurred = mix(frame.ground_light, frame.sky_light, 0.5 + 0.5 * direction.y);
    return mix(sharp, blurred, roughness);
}

// Ambient light that is sent to the eye. `ambient` is what a white surface would scatter.
fn reflected_ambient(at: Surface, ambient: vec3<f32>) -> vec3<f32> {
    let to_eye = -normalize(at.ray);
    let n_v = clamp(dot(at.normal, to_eye), LEAST_COSINE, 1.0);
    let roughness = roughness_of(at);
    let fit = roughness * vec4<f32>(-1.0, -0.0275, -0.572, 0.022) + vec4<f32>(1.0, 0.0425, 1.04, -0.04);
    let grazing = min(fit.x * fit.x, exp2(-9.28 * n_v)) * fit.x + fit.y;
    let scale = fit.z - 1.04 * grazing;
    let offset = max(fit.w + 1.04 * grazing, 0.0);
    let f0 = specular_color(at);
    let once = f0 * scale + offset;
    let lost = 1.0 - (scale + offset);
    let average = f0 + (1.0 - f0) / 21.0;
    let again = once * average * lost / (1.0 - average * lost);
    let open = mix(frame.ground_light, frame.sky_light, 0.5 + 0.5 * at.normal.y);
    let seen = clamp(dot(ambient, vec3<f32>(1.0)) / max(dot(open, vec3<f32>(1.0)), 1e-9), 0.0, 1.0);
    let mirrored = mirrored_light(reflect(-to_eye, at.normal), roughness);
    return once * mirrored * seen + (again + diffuse_color(at) * (1.0 - once - again)) * ambient;
}
