//! What is decided about times.

use super::{Decision, Effect, Facts, NoSun};
use crate::lamp::LampPath;
use crate::maps::Bits;
use crate::settings::{BakeSettings, TrackChoice};
use crate::sun::SunPath;

/// What decides about times.
pub(super) struct Times<'a> {
    /// The sun's path, if times of the sun are stored.
    pub path: Option<&'a SunPath>,
    /// The lamp's path, if times of a lamp are stored.
    pub lamp: Option<&'a LampPath>,
    pub settings: &'a BakeSettings,
    /// Why there is no sun, where there is none.
    pub no_sun: NoSun,
}

impl Times<'_> {
    pub fn decisions(&self) -> [Decision; 8] {
        let &BakeSettings { bits, engine, layer_cap, lane_count, loss_map, tracks, .. } = self.settings;
        let has_times = self.path.is_some() || self.lamp.is_some();
        let sun_radius_rad = self.path.map(|path| path.angular_radius_rad);
        let sun_radius_deg = sun_radius_rad.map(f64::to_degrees);
        let lamp_radius_m = self.lamp.map(LampPath::radius_m);
        let has_width = sun_radius_rad.map(|radius| radius > 0.0);
        let is_wide = sun_radius_deg.is_some_and(|deg| deg > 0.0) || lamp_radius_m.is_some_and(|m| m > 0.0);
        let arcs = self.path.map(|path| path.arcs().len()).ok_or(self.no_sun);
        let segments = self.lamp.map(|lamp| lamp.segments().count());
        let decision = |effect, is_on, facts| Decision { effect, is_on, facts };
        [
            decision(Effect::SunIntervals, self.path.is_some(), Facts::Sun { arcs, bits, engine }),
            decision(Effect::LampIntervals, self.lamp.is_some(), Facts::Lamp { segments, bits, engine }),
            decision(Effect::Penumbra, is_wide, Facts::Widths { sun_radius_deg, lamp_radius_m }),
            decision(
                Effect::DiscLanes,
                has_width == Some(true) && lane_count > 1,
                Facts::Lanes { count: lane_count, has_width },
            ),
            decision(
                Effect::ShadowTracks,
                has_width == Some(true) && tracks != TrackChoice::Off,
                Facts::Tracks { choice: tracks, has_width, texels: None },
            ),
            decision(
                Effect::SeveralLayers,
                has_times && layer_cap > 1,
                Facts::Layers { cap: layer_cap, has_times, bits, needed: None },
            ),
            decision(
                Effect::SixteenBitTimes,
                has_times && bits == Bits::Sixteen,
                Facts::Depth { bits, half_step_s: self.half_step_s() },
            ),
            decision(Effect::LossMap, loss_map && has_times, Facts::Losses { is_asked: loss_map, has_times }),
        ]
    }

    /// Half the time between two codes, in seconds: how far off a stored edge is at most.
    fn half_step_s(&self) -> Option<f64> {
        let duration_min = self.path.map(|path| path.duration_min).or(self.lamp.map(LampPath::duration_min));
        duration_min.map(|min| 0.5 * 60.0 * min / f64::from(self.settings.bits.max_code()))
    }
}
