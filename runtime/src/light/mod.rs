//! Light at a moment of the day: where the sun stands, and a simple sky to go with it.
//!
//! **Sun.** Its colour is what the air lets through: `exp(-depth * air mass)` for red, green and blue, the air mass
//! after Kasten and Young ("Revised optical air mass tables and approximation formula", *Applied Optics* 28, 1989), the
//! depths those of clear air with a little dust.
//!
//! **Brightness.** Noon is some thousand times brighter than dusk. The eye adapts, a picture with a fixed exposure
//! cannot. The sun's brightness is therefore compressed by a power (`ADAPTATION`), and all light is scaled up as the
//! light on level ground falls (`ADAPTATION_TO_DUSK`), as if the eye had adapted in part.
//!
//! **Sky.** Blue above, pale at the horizon, warm around a low sun; the ground reflects what it receives. None of this
//! is measured. It gives the shadows a plausible light.

pub(crate) mod disc;
mod lamp;
mod sky;
mod time_choice;
mod tone;

pub use disc::SunDisc;
pub use lamp::{LampMoment, WITHOUT_END};
pub use time_choice::{TimeChoice, TimeError, clock_label};
pub use tone::{codes_from_display, display_from_light, displayed};

use crate::camera::View;
use glam::Vec3;
use sunbake::sun::SunPath;
use sunbake_shaders::FrameUniform;

/// Optical depth of the air straight up, for red, green and blue.
const AIR_DEPTH: Vec3 = Vec3::new(0.10, 0.165, 0.31);
/// Power by which brightness is compressed.
const ADAPTATION: f32 = 0.42;
/// Power by which all light is scaled up as the light on level ground falls below [`NOON_LIGHT`].
const ADAPTATION_TO_DUSK: f32 = 0.38;
/// Luminance of the light on level ground under a high sun.
const NOON_LIGHT: f32 = 1.9;
/// Share of light that the ground reflects, for red, green and blue.
const GROUND_ALBEDO: Vec3 = Vec3::new(0.36, 0.31, 0.25);
/// Weights of red, green and blue in luminance (ITU-R BT.709).
pub const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// A time of day: where the lights are, and how bright they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Path time, 0 to 1.
    pub t: f32,
    /// The sun's width in path time; 0 without a sun and for a point.
    pub width_t: f32,
    /// Unit vector towards the sun; zero without a sun.
    pub sun_direction: Vec3,
    /// Angular radius of the sun's disc, in radians; 0 for a point.
    pub sun_radius_rad: f32,
    /// One over the sun's angular diameter; very large for a point.
    pub inverse_angular_diameter: f32,
    /// Light of sun, sky and ground.
    pub daylight: Daylight,
    /// The lamp in the scene, if there is one.
    pub lamp: Option<LampMoment>,
}

/// Light of sun, sky and ground: linear RGB, where 1 is a white surface at full exposure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Daylight {
    /// Sunlight on a surface that faces the sun.
    pub sun_light: Vec3,
    /// Skylight on a surface that faces up.
    pub sky_light: Vec3,
    /// Light from the ground on a surface that faces down.
    pub ground_light: Vec3,
    /// The sky's radiance overhead.
    pub zenith: Vec3,
    /// The sky's radiance at the horizon.
    pub horizon: Vec3,
    /// Radiance that the sky has in addition around the sun.
    pub glow: Vec3,
    /// Radiance below the horizon where there is no ground.
    pub haze: Vec3,
}

impl Moment {
    /// Path time `t` of a sun's path. Without a path it is dusk, and there is no sun.
    pub fn new(path: Option<&SunPath>, t: f64) -> Self {
        let Some(path) = path else {
            let daylight = Daylight { sun_light: Vec3::ZERO, glow: Vec3::ZERO, ..Daylight::at_height(-0.1) };
            return Self {
                t: t as f32,
                width_t: 0.0,
                sun_direction: Vec3::ZERO,
                sun_radius_rad: 0.0,
                inverse_angular_diameter: POINT_INVERSE_ANGULAR_DIAMETER,
                daylight,
                lamp: None,
            };
        };
        let direction = path.direction(t);
        let radius = path.angular_radius_rad;
        Self {
            t: t as f32,
            width_t: path.width_t(t) as f32,
            sun_direction: direction.as_vec3(),
            sun_radius_rad: radius as f32,
            inverse_angular_diameter: if radius > 0.0 { (0.5 / radius) as f32 } else { POINT_INVERSE_ANGULAR_DIAMETER },
            daylight: Daylight::at_height(direction.y as f32),
            lamp: None,
        }
    }

    /// The same moment without sunlight; the sky stays.
    pub fn without_sun(self) -> Self {
        Self { daylight: Daylight { sun_light: Vec3::ZERO, ..self.daylight }, ..self }
    }

    /// The same moment without ambient light: only sun and lamp light surfaces. The background stays.
    pub fn without_sky(self) -> Self {
        let daylight = Daylight { sky_light: Vec3::ZERO, ground_light: Vec3::ZERO, ..self.daylight };
        Self { daylight, ..self }
    }

    /// The same moment with a lamp in the scene.
    pub fn with_lamp(self, lamp: Option<LampMoment>) -> Self {
        Self { lamp, ..self }
    }

    /// Whether there is a lamp and no sun.
    pub fn is_lit_by_lamp_alone(&self) -> bool {
        self.lamp.is_some() && self.sun_direction == Vec3::ZERO
    }

