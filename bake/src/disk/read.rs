//! Reads a baked set. This is the only reader: everything is checked here once, and trusted afterwards.

use super::manifest::{
    ArcEntry, AtlasEntry, FORMAT, InstanceEntry, LampEntry, LampKeyEntry, LayerEntry, Manifest, PathEntry, VERSION,
};
use super::tracks::read_tracks;
use crate::lamp::{LampError, LampKey, LampPath};
use crate::maps::{AmbientMaps, AmbientSide, Bits, Lane, LaneMaps, LayerMaps, PageMaps};
use crate::scene::{self, LoadError, LoadLimits, Scene};
use crate::sun::{Day, PathError, SunArc, SunPath};
use glam::DVec3;
use std::path::{Component, Path, PathBuf};

/// Name of the manifest in a set's folder.
pub const MANIFEST_FILE: &str = "sunbake.json";
/// Largest width and height of a page, in texels: the limit of a bake.
const MAX_PAGE_TEXELS: u32 = 16_384;

/// A baked set, read and checked: files exist, sizes agree, indices are in range. The scene itself is read with
/// [`BakedSet::scene`].
#[derive(Debug, Clone)]
pub struct BakedSet {
    /// The folder that holds `sunbake.json`.
    pub folder: PathBuf,
    /// The manifest as read.
    pub manifest: Manifest,
    /// The sun's path, if the set has a sun.
    pub path: Option<SunPath>,
    /// The lamp's path, world space, if the set has a lamp.
    pub lamp: Option<LampPath>,
    /// Depth of stored times.
    pub bits: Bits,
    /// One per atlas page.
    pub pages: Vec<PageMaps>,
}

impl BakedSet {
    /// Path of `scene.glb`.
    pub fn scene_file(&self) -> PathBuf {
        self.folder.join(&self.manifest.scene.file)
    }

    /// The scene, without what the bake left out.
    ///
    /// # Errors
    ///
    /// Where the file cannot be loaded within `limits`.
    pub fn scene(&self, limits: &LoadLimits) -> Result<Scene, LoadError> {
        let mut scene = scene::load(&self.scene_file(), limits)?;
        self.manifest.apply_roles(&mut scene);
        Ok(scene)
    }
}

/// Why a folder is not a baked set.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}; put it back, or bake the scene again", path.display())]
    Io {
        /// The file that cannot be read.
        path: PathBuf,
        /// Why the system could not read it.
        source: std::io::Error,
    },
    /// There is nothing of that name.
    #[error("{} is not there: check its name", path.display())]
    Missing {
        /// What was named.
        path: PathBuf,
    },
    /// It is a file.
    #[error("{} is a file, and a baked set is a folder: give the folder that a bake wrote", path.display())]
    File {
        /// What was named.
        path: PathBuf,
    },
    /// There is no manifest in the folder.
    #[error(
        "{} holds no {MANIFEST_FILE}, so it is not a baked set: check its name, or make a set with \
         `sunbake bake SCENE -o SET`",
        folder.display()
    )]
    NotASet {
        /// The folder that was named.
        folder: PathBuf,
    },
    /// The manifest is not valid.
    #[error("{}: {reason}; bake the scene again", path.display())]
    Manifest {
        /// Path of `sunbake.json`.
        path: PathBuf,
        /// What is wrong, and where.
        reason: String,
    },
    /// A texture does not match the manifest.
    #[error("{}: {reason}; bake the scene again", path.display())]
    Texture {
        /// Path of the texture file.
        path: PathBuf,
        /// What is wrong, to be read after a colon.
        reason: String,
    },
}

/// Reads the set in `folder`.
pub fn read(folder: &Path) -> Result<BakedSet, ReadError> {
    let manifest = read_manifest(folder)?;
    let wrong = |reason: String| ReadError::Manifest { path: folder.join(MANIFEST_FILE), reason };
    let bits =
        Bits::from_count(manifest.bits).ok_or_else(|| wrong(format!("bits is {}, not 8 or 16", manifest.bits)))?;
    let path = manifest.path.as_ref().map(sun_path).transpose().map_err(|e| wrong(e.to_string()))?;
    let lamp = manifest.lamp.as_ref().map(lamp_path).transpose().map_err(|e| wrong(e.to_string()))?;
    check_instances(&manifest).map_err(&wrong)?;
    check_lamp(&manifest).map_err(&wrong)?;
    let pages = manifest.atlases.iter().map(|atlas| read_page(folder, atlas, bits)).collect::<Result<_, _>>()?;
    Ok(BakedSet { folder: folder.to_owned(), manifest, path, lamp, bits, pages })
}

