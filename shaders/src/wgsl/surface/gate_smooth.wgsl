// The normal that decides whether a surface faces the light, on the side that the eye is on: where faces are facets of
// something smooth, the shading normal.
fn gate_normal(varyings: Varyings, ray: vec3<f32>) -> vec3<f32> {
    return towards_eye(normalize(varyings.shading_normal.xyz), varyings, ray);
}
