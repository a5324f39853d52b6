//! The errors of a technique's pictures, and what the report says of it.

use super::super::report::{FrameEntry, Preparation, TechniqueEntry};
use super::super::score::{Tally, luma, structural_similarity};
use super::super::technique::TechniqueSpec;
use super::drawing::DrawnFrames;
use super::set_reader::set_for;
use super::times::mean_times;
use super::{Comparison, FrameRequest, LitFrame, SetOnDisk, lit_picture_of};
use crate::image::Raster;
use rayon::prelude::*;
use sunbake_shaders::Filter;

impl Comparison<'_> {
    /// What a report says of a technique. `lumas` are the reference's lit pictures, `hard_truths` truths of the sun's
    /// centre.
    pub(super) fn scored(
        &self,
        technique: TechniqueSpec,
        drawn: &DrawnFrames,
        lit: &[LitFrame],
        lumas: &[Raster<u8>],
        hard_truths: Option<&[Raster<f32>]>,
        frames: &[FrameRequest],
    ) -> TechniqueEntry {
        let tally = |i: usize| {
            let hits = frames[i].shot.hits();
            let mut tally = Tally::default();
            tally.add(&drawn.visibility[i], &lit[i].reference, |pixel| hits[pixel].is_some());
            tally.add_similarity(structural_similarity(
                &luma(&lit_picture_of(&lit[i], &drawn.visibility[i])),
                &lumas[i],
            ));
            tally
        };
        let tallies: Vec<Tally> = (0..frames.len()).into_par_iter().map(tally).collect();
        let mut all = Tally::default();
        tallies.iter().for_each(|tally| all.append(tally));
        let frame_entry = |i: usize| FrameEntry {
            camera: lit[i].camera as u64,
            time: lit[i].time as u64,
            error: tallies[i].score(),
            frame_ms: drawn.times[i].frame_ms,
        };
        let hard_error = hard_truths.filter(|_| technique.is_hard()).map(|truths| {
            let mut tally = Tally::default();
            for ((seen, truth), frame) in drawn.visibility.iter().zip(truths).zip(frames) {
                let hits = frame.shot.hits();
                tally.add(seen, truth, |pixel| hits[pixel].is_some());
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
        let tracks = playback.filter(|one| one.filter == Filter::Tracks).and(set).and_then(|set| set.entry.tracks);
        let track_seconds = tracks.map_or(0.0, |tracks| tracks.bake_s);
        let disk_bytes = |set: &SetOnDisk| tracks.map_or(set.entry.disk_bytes, |tracks| tracks.disk_bytes);
        TechniqueEntry {
            name: technique.to_string(),
            family: technique.family().into(),
            is_hard: technique.is_hard(),
            error: all.score(),
            hard_error,
            times: mean_times(&drawn.times),
            preparation: Preparation {
                bake_s: set.map(|set| set.entry.bake_s + track_seconds),
                setup_s: drawn.setup_s.max(0.0),
            },
            memory_bytes: drawn.memory_bytes,
            disk_bytes: set.filter(has_its_bits).map(disk_bytes),
            plan: drawn.plan.clone(),
            frames: (0..frames.len()).map(frame_entry).collect(),
        }
    }
}
