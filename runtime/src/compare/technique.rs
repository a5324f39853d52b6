//! What can be compared, and what it is called.
//!
//! A name is parts with colons between them: `baked:16:lanes3:filtered`, `volumes`, `map:pcss`, `truth:hard`. A user
//! may ask for a part of a name, which selects every technique that has those parts: `baked` is every way to play a set
//! back, `baked:8` those with eight bits.

use crate::shadow_maps::Variant;
use crate::technique::Truth;
use crate::volumes::Mode;
use std::fmt::{Display, Formatter};
use sunbake::maps::Bits;
use sunbake_shaders::Filter;

/// A technique with every setting that its pictures depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TechniqueSpec {
    /// A baked set, played back.
    Baked(Playback),
    /// Shadow volumes.
    Volumes(Mode),
    /// Shadow maps.
    Map(Variant),
    /// Rays.
    Truth(Truth),
}

/// How a set is played back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Playback {
    /// Bits of a stored time, 8 or 16.
    pub bits: Bits,
    /// Lanes across the sun's disc, 1 or more.
    pub lanes: usize,
    /// How the four texels around a pixel are combined.
    pub filter: Filter,
}

impl Display for TechniqueSpec {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        match self {
            Self::Baked(Playback { bits, lanes, filter }) => {
                let filter = match filter {
                    Filter::Nearest => "nearest",
                    Filter::Bilinear => "filtered",
                    Filter::Sharp => "sharp",
                    Filter::Tracks => "tracks",
                };
                write!(f, "baked:{}:lanes{lanes}:{filter}", bits.count())
            }
            Self::Volumes(mode) => write!(f, "{mode}"),
            Self::Map(variant) => write!(f, "{variant}"),
            Self::Truth(Truth::Hard) => write!(f, "truth:hard"),
            Self::Truth(Truth::Soft { rays }) => write!(f, "truth:soft:{rays}"),
        }
    }
}

/// Why a name selects no technique, or not one.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TechniqueNameError {
    /// No technique has it.
    #[error(
        "there is no `{name}` here: give {}, a part of such a name as `baked:8`, volumes:MODE or truth:soft:N",
        known.join(", ")
    )]
    Unknown {
        /// The name given.
        name: String,
        /// All names that the source allows.
        known: Vec<String>,
    },
    /// One technique was asked for, and several have it.
    #[error("`{name}` is several techniques: {}", found.join(", "))]
    Several {
        /// The name given.
        name: String,
        /// Names of the techniques.
        found: Vec<String>,
    },
}

impl TechniqueSpec {
    /// The one technique that a name selects: of any set, with one, three or five lanes.
    pub fn named(name: &str) -> Result<Self, TechniqueNameError> {
        let all = Self::all(Bits::Sixteen, &[1, 3, 5], true);
        match selected(&all, &[name.to_owned()])?.as_slice() {
            [one] => Ok(*one),
            several => Err(TechniqueNameError::Several {
                name: name.to_owned(),
                found: several.iter().map(ToString::to_string).collect(),
            }),
        }
    }

    /// What is compared unless told otherwise, of sets with these counts of lanes. Of 16 bits, 8 are made as well.
    /// Tracks are the middle lane's, and their times are of 16 bits whatever those of the intervals.
    pub fn all(most_bits: Bits, lane_counts: &[usize], has_tracks: bool) -> Vec<Self> {
        let bits: &[Bits] = if most_bits == Bits::Sixteen { &[Bits::Sixteen, Bits::Eight] } else { &[Bits::Eight] };
        let mut all = Vec::new();
        for &lanes in lane_counts {
            for &bits in bits {
                let tracks = (has_tracks && lanes == 1 && bits == most_bits).then_some(Filter::Tracks);
                for filter in [Filter::Bilinear, Filter::Sharp, Filter::Nearest].into_iter().chain(tracks) {
                    all.push(Self::Baked(Playback { bits, lanes, filter }));
                }
            }
        }
        all.push(Self::Volumes(Mode::Planned));
        all.extend(Variant::ALL.map(Self::Map));
        all.push(Self::Truth(Truth::Hard));
        all
    }