/// Reads and checks `sunbake.json` alone: enough for `sunbake inspect`.
pub fn read_manifest(folder: &Path) -> Result<Manifest, ReadError> {
    let path = folder.join(MANIFEST_FILE);
    let text = std::fs::read_to_string(&path).map_err(|source| match source.kind() {
        _ if !folder.exists() => ReadError::Missing { path: folder.to_owned() },
        _ if folder.is_file() => ReadError::File { path: folder.to_owned() },
        std::io::ErrorKind::NotFound => ReadError::NotASet { folder: folder.to_owned() },
        _ => ReadError::Io { path: path.clone(), source },
    })?;
    let wrong = |reason: String| ReadError::Manifest { path: path.clone(), reason };
    let header: serde_json::Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    if header["format"] != FORMAT {
        return Err(wrong(format!("format is {}, not \"{FORMAT}\"", header["format"])));
    }
    if header["version"] != VERSION {
        return Err(wrong(format!("version is {}; this program reads version {VERSION}", header["version"])));
    }
    let manifest: Manifest = serde_json::from_value(header).map_err(|e| wrong(e.to_string()))?;
    check_names(&manifest).map_err(wrong)?;
    Ok(manifest)
}

/// Every file a manifest names must lie in its own folder.
fn check_names(manifest: &Manifest) -> Result<(), String> {
    let mut names = vec![&manifest.scene.file];
    names.extend(manifest.ambient.iter().flat_map(|ambient| &ambient.vertices).map(|vertices| &vertices.file));
    for atlas in &manifest.atlases {
        names.extend(
            atlas.walls.iter().chain(&atlas.ao).chain(&atlas.bent).chain(&atlas.bent_back).chain(&atlas.ambient_exr),
        );
        names.extend(atlas.sky.iter().flat_map(|sky| sky.front.iter().chain(sky.back.iter().flatten())));
        names.extend(atlas.loss_map.iter().flat_map(|map| [&map.picture, &map.numbers]));
        names.extend(atlas.tracks.iter().flat_map(|tracks| [&tracks.lists, &tracks.spans]));
        let layers = atlas.lanes.iter().flat_map(|lane| &lane.layers);
        let of_lamp = atlas.lamp.iter().flat_map(|lamp| &lamp.layers);
        names.extend(layers.chain(of_lamp).flat_map(|layer| [&layer.rise, &layer.fall]));
    }
    match names.into_iter().find(|name| !is_plain_file_name(name)) {
        Some(name) => Err(format!("it names {name:?}, which is not a plain file name in its own folder")),
        None => Ok(()),
    }
}

fn is_plain_file_name(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!((components.next(), components.next()), (Some(Component::Normal(_)), None))
        && !name.contains(['/', '\\', ':'])
}

fn check_instances(manifest: &Manifest) -> Result<(), String> {
    let wrong = |i: &&InstanceEntry| {
        let finite = i.uv_scale.iter().chain(&i.uv_offset).all(|x| x.is_finite());
        !finite || i.atlas.is_some_and(|a| a as usize >= manifest.atlases.len())
    };
    match manifest.instances.iter().find(wrong) {
        Some(i) => Err(format!("the instance of node {}, primitive {} points outside the atlas", i.node, i.primitive)),
        None => Ok(()),
    }
}

/// A lamp's path and its times on every page must all be present or all be absent.
fn check_lamp(manifest: &Manifest) -> Result<(), String> {
    let differs = |atlas: &AtlasEntry| atlas.lamp.is_some() != manifest.lamp.is_some();
    match manifest.atlases.iter().position(differs) {
        Some(page) => Err(format!("it has a path of a lamp or times of one on atlas page {page}, and not both")),
        None => Ok(()),
    }
}

