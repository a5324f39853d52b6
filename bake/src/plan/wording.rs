//! The effect plan in sentences: why an effect is on or off, what it costs, what toggles it.
//!
//! Every sentence of the plan is here. They name options of the command line, since they are written for its users.

use super::{Decision, Effect, Facts, LayersNeeded, NoSun};
use crate::disk::manifest::EffectEntry;
use crate::maps::Bits;
use crate::settings::{AmbientRequest, EngineChoice, TrackChoice};
use crate::words::{counted, either};

/// What the manifest says of a decision.
pub(super) fn entry(decision: &Decision) -> EffectEntry {
    let &Decision { effect, is_on, facts } = decision;
    EffectEntry {
        effect: effect.name().into(),
        on: is_on,
        why: why(effect, is_on, facts),
        cost: cost(effect, is_on, facts),
        toggled_by: toggled_by(effect, is_on, facts),
    }
}

fn why(effect: Effect, is_on: bool, facts: Facts) -> String {
    match facts {
        Facts::Sun { arcs: Ok(arcs), .. } => format!("the sun is up, along {}", counted(arcs as u64, "arc")),
        Facts::Sun { arcs: Err(no_sun), .. } => why_no_sun(no_sun).into(),
        Facts::Lamp { segments: Some(segments), .. } => {
            format!("a lamp moves along {}", counted(segments as u64, "straight segment"))
        }
        Facts::Lamp { segments: None, .. } => "no lamp is asked for; --lamp bakes one beside the sun".into(),
        Facts::Widths { sun_radius_deg, lamp_radius_m } => why_penumbra(sun_radius_deg, lamp_radius_m),
        Facts::Lanes { has_width: None, .. } => "there is no sun".into(),
        Facts::Lanes { has_width: Some(false), .. } => "a light without width has no disc to divide into lanes".into(),
        Facts::Lanes { count, .. } if is_on => format!("--lanes {count}: edges along the path soften in {count} steps"),
        Facts::Lanes { .. } => "the sun is taken as a line along its path; --lanes 3 or 5 divides its disc".into(),
        Facts::Tracks { choice: TrackChoice::Off, .. } => {
            "not asked for; --tracks draws shadows that are narrower than texels".into()
        }
        Facts::Tracks { has_width: None, .. } => "there is no sun".into(),
        Facts::Tracks { has_width: Some(false), .. } => "they are read as shares of a light's width".into(),
        Facts::Tracks { texels: Some([0, all]), .. } => {
            format!("none of {} would gain anything", counted(all, "texel"))
        }
        Facts::Tracks { texels: Some([some, all]), .. } => {
            let have = either(some, "has", "have");
            format!("{some} of {} {have} some", counted(all, "texel"))
        }
        Facts::Tracks { choice: TrackChoice::Auto, .. } => {
            "--tracks: where shade moves from texel to texel, and they draw it better".into()
        }
        Facts::Tracks { .. } => "--tracks=on: wherever shade moves from texel to texel".into(),
        Facts::Layers { has_times: false, .. } | Facts::Depth { half_step_s: None, .. } => "no times are stored".into(),
        Facts::Layers { cap, needed: Some(needed), .. } => why_layers(cap, needed),
        Facts::Layers { cap: 1, .. } => "--layers 1: what is beyond four intervals is merged".into(),
        Facts::Layers { cap, .. } => {
            format!("as many layers of four intervals as texels need, {cap} at most (--layers)")
        }
        Facts::Depth { bits, half_step_s: Some(s) } => {
            format!("--bits {}, given or by preset: edges are stored to {s:.2} s", bits.count())
        }
        Facts::Losses { is_asked: false, .. } => "not asked for".into(),
        Facts::Losses { has_times: true, .. } => "--loss-map asks for it".into(),
        Facts::Losses { .. } => "no times are stored, and none can be lost".into(),
        Facts::Surfaces { surfaces, .. } => why_surfaces(effect, surfaces as u64),
        Facts::Smooth { is_asked: false, .. } => "--flat-terminator: light ends face by face".into(),
        Facts::Smooth { has_times: false, .. } => "no times are stored".into(),
        Facts::Smooth { triangles: 0, .. } => "no surface of several faces is smooth-shaded".into(),
        Facts::Smooth { triangles, .. } => {
            let triangles = triangles as u64;
            let are = either(triangles, "is a facet", "are facets");
            format!("{} {are} of smooth-shaded surfaces", counted(triangles, "triangle"))
        }
        Facts::Walls { pages: None } => "wherever a wall stands between neighbouring texels".into(),
        Facts::Walls { pages: Some([0, all]) } => {
            format!("no wall stands between texels of {}", counted(all as u64, "page"))
        }
        Facts::Walls { pages: Some([1, 1]) } => "walls stand between neighbouring texels of the page".into(),
        Facts::Walls { pages: Some([walled, all]) } => {
            format!("walls stand between neighbouring texels of {walled} of {}", counted(all as u64, "page"))
        }
        Facts::Ambient(None) => "--only asks for no ao".into(),
        Facts::Ambient(Some(request)) if is_on => why_ambient(effect, &request),
        Facts::Ambient(Some(_)) => why_no_ambient(effect).into(),
    }
}

