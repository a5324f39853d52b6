//! Sets on disk, and the stages that are read from them.

use super::super::report::{SetEntry, SetTracksEntry};
use super::super::technique::Playback;
use super::not_drawn::NotDrawn;
use crate::stage::Stage;
use std::path::{Path, PathBuf};
use sunbake::disk::manifest::Manifest;
use sunbake::disk::read::{ReadError, read_manifest};
use sunbake::maps::Bits;
use sunbake_shaders::AmbientModel;

/// A set on disk, from which stages are read.
#[derive(Debug, Clone)]
pub struct SetOnDisk {
    /// The folder that holds `sunbake.json`.
    pub folder: PathBuf,
    /// What the report says of it.
    pub entry: SetEntry,
}

impl SetOnDisk {
    /// Reads what the manifest of a set says.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let manifest = read_manifest(folder)?;
        Ok(Self { folder: folder.to_owned(), entry: entry_of(folder, &manifest) })
    }
}

fn entry_of(folder: &Path, manifest: &Manifest) -> SetEntry {
    let seconds = &manifest.stats.seconds;
    let layers = manifest.atlases.iter().flat_map(|atlas| &atlas.lanes).flat_map(|lane| &lane.layers);
    let size = |name: &String| std::fs::metadata(folder.join(name)).map_or(0, |file| file.len());
    let tracks = || manifest.atlases.iter().filter_map(|atlas| atlas.tracks.as_ref());
    let track_seconds = manifest.stats.tracks.map_or(0.0, |tracks| tracks.seconds);
    let bake_s = seconds.load + seconds.unwrap + seconds.bvh + seconds.visibility + seconds.encode + seconds.write;
    SetEntry {
        lanes: manifest.atlases.iter().map(|atlas| atlas.lanes.len()).max().unwrap_or(0) as u64,
        bits: manifest.bits,
        texels: manifest.stats.texels,
        texels_per_metre: manifest.scene.texels_per_metre,
        bake_s: bake_s - track_seconds,
        disk_bytes: layers.map(|layer| size(&layer.rise) + size(&layer.fall)).sum(),
        tracks: tracks().next().map(|_| SetTracksEntry {
            bake_s: track_seconds,
            disk_bytes: tracks().map(|tracks| size(&tracks.lists) + size(&tracks.spans)).sum(),
        }),
        engine: manifest.stats.engine.clone(),
    }
}

/// The set that a playback reads: the one with as many lanes or, for a single lane, any set, whose middle lane is then
/// taken.
pub(super) fn set_for(sets: &[SetOnDisk], playback: Playback) -> Option<&SetOnDisk> {
    let has = |set: &&SetOnDisk| set.entry.lanes == playback.lanes as u64;
    sets.iter().find(has).or_else(|| sets.first().filter(|_| playback.lanes == 1))
}

/// Reads stages of sets, and keeps the last one for as long as it can be used again.
pub(super) struct SetReader<'a> {
    pub sets: &'a [SetOnDisk],
    /// Folder, lanes and bits of the stage that was read last.
    pub current: Option<(PathBuf, usize, Bits, Stage)>,
}

impl SetReader<'_> {
    pub fn stage(&mut self, playback: Playback) -> Result<&Stage, NotDrawn> {
        let set = set_for(self.sets, playback)
            .ok_or_else(|| NotDrawn::Unsupported(format!("there is no set of {} lanes", playback.lanes)))?;
        let is_kept = |kept: &(PathBuf, usize, Bits, Stage)| {
            let (folder, lanes, bits, _) = kept;
            *folder == set.folder && *lanes == playback.lanes && (*bits == playback.bits || *bits == Bits::Sixteen)
        };
        let stage = match self.current.take().filter(is_kept) {
            Some((.., stage)) => stage,
            None => {
                let stage =
                    Stage::read_without_looks(&set.folder)?.without_lamp().with_ambient(AmbientModel::Hemisphere);
                if playback.lanes as u64 == set.entry.lanes { stage } else { stage.with_one_lane() }
            }
        };
        let stage = if playback.bits == Bits::Eight { stage.with_eight_bits() } else { stage };
        let kept = self.current.insert((set.folder.clone(), playback.lanes, stage.bits, stage));
        Ok(&kept.3)
    }
}
