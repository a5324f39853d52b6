//! What is decided about ambient light.

use super::{Decision, Effect, Facts};
use crate::settings::AmbientRequest;

/// An effect, and whether a request for ambient light calls for it.
type Condition = (Effect, fn(&AmbientRequest) -> bool);

const CONDITIONS: [Condition; 6] = [
    (Effect::AmbientOcclusion, |_| true),
    (Effect::AmbientDistance, |request| request.estimate.distance_m.is_some()),
    (Effect::BentNormals, |request| request.estimate.wants_bent),
    (Effect::SkyHarmonics, |request| request.estimate.wants_sky),
    (Effect::VertexAmbient, |request| request.vertices.is_some()),
    (Effect::AmbientNumbers, |request| request.exr),
];

/// What of ambient light is baked.
pub(super) fn decisions(request: Option<AmbientRequest>) -> impl Iterator<Item = Decision> {
    CONDITIONS.iter().map(move |(effect, is_asked)| Decision {
        effect: *effect,
        is_on: request.as_ref().is_some_and(is_asked),
        facts: Facts::Ambient(request),
    })
}
