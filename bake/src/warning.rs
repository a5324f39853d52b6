//! What a caller should know of a bake that went well all the same.

use crate::remedy::{Remedy, Setting};
use crate::scene::{SceneWarning, first_of};
use crate::sun::Date;
use crate::words::{counted, either};

/// A light whose visibility is baked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// The sun.
    Sun,
    /// The lamp.
    Lamp,
}

/// Something that was done otherwise than asked, or that looks wrong. Its text says what; [`Warning::remedy`] what to
/// do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Warning {
    /// Something in the scene was not read as the file has it.
    #[error("{0}")]
    Scene(SceneWarning),
    /// `scene.glb` has something otherwise than the scene's own file: what, in a sentence.
    #[error("scene.glb: {0}")]
    NotKept(String),
    /// The sun stays below the horizon all day.
    #[error(
        "the sun does not rise at latitude {latitude_deg} on {date}: its centre stays {} the horizon, so there is no \
         sun",
        depth_below(*highest_elevation_deg)
    )]
    NoSunrise {
        /// Degrees north.
        latitude_deg: f64,
        /// The day.
        date: Date,
        /// Highest elevation of the sun's centre, in degrees: not above 0, up to rounding.
        highest_elevation_deg: f64,
    },
    /// North is turned, and the sun does not depend on it.
    #[error("the scene's own light is the sun, which north turned by {north_deg} degrees does not move")]
    NorthUnused {
        /// Degrees that north is turned from -Z towards +X.
        north_deg: f64,
    },
    /// Nothing is left that can be shaded.
    #[error(
        "{}, so the set has no texels: there is nothing to bake",
        if *is_empty { "everything is left out" } else { "nothing takes shadows" }
    )]
    NothingToBake {
        /// Whether everything is left out, and nothing is drawn either.
        is_empty: bool,
    },
    /// A mesh does not fit a page, so charts are closer together than asked.
    #[error(
        "{misfit} of {page_size_texels} texels with a padding of {asked_texels}: it was baked with a padding of \
         {used_texels}"
    )]
    PaddingReduced {
        /// What does not fit, up to the word page or pages.
        misfit: String,
        /// Edge of the page, in texels.
        page_size_texels: u32,
        /// Padding asked for, in texels.
        asked_texels: u32,
        /// Padding it came to, in texels.
        used_texels: u32,
    },
    /// A mesh does not fit a page, so pages are larger than asked.
    #[error("{misfit} of {asked_texels} texels: it was baked on pages of {used_texels}")]
    PageEnlarged {
        /// What does not fit, up to the word page or pages.
        misfit: String,
        /// What would make it smaller.
        smaller: Vec<Remedy>,
        /// Edge asked for, in texels.
        asked_texels: u32,
        /// Edge it came to, in texels.
        used_texels: u32,
    },
    /// Charts take more pages than asked.
    #[error("the charts take {pages} pages of {page_size_texels} texels; larger pages take fewer")]
    ManyPages {
        /// Number of pages that the charts take.
        pages: usize,
        /// Edge of each, in texels.
        page_size_texels: u32,
    },
    /// Some meshes do not get the density asked for.
    #[error(
        "{} not fit a page of {page_size_texels} texels at {asked_per_metre} texels a metre; mesh {mesh} gets \
         {reached_per_metre:.3}",
        if *meshes == 1 { "a mesh does".to_owned() } else { format!("{meshes} meshes do") }
    )]
    LessDensity {
        /// Number of meshes that get a lower density.
        meshes: usize,
        /// Edge of a page, in texels.
        page_size_texels: u32,
        /// Texels a metre, asked for.
        asked_per_metre: f64,
        /// Name of the mesh that gets least.
        mesh: String,
        /// Texels a metre that it gets.
        reached_per_metre: f64,
    },
    /// The file's own coordinates fill one page, which decides the density.
    #[error(
        "TEXCOORD_1 fills one page, so the density is {reached_per_metre:.3} texels a metre instead of \
         {asked_per_metre}"
    )]
    DensityGiven {
        /// Texels a metre, asked for.
        asked_per_metre: f64,
        /// Texels a metre that it came to.
        reached_per_metre: f64,
    },
    /// The file's own coordinates could not be used.
    #[error(
        "TEXCOORD_1 of {} tiles, overlaps, has no area or has islands too close together: unwrapped",
        first_of(meshes, 3)
    )]
    Unwrapped {
        /// The meshes' labels, each once.
        meshes: Vec<String>,
    },
    /// An object alone hides the sun from much of the rest.
    #[error(
        "{} alone hides the sun from {:.0} % of what would see it; if it is an outline or a collision shell, leave it \
         out; water should cast no shadow, and a sky dome should neither cast nor take any",
        .0.object,
        100.0 * .0.share
    )]
    Occluder(Occluder),
    /// Clear surfaces let the light through.
    #[error(
        "light passes {} as if {} not there, untinted, for {} or blends below one half; where it should be stopped, \
         set sunbake_no_cast to false in the extras",
        first_of(materials, 3),
        if materials.len() == 1 { "it were" } else { "they were" },
        if materials.len() == 1 { "it transmits" } else { "each of them transmits" }
    )]
    Clear {
        /// The materials' labels, each once.
        materials: Vec<String>,
    },
    /// Objects are hardly wider than the texels on them or around them.
    #[error(
        "{} narrower than two texels of {}, {}: {}; {} blurred or lost",
        if *count == 1 { "an object is".to_owned() } else { format!("{count} objects are") },
        length(*texel_m),
        either(*count as u64, "its own or those around it", "their own or those around them"),
        first_of(objects, 3) + if *count > objects.len() { " and others" } else { "" },
        either(*count as u64, "its shadow is", "their shadows are")
    )]
    Narrow {
        /// How many.
        count: usize,
        /// Texts that select the narrowest of them ([`crate::scene::Selection`]), at least one.
        objects: Vec<String>,
        /// Width of a texel on the narrowest or, if that is wider, of one around it, metres.
        texel_m: f64,
        /// A density at which the narrowest would be eight texels wide, texels a metre.
        texels_per_metre: f64,
    },
    /// Nearly nothing sees the sun.
    #[error(
        "{:.0} % of the texels never see the sun; if that is wrong, something may enclose the scene, as an outline \
         hull or a sky dome does: leave its material out",
        100.0 * share
    )]
    Dark {
        /// Share of the texels, 0 to 1.
        share: f64,
    },
    /// Texels have more intervals than their layers hold.
    #[error(
        "{} {} more intervals{} than {} {}: the worst is wrong for {worst_min:.1} minutes of the day, and {} would \
         keep them all",
        counted(*texels, "texel"),
        either(*texels, "has", "have"),
        if *light == Light::Lamp { " of the lamp" } else { "" },
        counted(*layer_cap as u64, "layer"),
        either(*layer_cap as u64, "holds", "hold"),
        counted(*needed_layers, "layer")
    )]
    Merged {
        /// The light whose intervals did not fit.
        light: Light,
        /// Number of texels with more intervals than the layers hold.
        texels: u64,
        /// Layers that were allowed.
        layer_cap: usize,
        /// Most minutes that a texel is wrong for.
        worst_min: f64,
        /// Layers that would hold everything.
        needed_layers: u64,
    },
    /// Rays ran out before the error was small enough.
    #[error("{} may still be off by more than {error} after {rays} rays of sky", counted(*texels, "texel"))]
    AmbientUnconverged {
        /// Number of sides of texels whose error may be larger.
        texels: u64,
        /// Error of ambient occlusion asked for.
        error: f64,
        /// Most rays a texel.
        rays: u32,
    },
    /// Pages are too large for as many points a texel as asked.
    #[error("pages are too large for {asked} x {asked} points a texel: some had {used} x {used}")]
    FewerPoints {
        /// Points along a texel's edge, asked for.
        asked: u32,
        /// What it came to on some pages.
        used: u32,
    },
}