fn read_page(folder: &Path, atlas: &AtlasEntry, bits: Bits) -> Result<PageMaps, ReadError> {
    let size = (atlas.width, atlas.height);
    if [size.0, size.1].iter().any(|edge| !(1..=MAX_PAGE_TEXELS).contains(edge)) {
        let reason = format!("a page of {} x {} texels is out of range", size.0, size.1);
        return Err(ReadError::Manifest { path: folder.join(MANIFEST_FILE), reason });
    }
    let mut lanes = Vec::with_capacity(atlas.lanes.len());
    for lane in &atlas.lanes {
        let layers = read_layers(folder, &lane.layers, size, bits)?;
        lanes.push(LaneMaps { lane: Lane { offset_rad: lane.offset_deg.to_radians(), weight: lane.weight }, layers });
    }
    let lamp = atlas.lamp.as_ref().map(|lamp| read_layers(folder, &lamp.layers, size, bits)).transpose()?;
    let ambient = read_ambient(folder, atlas, size)?;
    let walls = atlas.walls.as_ref().map(|name| read_walls(&folder.join(name), size)).transpose()?;
    let tracks = atlas.tracks.as_ref().map(|entry| read_tracks(folder, entry, size)).transpose()?;
    Ok(PageMaps { width: size.0, height: size.1, lanes, lamp, ambient, walls, tracks })
}

fn read_ambient(folder: &Path, atlas: &AtlasEntry, size: (u32, u32)) -> Result<Option<AmbientMaps>, ReadError> {
    let Some(ao) = &atlas.ao else { return Ok(None) };
    let [front, back] = read_occlusion(&folder.join(ao), size)?;
    let bent = |name: &Option<String>| name.as_ref().map(|n| read_rgb16(&folder.join(n), size)).transpose();
    let sky = |names: Option<&[String; 3]>| names.map(|names| read_sky(folder, names, size)).transpose();
    let of_front = atlas.sky.as_ref().map(|sky| &sky.front);
    let of_back = atlas.sky.as_ref().and_then(|sky| sky.back.as_ref());
    let front = AmbientSide { visibility: front.unwrap_or_default(), bent: bent(&atlas.bent)?, sky: sky(of_front)? };
    let back = match back {
        None => None,
        Some(visibility) => Some(AmbientSide { visibility, bent: bent(&atlas.bent_back)?, sky: sky(of_back)? }),
    };
    let lacks = |is_there: fn(&AmbientSide) -> bool| back.as_ref().is_some_and(|b| is_there(b) != is_there(&front));
    if lacks(|side| side.bent.is_some()) || lacks(|side| side.sky.is_some()) {
        let reason = "it has bent normals or a sky of one side of its surfaces and not of the other".into();
        return Err(ReadError::Manifest { path: folder.join(MANIFEST_FILE), reason });
    }
    Ok(Some(AmbientMaps { front, back }))
}

fn read_layers(
    folder: &Path,
    entries: &[LayerEntry],
    size: (u32, u32),
    bits: Bits,
) -> Result<Vec<LayerMaps>, ReadError> {
    let codes = |name: &String| read_codes(&folder.join(name), size, bits);
    entries.iter().map(|entry| Ok(LayerMaps { rise: codes(&entry.rise)?, fall: codes(&entry.fall)? })).collect()
}

/// Decodes a texture. A texture of another size is an error before its texels are allocated.
pub(super) fn decode(path: &Path, (width, height): (u32, u32)) -> Result<image::DynamicImage, ReadError> {
    let wrong = |reason: String| ReadError::Texture { path: path.to_owned(), reason };
    let io = |source| ReadError::Io { path: path.to_owned(), source };
    let mut reader = image::ImageReader::open(path).map_err(io)?;
    reader.set_format(image::ImageFormat::Png);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(width);
    limits.max_image_height = Some(height);
    limits.max_alloc = None;
    reader.limits(limits);
    let image = reader.decode().map_err(|e| wrong(e.to_string()))?;
    if (image.width(), image.height()) != (width, height) {
        let found = format!("{} x {}", image.width(), image.height());
        return Err(wrong(format!("it is {found} texels; the manifest says {width} x {height}")));
    }
    Ok(image)
}

