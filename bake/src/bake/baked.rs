//! A bake in memory, and the two sinks of its pages: one keeps them, the other writes one after the other.

use super::error::BakeError;
use crate::disk::BakedPage;
use crate::disk::manifest::{AtlasEntry, Manifest, Stats, StepSeconds};
use crate::disk::write::{SetWriter, WriteError};
use crate::lamp::LampPath;
use crate::maps::{Bits, StoredBits};
use crate::scene::{self, LoadError, LoadLimits, Scene};
use crate::settings::BakeSettings;
use crate::sun::SunPath;
use crate::warning::Warning;
use std::path::Path;
use std::time::Instant;

/// A bake in memory: everything that a baked set holds.
#[derive(Debug, Clone)]
pub struct Bake {
    /// The manifest, with the names that [`Bake::write`] gives to files. `stats.bytes` is 0 until files are written.
    pub manifest: Manifest,
    /// The sun's path, if there is a sun.
    pub path: Option<SunPath>,
    /// The lamp's path in world space, if there is a lamp.
    pub lamp: Option<LampPath>,
    /// Depth of stored numbers.
    pub bits: StoredBits,
    /// One per atlas page.
    pub pages: Vec<BakedPage>,
    /// The bytes of `scene.glb`: the scene with the coordinates that `manifest.instances` refer to.
    pub scene_glb: Vec<u8>,
    /// The bytes of the scene with ambient visibility at its vertices, if that was asked for.
    pub vertices_glb: Option<Vec<u8>>,
    /// What a user should know: one sentence each.
    pub warnings: Vec<Warning>,
}

impl Bake {
    /// The scene as [`crate::disk::read::BakedSet::scene`] reads it from a written set.
    ///
    /// # Errors
    ///
    /// Where the scene needs more memory than `limits` allow.
    pub fn scene(&self, limits: &LoadLimits) -> Result<Scene, LoadError> {
        let mut scene = scene::parse(Path::new(&self.manifest.scene.file), &self.scene_glb, limits)?;
        self.manifest.apply_roles(&mut scene);
        Ok(scene)
    }

    /// Writes the set into the folder `target`; `force` allows an older set there to be replaced. Gives the manifest as
    /// written.
    ///
    /// # Errors
    ///
    /// Where `target` is taken or cannot be written.
    pub fn write(&self, target: &Path, force: bool) -> Result<Manifest, WriteError> {
        let mut writer = SetWriter::begin(target, force)?;
        let started = Instant::now();
        for (entry, page) in self.manifest.atlases.iter().zip(&self.pages) {
            writer.write_page(entry, page, self.bits)?;
        }
        let mut manifest = self.manifest.clone();
        manifest.stats.seconds.write += started.elapsed().as_secs_f64();
        write_unpaged(writer, manifest, &self.scene_glb, self.vertices_glb.as_deref())
    }
}

/// A bake without its pages.
pub(super) struct UnpagedBake {
    pub manifest: Manifest,
    pub scene_glb: Vec<u8>,
    pub vertices_glb: Option<Vec<u8>>,
    pub warnings: Vec<Warning>,
}

/// Writes everything of a set but its pages, and moves it into place. Gives the manifest as written.
pub(super) fn write_unpaged(
    mut writer: SetWriter,
    manifest: Manifest,
    scene_glb: &[u8],
    vertices_glb: Option<&[u8]>,
) -> Result<Manifest, WriteError> {
    let started = Instant::now();
    writer.write_scene(scene_glb)?;
    vertices_glb.map(|glb| writer.write_vertices(glb)).transpose()?;
    let Stats { seconds, .. } = manifest.stats;
    let seconds = StepSeconds { write: seconds.write + started.elapsed().as_secs_f64(), ..seconds };
    let manifest = Manifest { stats: Stats { bytes: writer.bytes(), seconds, ..manifest.stats }, ..manifest };
    writer.finish(&manifest)?;
    Ok(manifest)
}

/// Takes each page of a bake as soon as it is finished.
pub(super) trait PageSink {
    /// Takes a page and what the manifest says of it.
    fn take(&mut self, page: BakedPage, entry: &AtlasEntry) -> Result<(), BakeError>;
}

/// Keeps every page.
impl PageSink for Vec<BakedPage> {
    fn take(&mut self, page: BakedPage, _entry: &AtlasEntry) -> Result<(), BakeError> {
        self.push(page);
        Ok(())
    }
}

/// Writes every page and keeps none.
pub(super) struct PageFiles<'a> {
    pub writer: &'a mut SetWriter,
    pub bits: StoredBits,
}

impl PageSink for PageFiles<'_> {
    fn take(&mut self, page: BakedPage, entry: &AtlasEntry) -> Result<(), BakeError> {
        Ok(self.writer.write_page(entry, &page, self.bits)?)
    }
}

