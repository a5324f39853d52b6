// Metal and highlights: the reflection model of glTF. Theory and sources: runtime/src/shade/reflection.rs, its twin.
const LEAST_ROUGHNESS: f32 = 0.07;
const LEAST_COSINE: f32 = 1e-3;

fn roughness_of(at: Surface) -> f32 {
    return clamp(at.roughness, LEAST_ROUGHNESS, 1.0);
}

fn diffuse_color(at: Surface) -> vec3<f32> {
    return at.base_color * (1.0 - at.metallic);
}

fn specular_color(at: Surface) -> vec3<f32> {
    return mix(vec3<f32>(0.04), at.base_color, at.metallic);
}

// The share of a light's irradiance that is sent to the eye.
fn reflected(at: Surface, towards_light: vec3<f32>) -> vec3<f32> {
    let n_l = dot(at.normal, towards_light);
    if n_l <= 0.0 {
        return vec3<f32>(0.0);
    }
    let to_eye = -normalize(at.ray);
    let halfway = normalize(towards_light + to_eye);
    let n_v = max(dot(at.normal, to_eye), LEAST_COSINE);
    let n_h = clamp(dot(at.normal, halfway), 0.0, 1.0);
    let v_h = clamp(dot(to_eye, halfway), 0.0, 1.0);
    let alpha = roughness_of(at) * roughness_of(at);
    let alpha2 = alpha * alpha;
    let spread = n_h * n_h * (alpha2 - 1.0) + 1.0;
    let shadowing = n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) + n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2);
    let specular = 0.5 * alpha2 / (spread * spread * shadowing);
    let f0 = specular_color(at);
    let fresnel = f0 + (1.0 - f0) * pow(1.0 - v_h, 5.0);
    return (diffuse_color(at) * (1.0 - fresnel) + fresnel * specular) * n_l;
}