/// What may hide the sun by mistake.
#[derive(Debug, Clone, PartialEq)]
pub struct Occluder {
    /// What it is called: `node "SkySphere"`, `material 3`.
    pub object: String,
    /// A text that selects it ([`crate::scene::Selection`]).
    pub name: String,
    /// Share of the light of all else that it alone takes, 0 to 1.
    pub share: f64,
}

/// How far below the horizon an elevation is, for a sentence: not as `-0.0 degrees`.
fn depth_below(elevation_deg: f64) -> String {
    match -elevation_deg {
        depth_deg @ 0.05.. => format!("at least {depth_deg:.1} degrees below"),
        _ => "just below".into(),
    }
}

/// A value as a shell takes it.
fn in_quotes(value: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-:.=/+".contains(c);
    match value.chars().all(is_plain) && !value.is_empty() {
        true => value.to_owned(),
        false => format!("'{}'", value.replace('\'', "'\\''")),
    }
}

/// A length with its unit.
fn length(metres: f64) -> String {
    match metres {
        0.0..1.0 => format!("{:.0} cm", 100.0 * metres),
        _ => format!("{metres:.1} m"),
    }
}

/// Most layers that may be asked for.
const MOST_LAYERS: u64 = 16;
/// Most rays of sky that may be asked for.
const MOST_RAYS: u32 = 65_536;

