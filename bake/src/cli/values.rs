//! Reading the values of options. An error says what to give instead.

use super::args::Only;
use sunbake::maps::Bits;
use sunbake::settings::{EngineChoice, TrackChoice, VertexAttribute};

pub fn parse_only(text: &str) -> Result<Only, String> {
    match text {
        "intervals" => Ok(Only::Intervals),
        "ao" => Ok(Only::Ao),
        _ => Err(format!("`{text}` is nothing to bake: give `intervals` or `ao`")),
    }
}

pub fn parse_rays(text: &str) -> Result<u32, String> {
    let count: Option<u32> = text.parse().ok().filter(|n| (4..=65_536).contains(n));
    let count = count.ok_or_else(|| format!("`{text}` is not a number of rays from 4 to 65536"))?;
    if count.is_power_of_two() {
        return Ok(count);
    }
    let above = count.next_power_of_two();
    Err(format!("{count} is no power of two, at which rays are spread evenly: give {} or {above}", above / 2))
}

pub fn parse_metres(text: &str) -> Result<f64, String> {
    let valid = |x: &f64| x.is_finite() && *x > 0.0;
    text.parse().ok().filter(valid).ok_or_else(|| format!("`{text}` is not a positive number of metres"))
}

pub fn parse_error(text: &str) -> Result<f64, String> {
    let valid = |x: &f64| (0.001..=0.5).contains(x);
    text.parse().ok().filter(valid).ok_or_else(|| format!("`{text}` is not an error from 0.001 to 0.5"))
}

pub fn parse_attribute(text: &str) -> Result<VertexAttribute, String> {
    match text {
        "COLOR_0" => Ok(VertexAttribute::Color),
        "_AO" => Ok(VertexAttribute::Ao),
        _ => Err(format!("`{text}` is no attribute for ambient occlusion: give COLOR_0 or _AO")),
    }
}

pub fn parse_bits(text: &str) -> Result<Bits, String> {
    let count = text.parse().ok().and_then(Bits::from_count);
    count.ok_or_else(|| format!("`{text}` is no depth of a stored time: give 8 or 16"))
}

pub fn parse_tracks(text: &str) -> Result<TrackChoice, String> {
    let all = [TrackChoice::Auto, TrackChoice::On, TrackChoice::Off];
    let choice = all.into_iter().find(|choice| choice.name() == text);
    choice.ok_or_else(|| format!("`{text}` is no choice of tracks: give auto, on or off"))
}

pub fn parse_lanes(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|n| [1, 3, 5].contains(n));
    count.ok_or_else(|| format!("`{text}` is no number of lanes: give 1, 3 or 5"))
}

pub fn parse_window(text: &str) -> Result<[f64; 2], String> {
    sunbake::sun::parse_window(text).map_err(|e| e.to_string())
}

pub fn parse_density(text: &str) -> Result<f64, String> {
    let valid = |x: &f64| sunbake::scene::is_density(*x);
    let wrong = || format!("`{text}` is not a number of texels per metre from 0.000001 to 1000000");
    text.parse().ok().filter(valid).ok_or_else(wrong)
}

pub fn parse_engine(text: &str) -> Result<EngineChoice, String> {
    if text == "exact" {
        return Ok(EngineChoice::Exact);
    }
    let wrong = || format!("`{text}` is not an engine: give exact, or rays:N or bisect:N with N from 2 to 65536");
    let (name, count) = text.split_once(':').ok_or_else(wrong)?;
    let count = count.parse().ok().filter(|n| (2..=65_536).contains(n)).ok_or_else(wrong)?;
    match name {
        "rays" => Ok(EngineChoice::Rays(count)),
        "bisect" => Ok(EngineChoice::Bisect(count)),
        _ => Err(wrong()),
    }
}

pub fn parse_edge_seconds(text: &str) -> Result<f64, String> {
    let valid = |seconds: &f64| (0.001..=3600.0).contains(seconds);
    text.parse().ok().filter(valid).ok_or_else(|| format!("`{text}` is not a number of seconds from 0.001 to 3600"))
}

pub fn parse_budget(text: &str) -> Result<f64, String> {
    let valid = |seconds: &f64| (10.0..=86_400.0).contains(seconds);
    text.parse().ok().filter(valid).ok_or_else(|| format!("`{text}` is not a number of seconds from 10 to 86400"))
}

pub fn parse_bytes(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is not a size: give bytes with K, M or G, as 8G");
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let shift = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        _ => return Err(wrong()),
    };
    let count: u64 = digits.parse().map_err(|_| wrong())?;
    count.checked_mul(1 << shift).filter(|&bytes| bytes > 0).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_with_their_unit() {
        assert_eq!(parse_bytes("500M"), Ok(500 << 20));
        assert_eq!(parse_bytes("8g"), Ok(8 << 30));
        assert_eq!(parse_bytes("77"), Ok(77));
        for bad in ["", "G", "8T", "-1", "0", "99999999999999G"] {
            assert!(parse_bytes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lanes_are_one_three_or_five() {
        assert_eq!(["1", "3", "5"].map(parse_lanes), [Ok(1), Ok(3), Ok(5)]);
        for bad in ["", "0", "2", "7", "-3", "three"] {
            assert!(parse_lanes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn rays_are_powers_of_two_and_the_nearest_are_named() {
        assert_eq!(["4", "256", "65536"].map(parse_rays), [Ok(4), Ok(256), Ok(65_536)]);
        assert!(parse_rays("100").is_err_and(|text| text.contains("64 or 128")));
        for bad in ["", "0", "2", "3", "65537", "131072", "-4", "many"] {
            assert!(parse_rays(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn engines_outside_their_range_are_refused() {
        assert_eq!(parse_engine("rays:256"), Ok(EngineChoice::Rays(256)));
        assert_eq!(parse_engine("bisect:64"), Ok(EngineChoice::Bisect(64)));
        for bad in ["rays", "rays:", "rays:0", "rays:1", "rays:65537", "rays:-3", "bisect", "bisect:1", "sun:7"] {
            assert!(parse_engine(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn every_engine_reads_what_it_prints() {
        for engine in [EngineChoice::Rays(7), EngineChoice::Bisect(65_536)] {
            assert_eq!(parse_engine(&engine.to_string()), Ok(engine));
        }
    }

    #[test]
    fn edges_are_asked_for_in_seconds() {
        assert_eq!(parse_edge_seconds("0.5"), Ok(0.5));
        for bad in ["", "0", "-1", "3601", "nan", "inf", "1s"] {
            assert!(parse_edge_seconds(bad).is_err(), "{bad}");
        }
    }
}
