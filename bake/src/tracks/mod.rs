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
//! match, directly or through others, make a *track*. Playback needs no more than the tracks' numbers: texels list
//! their spans by ascending number, and equal numbers are blended.
//!
//! **Practice.**
//!
//! * [`page`]: which texels of a page have tracks. Where shade hardly moves from texel to texel, blending what texels
//!   see is as good, so the others keep their merged shade.
//! * [`find`]: the spans of a texel. What matters is a minimal cover of its own shade and of its eight neighbours'.
//! * [`foretell`] and [`worth`]: which of them are kept. [`times`]: lists of times.
//! * [`link`]: the numbers of tracks.
//! * [`evaluate`]: visibility at a point between texels.
//!
//! What the surface's own plane and the horizon hide is a track like any other.

mod evaluate;
mod find;
mod foretell;
mod link;
mod page;
mod times;
mod worth;

pub use evaluate::tracked_visibility;
pub use find::{FindHiders, SpanSearch, find_spans};
pub use link::{Linked, number_tracks};
pub use page::{PageShade, page_tracks};

use crate::maps::Bits;

/// The occluder that stands for the surface's own plane and the horizon.
pub const OWN_PLANE: u32 = u32::MAX;
/// The occluder that stands for all of them together, where a texel has no tracks.
pub const MERGED: u32 = u32::MAX - 1;
/// The occluder that stands for all of them together, where all texels around are dark as well.
pub const DEEP: u32 = u32::MAX - 2;
/// Most spans of a texel.
pub const MOST_SPANS: usize = (1 << COUNT_BITS) - 1;
/// Most spans of a page.
pub const MOST_PAGE_SPANS: usize = 1 << (32 - COUNT_BITS);
/// Numbers of tracks are less: those from here on are of merged shade.
pub const FIRST_MERGED: u32 = (1 << 16) - 4 * MOST_SPANS as u32;
/// Bits of a number of spans, beside those of a place.
const COUNT_BITS: u32 = 6;

/// Spans in a row of the textures that hold them.
pub const SPANS_WIDTH: u32 = 2048;
/// Most rows of a slice of them.
const MOST_ROWS: u64 = 8192;

/// Width, rows and slices of the textures that hold this many spans of a page.
pub fn span_texture(spans: u64) -> [u32; 3] {
    let rows = spans.div_ceil(SPANS_WIDTH.into()).max(1);
    let slices = rows.div_ceil(MOST_ROWS);
    [SPANS_WIDTH, if slices > 1 { MOST_ROWS as u32 } else { rows as u32 }, slices as u32]
}

/// Texels of these textures.
pub fn span_texels(spans: u64) -> u64 {
    span_texture(spans).map(u64::from).iter().product()
}

/// A span of shade by one occluder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FoundSpan {
    /// The occluder's part, [`OWN_PLANE`], [`MERGED`] or [`DEEP`].
    pub part: u32,
    /// When it starts: a code of 16 bits.
    pub start: u16,
    /// When it ends.
    pub end: u16,
}

impl FoundSpan {
    /// From its start and end in path time.
    pub fn new(part: u32, shade: [f64; 2]) -> Self {
        let [start, end] = shade.map(|t| Bits::Sixteen.encode(t));
        Self { part, start, end }
    }

    /// When it starts and ends.
    fn times(&self) -> [u16; 2] {
        [self.start, self.end]
    }
}

/// The spans of each part of a texel.
fn parts(spans: &[FoundSpan]) -> impl Iterator<Item = &[FoundSpan]> {
    spans.chunk_by(|a, b| a.part == b.part)
}

/// Spans of texels, each texel's by ascending part and time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundSpans {
    /// For each texel, where its spans begin; one more at the end.
    pub first: Vec<u32>,
    /// Those of all texels, one texel's after the other's.
    pub spans: Vec<FoundSpan>,
}

impl Default for FoundSpans {
    fn default() -> Self {
        Self { first: vec![0], spans: Vec::new() }
    }
}

impl FoundSpans {
    /// Adds the next texel's.
    pub fn push(&mut self, spans: impl IntoIterator<Item = FoundSpan>) {
        self.spans.extend(spans);
        self.first.push(self.spans.len() as u32);
    }

    /// The texels of several lists, one list's after the other's.
    pub fn joined(lists: Vec<Self>) -> Self {
        let count = |of: fn(&Self) -> usize| lists.iter().map(of).sum::<usize>();
        let mut all = Self { first: Vec::with_capacity(count(|l| l.first.len()) + 1), spans: Vec::new() };
        all.spans.reserve_exact(count(|list| list.spans.len()));
        all.first.push(0);
        for list in lists {
            let before = all.spans.len() as u32;
            all.first.extend(list.first[1..].iter().map(|first| before + first));
            all.spans.extend(list.spans);
        }
        all
    }

    /// Of a texel.
    pub fn of_texel(&self, texel: usize) -> &[FoundSpan] {
        &self.spans[self.first[texel] as usize..self.first[texel + 1] as usize]
    }
}

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

/// What came of the texels of a page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TrackCounts {
    /// Texels that have tracks.
    pub texels: u64,
    /// Texels of whose tracks some are merged, for they have more spans than are stored.
    pub crowded_texels: u64,
}

impl PageTracks {
    /// The spans of a texel.
    pub fn of_texel(&self, texel: usize) -> &[TrackSpan] {
        let [first, count] = self.ranges[texel].map(|n| n as usize);
        &self.spans[first..first + count]
    }

    /// The first span of a texel and how many it has, from its number in [`Self::lists`].
    pub fn range_of(list: u32) -> [u32; 2] {
        [list >> COUNT_BITS, list & MOST_SPANS as u32]
    }

    /// For each texel 64 times the index of its first span, plus how many it has: what shaders read.
    pub fn lists(&self) -> impl Iterator<Item = u32> + '_ {
        self.ranges.iter().map(|[first, count]| (first << COUNT_BITS) + count)
    }

    /// Bytes that it takes on a GPU: 4 a texel, where its spans lie and how many they are, and 6 a span.
    pub fn gpu_bytes(&self) -> u64 {
        Self::bytes_of(self.ranges.len() as u64, self.spans.len() as u64)
    }

    /// The same of this many texels and spans.
    pub fn bytes_of(texels: u64, spans: u64) -> u64 {
        4 * texels + 6 * span_texels(spans)
    }
}
