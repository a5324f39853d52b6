//! Reading the values of options. An error says what to give instead.

use super::args::TechniqueChoice;
use sunbake_runtime::light::WITHOUT_END;
use sunbake_runtime::shadow_maps::Variant;
use sunbake_runtime::technique::Truth;
use sunbake_runtime::volumes::Mode;

/// Reads `WIDTHxHEIGHT`.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("`{text}` is not a size: give WIDTHxHEIGHT in pixels, as 1280x720");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let edge = |text: &str| text.parse().ok().filter(|edge| (1..=16_384).contains(edge)).ok_or_else(wrong);
    Ok([edge(width)?, edge(height)?])
}

pub fn parse_range(text: &str) -> Result<f32, String> {
    let range_m = text.parse().ok().filter(|range_m: &f32| *range_m > 0.0 && *range_m < WITHOUT_END);
    range_m.ok_or_else(|| format!("`{text}` is not a range: give metres above 0"))
}

pub fn parse_technique(text: &str) -> Result<TechniqueChoice, String> {
    let wrong = || {
        let modes = Mode::ALL.map(|mode| mode.to_string()).join(", ");
        let variants = Variant::ALL.map(|variant| variant.to_string()).join(", ");
        format!(
            "`{text}` is not a technique: give baked, {modes}, map, {variants}, truth:hard, truth:soft, or \
             truth:soft:N with N from 1 to 65536"
        )
    };
    if text == "map" {
        return Ok(TechniqueChoice::Map(Variant::default()));
    }
    if let Some(variant) = Variant::ALL.into_iter().find(|variant| variant.to_string() == text) {
        return Ok(TechniqueChoice::Map(variant));
    }
    if let Some(mode) = Mode::ALL.into_iter().find(|mode| mode.to_string() == text) {
        return Ok(TechniqueChoice::Volumes(mode));
    }
    match text {
        "baked" => Ok(TechniqueChoice::Baked),
        "truth:hard" => Ok(TechniqueChoice::Truth(Truth::Hard)),
        "truth:soft" => Ok(TechniqueChoice::Truth(Truth::Soft { rays: Truth::DEFAULT_RAYS })),
        _ => {
            let rays = text.strip_prefix("truth:soft:").and_then(|n| n.parse().ok()).ok_or_else(wrong)?;
            (1..=65_536).contains(&rays).then_some(TechniqueChoice::Truth(Truth::Soft { rays })).ok_or_else(wrong)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_techniques_outside_their_range_are_refused() {
        assert_eq!(parse_size("640x360"), Ok([640, 360]));
        for bad in ["640", "0x4", "x", "4x", "20000x4", "-4x4", "4x4x4"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_technique("truth:soft:9"), Ok(TechniqueChoice::Truth(Truth::Soft { rays: 9 })));
        assert_eq!(parse_technique("volumes"), Ok(TechniqueChoice::Volumes(Mode::Planned)));
        assert_eq!(parse_technique("volumes:gpu"), Ok(TechniqueChoice::Volumes(Mode::Gpu)));
        assert_eq!(parse_technique("map"), Ok(TechniqueChoice::Map(Variant::Cascades)));
        assert_eq!(parse_technique("map:cube"), Ok(TechniqueChoice::Map(Variant::Cube)));
        for bad in [
            "map:",
            "map:pcf",
            "maps",
            "truth",
            "truth:",
            "truth:soft:",
            "truth:soft:0",
            "truth:soft:x",
            "volumes:",
            "volumes:z",
        ] {
            assert!(parse_technique(bad).is_err(), "{bad}");
        }
    }
}
