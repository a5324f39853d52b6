//! The sky's colour in a direction: twin of `sky_color.wgsl`, same names, same order.

use super::Moment;
use glam::Vec3;

impl Moment {
    /// From horizon to zenith, a glow around the sun, the disc, haze below the horizon. `direction` is unit.
    pub fn sky_color(&self, direction: Vec3) -> Vec3 {
        let light = &self.daylight;
        let height = direction.y.max(0.0);
        let up = 1.0 - (-4.0 * height).exp();
        let cos_sun = direction.dot(self.sun_direction);
        let near_sun = (0.5 + 0.5 * cos_sun).max(0.0);
        let aureole = 0.35 * near_sun.powf(8.0) * (1.0 - 0.7 * up) + 0.65 * near_sun.powf(96.0);
        let air = light.horizon.lerp(light.zenith, up) + light.glow * aureole;
        let disc = if cos_sun > self.sun_cos_radius() && direction.y > 0.0 { 1.0 } else { 0.0 };
        let below = smoothstep(0.25, -direction.y);
        air.lerp(light.haze, below) + light.sun_light * (8.0 * disc)
    }
}

fn smoothstep(end: f32, x: f32) -> f32 {
    let x = (x / end).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
