//! Writes a baked set. The only writer.
//!
//! Everything goes into a folder beside the target, under a name that nothing reads; [`SetWriter::finish`] renames it into
//! place. A bake that stops before that, for whatever reason, leaves the old set or none.

use super::manifest::{AtlasEntry, LampMapsEntry, LaneEntry, LayerEntry, Manifest};
use super::read::MANIFEST_FILE;
use crate::maps::{Bits, LaneMaps, LayerMaps, PageMaps};
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Name of the scene in a set's folder.
pub const SCENE_FILE: &str = "scene.glb";
/// Name of the scene with ambient occlusion at its vertices.
pub const VERTICES_FILE: &str = "vertices.glb";
/// How the folder of an unfinished bake is called, after a dot and the target's name.
const PARTIAL_SUFFIX: &str = ".sunbake-partial";

/// Why a set could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The target is there already.
    #[error("{} exists: choose another folder with -o, or replace it with --force", target.display())]
    Exists {
        /// The target.
        target: PathBuf,
    },
    /// The target is there and is no set, so it is not replaced even by force.
    #[error(
        "{} exists and is not a baked set, so --force will not replace it: choose another folder with -o, or remove it yourself",
        target.display()
    )]
    NotASet {
        /// The target.
        target: PathBuf,
    },
    /// The target's parent folder is missing, or cannot be written.
    #[error("cannot write in {}: {source}; choose another folder with -o", folder.display())]
    Folder {
        /// The parent.
        folder: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {name}: {source}; nothing was left behind, so make room or choose another folder with -o")]
    File {
        /// Its name within the set.
        name: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The finished set could not be moved into place.
    #[error("cannot move the finished set to {}: {source}", target.display())]
    Rename {
        /// The target.
        target: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// A set being written. Dropped before it is finished, it takes back whatever it made.
#[derive(Debug)]
pub struct SetWriter {
    target: PathBuf,
    partial: TempDir,
    bytes: u64,
    /// After `partial`, which lies in it and has to go first.
    _parent: MadeFolders,
}

/// Folders that were made on the way to the target, outermost first. Those that stay empty are removed again.
#[derive(Debug)]
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    fn make(folder: &Path) -> std::io::Result<Self> {
        let missing = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists());
        let mut made = Self(Vec::new());
        let missing: Vec<&Path> = missing.collect();
        for folder in missing.into_iter().rev() {
            match std::fs::create_dir(folder) {
                Ok(()) => made.0.push(folder.to_owned()),
                // Another process was faster.
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(made)
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // Only empty folders can be removed so: one that holds a set stays.
            let _ = std::fs::remove_dir(folder);
        }
    }
}

/// Whether a set may be written at `target`.
fn check_target(target: &Path, force: bool) -> Result<(), WriteError> {
    let Ok(metadata) = std::fs::metadata(target).or_else(|_| std::fs::symlink_metadata(target)) else { return Ok(()) };
    let is_empty = || std::fs::read_dir(target).is_ok_and(|mut entries| entries.next().is_none());
    if metadata.is_dir() && is_empty() {
        return Ok(());
    }
    if !force {
        return Err(WriteError::Exists { target: target.to_owned() });
    }
    match metadata.is_dir() && target.join(MANIFEST_FILE).is_file() {
        true => Ok(()),
        false => Err(WriteError::NotASet { target: target.to_owned() }),
    }
}

impl SetWriter {
    /// Opens a folder beside `target` to write in.
    pub fn begin(target: &Path, force: bool) -> Result<Self, WriteError> {
        check_target(target, force)?;
        // What is there already is replaced where it really is, be it named `.` or by a link.
        let target = &target.canonicalize().unwrap_or_else(|_| target.to_owned());
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let wrong = |source| WriteError::Folder { folder: folder.clone(), source };
        let made = MadeFolders::make(&folder).map_err(wrong)?;
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let partial = tempfile::Builder::new()
            .prefix(&format!(".{name}."))
            .suffix(PARTIAL_SUFFIX)
            .tempdir_in(&folder)
            // The kind alone: the whole error names our hidden folder, which means nothing to anyone.
            .map_err(|error| wrong(error.kind().into()))?;
        Ok(Self { target: target.to_owned(), partial, bytes: 0, _parent: made })
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
        make_readable(self.partial.path());
        let wrong = |source| WriteError::Rename { target: self.target.clone(), source };
        let replaced = self.set_old_aside().map_err(wrong)?;
        match std::fs::rename(self.partial.path(), &self.target) {
            Ok(()) => Ok(()),
            Err(source) => {
                if let Some(old) = &replaced {
                    // The old set goes back to where it was; if even that fails, the error below names the cause.
                    let _ = std::fs::rename(old.path().join("old"), &self.target);
                }
                Err(wrong(source))
            }
        }
    }

    /// Moves what the target holds into a folder that is removed when this set is in place.
    fn set_old_aside(&self) -> std::io::Result<Option<TempDir>> {
        if !self.target.exists() {
            return Ok(None);
        }
        let parent = self.partial.path().parent().unwrap_or(Path::new("."));
        let aside = tempfile::Builder::new().prefix(".old.").suffix(PARTIAL_SUFFIX).tempdir_in(parent)?;
        std::fs::rename(&self.target, aside.path().join("old"))?;
        Ok(Some(aside))
    }

    /// Writes a file of the set.
    pub(super) fn write_file(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), WriteError> {
        self.bytes += write_into(self.partial.path(), name, write)?;
        Ok(())
    }

    fn write_texture(&self, name: &str, codes: &[[u16; 4]], size: (u32, u32), bits: Bits) -> Result<u64, WriteError> {
        write_into(self.partial.path(), name, |file| {
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

fn write_into(
    folder: &Path,
    name: &str,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<u64, WriteError> {
    let wrong = |source| WriteError::File { name: name.to_owned(), source };
    let mut file = BufWriter::new(File::create(folder.join(name)).map_err(wrong)?);
    write(&mut file).and_then(|()| file.flush()).map_err(wrong)?;
    let length = file.get_ref().metadata().map_err(wrong)?.len();
    Ok(length)
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

/// A temporary folder is its owner's alone; a set is as open as any folder the user makes.
#[cfg(unix)]
fn make_readable(folder: &Path) {
    use std::os::unix::fs::PermissionsExt;
    // A set that only its owner can read is still a set.
    let _ = std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755));
}

#[cfg(not(unix))]
fn make_readable(_folder: &Path) {}

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
            scene: manifest::SceneEntry { file: SCENE_FILE.into(), centre_m: [0.0; 3], texels_per_metre: 1.0 },
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
        assert!(matches!(write(&precious, true, Bits::Eight), Err(WriteError::NotASet { .. })));
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