/// Depth of what a bake with these settings stores.
pub(super) fn stored_bits(settings: &BakeSettings) -> StoredBits {
    StoredBits { times: settings.bits, ambient: settings.ambient.map_or(Bits::Sixteen, |request| request.bits) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ambient::AmbientSettings;
    use crate::atlas::{self, AtlasSettings};
    use crate::disk::manifest::TrackStats;
    use crate::disk::read;
    use crate::maps::PageMaps;
    use crate::progress::Silent;
    use crate::settings::{AmbientRequest, SunRequest, TrackChoice, VertexAttribute};
    use crate::sun::DayRequest;
    use crate::testing::{SceneBuilder, block, floor, opaque};
    use crate::{bake, bake_scene, glb};
    use glam::{Vec2, Vec3};
    use std::collections::BTreeMap;

    /// A box above a two-sided floor, as a file.
    fn scene_file(folder: &Path) -> std::path::PathBuf {
        let two_sided = scene::Material { is_double_sided: true, ..opaque() };
        let scene = SceneBuilder::new()
            .soup_of(&floor(Vec2::ZERO, Vec2::splat(4.0), 0.0), two_sided)
            .soup(&block(Vec3::new(1.0, 0.5, 1.0), Vec3::new(2.0, 2.0, 3.0)))
            .build();
        let settings = AtlasSettings { page_size_texels: 64, ..AtlasSettings::default() };
        let atlas = atlas::build(&scene, &settings, &|_| true).unwrap();
        let file = folder.join("box.glb");
        std::fs::write(&file, glb::write_glb(&scene, &atlas.layouts, None).unwrap().bytes).unwrap();
        file
    }

    /// Everything that a set can hold, in small.
    fn settings(bits: Bits) -> BakeSettings {
        let day = DayRequest::new(Some([40.0, 0.0]), Some("2026-06-21".parse().unwrap())).unwrap();
        let standard = BakeSettings::standard(SunRequest::Day(day));
        let ambient = AmbientRequest::with_rays(64);
        let estimate = AmbientSettings { wants_bent: true, wants_sky: true, ..ambient.estimate };
        let vertices = Some(VertexAttribute::Ao);
        let ambient = AmbientRequest { estimate, bits, exr: cfg!(feature = "exr"), vertices, ..ambient };
        BakeSettings {
            page_size_texels: 64,
            bits,
            lane_count: 3,
            tracks: TrackChoice::Auto,
            ambient: Some(ambient),
            loss_map: cfg!(feature = "exr"),
            threads: 1,
            ..standard
        }
    }

    /// A manifest without what no two bakes share.
    fn timeless(manifest: &Manifest) -> Manifest {
        let tracks = manifest.stats.tracks.map(|tracks| TrackStats { seconds: 0.0, ..tracks });
        let stats = Stats { seconds: StepSeconds::default(), tracks, ..manifest.stats.clone() };
        Manifest { stats, ..manifest.clone() }
    }

    /// The files of a folder but the manifest.
    fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
        let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), entry.path()));
        let read = named.filter(|(name, _)| name != read::MANIFEST_FILE);
        read.map(|(name, path)| (name, std::fs::read(path).unwrap())).collect()
    }

    #[test]
    fn a_bake_in_memory_is_what_the_command_writes_and_what_is_read_again() {
        for bits in [Bits::Eight, Bits::Sixteen] {
            let folder = tempfile::tempdir().unwrap();
            let [by_command, by_hand] = ["command", "hand"].map(|name| folder.path().join(name));
            let file = scene_file(folder.path());
            let settings = settings(bits);
            let report = bake(&file, &by_command, false, &settings, &Silent).unwrap();
            let scene = scene::load(&file, &LoadLimits { max_memory_bytes: 1 << 30 }).unwrap();
            let baked = bake_scene(&scene, &settings, &Silent).unwrap();

            let set = read::read(&by_command).unwrap();
            let unwritten = Stats { bytes: 0, ..set.manifest.stats.clone() };
            assert_eq!(timeless(&baked.manifest), timeless(&Manifest { stats: unwritten, ..set.manifest.clone() }));
            let maps = |page: &BakedPage| PageMaps { lanes: Vec::new(), ..page.maps.clone() };
            let without_lanes = |page: &PageMaps| PageMaps { lanes: Vec::new(), ..page.clone() };
            assert!(baked.pages.iter().map(maps).eq(set.pages.iter().map(without_lanes)));
            let layers = |page: &PageMaps| page.lanes.iter().map(|lane| lane.layers.clone()).collect::<Vec<_>>();
            assert!(baked.pages.iter().map(|page| layers(&page.maps)).eq(set.pages.iter().map(layers)));
            assert_eq!((baked.bits.times, &baked.warnings), (set.bits, &report.warnings));

            let written = baked.write(&by_hand, false).unwrap();
            assert_eq!(timeless(&written), timeless(&report.manifest));
            assert_eq!(files(&by_hand), files(&by_command));
            let again = baked.scene(&LoadLimits { max_memory_bytes: 1 << 30 }).unwrap();
            assert_eq!(Some(again.source.sha256), set.manifest.scene.sha256);
        }
    }
}
