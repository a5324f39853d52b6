//! Writes a baked set. This is the only writer.
//!
//! A set is written beside its target and moved into place when it is complete (`folder.rs`). A bake that stops
//! earlier, for whatever reason, leaves the old set or none.

use super::folder::{FolderKind, FolderWriter};
use super::manifest::{AtlasEntry, Manifest};
use super::page::BakedPage;
use super::png_file::write_png;
use super::read::MANIFEST_FILE;
use crate::maps::{Bits, StoredBits};
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Name of the scene in a set's folder.
pub const SCENE_FILE: &str = "scene.glb";
/// Name of the scene with ambient occlusion at its vertices.
pub const VERTICES_FILE: &str = "vertices.glb";

/// Why a set could not be written.
pub use super::folder::FolderError as WriteError;

/// How a set's folder is recognised and named in messages.
const KIND: FolderKind = FolderKind { marker: MANIFEST_FILE, what: "a baked set", noun: "set" };

/// A set being written. If it is dropped before [`SetWriter::finish`], everything it wrote is removed.
#[derive(Debug)]
pub struct SetWriter {
    folder: FolderWriter,
    bytes: u64,
}

impl SetWriter {
    /// Makes a temporary folder beside `target`. `force` allows an older set at `target` to be replaced.
    pub fn begin(target: &Path, force: bool) -> Result<Self, WriteError> {
        Ok(Self { folder: FolderWriter::begin(target, force, KIND)?, bytes: 0 })
    }

    /// Writes the bytes of `scene.glb`.
    pub fn write_scene(&mut self, glb: &[u8]) -> Result<(), WriteError> {
        self.write_file(SCENE_FILE, |file| file.write_all(glb))
    }

    /// Writes the scene with ambient occlusion at its vertices.
    pub fn write_vertices(&mut self, glb: &[u8]) -> Result<(), WriteError> {
        self.write_file(VERTICES_FILE, |file| file.write_all(glb))
    }

    /// Writes a page's files with the names in `entry` ([`BakedPage::entry`]).
    pub fn write_page(&mut self, entry: &AtlasEntry, page: &BakedPage, bits: StoredBits) -> Result<(), WriteError> {
        let lanes = entry.lanes.iter().map(|lane| &lane.layers).zip(page.maps.lanes.iter().map(|lane| &lane.layers));
        let lamp = entry.lamp.as_ref().map(|lamp| &lamp.layers).zip(page.maps.lamp.as_ref());
        let layers = lanes.chain(lamp).flat_map(|(names, layers)| names.iter().zip(layers));
        let textures: Vec<(&String, &[[u16; 4]])> = layers
            .flat_map(|(name, layer)| [(&name.rise, layer.rise.as_slice()), (&name.fall, layer.fall.as_slice())])
            .collect();
        let size = (entry.width, entry.height);
        let written: Result<Vec<u64>, WriteError> =
            textures.par_iter().map(|(name, codes)| self.write_texture(name, codes, size, bits.times)).collect();
        self.bytes += written?.iter().sum::<u64>();
        self.write_ambient(entry, page, bits.ambient)?;
        if let (Some(name), Some(codes)) = (&entry.walls, &page.maps.walls) {
            let write = |file: &mut BufWriter<File>| {
                write_png(codes.as_flattened(), png::ColorType::GrayscaleAlpha, size, Bits::Eight, file)
            };
            self.write_file(name, write)?;
        }
        if let (Some(names), Some(tracks)) = (&entry.tracks, &page.maps.tracks) {
            self.write_tracks(names, tracks, size)?;
        }
        if let (Some(names), Some(map)) = (&entry.loss_map, &page.loss_map) {
            self.write_loss_map(names, map)?;
        }
        Ok(())
    }

    /// Bytes written so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Writes the manifest and moves the set into place.
    pub fn finish(mut self, manifest: &Manifest) -> Result<(), WriteError> {
        self.write_file(MANIFEST_FILE, |file| {
            serde_json::to_writer_pretty(&mut *file, manifest)?;
            file.write_all(b"\n")
        })?;
        self.folder.finish()
    }

    /// Writes a file of the set.
    pub(super) fn write_file(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), WriteError> {
        self.bytes += self.folder.write_file(name, write)?;
        Ok(())
    }

    fn write_texture(&self, name: &str, codes: &[[u16; 4]], size: (u32, u32), bits: Bits) -> Result<u64, WriteError> {
        let bytes = bytes_of(codes, bits);
        self.folder.write_file(name, |file| write_png(&bytes, png::ColorType::Rgba, size, bits, file))
    }
}

