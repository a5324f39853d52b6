//! How much memory a bake needs, estimated before it starts.

use crate::ambient::Estimate;
use crate::atlas::Sample;
use crate::scene::Scene;
use crate::settings::{AmbientRequest, BakeSettings, TrackChoice};

/// Bytes of a covered texel while its page is baked: its sample, its intervals (three, as a town has on average, and
/// the vectors around them) and its share of the loss statistics.
pub(super) const BYTES_PER_SAMPLE: u64 = 100;
/// Bytes of a covered texel for each lane beyond the first: its intervals.
const BYTES_PER_LANE: u64 = 60;
/// Bytes of a covered texel while tracks are found: 27 spans, as our station has them, which are held as they are
/// found, with merged shade between, as sets of links and as they are stored.
const BYTES_PER_TRACKS: u64 = 27 * 30;
/// Bytes of a texel of a loss map: its numbers, and their copies while they are written.
const BYTES_PER_LOSS: u64 = 24;
/// Additional bytes of a triangle's corners while the ambient visibility of vertices is baked.
const BYTES_PER_CORNERS: u64 = 300;
/// Bytes of a triangle: corners in bake space and in the hierarchy, its box, nodes while building, layout and writing.
const BYTES_PER_TRIANGLE: u64 = 600;

/// Bytes of a texel while ambient light is baked: for each side an estimate, and its numbers as floats, as codes, and
/// as bytes on their way to a file; and the points that its rays start from.
fn ambient_bytes(scene: &Scene, request: &AmbientRequest) -> u64 {
    let has_backs = (0..scene.instances.len()).any(|instance| scene.material(instance).is_double_sided);
    let sides = if has_backs { 2 } else { 1 };
    let estimate = &request.estimate;
    let numbers = 1 + if estimate.wants_bent { 3 } else { 0 } + if estimate.wants_sky { 9 } else { 0 };
    let points = if request.supersample > 1 { 2 * u64::from(request.supersample).pow(2) } else { 0 };
    sides * (size_of::<Estimate>() as u64 + 8 * numbers) + points * size_of::<Sample>() as u64
}

/// Bytes that baking needs at most, with pages of this edge.
pub(super) fn bytes_needed(scene: &Scene, settings: &BakeSettings, page_size_texels: u32) -> u64 {
    let texels = u64::from(page_size_texels).pow(2);
    // A lamp beside the sun is one lane more; one instead of the sun takes its place.
    let lamps = u64::from(settings.lamp.is_some());
    let lanes = settings.lane_count as u64 + lamps;
    // Codes are held twice while they are written; two layers are what a scene usually needs.
    let layers = if settings.bakes_intervals { settings.layer_cap.min(2) as u64 } else { 0 };
    let codes = texels * 16 * layers * 2 * lanes;
    let at_vertices = settings.ambient.is_some_and(|request| request.vertices.is_some());
    let a_triangle = BYTES_PER_TRIANGLE + if at_vertices { BYTES_PER_CORNERS } else { 0 };
    let triangles = scene.triangle_count() as u64 * a_triangle;
    let a_sample = if settings.bakes_intervals { BYTES_PER_SAMPLE } else { size_of::<Sample>() as u64 + 4 };
    let loss_map = if settings.loss_map { BYTES_PER_LOSS } else { 0 };
    let tracks = if settings.tracks != TrackChoice::Off && settings.bakes_intervals { BYTES_PER_TRACKS } else { 0 };
    let ambient = settings.ambient.as_ref().map_or(0, |request| ambient_bytes(scene, request));
    codes + texels * (a_sample + BYTES_PER_LANE * (lanes - 1) + tracks + loss_map + ambient) + triangles
}