fn why_surfaces(effect: Effect, surfaces: u64) -> String {
    let what = match effect {
        Effect::AlphaMask => either(surfaces, "has an alpha mask", "have an alpha mask"),
        _ => either(surfaces, "is double-sided", "are double-sided"),
    };
    format!("{} {what}", counted(surfaces, "drawn surface"))
}

fn why_no_sun(no_sun: NoSun) -> &'static str {
    match no_sun {
        NoSun::NotAsked => "--only asks for no intervals",
        NoSun::LampInstead => "a lamp is baked instead",
        NoSun::DoesNotRise => "the sun does not rise",
    }
}

fn why_penumbra(sun_radius_deg: Option<f64>, lamp_radius_m: Option<f64>) -> String {
    let sun = sun_radius_deg.map(|deg| format!("the light's radius is {deg:.3} degrees"));
    let lamp = lamp_radius_m.map(|m| format!("the lamp's radius is {m} m"));
    match (sun, lamp) {
        (None, None) => "there is no light whose times are stored".into(),
        (sun, lamp) => sun.into_iter().chain(lamp).collect::<Vec<_>>().join(", "),
    }
}

/// Of how many layers were needed after all.
fn why_layers(cap: usize, needed: LayersNeeded) -> String {
    let LayersNeeded { layers, crowded_texels, texels } = needed;
    let have = either(crowded_texels, "has", "have");
    let all = counted(texels, "texel");
    let crowded = format!("{crowded_texels} of {all} {have} more than four intervals");
    match (layers, crowded_texels) {
        (2.., _) => format!("{crowded}: {layers} layers"),
        (_, 0) => format!("none of {all} has more than four intervals: one layer holds them all"),
        _ if cap > 1 => format!("{crowded}, but rounding leaves no more than four"),
        _ => format!("{crowded}, and --layers 1 merged them"),
    }
}

fn why_ambient(effect: Effect, request: &AmbientRequest) -> String {
    let estimate = &request.estimate;
    match (effect, estimate.error) {
        (Effect::AmbientDistance, _) => {
            format!("nothing farther than {} m occludes", estimate.distance_m.unwrap_or_default())
        }
        (Effect::BentNormals, _) => "--bent asks for them".into(),
        (Effect::SkyHarmonics, _) => "--sky sh2: nine coefficients a texel".into(),
        (Effect::VertexAmbient, _) => {
            format!("--ao-vertices asks for {}", request.vertices.map_or("", |attribute| attribute.name()))
        }
        (Effect::AmbientNumbers, _) => "--exr asks for them".into(),
        (_, Some(error)) => format!("to {error} with 95 % confidence, by {} rays a texel at most", estimate.rays),
        (_, None) => format!("{} rays a texel", estimate.rays),
    }
}

