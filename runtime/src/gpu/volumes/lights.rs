//! The point lights of a frame.

use super::VolumeRenderer;
use super::plan::{hard_lights, light_blend};
use super::programs::LightBlend;
use crate::gpu::frame::Output;
use crate::light::{Moment, SunDisc, WITHOUT_END};
use crate::volumes::Light;
use glam::Vec3;
use sunbake_shaders::HardLight;

/// A light of a frame. A sun with a disc is several.
pub struct FrameLight {
    /// The moment, with this light's own direction of the sun.
    pub moment: Moment,
    pub light: Light,
    /// The shader that adds it.
    pub hard: HardLight,
    /// How it is added.
    pub blend: LightBlend,
    /// Its share of the sun's light.
    pub share: f32,
}

/// Index of a light where there is one of each kind: 0 for the sun, 1 for the lamp.
pub fn light_index(light: &Light) -> usize {
    match light {
        Light::Sun { .. } => 0,
        Light::Lamp { .. } => 1,
    }
}

impl VolumeRenderer<'_> {
    /// The lights of a frame, in the order in which they are added.
    pub(super) fn lights(&self, moment: &Moment, output: Output) -> Vec<FrameLight> {
        self.suns(moment, output).into_iter().chain(self.lamp(moment, output)).collect()
    }

    fn suns(&self, moment: &Moment, output: Output) -> Vec<FrameLight> {
        let is_dark = output == Output::Lit && moment.daylight.sun_light == Vec3::ZERO;
        if is_dark || output == Output::LampVisibility {
            return Vec::new();
        }
        let [hard, _] = hard_lights(output);
        let count = self.settings.sun_samples.max(1);
        let disc = SunDisc::new(moment.sun_direction.as_dvec3(), self.sun_radius_rad);
        let direction = |i| if count == 1 { disc.centre } else { disc.direction(i, count, 0.0) };
        // Below the horizon a sun lights nothing.
        let directions = (0..count).map(direction).map(|d| d.as_vec3()).filter(|d| d.y > 0.0);
        let sun = |towards: Vec3| FrameLight {
            moment: Moment { sun_direction: towards, ..*moment },
            light: Light::Sun { towards: towards.as_dvec3() },
            hard,
            blend: light_blend(output, count as usize),
            share: 1.0 / count as f32,
        };
        directions.map(sun).collect()
    }

    fn lamp(&self, moment: &Moment, output: Output) -> Option<FrameLight> {
        // A stage without a lamp has no uniform for one.
        let has_lamp = self.scene.frame.lamp.is_some() && output != Output::Visibility;
        let at = moment.lamp.filter(|_| has_lamp)?;
        let [_, hard] = hard_lights(output);
        let range_m = (at.range_m < WITHOUT_END).then_some(f64::from(at.range_m));
        Some(FrameLight {
            moment: *moment,
            light: Light::Lamp { position_m: at.position_m.as_dvec3(), range_m },
            hard,
            blend: light_blend(output, 1),
            share: 1.0,
        })
    }
}
