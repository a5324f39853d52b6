//! What is decided about ambient light.

use super::{Decision, Effect};
use crate::settings::{AmbientRequest, BakeSettings};

/// What an effect of ambient light is to be told about.
struct Facet {
    effect: Effect,
    /// Whether a request has it.
    has: fn(&AmbientRequest) -> bool,
    /// Why it is on.
    why: fn(&AmbientRequest) -> String,
    /// Why it is off, though there is ambient light.
    why_off: &'static str,
    /// What it costs.
    cost: fn(&AmbientRequest) -> String,
    /// What turns it off, and on.
    by: [&'static str; 2],
}

const FACETS: [Facet; 6] = [
    Facet {
        effect: Effect::AmbientOcclusion,
        has: |_| true,
        why: |r| match r.estimate.error {
            Some(error) => format!("to {error} with 95 % confidence, by {} rays a texel at most", r.estimate.rays),
            None => format!("{} rays a texel", r.estimate.rays),
        },
        why_off: "",
        cost: |r| {
            let bytes = r.bits.count() / 8;
            format!(
                "{} rays a texel and side; {bytes} {} a texel, {} on pages with surfaces of two sides",
                r.estimate.rays,
                if bytes == 1 { "byte" } else { "bytes" },
                3 * bytes
            )
        },
        by: ["--only intervals", "ao among what --only names"],
    },
    Facet {
        effect: Effect::AmbientDistance,
        has: |r| r.estimate.distance_m.is_some(),
        why: |r| format!("nothing hides from beyond {} m", r.estimate.distance_m.unwrap_or_default()),
        why_off: "everything hides, however far; --ao-distance sets a limit, which closed rooms need",
        cost: |_| "nothing: the same rays end sooner".into(),
        by: ["leaving --ao-distance out", "--ao-distance M"],
    },
    Facet {
        effect: Effect::BentNormals,
        has: |r| r.estimate.wants_bent,
        why: |_| "--bent asks for them".into(),
        why_off: "not asked for; --bent bakes them",
        cost: |_| "6 bytes a texel and side, in an RGB texture of 16 bits; no ray".into(),
        by: ["leaving --bent out", "--bent"],
    },
    Facet {
        effect: Effect::SkyHarmonics,
        has: |r| r.estimate.wants_sky,
        why: |_| "--sky sh2: nine coefficients a texel".into(),
        why_off: "not asked for; --sky sh2 bakes them",
        cost: |_| "18 bytes a texel and side, in three RGB textures of 16 bits; no ray".into(),
        by: ["leaving --sky out", "--sky sh2"],
    },
    Facet {
        effect: Effect::VertexAmbient,
        has: |r| r.vertices.is_some(),
        why: |r| format!("--ao-vertices asks for {}", r.vertices.map_or("", |v| v.name())),
        why_off: "not asked for; --ao-vertices stores it for engines without a second set of coordinates",
        cost: |r| format!("{} rays a vertex and side; vertices.glb, as large as the scene", r.estimate.rays),
        by: ["leaving --ao-vertices out", "--ao-vertices ATTRIBUTE"],
    },
    Facet {
        effect: Effect::AmbientNumbers,
        has: |r| r.exr,
        why: |_| "--exr asks for them".into(),
        why_off: "not asked for; --exr writes the numbers beside the textures",
        cost: |r| {
            let channels = 1 + 3 * u32::from(r.estimate.wants_bent) + 9 * u32::from(r.estimate.wants_sky);
            format!("an OpenEXR of {} bytes a texel and side for each page; no ray", 4 * channels)
        },
        by: ["leaving --exr out", "--exr"],
    },
];

/// What of ambient light is baked, and why.
pub(super) fn decisions(settings: &BakeSettings) -> impl Iterator<Item = Decision> {
    let request = settings.ambient.as_ref();
    FACETS.iter().map(move |facet| match request {
        Some(request) => facet.of(request),
        None => facet.left_out(),
    })
}

impl Facet {
    fn of(&self, request: &AmbientRequest) -> Decision {
        let is_on = (self.has)(request);
        Decision {
            effect: self.effect,
            is_on,
            why: if is_on { (self.why)(request) } else { self.why_off.into() },
            cost: (self.cost)(request),
            toggled_by: self.by[usize::from(!is_on)].into(),
        }
    }

    /// Of a bake without ambient light, which says neither how many rays nor how many bits.
    fn left_out(&self) -> Decision {
        let own = self.by[1];
        let (cost, toggled_by) = match self.effect {
            Effect::AmbientOcclusion => {
                ("as many rays a texel and side as --ao-rays says, and 1 or 2 bytes".into(), own.into())
            }
            Effect::VertexAmbient => ("as many rays a vertex and side as --ao-rays says".into(), with_ao(own)),
            _ => ((self.cost)(&AmbientRequest::with_rays(0)), with_ao(own)),
        };
        Decision { effect: self.effect, is_on: false, why: "--only asks for no ao".into(), cost, toggled_by }
    }
}

fn with_ao(flag: &str) -> String {
    format!("{flag}, with ao among what --only names")
}