/// Codes as PNG stores them: one byte, or two with the higher first.
fn bytes_of(codes: &[[u16; 4]], bits: Bits) -> Vec<u8> {
    match bits {
        Bits::Eight => codes.iter().flatten().map(|&code| code as u8).collect(),
        Bits::Sixteen => codes.iter().flatten().flat_map(|code| code.to_be_bytes()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{manifest, read};
    use super::*;
    use crate::maps::{Lane, LaneMaps, LayerMaps, PageMaps};
    use crate::tracks::{PageTracks, TrackSpan};

    fn maps(bits: Bits) -> PageMaps {
        let mut layer = LayerMaps::unlit(6, bits);
        layer.rise[4] = [0, 1, bits.max_code() / 2, bits.max_code()];
        layer.fall[4] = [bits.max_code(), 2, 3, 0];
        let mut of_lamp = layer.clone();
        of_lamp.rise[2] = [7; 4];
        let lanes = vec![LaneMaps { lane: Lane::CENTRE, layers: vec![layer.clone(), layer] }];
        let span = |track, start, end| TrackSpan { track, start, end };
        let tracks = PageTracks {
            ranges: vec![[0, 2], [0, 2], [2, 0], [2, 3], [5, 1], [1, 1]],
            spans: vec![
                span(3, 0, 65_535),
                span(65_284, 7, 9),
                span(0, 1, 2),
                span(1, 5, 5),
                span(9, 0, 1),
                span(4, 8, 9),
            ],
        };
        let (lamp, tracks) = (Some(vec![of_lamp]), Some(tracks));
        PageMaps { width: 3, height: 2, lanes, lamp, ambient: None, walls: None, tracks }
    }

    fn manifest(atlas: AtlasEntry, bits: Bits) -> Manifest {
        Manifest {
            format: manifest::FORMAT.into(),
            version: manifest::VERSION,
            generator: "test".into(),
            source: manifest::SourceEntry { file: "x.glb".into(), sha256: String::new() },
            scene: manifest::SceneEntry {
                file: SCENE_FILE.into(),
                centre_m: [0.0; 3],
                texels_per_metre: 1.0,
                sha256: None,
            },
            path: None,
            lamp: Some(lamp()),
            ambient: None,
            bits: bits.count(),
            atlases: vec![atlas],
            instances: Vec::new(),
            effects: Vec::new(),
            stats: manifest::Stats::default(),
            error: manifest::ErrorEntry::default(),
        }
    }

    fn lamp() -> manifest::LampEntry {
        let keys = [(0.0, [0.0, 1.0, 2.0]), (1.0, [3.0, 1.0, 2.0])];
        manifest::LampEntry {
            keys: keys.map(|(t, position)| manifest::LampKeyEntry { t, position }).to_vec(),
            radius_m: 0.25,
            duration_min: 7.0,
            stats: manifest::LampStats::default(),
            error: manifest::ErrorEntry::default(),
        }
    }

    fn write(target: &Path, force: bool, bits: Bits) -> Result<(), WriteError> {
        let mut writer = SetWriter::begin(target, force)?;
        let page = BakedPage { maps: maps(bits), ambient_numbers: None, loss_map: None };
        let entry = page.entry(0);
        writer.write_page(&entry, &page, StoredBits { times: bits, ambient: bits })?;
        writer.finish(&manifest(entry, bits))
    }

    /// B15.
    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        for bits in [Bits::Eight, Bits::Sixteen] {
            let folder = tempfile::tempdir().unwrap();
            let target = folder.path().join("set");
            write(&target, false, bits).unwrap();
            let set = read::read(&target).unwrap();
            assert_eq!(set.pages, vec![maps(bits)]);
            let lamp = set.lamp.unwrap();
            assert_eq!((lamp.radius_m(), lamp.duration_min(), lamp.position_m(1.0).x), (0.25, 7.0, 3.0));
        }
    }

    /// O1.
    #[test]
    fn a_stopped_bake_leaves_the_old_set_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        let names = || std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>();
        let mut writer = SetWriter::begin(&target, false).unwrap();
        writer.write_scene(b"half").unwrap();
        assert!(!target.exists());
        drop(writer);
        assert!(names().is_empty());
        write(&target, false, Bits::Eight).unwrap();
        let mut writer = SetWriter::begin(&target, true).unwrap();
        writer.write_scene(b"half").unwrap();
        drop(writer);
        assert_eq!(names(), ["set"]);
        assert!(read::read(&target).is_ok());
    }

    /// O1.
    #[test]
    fn force_replaces_a_set_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        write(&target, false, Bits::Eight).unwrap();
        assert!(matches!(write(&target, false, Bits::Sixteen), Err(WriteError::Exists { .. })));
        write(&target, true, Bits::Sixteen).unwrap();
        assert_eq!(read::read(&target).unwrap().bits, Bits::Sixteen);
        let precious = folder.path().join("home");
        std::fs::create_dir(&precious).unwrap();
        std::fs::write(precious.join("letter.txt"), "dear").unwrap();
        for force in [false, true] {
            assert!(matches!(write(&precious, force, Bits::Eight), Err(WriteError::NotOurs { .. })), "{force}");
        }
        assert!(precious.join("letter.txt").exists());
    }

    #[test]
    fn a_manifest_that_names_a_file_elsewhere_is_refused() {
        for name in ["../scene.glb", "/etc/passwd", "a/b.png", "..", "http://example.org/x.glb", "c:\\x.png"] {
            let folder = tempfile::tempdir().unwrap();
            let target = folder.path().join("set");
            write(&target, false, Bits::Eight).unwrap();
            let path = target.join(MANIFEST_FILE);
            let text = std::fs::read_to_string(&path).unwrap();
            let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
            json["scene"]["file"] = name.into();
            std::fs::write(&path, json.to_string()).unwrap();
            let message = read::read(&target).unwrap_err().to_string();
            assert!(message.contains("not a plain file name"), "{message}");
        }
    }

    /// The set's manifest, after `change`, is refused with a message that contains `expected`.
    fn refused(change: impl FnOnce(&mut serde_json::Value), expected: &str) {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        write(&target, false, Bits::Eight).unwrap();
        let path = target.join(MANIFEST_FILE);
        let mut json = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        change(&mut json);
        std::fs::write(&path, json.to_string()).unwrap();
        let message = read::read(&target).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }

    #[test]
    fn a_lamp_that_a_set_holds_in_part_is_refused() {
        refused(|json| drop(json["atlases"][0]["lamp"].take()), "atlas page 0");
        refused(|json| drop(json["lamp"].take()), "atlas page 0");
        refused(|json| json["lamp"]["keys"][1]["t"] = 0.5.into(), "ascend from 0 to 1");
        refused(|json| json["lamp"]["keys"][1]["position"] = json["lamp"]["keys"][0]["position"].clone(), "same place");
        refused(|json| json["atlases"][0]["lamp"]["layers"][0]["rise"] = "../x.png".into(), "not a plain file name");
    }

    #[test]
    fn tracks_that_are_none_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        write(&target, false, Bits::Sixteen).unwrap();
        let png = target.join("page0_track_lists.png");
        let said = || read::read(&target).unwrap_err().to_string();
        // A list of one span beyond the last, and one of two that do not ascend.
        for list in [6 << 6 | 1, 1 << 6 | 2u32] {
            image::RgbaImage::from_pixel(3, 2, image::Rgba(list.to_le_bytes())).save(&png).unwrap();
            assert!(said().contains("the list of texel 0, 0"), "{}", said());
        }
        image::RgbImage::new(3, 2).save(&png).unwrap();
        assert!(said().contains("not RGBA of 8 bits"), "{}", said());
        refused(|json| json["atlases"][0]["tracks"]["count"] = 1_000_000.into(), "the manifest says 2048 x 489");
        refused(|json| json["atlases"][0]["tracks"]["spans"] = "../x.png".into(), "not a plain file name");
    }

    #[test]
    fn a_texture_of_another_size_or_depth_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        write(&target, false, Bits::Eight).unwrap();
        let png = target.join("page0_lane0_layer0_rise.png");
        image::RgbaImage::new(2, 2).save(&png).unwrap();
        assert!(matches!(read::read(&target), Err(read::ReadError::Texture { .. })));
        image::RgbImage::new(3, 2).save(&png).unwrap();
        assert!(matches!(read::read(&target), Err(read::ReadError::Texture { .. })));
        std::fs::write(&png, b"not a png").unwrap();
        assert!(matches!(read::read(&target), Err(read::ReadError::Texture { .. })));
        std::fs::remove_file(&png).unwrap();
        assert!(matches!(read::read(&target), Err(read::ReadError::Io { .. })));
    }
}