    /// `baked`, `volumes`, `map` or `truth`.
    pub fn family(&self) -> &'static str {
        match self {
            Self::Baked(_) => "baked",
            Self::Volumes(_) => "volumes",
            Self::Map(_) => "map",
            Self::Truth(_) => "truth",
        }
    }

    /// Whether it takes the sun for a point, and so draws no penumbra.
    pub fn is_hard(&self) -> bool {
        match self {
            Self::Baked(_) => false,
            Self::Volumes(_) => true,
            Self::Map(variant) => !variant.is_soft(),
            Self::Truth(truth) => *truth == Truth::Hard,
        }
    }

    /// Whether it has all parts of a name.
    fn is_selected_by(&self, asked: &str) -> bool {
        let name = self.to_string();
        let parts: Vec<&str> = name.split(':').collect();
        let mut asked = asked.split(':');
        // The family comes first; `bilinear` is what `--filter` calls the same.
        asked.next() == Some(parts[0])
            && asked.all(|part| parts[1..].contains(&if part == "bilinear" { "filtered" } else { part }))
    }
}

/// Those of `all` that have the parts of some name, in the order of `all`; then modes of volumes and soft truths that
/// are asked for by their own names. Without names, all.
pub fn selected(all: &[TechniqueSpec], names: &[String]) -> Result<Vec<TechniqueSpec>, TechniqueNameError> {
    if names.is_empty() {
        return Ok(all.to_vec());
    }
    let others = Mode::ALL.map(TechniqueSpec::Volumes);
    let mut found: Vec<TechniqueSpec> = Vec::new();
    let mut extra: Vec<TechniqueSpec> = Vec::new();
    for name in names {
        let matching: Vec<TechniqueSpec> = all.iter().copied().filter(|one| one.is_selected_by(name)).collect();
        let named = others.iter().copied().find(|one| one.to_string() == *name).or_else(|| soft_truth(name));
        match named {
            _ if !matching.is_empty() => found.extend(matching),
            Some(one) => extra.push(one),
            None => return Err(unknown(all, name)),
        }
    }
    let mut ordered: Vec<TechniqueSpec> = all.iter().copied().filter(|one| found.contains(one)).collect();
    for one in extra {
        if !ordered.contains(&one) {
            ordered.push(one);
        }
    }
    Ok(ordered)
}

/// `truth:soft` or `truth:soft:N`.
fn soft_truth(name: &str) -> Option<TechniqueSpec> {
    let rays = match name.strip_prefix("truth:soft")? {
        "" => Truth::DEFAULT_RAYS,
        rest => rest.strip_prefix(':')?.parse().ok().filter(|n| (1..=65_536).contains(n))?,
    };
    Some(TechniqueSpec::Truth(Truth::Soft { rays }))
}

fn unknown(all: &[TechniqueSpec], name: &str) -> TechniqueNameError {
    TechniqueNameError::Unknown { name: name.to_owned(), known: all.iter().map(ToString::to_string).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(asked: &[&str]) -> Result<Vec<String>, TechniqueNameError> {
        let all = TechniqueSpec::all(Bits::Sixteen, &[1, 3], true);
        let asked: Vec<String> = asked.iter().map(|&name| name.to_owned()).collect();
        Ok(selected(&all, &asked)?.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn a_part_of_a_name_means_all_that_have_it() {
        assert_eq!(names(&[]).unwrap().len(), 13 + 1 + 10 + 1);
        assert_eq!(names(&["baked"]).unwrap().len(), 13);
        assert_eq!(names(&["baked:8:nearest"]).unwrap(), ["baked:8:lanes1:nearest", "baked:8:lanes3:nearest"]);
        assert_eq!(names(&["baked:16:lanes3:bilinear"]).unwrap(), ["baked:16:lanes3:filtered"]);
        assert_eq!(names(&["baked:tracks"]).unwrap(), ["baked:16:lanes1:tracks"]);
        assert_eq!(names(&["map:pcf4", "volumes"]).unwrap(), ["volumes", "map:pcf4"]);
        assert_eq!(names(&["map"]).unwrap().len(), 10);
        assert_eq!(names(&["truth:soft:9", "volumes:zfail"]).unwrap(), ["truth:soft:9", "volumes:zfail"]);
        for bad in ["", "8", "baked:9", "map:", "truth:soft:0", "truth:soft:x", "volume", "baked:16:16x"] {
            assert!(names(&[bad]).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_reference_is_one_technique() {
        assert_eq!(TechniqueSpec::named("truth:soft"), Ok(TechniqueSpec::Truth(Truth::Soft { rays: 64 })));
        assert!(
            matches!(TechniqueSpec::named("map"), Err(TechniqueNameError::Several { found, .. }) if found.len() == 10)
        );
    }
}
