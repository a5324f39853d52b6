//! A technique's pictures, held against the reference's.

use super::super::report::{FrameEntry, Preparation, TechniqueEntry};
use super::super::score::{Tally, luma, structural_similarity};
use super::super::technique::TechniqueSpec;
use super::sets::set_for;
use super::times::mean_times;
use super::{Comparison, Drawn, LitFrame, SetOnDisk, Take, lit_by};
use crate::image::Raster;
use rayon::prelude::*;

impl Comparison<'_> {
    /// What a report says of it. `lumas` are the reference's lit pictures, `hard` truths of the sun's centre.
    pub(super) fn judged(
        &self,
        technique: TechniqueSpec,
        drawn: &Drawn,
        frames: &[LitFrame],
        lumas: &[Raster<u8>],
        hard: Option<&[Raster<f32>]>,
        takes: &[Take],
    ) -> TechniqueEntry {
        let tally = |i: usize| {
            let hits = takes[i].shot.hits();
            let mut tally = Tally::default();
            tally.add(&drawn.seen[i], &frames[i].reference, |pixel| hits[pixel].is_some());
            tally.add_likeness(structural_similarity(&luma(&lit_by(&frames[i], &drawn.seen[i])), &lumas[i]));
            tally
        };
        let tallies: Vec<Tally> = (0..frames.len()).into_par_iter().map(tally).collect();
        let mut all = Tally::default();
        tallies.iter().for_each(|tally| all.append(tally));
        let frame = |i: usize| FrameEntry {
            camera: frames[i].camera as u64,
            time: frames[i].time as u64,
            error: tallies[i].score(),
            frame_ms: drawn.times[i].frame_ms,
        };
        let hard_error = hard.filter(|_| technique.is_hard()).map(|hard| {
            let mut tally = Tally::default();
            for ((seen, hard), take) in drawn.seen.iter().zip(hard).zip(takes) {
                let hits = take.shot.hits();
                tally.add(seen, hard, |pixel| hits[pixel].is_some());
            }
            tally.score()
        });
        let playback = match technique {
            TechniqueSpec::Baked(playback) => Some(playback),
            _ => None,
        };
        let has_its_lanes = |set: &&SetOnDisk| playback.is_some_and(|one| one.lanes as u64 == set.entry.lanes);
        let has_its_bits = |set: &&SetOnDisk| playback.is_some_and(|one| one.bits.count() == set.entry.bits);
        let set = playback.and_then(|one| set_for(self.sets, one)).filter(has_its_lanes);
        TechniqueEntry {
            name: technique.to_string(),
            family: technique.family().into(),
            is_hard: technique.is_hard(),
            error: all.score(),
            hard_error,
            times: mean_times(&drawn.times),
            preparation: Preparation { bake_s: set.map(|set| set.entry.bake_s), setup_s: drawn.setup_s.max(0.0) },
            memory_bytes: drawn.memory_bytes,
            disk_bytes: set.filter(has_its_bits).map(|set| set.entry.disk_bytes),
            plan: drawn.plan.clone(),
            frames: (0..frames.len()).map(frame).collect(),
        }
    }
}
