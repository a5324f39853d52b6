//! Metal and highlights against the specification's formulas, evaluated in `f64`, and against energy.

use super::{middle, square, squares, sun_alone};
use glam::{DMat4, DVec3, Vec3, Vec4};
use sunbake::scene::Material;
use sunbake::scene::looks::Look;
use sunbake_runtime::testing::looks::{flat_image, named, texture, with_looks};
use sunbake_runtime::testing::masks::gpu;

/// Appendix B of the specification, word for word, times pi: light is measured so that 1 is what a white surface
/// scatters.
fn gltf_brdf(base: DVec3, metallic: f64, roughness: f64, [n, l, v]: [DVec3; 3]) -> DVec3 {
    let h = (l + v).normalize();
    let alpha = roughness * roughness;
    let chi = |x: f64| if x > 0.0 { 1.0 } else { 0.0 };
    let d = alpha.powi(2) * chi(n.dot(h))
        / (std::f64::consts::PI * (n.dot(h).powi(2) * (alpha.powi(2) - 1.0) + 1.0).powi(2));
    let side = |x: DVec3| {
        let cos = n.dot(x).abs();
        chi(h.dot(x) / n.dot(x)) / (cos + (alpha.powi(2) + (1.0 - alpha.powi(2)) * cos * cos).sqrt())
    };
    // The separable form of the specification.
    let separable = side(l) * side(v);
    // Its height-correlated form (Heitz 2014), which renderers use.
    let lambda = |x: DVec3| {
        let tan2 = 1.0 / n.dot(x).powi(2) - 1.0;
        0.5 * ((1.0 + alpha.powi(2) * tan2).sqrt() - 1.0)
    };
    let correlated = 1.0 / ((1.0 + lambda(l) + lambda(v)) * 4.0 * n.dot(l) * n.dot(v));
    assert!((correlated / separable).ln().abs() < 0.5, "the two forms are near to one another");
    let f0 = DVec3::splat(0.04).lerp(base, metallic);
    let f = f0 + (DVec3::ONE - f0) * (1.0 - v.dot(h).abs()).powi(5);
    let diffuse = base.lerp(DVec3::ZERO, metallic) / std::f64::consts::PI;
    ((DVec3::ONE - f) * diffuse + f * (d * correlated)) * std::f64::consts::PI
}

#[test]
fn sunlight_is_reflected_as_the_specification_says() {
    let gpu = gpu();
    let base = Vec3::new(0.9, 0.6, 0.3);
    let material = Material { base_color: base.extend(1.0), ..named("it") };
    for (metallic, roughness) in [(0.0, 0.2), (0.0, 0.6), (1.0, 0.15), (1.0, 0.5), (1.0, 1.0), (0.4, 0.35)] {
        let look = Look { metallic, roughness, ..Look::PLAIN };
        let stage = with_looks(squares(&[(square(), material.clone(), DMat4::IDENTITY)]), Vec::new(), |_| look);
        let moment = sun_alone(&stage);
        let l = moment.sun_direction.as_dvec3();
        // Towards the mirrored sun, beside it, and far away from it.
        for towards_eye in [DVec3::new(-l.x, l.y, -l.z), DVec3::new(-0.3, 0.9, -0.5), DVec3::new(0.6, 0.3, -0.2)] {
            let v = towards_eye.normalize();
            let expected = gltf_brdf(base.as_dvec3(), metallic.into(), roughness.into(), [DVec3::Y, l, v]) * l.y;
            let expected = expected * moment.daylight.sun_light.as_dvec3();
            let found = middle(&gpu, &stage, v * 4.0, &moment).as_dvec3();
            let error = (found - expected).abs().max_element() / (1e-3 + expected.max_element());
            assert!(error < 2e-3, "metal {metallic}, roughness {roughness}, eye {v}: {found}, not {expected}");
        }
    }
}

