//! Shadow tracks: for each texel the shade of each occluder by itself, so that the shadow *between* texels is known.
//!
//! **Theory.** A texel's merged lit times jump from texel to texel where shadows are narrower than texels: at one
//! texel a picket ends the shade, at the next its neighbour does. The time at which *one* occluder starts or ends to
//! hide the sun moves smoothly. So a texel keeps, for every occluder that matters in its neighbourhood, the whole time
//! that this occluder alone would hide the sun. A filter blends the times of the same occluder over the four texels
//! around a point and takes the union of what they hide: shadows are clean lines at any resolution, far below the size
//! of a texel.
//!
//! An occluder is a connected part of the scene ([`crate::scene::Components`]). It may hide the sun several times: each
//! such *span* is matched with the spans of the same occluder in the texels to the right and below, and spans that
//! match, directly or through others, make a *track*. Playback needs no more than the tracks' numbers: texels list their
//! spans by ascending number, and equal numbers are blended.
//!
//! **Practice.**
//!
//! * [`find`]: the spans of every texel. What matters is a minimal cover of its own shade and of its eight neighbours'.
//! * [`link`]: the numbers of tracks.
//! * [`evaluate`]: visibility at a point between texels.
//!
//! What the surface's own plane and the horizon hide is a track like any other.

mod evaluate;
mod find;
mod link;

pub use evaluate::{TrackFootprint, tracked_visibility};
pub use find::{FoundSpan, FoundSpans, find_spans};
pub use link::number_tracks;

/// The shade of one occluder at one texel, as it is stored. Times are codes of 16 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrackSpan {
    /// Number of the track: equal ones in neighbouring texels are one track's.
    pub track: u16,
    /// When the shade starts; 0 for ever before.
    pub start: u16,
    /// When it ends; the largest code for ever after.
    pub end: u16,
}

/// Tracks of a page.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PageTracks {
    /// For each texel, its spans as a range of `spans`: the first, and how many. Several texels may share a range.
    pub ranges: Vec<[u32; 2]>,
    /// Spans, those of a texel by ascending number of their track.
    pub spans: Vec<TrackSpan>,
}

impl PageTracks {
    /// The spans of a texel.
    pub fn of_texel(&self, texel: usize) -> &[TrackSpan] {
        let [first, count] = self.ranges[texel].map(|n| n as usize);
        &self.spans[first..first + count]
    }
}
