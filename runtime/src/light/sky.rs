//! The sky's colour in a direction: twin of `frame/sky_color.wgsl` and `frame/air_color.wgsl`, same names, same order.

use super::Moment;
use glam::Vec3;
use sunbake::ambient::harmonics;

impl Moment {
    /// From horizon to zenith, a glow around the sun, the disc, haze below the horizon. `direction` is unit.
    pub fn sky_color(&self, direction: Vec3) -> Vec3 {
        let light = &self.daylight;
        let is_disc = direction.dot(self.sun_direction) > self.sun_cos_radius() && direction.y > 0.0;
        let below = smoothstep(0.25, -direction.y);
        let depth = 1.0 - 0.45 * smoothstep(1.0, -direction.y);
        let disc = if is_disc { 1.0 } else { 0.0 };
        self.air_color(direction).lerp(light.haze * depth, below) + light.sun_light * (8.0 * disc)
    }

    /// Light of sky and ground on a white surface that nothing hides, by its unit normal.
    pub fn hemisphere_light(&self, normal: Vec3) -> Vec3 {
        self.daylight.ground_light.lerp(self.daylight.sky_light, 0.5 + 0.5 * normal.y)
    }

    /// Light from around a mirror's unit direction: the sky's colour, or the ground's, the more blurred the rougher the
    /// mirror is. Twin of `mirrored_light` in `surface/ambient_specular.wgsl`.
    pub fn mirrored_light(&self, direction: Vec3, roughness: f32) -> Vec3 {
        let below = smoothstep(0.2, 0.1 - direction.y);
        let sharp = self.air_color(direction).lerp(self.daylight.ground_light, below);
        sharp.lerp(self.hemisphere_light(direction), roughness)
    }

    /// The sky above the horizon, without the disc.
    fn air_color(&self, direction: Vec3) -> Vec3 {
        let light = &self.daylight;
        let height = direction.y.max(0.0);
        let up = 1.0 - (-4.0 * height).exp();
        let cos_sun = direction.dot(self.sun_direction);
        let near_sun = (0.5 + 0.5 * cos_sun).max(0.0);
        let aureole = 0.35 * near_sun.powf(8.0) * (1.0 - 0.7 * up) + 0.65 * near_sun.powf(96.0);
        light.horizon.lerp(light.zenith, up) + light.glow * aureole
    }
}

/// Rows and columns of the quadrature over the sky.
const QUADRATURE: [usize; 2] = [24, 48];

impl Moment {
    /// Radiance of sky and ground in spherical harmonics up to degree two, for surfaces with baked sky visibility.
    ///
    /// Above the horizon these are the sky's colours without the sun's disc, scaled so that level ground receives
    /// [`super::Daylight::sky_light`]. Below it is [`super::Daylight::ground_light`] from everywhere. An unoccluded
    /// surface that faces up or down is therefore lit as by the hemisphere model; one that faces aside is brighter
    /// towards the sun.
    pub fn sky_harmonics(&self) -> [Vec3; harmonics::COUNT] {
        let mut above = [Vec3::ZERO; harmonics::COUNT];
        let mut below = [0.0f32; harmonics::COUNT];
        let mut on_level_ground = Vec3::ZERO;
        for (direction, weight) in sphere() {
            let values = harmonics::basis(direction.as_dvec3()).map(|value| value as f32 * weight);
            if direction.y > 0.0 {
                let color = self.air_color(direction);
                on_level_ground += color * (direction.y * weight / std::f32::consts::PI);
                above.iter_mut().zip(values).for_each(|(sum, value)| *sum += color * value);
            } else {
                below.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
        let gain = self.daylight.sky_light / on_level_ground.max(Vec3::splat(1e-9));
        std::array::from_fn(|i| above[i] * gain + self.daylight.ground_light * below[i])
    }
}

/// Directions over the sphere and the solid angle of each: even steps of height and of azimuth, none on the horizon.
fn sphere() -> impl Iterator<Item = (Vec3, f32)> {
    let [rows, columns] = QUADRATURE;
    let weight = 4.0 * std::f32::consts::PI / (rows * columns) as f32;
    (0..rows * columns).map(move |i| {
        let height = ((i / columns) as f32 + 0.5) / rows as f32 * 2.0 - 1.0;
        let (sin, cos) = (((i % columns) as f32 + 0.5) / columns as f32 * std::f32::consts::TAU).sin_cos();
        let across = (1.0 - height * height).sqrt();
        (Vec3::new(across * cos, height, across * sin), weight)
    })
}

fn smoothstep(end: f32, x: f32) -> f32 {
    let x = (x / end).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
