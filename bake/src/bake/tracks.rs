//! The shadow tracks of a page, after its lit intervals.

use super::pages::PageTexels;
use crate::atlas::{PageSize, surface_point};
use crate::progress::Progress;
use crate::scene::{Geometry, Scene};
use crate::settings::TrackChoice;
use crate::tracks::{FoundSpan, FoundSpans, MERGED, PageShade, PageTracks, TrackCounts, page_tracks};
use crate::visibility::{Hiders, Intervals, OccluderFinder};

/// How tracks are found.
#[derive(Clone, Copy)]
pub(super) struct TrackJob<'a> {
    /// Finds what hides the sun's centre.
    pub finder: &'a OccluderFinder<'a>,
    /// Width of the sun in path time.
    pub width_t: f64,
    /// Where tracks are wanted.
    pub choice: TrackChoice,
    /// Intervals that the layers of a texel hold.
    pub slots: usize,
}

/// Takes the intervals of a page's texels in their order, and then finds its tracks.
pub(super) struct TrackBaker<'a> {
    job: TrackJob<'a>,
    size: PageSize,
    texels: PageTexels<'a>,
    hiders: &'a Hiders,
    lit: FoundSpans,
    is_filled: Vec<bool>,
}

/// The place of a texel that nothing covers.
const ABSENT: u32 = u32::MAX;

impl<'a> TrackBaker<'a> {
    /// `hiders` are in the order of the page's texels, or empty.
    pub fn new(job: TrackJob<'a>, size: PageSize, texels: PageTexels<'a>, hiders: &'a Hiders) -> Self {
        Self { job, size, texels, hiders, lit: FoundSpans::default(), is_filled: Vec::new() }
    }

    /// Texels of the page.
    pub fn texel_count(&self) -> u64 {
        u64::from(self.size.width) * u64::from(self.size.height)
    }

    /// Adds the next texel's intervals. `is_filled`: they are what its neighbours agree on.
    pub fn add(&mut self, lit: &Intervals, is_filled: bool) {
        self.lit.push(lit.as_slice().iter().map(|&lit| FoundSpan::new(MERGED, lit)));
        self.is_filled.push(is_filled);
    }

    /// Finds the tracks, which take no more than so many bytes.
    pub fn find(
        self,
        scene: &Scene,
        geometry: &Geometry,
        most_bytes: u64,
        progress: &dyn Progress,
    ) -> (Option<PageTracks>, TrackCounts) {
        let Self { job, size, texels, .. } = &self;
        let samples = &texels.samples.samples;
        let count = size.width * size.height;
        let mut place = vec![ABSENT; count as usize];
        texels.order.iter().zip(0..).for_each(|(&i, index)| place[samples[i as usize].texel as usize] = index);
        let mut source: Vec<u32> = (0..count).collect();
        texels.gutter.iter().for_each(|copy| source[copy.texel as usize] = samples[copy.sample as usize].texel);
        let mut lit = FoundSpans::default();
        for &place in &place {
            match place {
                ABSENT => lit.push([FoundSpan::new(MERGED, [0.0, 1.0])]),
                place => lit.push(self.lit.of_texel(place as usize).iter().copied()),
            }
        }
        let has_point = |texel: u32| {
            let place = place[texel as usize];
            place != ABSENT && !self.is_filled[place as usize]
        };
        let point = |texel: u32| {
            let sample = texels.order[place[texel as usize] as usize];
            surface_point(scene, geometry, &samples[sample as usize])
        };
        let hiders = |texel: u32| self.hiders.of_point(place[texel as usize] as usize).to_vec();
        let shade = PageShade {
            size: *size,
            source: &source,
            lit: &lit,
            has_point: &has_point,
            point: &point,
            hiders: (!self.hiders.is_empty()).then_some(&hiders),
            walls: texels.walls,
            width_t: job.width_t,
            choice: job.choice,
            most_merged: job.slots,
            most_bytes: if job.choice == TrackChoice::Auto { most_bytes } else { u64::MAX },
        };
        page_tracks(job.finder, &shade, progress)
    }
}