impl Warning {
    /// What to do about it, if a setting can help.
    pub fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Scene(_)
            | Self::NotKept(_)
            | Self::Clear { .. }
            | Self::PaddingReduced { .. }
            | Self::Unwrapped { .. } => None,
            Self::NoSunrise { .. } => Some(Remedy::Change(Setting::Date)),
            Self::NorthUnused { .. } => Some(Remedy::Set(Setting::Place, "LAT,LON".into())),
            Self::NothingToBake { is_empty: true } => Some(Remedy::Fewer(Setting::LeaveOut)),
            Self::NothingToBake { is_empty: false } => {
                Some(Remedy::AnyOf([Setting::NoReceive, Setting::LeaveOut].map(Remedy::Fewer).into()))
            }
            Self::PageEnlarged { smaller, used_texels, .. } => {
                let page = Remedy::Set(Setting::PageSize, used_texels.to_string());
                Some(Remedy::AnyOf([page].into_iter().chain(smaller.iter().cloned()).collect()))
            }
            Self::ManyPages { .. } | Self::LessDensity { .. } | Self::DensityGiven { .. } => {
                Some(Remedy::Raise(Setting::PageSize))
            }
            Self::Dark { .. } => Some(Remedy::Set(Setting::LeaveOut, "MATERIAL".into())),
            Self::Occluder(Occluder { name, .. }) => {
                let set = |setting| (setting, in_quotes(name));
                let alone = |setting| Remedy::Set(setting, in_quotes(name));
                // Not to take shadows does not help alone: it would go on to cast them.
                let both = Remedy::SetAll([Setting::NoCast, Setting::NoReceive].map(set).into());
                Some(Remedy::any([alone(Setting::LeaveOut), alone(Setting::NoCast), both]))
            }
            Self::Narrow { objects, texels_per_metre, .. } => {
                let name = objects.first().map(String::as_str).unwrap_or_default();
                let value = in_quotes(&format!("{name}={}", texels_per_metre.ceil()));
                Some(Remedy::Set(Setting::ObjectDensityAround, value))
            }
            Self::Merged { layer_cap, .. } if *layer_cap as u64 >= MOST_LAYERS => None,
            Self::Merged { needed_layers, .. } => {
                Some(Remedy::Set(Setting::Layers, needed_layers.min(&MOST_LAYERS).to_string()))
            }
            Self::AmbientUnconverged { rays, .. } if *rays >= MOST_RAYS => Some(Remedy::Raise(Setting::AoError)),
            Self::AmbientUnconverged { .. } => {
                Some(Remedy::AnyOf([Setting::AoRays, Setting::AoError].map(Remedy::Raise).into()))
            }
            Self::FewerPoints { .. } => Some(Remedy::Lower(Setting::PageSize)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sun_that_nearly_rises_is_not_minus_zero_degrees_below() {
        let below = |highest_elevation_deg| {
            let date = Date::new(2026, 12, 21).expect("a date");
            Warning::NoSunrise { latitude_deg: 67.4, date, highest_elevation_deg }.to_string()
        };
        for nearly in [-0.04, -0.0, 0.0, 1e-9, 0.02] {
            assert!(below(nearly).contains("stays just below the horizon"), "{}", below(nearly));
        }
        assert!(below(-0.06).contains("stays at least 0.1 degrees below the horizon"), "{}", below(-0.06));
    }

    #[test]
    fn what_hides_the_sun_is_told_with_remedies_that_help() {
        let dome = Occluder { object: "node \"Sky\"".into(), name: "Sky".into(), share: 1.0 };
        let set = |setting| (setting, "Sky".to_owned());
        let remedy = Warning::Occluder(dome).remedy();
        let Some(Remedy::AnyOf(all)) = remedy else { panic!("{remedy:?}") };
        assert_eq!(all[0], Remedy::Set(Setting::LeaveOut, "Sky".into()));
        assert_eq!(all[2], Remedy::SetAll(vec![set(Setting::NoCast), set(Setting::NoReceive)]));
        assert!(!all.contains(&Remedy::Set(Setting::NoReceive, "Sky".into())), "it would go on to cast");
    }
}