/// Of a bake with ambient light.
fn why_no_ambient(effect: Effect) -> &'static str {
    match effect {
        Effect::AmbientDistance => {
            "everything occludes, however far; --ao-distance sets a limit, which closed rooms need"
        }
        Effect::BentNormals => "not asked for; --bent bakes them",
        Effect::SkyHarmonics => "not asked for; --sky sh2 bakes them",
        Effect::VertexAmbient => {
            "not asked for; --ao-vertices stores it for engines without a second set of coordinates"
        }
        Effect::AmbientNumbers => "not asked for; --exr writes the numbers beside the textures",
        _ => "",
    }
}

fn cost(effect: Effect, is_on: bool, facts: Facts) -> String {
    match facts {
        Facts::Sun { bits, engine, .. } => format!(
            "{}, layer and lane: a rise and a fall texture with four times each; {} and lane",
            bytes_of_times(bits),
            engine_cost(engine)
        ),
        Facts::Lamp { bits, engine, .. } => {
            format!("as much as a lane of the sun: {} and layer; {}", bytes_of_times(bits), engine_cost(engine))
        }
        Facts::Widths { .. } => {
            "no texture and no ray; playback measures how much of the light's width each interval fills".into()
        }
        Facts::Lanes { count, .. } => {
            let times = if is_on { count.to_string() } else { "3 or 5".into() };
            format!("{times} times the bytes of one lane's times, and {times} times the work of finding them")
        }
        Facts::Tracks { .. } => {
            "a query for each occluder of such a texel; 4 bytes a texel and 6 a span, read in place of the times".into()
        }
        Facts::Layers { bits, .. } => format!("{} and lane for each layer beyond the first", bytes_of_times(bits)),
        Facts::Depth { .. } => "twice the bytes of times: 16 a texel, layer and lane, where 8 bits take 8".into(),
        Facts::Losses { .. } => {
            "a PNG of 4 and an OpenEXR of 8 bytes a texel of each page; 24 bytes of memory a texel meanwhile".into()
        }
        Facts::Surfaces { triangles: 0, .. } if effect == Effect::AlphaMask => {
            "alpha looked up wherever a triangle with an alpha mask is met".into()
        }
        Facts::Surfaces { triangles, .. } if effect == Effect::AlphaMask => {
            format!(
                "alpha looked up wherever one of {} with an alpha mask is met",
                counted(triangles as u64, "triangle")
            )
        }
        Facts::Surfaces { triangles, .. } => format!(
            "times serve both sides; ambient light takes rays and bytes for a second side{}",
            if triangles > 0 { format!(" of {}", counted(triangles as u64, "triangle")) } else { String::new() }
        ),
        Facts::Smooth { .. } => "a short ray and a second query a texel of such a surface".into(),
        Facts::Walls { .. } => "two rays a texel, twelve where something is in the way, and 2 bytes".into(),
        Facts::Ambient(request) => ambient_cost(effect, request.as_ref()),
    }
}

/// Bytes of a pair of textures with four times each, uncompressed.
fn bytes_of_times(bits: Bits) -> String {
    format!("{} bytes a texel", bits.count())
}

fn engine_cost(engine: EngineChoice) -> String {
    match engine {
        EngineChoice::Exact => "one walk of the hierarchy a texel".into(),
        EngineChoice::Rays(count) => format!("{count} rays a texel"),
        EngineChoice::Bisect(count) => format!("{count} rays and some for each edge a texel"),
    }
}

