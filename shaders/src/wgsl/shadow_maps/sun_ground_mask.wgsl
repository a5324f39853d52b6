// The sun on the ground, from a blurred mask of casters. The ground does not shade itself, so no depths are compared.
@group(3) @binding(3) var shadow_mask: texture_2d<f32>;
@group(3) @binding(4) var mask_sampler: sampler;

fn sun_visibility(varyings: Varyings, gate: vec3<f32>) -> f32 {
    if dot(gate, frame.sun_direction) <= 0.0 {
        return 0.0;
    }
    let place = place_on_map(0, view_ray(varyings.clip.xy) / varyings.clip.w);
    if !is_on_map(place, 0.0) {
        return 1.0;
    }
    return textureSampleLevel(shadow_mask, mask_sampler, vec2<f32>(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y), 0.0).r;
}