    /// The uniform that shaders read of a view at this moment.
    pub fn uniform(&self, view: &View) -> FrameUniform {
        let light = &self.daylight;
        FrameUniform {
            clip_from_eye: view.clip_from_eye().to_cols_array_2d(),
            eye_m: view.eye_m.into(),
            pixel_angle_rad: view.pixel_angle_rad,
            ray_first: view.ray_first.into(),
            t: self.t,
            ray_per_column: view.ray_per_column.into(),
            width_t: self.width_t,
            ray_per_row: view.ray_per_row.into(),
            sun_cos_radius: self.sun_cos_radius(),
            sun_direction: self.sun_direction.into(),
            inverse_angular_diameter: self.inverse_angular_diameter,
            sun_light: light.sun_light.into(),
            sky_light: light.sky_light.into(),
            ground_light: light.ground_light.into(),
            zenith: light.zenith.into(),
            horizon: light.horizon.into(),
            glow: light.glow.into(),
            haze: light.haze.into(),
            ..bytemuck::Zeroable::zeroed()
        }
    }

    /// The sun's visibility where nothing hides it: the share of its disc in front of the surface's plane. Twin of
    /// `baked/sun_open.wgsl`.
    pub fn open_visibility(&self, geometric_normal: Vec3) -> f32 {
        (0.5 + geometric_normal.dot(self.sun_direction) * self.inverse_angular_diameter).clamp(0.0, 1.0)
    }

    fn sun_cos_radius(&self) -> f32 {
        if self.sun_radius_rad > 0.0 { self.sun_radius_rad.cos() } else { 2.0 }
    }
}

/// [`Moment::inverse_angular_diameter`] of a point sun: it is wholly above or below any plane.
const POINT_INVERSE_ANGULAR_DIAMETER: f32 = 1e9;

impl Daylight {
    /// Light when the sine of the sun's elevation is `height`.
    pub fn at_height(height: f32) -> Self {
        let up = height.clamp(0.0, 1.0);
        let through = (AIR_DEPTH * -air_mass(height)).exp();
        let strength = through.dot(LUMINANCE);
        let tint = soften(through / strength.max(1e-9));
        let sun_light = tint * (1.62 * strength.powf(ADAPTATION));
        // Below the horizon the sky goes on darkening through twilight.
        let dusk = (1.0 + height.min(0.0) * 6.0).clamp(0.05, 1.0);
        let level = (0.17 + 0.31 * up.sqrt()) * dusk;
        let warmth = (-up * 6.0).exp();
        let sky_light = Vec3::new(0.66, 0.80, 1.0).lerp(Vec3::new(0.84, 0.74, 0.90), warmth) * level;
        let ground_light = GROUND_ALBEDO * (sun_light * up + sky_light);
        let horizon = Vec3::new(1.05, 1.25, 1.42).lerp(Vec3::new(2.1, 1.22, 0.78), warmth) * (level * 1.25);
        let light = Self {
            sun_light,
            sky_light,
            ground_light,
            zenith: Vec3::new(0.26, 0.55, 1.22).lerp(Vec3::new(0.40, 0.56, 1.05), warmth) * level,
            horizon,
            glow: tint * (1.0 * strength.powf(0.30) * dusk),
            haze: horizon * 0.45 + ground_light * 0.35,
        };
        light.exposed_for((sun_light * up + sky_light).dot(LUMINANCE))
    }

    /// The same light, as seen by an eye that has adapted to the light on level ground.
    fn exposed_for(self, on_level_ground: f32) -> Self {
        let gain = (NOON_LIGHT / on_level_ground.max(0.02)).powf(ADAPTATION_TO_DUSK).max(1.0);
        Self {
            sun_light: self.sun_light * gain,
            sky_light: self.sky_light * gain,
            ground_light: self.ground_light * gain,
            zenith: self.zenith * gain,
            horizon: self.horizon * gain,
            glow: self.glow * gain,
            haze: self.haze * gain,
        }
    }
}

/// Keeps a low sun orange; the air alone would make it a pure red that no display can show.
fn soften(tint: Vec3) -> Vec3 {
    let soft = tint.powf(0.72);
    soft / soft.dot(LUMINANCE)
}

/// The mass of air in the sun's way, relative to straight up. `height` is the sine of the sun's elevation.
fn air_mass(height: f32) -> f32 {
    let elevation_deg = height.clamp(0.0, 1.0).asin().to_degrees();
    1.0 / (height.max(0.0) + 0.505_72 * (elevation_deg + 6.079_95).powf(-1.636_4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_mass_is_one_overhead_and_38_at_the_horizon() {
        assert!((air_mass(1.0) - 1.0).abs() < 1e-3 && (air_mass(0.0) - 37.92).abs() < 0.1);
    }

    #[test]
    fn a_low_sun_is_dimmer_and_redder_than_a_high_one() {
        let [low, high] = [0.05, 0.9].map(Daylight::at_height);
        assert!(low.sun_light.dot(LUMINANCE) < high.sun_light.dot(LUMINANCE));
        assert!(low.sun_light.x / low.sun_light.z > 2.0 * high.sun_light.x / high.sun_light.z);
    }

    #[test]
    fn every_height_gives_finite_light() {
        for i in -100..=100 {
            let d = Daylight::at_height(i as f32 / 100.0);
            let all = [d.sun_light, d.sky_light, d.ground_light, d.zenith, d.horizon, d.glow, d.haze];
            assert!(all.iter().all(|c| c.is_finite() && c.min_element() >= 0.0), "{d:?}");
        }
    }
}