#[test]
fn a_rough_surface_without_metal_only_scatters_and_a_metal_only_reflects() {
    let gpu = gpu();
    let stage = squares(&[(square(), named("it"), DMat4::IDENTITY)]);
    let moment = sun_alone(&stage);
    let lambert = moment.daylight.sun_light * moment.sun_direction.y * 0.5;
    let found = middle(&gpu, &stage, DVec3::new(-1.0, 3.0, 1.0), &moment);
    assert!((found - lambert).abs().max_element() < 1e-4, "{found}");
    // Under the sky as well, a metal is not black, and a black one is.
    let metal = Look { metallic: 1.0, roughness: 0.3, ..Look::PLAIN };
    let day = stage.moment(0.5).without_sun();
    let stage = with_looks(stage, Vec::new(), |_| metal);
    let [sky, none] = [day, day.without_sky()].map(|moment| middle(&gpu, &stage, DVec3::new(-1.0, 3.0, 1.0), &moment));
    assert!(sky.min_element() > 0.05, "{sky}");
    assert_eq!(none, Vec3::ZERO);
    let black = Material { base_color: Vec4::new(0.0, 0.0, 0.0, 1.0), ..named("it") };
    let stage = with_looks(squares(&[(square(), black, DMat4::IDENTITY)]), Vec::new(), |_| metal);
    let black = middle(&gpu, &stage, DVec3::new(-1.0, 3.0, 1.0), &day);
    assert!(black.max_element() < 0.05 * sky.max_element(), "{black}");
}

/// Green is roughness and blue is metal, and both are numbers, not colours: code 128 is 0.502, where sRGB would make
/// it 0.216.
#[test]
fn metal_and_roughness_come_from_a_texture_as_numbers() {
    let gpu = gpu();
    let material = Material { base_color: Vec4::new(0.9, 0.6, 0.3, 1.0), ..named("it") };
    let eye = DVec3::new(-1.5, 2.5, -1.2);
    let with = |look: Look, images| {
        let stage = with_looks(squares(&[(square(), material.clone(), DMat4::IDENTITY)]), images, |_| look);
        middle(&gpu, &stage, eye, &stage.moment(0.5))
    };
    let factors = Look { metallic: 0.8 * 64.0 / 255.0, roughness: 0.9 * 128.0 / 255.0, ..Look::PLAIN };
    let mapped = Look { metallic: 0.8, roughness: 0.9, metallic_roughness_texture: Some(texture(0)), ..Look::PLAIN };
    let [a, b] = [with(factors, Vec::new()), with(mapped, vec![flat_image([7, 128, 64])])];
    assert!((a - b).abs().max_element() < 1e-4, "{a} {b}");
    let swapped = with(mapped, vec![flat_image([7, 64, 128])]);
    assert!((a - swapped).abs().max_element() > 0.01, "{a} {swapped}");
}

/// The emissive texture is sRGB: code 188 is half of the light.
#[test]
fn emission_is_the_factor_times_a_texture_of_colours() {
    let gpu = gpu();
    let emissive = Vec3::new(4.0, 1.0, 0.5);
    let material = Material { emissive, base_color: Vec4::new(0.0, 0.0, 0.0, 1.0), ..named("it") };
    let look = Look { emissive_texture: Some(texture(0)), ..Look::PLAIN };
    let images = vec![flat_image([188, 255, 0])];
    let stage = with_looks(squares(&[(square(), material.clone(), DMat4::IDENTITY)]), images, |_| look);
    let found = middle(&gpu, &stage, DVec3::new(0.5, 3.0, 1.0), &stage.moment(0.5));
    let half = ((188.0f32 / 255.0 + 0.055) / 1.055).powf(2.4);
    assert!((found - emissive * Vec3::new(half, 1.0, 0.0)).abs().max_element() < 1e-3, "{found}");
    // An unlit material shows its base colour, and nothing else.
    let unlit = Material { is_unlit: true, base_color: Vec4::new(0.2, 0.4, 0.6, 1.0), ..material };
    let stage = squares(&[(square(), unlit, DMat4::IDENTITY)]);
    let found = middle(&gpu, &stage, DVec3::new(0.5, 3.0, 1.0), &stage.moment(0.5));
    assert!((found - Vec3::new(0.2, 0.4, 0.6)).abs().max_element() < 1e-6, "{found}");
}
