// The front's shading normal, tilted by a normal map. The tangent is made perpendicular to the normal at each pixel;
// the bitangent is their cross product, turned where the texture is mirrored.
@group(2) @binding(4) var normal_texture: texture_2d<f32>;
@group(2) @binding(5) var normal_sampler: sampler;

fn shading_normal(varyings: Varyings, ray: vec3<f32>, material: Material) -> vec3<f32> {
    let normal = normalize(varyings.shading_normal.xyz);
    let along = varyings.tangent.xyz - normal * dot(normal, varyings.tangent.xyz);
    if dot(along, along) < 1e-8 {
        return normal;
    }
    let tangent = normalize(along);
    let bitangent = cross(normal, tangent) * sign(varyings.tangent.w);
    let level = texture_level(varyings, ray, varyings.normal_place.z);
    let texel = textureSampleLevel(normal_texture, normal_sampler, varyings.normal_place.xy, level).xyz * 2.0 - 1.0;
    let tilted = (tangent * texel.x + bitangent * texel.y) * material.normal_scale + normal * texel.z;
    return tilted / max(length(tilted), 1e-6);
}
