//! How surfaces reflect light: twin of `surface/reflection*.wgsl`, `surface/ambient_specular.wgsl` and
//! `surface/shade*.wgsl`.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, appendix B. Microfacets of Trowbridge and Reitz (GGX), with the
//! height-correlated shadowing of Smith (Heitz, "Understanding the masking-shadowing function in microfacet-based
//! BRDFs", 2014) and Schlick's Fresnel term; what is not reflected there is scattered evenly.
//!
//! **Ambient light.** What a surface reflects of even light is the polynomial fit of Karis, "Physically based shading
//! on mobile", 2014. Light that microfacets reflect several times is added after Fdez-Agüera, "A multiple-scattering
//! microfacet model for real-time image-based lighting", 2019, so that a white metal in even light is white. It is
//! reflected from the sky in the mirror's direction, blurred towards the hemisphere's mean with roughness, and hidden
//! as far as the ambient light of the surface is.
//!
//! **Departures.** A highlight is never smaller than that of [`LEAST_ROUGHNESS`], which is about the sun's disc.
//! Surfaces without metal of roughness 1 scatter light only ([`sunbake::scene::looks::Look::is_diffuse`]).

use crate::light::Moment;
use glam::{Vec3, Vec4};

/// Least roughness: its square is the sun's angular radius.
const LEAST_ROUGHNESS: f32 = 0.07;
/// Least cosine between normal and eye.
const LEAST_COSINE: f32 = 1e-3;

/// What a surface does with light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflector {
    /// Linear RGB.
    pub base_color: Vec3,
    /// Metal and roughness, 0 to 1; none where it only scatters light.
    pub metal: Option<[f32; 2]>,
    /// Unit shading normal, on the side that the eye is on.
    pub normal: Vec3,
    /// Unit vector towards the eye.
    pub to_eye: Vec3,
}

impl Reflector {
    fn diffuse_color(&self, metallic: f32) -> Vec3 {
        self.base_color * (1.0 - metallic)
    }

    fn specular_color(&self, metallic: f32) -> Vec3 {
        Vec3::splat(0.04).lerp(self.base_color, metallic)
    }

    /// The share of a light's irradiance that is sent to the eye: 1 is what a white surface that faces it scatters.
    pub fn reflected(&self, towards_light: Vec3) -> Vec3 {
        let n_l = self.normal.dot(towards_light);
        let Some([metallic, roughness]) = self.metal else { return self.base_color * n_l.max(0.0) };
        if n_l <= 0.0 {
            return Vec3::ZERO;
        }
        let halfway = (towards_light + self.to_eye).normalize_or_zero();
        let n_v = self.normal.dot(self.to_eye).max(LEAST_COSINE);
        let n_h = self.normal.dot(halfway).clamp(0.0, 1.0);
        let v_h = self.to_eye.dot(halfway).clamp(0.0, 1.0);
        let alpha2 = roughness.clamp(LEAST_ROUGHNESS, 1.0).powi(4);
        let spread = n_h * n_h * (alpha2 - 1.0) + 1.0;
        let smith = |n_a: f32, n_b: f32| n_a * (n_b * n_b * (1.0 - alpha2) + alpha2).sqrt();
        let specular = 0.5 * alpha2 / (spread * spread * (smith(n_l, n_v) + smith(n_v, n_l)));
        let f0 = self.specular_color(metallic);
        let fresnel = f0 + (Vec3::ONE - f0) * (1.0 - v_h).powi(5);
        (self.diffuse_color(metallic) * (Vec3::ONE - fresnel) + fresnel * specular) * n_l
    }

    /// Ambient light that is sent to the eye. `ambient` is what a white surface would scatter.
    pub fn reflected_ambient(&self, ambient: Vec3, moment: &Moment) -> Vec3 {
        let Some([metallic, roughness]) = self.metal else { return self.base_color * ambient };
        let n_v = self.normal.dot(self.to_eye).clamp(LEAST_COSINE, 1.0);
        let roughness = roughness.clamp(LEAST_ROUGHNESS, 1.0);
        let fit = Vec4::new(-1.0, -0.0275, -0.572, 0.022) * roughness + Vec4::new(1.0, 0.0425, 1.04, -0.04);
        let grazing = (fit.x * fit.x).min((-9.28 * n_v).exp2()) * fit.x + fit.y;
        let (scale, offset) = (fit.z - 1.04 * grazing, (fit.w + 1.04 * grazing).max(0.0));
        let f0 = self.specular_color(metallic);
        let once = f0 * scale + offset;
        let lost = 1.0 - (scale + offset);
        let average = f0 + (Vec3::ONE - f0) / 21.0;
        let again = once * average * lost / (Vec3::ONE - average * lost);
        let open = moment.hemisphere_light(self.normal);
        let seen = (ambient.element_sum() / open.element_sum().max(1e-9)).clamp(0.0, 1.0);
        let mirrored = moment.mirrored_light((-self.to_eye).reflect(self.normal), roughness);
        let scattered = again + self.diffuse_color(metallic) * (Vec3::ONE - once - again);
        once * mirrored * seen + scattered * ambient
    }