/// Without a request, neither rays nor bits are known.
fn ambient_cost(effect: Effect, request: Option<&AmbientRequest>) -> String {
    match (effect, request) {
        (Effect::AmbientOcclusion, None) => "as many rays a texel and side as --ao-rays says, and 1 or 2 bytes".into(),
        (Effect::AmbientOcclusion, Some(request)) => {
            let bytes = request.bits.count() / 8;
            let unit = if bytes == 1 { "byte" } else { "bytes" };
            let rays = request.estimate.rays;
            format!(
                "{rays} rays a texel and side; {bytes} {unit} a texel, {} on pages with surfaces of two sides",
                3 * bytes
            )
        }
        (Effect::AmbientDistance, _) => "nothing: the same rays end sooner".into(),
        (Effect::BentNormals, _) => "6 bytes a texel and side, in an RGB texture of 16 bits; no ray".into(),
        (Effect::SkyHarmonics, _) => "18 bytes a texel and side, in three RGB textures of 16 bits; no ray".into(),
        (Effect::VertexAmbient, None) => "as many rays a vertex and side as --ao-rays says".into(),
        (Effect::VertexAmbient, Some(request)) => {
            format!("{} rays a vertex and side; vertices.glb, as large as the scene", request.estimate.rays)
        }
        (_, request) => {
            let [bent, sky] = request.map_or([false; 2], |r| [r.estimate.wants_bent, r.estimate.wants_sky]);
            let channels = 1 + 3 * u32::from(bent) + 9 * u32::from(sky);
            format!("an OpenEXR of {} bytes a texel and side for each page; no ray", 4 * channels)
        }
    }
}

fn toggled_by(effect: Effect, is_on: bool, facts: Facts) -> String {
    match facts {
        Facts::Sun { arcs: Ok(_), .. } => "--only ao",
        Facts::Sun { arcs: Err(NoSun::NotAsked), .. } => "intervals among what --only names",
        Facts::Sun { arcs: Err(NoSun::LampInstead), .. } => "a lamp given as --lamp FILE, not as --path FILE",
        Facts::Sun { arcs: Err(NoSun::DoesNotRise), .. } => "another --date or --place, on which the sun rises",
        Facts::Lamp { .. } if is_on => "leaving the lamp's FILE out",
        Facts::Lamp { .. } => "--lamp FILE",
        Facts::Widths { .. } if is_on => {
            "a radius of 0 in the light's FILE (\"angular_radius_deg\", or of a lamp \"radius_m\")"
        }
        Facts::Widths { .. } => {
            "a radius above 0 in the light's FILE (\"angular_radius_deg\", or of a lamp \"radius_m\")"
        }
        Facts::Lanes { .. } if is_on => "--lanes 1",
        Facts::Lanes { has_width: None, .. } => "a sun, and --lanes 3 or 5",
        Facts::Lanes { has_width: Some(false), .. } => "a light with a width, and --lanes 3 or 5",
        Facts::Lanes { .. } => "--lanes 3 or 5",
        Facts::Tracks { texels: Some([0, _]), .. } => "a scene with fences, posts or wires, or coarser texels",
        Facts::Tracks { .. } if is_on => "--tracks=off",
        Facts::Tracks { has_width: Some(true), .. } => "--tracks",
        Facts::Tracks { has_width: None, .. } => "a sun, and --tracks",
        Facts::Tracks { .. } => "a light with a width, and --tracks",
        Facts::Layers { has_times: false, .. } | Facts::Depth { half_step_s: None, .. } => "times to store",
        Facts::Layers { cap: 1, .. } => "--layers 2 or more",
        Facts::Layers { needed: Some(LayersNeeded { layers: 0 | 1, .. }), .. } => {
            "a scene that is lit in more pieces: through fences, wires or leaves"
        }
        Facts::Layers { .. } => "--layers 1",
        Facts::Depth { bits: Bits::Sixteen, .. } => "--bits 8",
        Facts::Depth { bits: Bits::Eight, .. } => "--bits 16",
        Facts::Losses { has_times: false, .. } => "times to store, and --loss-map",
        Facts::Losses { is_asked: true, .. } => "leaving --loss-map out",
        Facts::Losses { is_asked: false, .. } => "--loss-map",
        Facts::Surfaces { surfaces, .. } => return surface_toggle(effect, surfaces).into(),
        Facts::Smooth { .. } if is_on => "--flat-terminator",
        Facts::Smooth { is_asked: false, .. } => "leaving --flat-terminator out",
        Facts::Smooth { has_times: false, .. } => "times to store",
        Facts::Smooth { .. } => "vertex normals that turn from corner to corner of a triangle",
        Facts::Walls { .. } if is_on => "a scene without walls higher than a texel is wide",
        Facts::Walls { .. } => "walls on floors that run on behind them",
        Facts::Ambient(request) => return ambient_toggle(effect, is_on, request.is_some()),
    }
    .into()
}

