//! Writes a baked set. The only writer.
//!
//! It is written beside its target and moved into place when it is whole (`folder.rs`): a bake that stops before that, for
//! whatever reason, leaves the old set or none.

use super::folder::{FolderKind, FolderWriter};
use super::manifest::{AtlasEntry, LampMapsEntry, LaneEntry, LayerEntry, Manifest};
use super::read::MANIFEST_FILE;
use crate::maps::{Bits, LaneMaps, LayerMaps, PageMaps};
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

/// What a set's folder is.
const KIND: FolderKind = FolderKind { marker: MANIFEST_FILE, what: "a baked set", noun: "set" };

/// A set being written. Dropped before it is finished, it takes back whatever it made.
#[derive(Debug)]
pub struct SetWriter {
    folder: FolderWriter,
    bytes: u64,
}

impl SetWriter {
    /// Opens a folder beside `target` to write in.
    pub fn begin(target: &Path, force: bool) -> Result<Self, WriteError> {
        Ok(Self { folder: FolderWriter::begin(target, force, KIND)?, bytes: 0 })
    }

    /// Writes the scene.
    pub fn write_scene(&mut self, glb: &[u8]) -> Result<(), WriteError> {
        self.write_file(SCENE_FILE, |file| file.write_all(glb))
    }

    /// Writes the scene with ambient occlusion at its vertices.
    pub fn write_vertices(&mut self, glb: &[u8]) -> Result<(), WriteError> {
        self.write_file(VERTICES_FILE, |file| file.write_all(glb))
    }

    /// Writes a page's textures and says what the manifest should say of them.
    pub fn write_page(&mut self, index: usize, maps: &PageMaps, bits: Bits) -> Result<AtlasEntry, WriteError> {
        let mut textures: Vec<(String, &[[u16; 4]])> = Vec::new();
        let lanes = maps.lanes.iter().enumerate().map(|(k, LaneMaps { lane, layers })| LaneEntry {
            offset_deg: lane.offset_rad.to_degrees(),
            weight: lane.weight,
            layers: named_layers(&format!("page{index}_lane{k}"), layers, &mut textures),
        });
        let lanes = lanes.collect();
        let lamp = maps
            .lamp
            .as_ref()
            .map(|layers| LampMapsEntry { layers: named_layers(&format!("page{index}_lamp"), layers, &mut textures) });
        let size = (maps.width, maps.height);
        let written: Result<Vec<u64>, WriteError> =
            textures.par_iter().map(|(name, codes)| self.write_texture(name, codes, size, bits)).collect();
        self.bytes += written?.iter().sum::<u64>();
        Ok(AtlasEntry { width: maps.width, height: maps.height, lanes, lamp, ..AtlasEntry::default() })
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
        self.folder.write_file(name, |file| {
            let mut encoder = png::Encoder::new(file, size.0, size.1);
            encoder.set_color(png::ColorType::Rgba);
            encoder.set_depth(match bits {
                Bits::Eight => png::BitDepth::Eight,
                Bits::Sixteen => png::BitDepth::Sixteen,
            });
            encoder.set_compression(png::Compression::Fast);
            encoder.set_filter(png::Filter::Up);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&bytes_of(codes, bits))?;
            Ok(writer.finish()?)
        })
    }
}

/// Names the textures of layers, and adds each with its name to `textures`.
fn named_layers<'a>(
    stem: &str,
    layers: &'a [LayerMaps],
    textures: &mut Vec<(String, &'a [[u16; 4]])>,
) -> Vec<LayerEntry> {
    let mut entries = Vec::with_capacity(layers.len());
    for (l, LayerMaps { rise, fall }) in layers.iter().enumerate() {
        let [rise_file, fall_file] = ["rise", "fall"].map(|what| format!("{stem}_layer{l}_{what}.png"));
        textures.extend([(rise_file.clone(), rise.as_slice()), (fall_file.clone(), fall.as_slice())]);
        entries.push(LayerEntry { rise: rise_file, fall: fall_file });
    }
    entries
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
    use crate::maps::Lane;

    fn maps(bits: Bits) -> PageMaps {
        let mut layer = LayerMaps::unlit(6, bits);
        layer.rise[4] = [0, 1, bits.max_code() / 2, bits.max_code()];
        layer.fall[4] = [bits.max_code(), 2, 3, 0];
        let mut of_lamp = layer.clone();
        of_lamp.rise[2] = [7; 4];
        let lanes = vec![LaneMaps { lane: Lane::CENTRE, layers: vec![layer.clone(), layer] }];
        PageMaps { width: 3, height: 2, lanes, lamp: Some(vec![of_lamp]), ambient: None }
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
        let atlas = writer.write_page(0, &maps(bits), bits)?;
        writer.finish(&manifest(atlas, bits))
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
        assert!(matches!(write(&precious, true, Bits::Eight), Err(WriteError::NotOurs { .. })));
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

    /// The set's manifest, changed, is refused with these words.
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