    /// Light of sun and sky that is sent to the eye, given the sun's visibility.
    pub fn shade(&self, moment: &Moment, visibility: f32, ambient: Vec3) -> Vec3 {
        let sun_light = moment.daylight.sun_light;
        match self.metal {
            None => {
                let sun = sun_light * (visibility * self.normal.dot(moment.sun_direction).max(0.0));
                self.base_color * (sun + ambient)
            }
            Some(_) => {
                self.reflected(moment.sun_direction) * (sun_light * visibility)
                    + self.reflected_ambient(ambient, moment)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Daylight;
    use std::f32::consts::TAU;

    fn white(metallic: f32, roughness: f32, slant: f32) -> Reflector {
        let to_eye = Vec3::new(slant.sin(), slant.cos(), 0.0);
        Reflector { base_color: Vec3::ONE, metal: Some([metallic, roughness]), normal: Vec3::Y, to_eye }
    }

    /// Even light from everywhere, of one sky and one ground.
    fn furnace() -> Moment {
        let daylight = Daylight {
            sky_light: Vec3::ONE,
            ground_light: Vec3::ONE,
            zenith: Vec3::ONE,
            horizon: Vec3::ONE,
            glow: Vec3::ZERO,
            ..Daylight::at_height(0.5)
        };
        Moment { daylight, ..Moment::new(None, 0.5) }
    }

    #[test]
    fn in_even_light_a_white_metal_is_white_and_nothing_gives_more_than_it_gets() {
        let moment = furnace();
        for i in 0..=20 {
            for slant in [0.0, 0.5, 1.0, 1.4, 1.56] {
                let roughness = i as f32 / 20.0;
                let of = |metallic| white(metallic, roughness, slant).reflected_ambient(Vec3::ONE, &moment);
                assert!((of(1.0) - 1.0).abs().max_element() < 1e-5, "{roughness} {slant}: {}", of(1.0));
                assert!(of(0.0).max_element() <= 1.0 + 1e-5 && of(0.0).min_element() > 0.9, "{}", of(0.0));
                assert!(of(0.5).max_element() <= 1.0 + 1e-5, "{}", of(0.5));
                let black = Reflector { base_color: Vec3::ZERO, ..white(0.0, roughness, slant) };
                let black = black.reflected_ambient(Vec3::ONE, &moment);
                assert!(black.min_element() >= 0.0 && black.max_element() <= 1.0);
            }
        }
    }

    /// The share of the light of all directions that is sent to the eye, by quadrature: that of single reflections,
    /// which lose some of it on rough surfaces. Metals add none. Of others the specification's mix takes from what is
    /// scattered as much as a microfacet towards each light reflects, which is less than what the surface reflects to
    /// an eye that grazes it: it may add that much.
    #[test]
    fn light_from_all_directions_adds_up_to_no_more_than_the_specification_adds() {
        let (rows, columns) = (600, 400);
        for roughness in [0.2, 0.4, 0.7, 1.0] {
            for slant in [0.1, 0.8, 1.3] {
                for (metallic, least) in [(1.0, 0.3), (0.0, 0.75)] {
                    let surface = white(metallic, roughness, slant);
                    let mut sum = 0.0f64;
                    for i in 0..rows * columns {
                        // Even in the square of the sine, so that each direction has the weight of its cosine.
                        let share = ((i / columns) as f32 + 0.5) / rows as f32;
                        let (sin, cos) = (((i % columns) as f32 + 0.5) / columns as f32 * TAU).sin_cos();
                        let height = (1.0 - share).sqrt();
                        let light = Vec3::new(share.sqrt() * cos, height, share.sqrt() * sin);
                        sum += f64::from(surface.reflected(light).x / height);
                    }
                    let seen = sum / f64::from(rows * columns);
                    let fresnel = 0.04 + 0.96 * (1.0 - f64::from(slant).cos()).powi(5);
                    let most = if metallic > 0.0 { 1.01 } else { 1.01 + fresnel };
                    assert!(seen < most && seen > least, "metal {metallic}, {roughness}, {slant}: {seen}");
                }
            }
        }
    }

    #[test]
    fn reflection_is_the_same_both_ways() {
        let directions = [Vec3::new(0.3, 0.8, 0.2), Vec3::new(-0.6, 0.4, 0.5), Vec3::new(0.1, 0.2, -0.9)];
        for roughness in [0.1, 0.5, 1.0] {
            for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|pair| pair.map(|i: usize| directions[i].normalize())) {
                let of = |to_eye: Vec3, light: Vec3| {
                    Reflector { to_eye, ..white(0.3, roughness, 0.0) }.reflected(light) / light.y
                };
                let [there, back] = [of(a, b), of(b, a)];
                assert!((there - back).abs().max_element() < 1e-4 * (1.0 + there.x), "{there} {back}");
            }
        }
        assert!((white(0.0, 0.5, 0.0).reflected(-Vec3::Y)).max_element() == 0.0);
    }
}