fn surface_toggle(effect: Effect, surfaces: usize) -> &'static str {
    match (effect, surfaces) {
        (Effect::AlphaMask, 0) => "a material with alphaMode MASK or BLEND",
        (Effect::AlphaMask, _) => "--leave-out MATERIAL, or alphaMode OPAQUE",
        (_, 0) => "a material with \"doubleSided\": true",
        _ => "--leave-out MATERIAL, or \"doubleSided\": false",
    }
}

fn ambient_toggle(effect: Effect, is_on: bool, has_ambient: bool) -> String {
    let [off, on] = match effect {
        Effect::AmbientDistance => ["leaving --ao-distance out", "--ao-distance M"],
        Effect::BentNormals => ["leaving --bent out", "--bent"],
        Effect::SkyHarmonics => ["leaving --sky out", "--sky sh2"],
        Effect::VertexAmbient => ["leaving --ao-vertices out", "--ao-vertices ATTRIBUTE"],
        Effect::AmbientNumbers => ["leaving --exr out", "--exr"],
        _ => ["--only intervals", "ao among what --only names"],
    };
    match (is_on, has_ambient || effect == Effect::AmbientOcclusion) {
        (true, _) => off.into(),
        (false, true) => on.into(),
        (false, false) => format!("{on}, with ao among what --only names"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_a_kind_is_singular() {
        let sun = |arcs| Facts::Sun { arcs: Ok(arcs), bits: Bits::Eight, engine: EngineChoice::Exact };
        let lamp = |count| Facts::Lamp { segments: Some(count), bits: Bits::Eight, engine: EngineChoice::Exact };
        let surfaces = |surfaces| Facts::Surfaces { surfaces, triangles: surfaces };
        for (effect, one, several, of_one, of_several) in [
            (Effect::SunIntervals, sun(1), sun(2), "along 1 arc", "along 2 arcs"),
            (Effect::LampIntervals, lamp(1), lamp(2), "1 straight segment", "2 straight segments"),
            (Effect::AlphaMask, surfaces(1), surfaces(2), "surface has an alpha mask", "surfaces have an alpha mask"),
            (Effect::DoubleSided, surfaces(1), surfaces(2), "surface is double-sided", "surfaces are double-sided"),
            (
                Effect::Walls,
                Facts::Walls { pages: Some([0, 1]) },
                Facts::Walls { pages: Some([1, 2]) },
                "texels of 1 page",
                "texels of 1 of 2 pages",
            ),
        ] {
            for (facts, expected) in [(one, of_one), (several, of_several)] {
                let text = why(effect, true, facts);
                assert!(text.ends_with(expected), "{text}: {expected}");
            }
        }
        let needed = |crowded_texels| LayersNeeded { layers: 2, crowded_texels, texels: 9 };
        assert_eq!(why_layers(4, needed(1)), "1 of 9 texels has more than four intervals: 2 layers");
        assert_eq!(why_layers(4, needed(3)), "3 of 9 texels have more than four intervals: 2 layers");
    }
}
