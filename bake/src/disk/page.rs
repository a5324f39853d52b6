//! A page of a baked set in memory, and the names that its files have on disk.

use super::manifest::{AtlasEntry, LampMapsEntry, LaneEntry, LayerEntry, LossMapEntry, SkyMapsEntry, TracksEntry};
use crate::ambient::AmbientPage;
use crate::loss_map::LossMap;
use crate::maps::{AmbientMaps, LaneMaps, LayerMaps, PageMaps};

/// Everything that the files of one atlas page hold.
#[derive(Debug, Clone)]
pub struct BakedPage {
    /// What playback reads.
    pub maps: PageMaps,
    /// Ambient light before it was rounded to codes; only if OpenEXR files were requested.
    pub ambient_numbers: Option<AmbientPage>,
    /// Minutes lost by storing; only if a loss map was requested.
    pub loss_map: Option<LossMap>,
}

impl BakedPage {
    /// The page's entry in the manifest: its size, and its files' names as page `index` of a set.
    pub fn entry(&self, index: usize) -> AtlasEntry {
        let PageMaps { width, height, lanes, lamp, ambient, walls, tracks } = &self.maps;
        let lane = |(k, LaneMaps { lane, layers }): (usize, &LaneMaps)| LaneEntry {
            offset_deg: lane.offset_rad.to_degrees(),
            weight: lane.weight,
            layers: layer_entries(&format!("page{index}_lane{k}"), layers),
        };
        let entry = AtlasEntry {
            width: *width,
            height: *height,
            lanes: lanes.iter().enumerate().map(lane).collect(),
            lamp: lamp
                .as_ref()
                .map(|layers| LampMapsEntry { layers: layer_entries(&format!("page{index}_lamp"), layers) }),
            walls: walls.as_ref().map(|_| format!("page{index}_walls.png")),
            tracks: tracks.as_ref().map(|tracks| TracksEntry {
                lists: format!("page{index}_track_lists.png"),
                spans: format!("page{index}_track_spans.png"),
                count: tracks.spans.len() as u32,
            }),
            loss_map: self.loss_map.as_ref().map(|map| loss_map_entry(index, map)),
            ..AtlasEntry::default()
        };
        match ambient {
            Some(maps) => self.with_ambient(index, maps, entry),
            None => entry,
        }
    }

    fn with_ambient(&self, index: usize, maps: &AmbientMaps, entry: AtlasEntry) -> AtlasEntry {
        let back = maps.back.as_ref();
        let named = |is_there: bool, what: &str| is_there.then(|| format!("page{index}_{what}"));
        let sky = |stem: &str| [0, 1, 2].map(|k| format!("page{index}_{stem}{k}.png"));
        AtlasEntry {
            ao: named(true, "ao.png"),
            bent: named(maps.front.bent.is_some(), "bent.png"),
            bent_back: named(back.is_some_and(|back| back.bent.is_some()), "bent_back.png"),
            sky: maps.front.sky.is_some().then(|| SkyMapsEntry {
                basis: "sh2".into(),
                front: sky("sky"),
                back: back.filter(|back| back.sky.is_some()).map(|_| sky("sky_back")),
            }),
            ambient_exr: named(self.ambient_numbers.is_some(), "ambient.exr"),
            ..entry
        }
    }
}

fn layer_entries(stem: &str, layers: &[LayerMaps]) -> Vec<LayerEntry> {
    let name = |layer: usize, what: &str| format!("{stem}_layer{layer}_{what}.png");
    (0..layers.len()).map(|layer| LayerEntry { rise: name(layer, "rise"), fall: name(layer, "fall") }).collect()
}

fn loss_map_entry(index: usize, map: &LossMap) -> LossMapEntry {
    let [picture, numbers] = ["png", "exr"].map(|kind| format!("lost_minutes.{index}.{kind}"));
    LossMapEntry { picture, numbers, scale: "sqrt".into(), scale_max_min: map.scale_max_min() }
}