fn read_codes(path: &Path, size: (u32, u32), bits: Bits) -> Result<Vec<[u16; 4]>, ReadError> {
    match (decode(path, size)?, bits) {
        (image::DynamicImage::ImageRgba8(image), Bits::Eight) => {
            Ok(image.pixels().map(|p| p.0.map(u16::from)).collect())
        }
        (image::DynamicImage::ImageRgba16(image), Bits::Sixteen) => Ok(image.pixels().map(|p| p.0).collect()),
        (image, _) => {
            let reason = format!("its texels are {:?}; the manifest says RGBA of {} bits", image.color(), bits.count());
            Err(ReadError::Texture { path: path.to_owned(), reason })
        }
    }
}

/// Ambient visibility of fronts and, for a coloured picture, of backs.
fn read_occlusion(path: &Path, size: (u32, u32)) -> Result<[Option<Vec<u16>>; 2], ReadError> {
    let image = decode(path, size)?;
    if !image.color().has_color() {
        return Ok([Some(image.into_luma16().into_raw()), None]);
    }
    let texels = image.into_rgb16();
    Ok([1, 2].map(|channel| Some(texels.pixels().map(|texel| texel.0[channel]).collect())))
}

fn read_walls(path: &Path, size: (u32, u32)) -> Result<Vec<[u8; 2]>, ReadError> {
    match decode(path, size)? {
        image::DynamicImage::ImageLumaA8(image) => Ok(image.pixels().map(|texel| texel.0).collect()),
        image => {
            let reason = format!("its texels are {:?}, not grey and alpha of 8 bits", image.color());
            Err(ReadError::Texture { path: path.to_owned(), reason })
        }
    }
}

fn read_rgb16(path: &Path, size: (u32, u32)) -> Result<Vec<[u16; 3]>, ReadError> {
    match decode(path, size)? {
        image::DynamicImage::ImageRgb16(image) => Ok(image.pixels().map(|texel| texel.0).collect()),
        image => {
            let reason = format!("its texels are {:?}, not RGB of 16 bits", image.color());
            Err(ReadError::Texture { path: path.to_owned(), reason })
        }
    }
}

fn read_sky(folder: &Path, names: &[String; 3], size: (u32, u32)) -> Result<Vec<[u16; 9]>, ReadError> {
    let mut sky = vec![[0; 9]; size.0 as usize * size.1 as usize];
    for (k, name) in names.iter().enumerate() {
        for (codes, three) in sky.iter_mut().zip(read_rgb16(&folder.join(name), size)?) {
            codes[3 * k..3 * k + 3].copy_from_slice(&three);
        }
    }
    Ok(sky)
}

/// The path that a manifest describes.
fn sun_path(entry: &PathEntry) -> Result<SunPath, PathError> {
    let arcs = entry.arcs.iter().map(arc).collect();
    let mut path = SunPath::new(arcs, entry.angular_radius_deg.to_radians(), entry.duration_min)?;
    path.day = day(entry);
    Ok(path)
}

/// The lamp's path that a manifest describes.
fn lamp_path(entry: &LampEntry) -> Result<LampPath, LampError> {
    let key = |key: &LampKeyEntry| LampKey { t: key.t, position_m: DVec3::from_array(key.position) };
    LampPath::new(entry.keys.iter().map(key).collect(), entry.radius_m, entry.duration_min)
}

fn arc(entry: &ArcEntry) -> SunArc {
    SunArc {
        axis: DVec3::from_array(entry.axis),
        zero: DVec3::from_array(entry.zero),
        declination_rad: entry.declination_deg.to_radians(),
        hour_angle_rad: entry.hour_angle_deg.map(f64::to_radians),
        t: entry.t,
    }
}

fn day(entry: &PathEntry) -> Option<Day> {
    let place = entry.place?;
    Some(Day {
        latitude_deg: place.latitude_deg,
        longitude_deg: place.longitude_deg,
        date: entry.date.clone()?,
        utc_offset_h: entry.utc_offset_h?,
        north_deg: entry.north_deg?,
        start_min: entry.start_min?,
        ephemeris_error_deg: entry.ephemeris_error_deg?,
    })
}
