//! `sunbake.json`: format version 1, field by field. Other programs read it, so a change here is a change of version.
//!
//! Lengths are metres, angles degrees, times fractions of the path unless a name says otherwise. Vectors are in the
//! scene's world space. File names are relative to the manifest's folder.

use serde::{Deserialize, Serialize};

/// What `format` says.
pub const FORMAT: &str = "sunbake";
/// What `version` says.
pub const VERSION: u32 = 1;

/// The whole of `sunbake.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Always [`FORMAT`].
    pub format: String,
    /// Always [`VERSION`].
    pub version: u32,
    /// Program and version that wrote the set.
    pub generator: String,
    /// The scene file that was baked.
    pub source: SourceEntry,
    /// The scene with the bake's texture coordinates.
    pub scene: SceneEntry,
    /// The sun's path; null where the sun did not rise, or only a lamp was baked.
    pub path: Option<PathEntry>,
    /// The path of a lamp that moves through the scene, where one was baked. Its t is the sun's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lamp: Option<LampEntry>,
    /// How ambient light was baked, where it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ambient: Option<AmbientEntry>,
    /// 8 or 16: bits of each stored time.
    pub bits: u32,
    /// Pages of the atlas.
    pub atlases: Vec<AtlasEntry>,
    /// What lies where in which page: one entry per drawn primitive of each node of `scene.glb`.
    pub instances: Vec<InstanceEntry>,
    /// What was baked and why, what was left out and why.
    pub effects: Vec<EffectEntry>,
    /// What it took.
    pub stats: Stats,
    /// What storing lost.
    pub error: ErrorEntry,
}

/// The file that was baked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceEntry {
    /// File name without its folder.
    pub file: String,
    /// SHA-256 of the file and of what it refers to.
    pub sha256: String,
}

/// `scene.glb`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// File name.
    pub file: String,
    /// World position of the centre that the bake was computed relative to.
    pub centre_m: [f64; 3],
    /// Texels a metre that the atlas reached.
    pub texels_per_metre: f64,
    /// SHA-256 of the file, in lower-case hex: with another scene the times are wrong. Sets of before this was kept lack it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

/// The sun's path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathEntry {
    /// Where, if the path is that of a real day.
    pub place: Option<GeoLocation>,
    /// The local date at the path's start, `YYYY-MM-DD`, if it is a real day.
    pub date: Option<String>,
    /// Hours local clocks are ahead of UTC.
    pub utc_offset_h: Option<f64>,
    /// Degrees the scene's north is turned from -Z towards +X.
    pub north_deg: Option<f64>,
    /// Start and end by local clocks, `YYYY-MM-DDTHH:MM:SS`.
    pub local: Option<[String; 2]>,
    /// Start and end in UTC, `YYYY-MM-DDTHH:MM:SSZ`.
    pub utc: Option<[String; 2]>,
    /// Minutes after local midnight of `date` at t = 0.
    pub start_min: Option<f64>,
    /// Minutes from t = 0 to t = 1.
    pub duration_min: f64,
    /// Angular radius of the sun's disc.
    pub angular_radius_deg: f64,
    /// Largest angle between the path and the ephemeris while the sun is up.
    pub ephemeris_error_deg: Option<f64>,
    /// The arcs, in order, from t = 0 to t = 1.
    pub arcs: Vec<ArcEntry>,
}

/// A place on Earth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GeoLocation {
    /// Degrees north.
    pub latitude_deg: f64,
    /// Degrees east.
    pub longitude_deg: f64,
}

/// `dir(h) = cos d (cos h zero + sin h axis x zero) + sin d axis`, h linear in t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ArcEntry {
    /// Unit vector.
    pub axis: [f64; 3],
    /// Unit vector across the axis.
    pub zero: [f64; 3],
    /// d.
    pub declination_deg: f64,
    /// h at the start and at the end.
    pub hour_angle_deg: [f64; 2],
    /// t at the start and at the end.
    pub t: [f64; 2],
}

/// A lamp's path, and what baking it took and lost. It moves at constant speed along straight lines from key to key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LampEntry {
    /// Two at least, from t = 0 to t = 1, times ascending.
    pub keys: Vec<LampKeyEntry>,
    /// Radius of the lamp.
    pub radius_m: f64,
    /// Minutes from t = 0 to t = 1; the sun's, where the set has a sun.
    pub duration_min: f64,
    /// What it took. Its seconds are among the set's.
    pub stats: LampStats,
    /// What storing its times lost.
    pub error: ErrorEntry,
}

/// A place of the lamp.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LampKeyEntry {
    /// When.
    pub t: f64,
    /// Where, in world space.
    pub position: [f64; 3],
}

/// What baking a lamp took.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LampStats {
    /// Engine and its parameters, as given on the command line.
    pub engine: String,
    /// Rays traced.
    pub rays: u64,
    /// Lit intervals found.
    pub intervals: u64,
    /// Texels that never see the lamp.
    pub dark_texels: u64,
    /// Most lit intervals of any texel.
    pub most_intervals: u64,
}

/// A page of the atlas.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct AtlasEntry {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// Paths across the sun's disc; one where the sun is a line along its path.
    pub lanes: Vec<LaneEntry>,
    /// When texels see the lamp, in every page of a set that has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lamp: Option<LampMapsEntry>,
    /// Ambient occlusion, 0 is occluded: a grey PNG or, where some texel has two sides, an RGB one whose green is what the
    /// front sees, blue what the back sees, and red, which viewers read, the greater of the two.
    pub ao: Option<String>,
    /// Bent normals of fronts: RGB PNG of 16 bits, a code q meaning `(q - 32768) / 32767`, world space. The length is the
    /// mean's own.
    pub bent: Option<String>,
    /// Bent normals of backs, where some texel has two sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bent_back: Option<String>,
    /// Sky visibility in spherical harmonics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sky: Option<SkyMapsEntry>,
    /// All of these as numbers, OpenEXR of `f32`, if asked for. Nothing else needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ambient_exr: Option<String>,
    /// Where storing this page lost minutes, if the bake was asked to show it. Nothing else needs these files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss_map: Option<LossMapEntry>,
}

/// Sky visibility: with sky radiance `L = sum of L_i Y_i`, a matt surface sends back `albedo * sum of L_i T_i`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SkyMapsEntry {
    /// `sh2`: real spherical harmonics up to degree two, in the order (0, 0), (1, -1), (1, 0), (1, 1), (2, -2) to (2, 2),
    /// orthonormal, of directions in world space: Y(1, -1) goes with y, Y(1, 0) with z, Y(1, 1) with x.
    pub basis: String,
    /// Coefficients T of fronts, three a file: RGB PNGs of 16 bits, a code q meaning `(q - 32768) / 32767`.
    pub front: [String; 3],
    /// Those of backs, where some texel has two sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back: Option<[String; 3]>,
}

/// What ambient light was baked with, and what came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AmbientEntry {
    /// Rays a texel and side; with an error, the most of them.
    pub rays: u32,
    /// The error that texels were estimated to, with 95 % confidence; null: all have as many rays.
    pub error: Option<f64>,
    /// Metres beyond which nothing hides; a surface at d hides `(1 - (d / distance_m)^2)^2`. Null: everything hides.
    pub distance_m: Option<f64>,
    /// Points of a texel along each of its edges.
    pub supersample: u32,
    /// 8 or 16: bits of the occlusion textures.
    pub bits: u32,
    /// Rays traced in all.
    pub rays_traced: u64,
    /// Texels inside a solid. Those beside one that can be seen hold its value, the others 0.
    pub buried_texels: u64,
    /// Sides of texels that may still be off by more than `error`, because there were no more rays.
    #[serde(default)]
    pub unsettled_texels: u64,
    /// How far apart the two sides of cuts are.
    pub seams: SeamEntry,
    /// The scene with openness at its vertices, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<VertexEntry>,
}

/// How far apart filtered occlusion is on the two sides of cuts between charts of one surface, at points half a texel apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SeamEntry {
    /// Points looked at.
    pub points: u64,
    /// Of these, those whose sides differ by more than a quarter: taken to be so in truth, left alone, and not counted below.
    pub differing: u64,
    /// Mean difference before the texels beside cuts were made to agree.
    pub mean_before: f64,
    /// Mean difference as written.
    pub mean: f64,
    /// 99 in 100 are no farther apart; of several pages, the largest.
    pub p99: f64,
    /// The worst.
    pub worst: f64,
}

/// A scene with openness at its vertices. Nothing else needs it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VertexEntry {
    /// File name.
    pub file: String,
    /// `COLOR_0` or `_AO`.
    pub attribute: String,
}

/// Minutes that storing lost, texel by texel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LossMapEntry {
    /// PNG: minutes lost in all, from black over violet, red and orange to pale yellow; transparent where no surface is.
    pub picture: String,
    /// OpenEXR of two `f32` channels, in minutes: `layers`, lost for want of slots, and `bits`, lost by rounding.
    pub numbers: String,
    /// How colours follow minutes: `sqrt`, so that a quarter of `scale_max_min` has the middle colour.
    pub scale: String,
    /// Minutes that the brightest colour stands for.
    pub scale_max_min: f64,
}

/// A lane across the sun's disc. Its times follow the path with the offset added to every arc's declination, and its window
/// is `sqrt(1 - (offset / angular radius)^2)` of the sun's width.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LaneEntry {
    /// Declination less the centre's.
    pub offset_deg: f64,
    /// Share of the disc's area.
    pub weight: f64,
    /// Texture pairs; channel c of layer l holds interval 4 l + c.
    pub layers: Vec<LayerEntry>,
}

/// A lamp's times on a page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LampMapsEntry {
    /// Texture pairs; channel c of layer l holds interval 4 l + c.
    pub layers: Vec<LayerEntry>,
}

/// A pair of RGBA textures.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LayerEntry {
    /// Interval starts.
    pub rise: String,
    /// Interval ends.
    pub fall: String,
}

/// Where the texels of a drawn primitive lie: `page_uv = uv * uv_scale + uv_offset`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InstanceEntry {
    /// Index of the node in `scene.glb`.
    pub node: usize,
    /// Index of the primitive within the node's mesh.
    pub primitive: usize,
    /// Index in `atlases`; null for surfaces that are not baked (wholly transparent ones).
    pub atlas: Option<u32>,
    /// Which `TEXCOORD_n` of `scene.glb` holds `uv`. In a set with ambient occlusion these are page coordinates already, so
    /// that any viewer shows it: the scale is 1 and the offset 0.
    pub uv_set: u32,
    /// In page coordinates, v from the top.
    pub uv_scale: [f32; 2],
    /// In page coordinates, v from the top.
    pub uv_offset: [f32; 2],
    /// Whether the times hold for both sides. If so, a face is lit only while the sun stands before it.
    pub double_sided: bool,
}

/// One effect: on or off, and why. What it costs and what turns it over is in words for people; sets of older bakers do
/// not say it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct EffectEntry {
    /// Its name.
    pub effect: String,
    /// Whether it was baked.
    pub on: bool,
    /// The reason.
    pub why: String,
    /// What it costs while it is on; of what is off, what it would cost.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub cost: String,
    /// The flag, or the property of the scene, that would turn it over.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[serde(alias = "turned_over_by")]
    pub toggled_by: String,
}

/// What the bake took.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// Triangles of all instances.
    pub triangles: u64,
    /// Triangles of the file that were left out: repeated index, no area, not finite.
    pub dropped_triangles: u64,
    /// Texels that stand for a point of a surface.
    pub texels: u64,
    /// Texels of all pages.
    pub page_texels: u64,
    /// Charts of the atlas.
    pub charts: u64,
    /// Lit intervals found, of all lanes.
    pub intervals: u64,
    /// Texels that never see the sun, along any lane.
    #[serde(default)]
    pub dark_texels: u64,
    /// Most lit intervals of any texel along one lane.
    pub most_intervals: u64,
    /// Engine and its parameters, as given on the command line.
    pub engine: String,
    /// Rays traced; none by the exact engine.
    pub rays: u64,
    /// Hierarchy nodes that the exact engine looked into: sixteen boxes, or sixteen triangles' corners, each.
    #[serde(default)]
    pub node_tests: u64,
    /// Triangles that the exact engine solved.
    #[serde(default)]
    pub triangle_tests: u64,
    /// Bytes of all files of the set but the manifest.
    pub bytes: u64,
    /// Threads used.
    pub threads: usize,
    /// Wall-clock seconds of each stage.
    pub seconds: StageSeconds,
}

/// Wall-clock seconds of each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StageSeconds {
    /// Reading the scene.
    pub load: f64,
    /// Unwrapping, packing and sampling.
    pub unwrap: f64,
    /// Building the hierarchy that rays are traced against.
    pub bvh: f64,
    /// Finding lit intervals.
    pub visibility: f64,
    /// Ambient occlusion.
    pub ambient: f64,
    /// Turning intervals into codes.
    pub encode: f64,
    /// Writing files.
    pub write: f64,
}

/// What storing lost, over covered texels, in minutes of the path. Of several lanes, a texel's loss is their mean by weight.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEntry {
    /// By rounding times to codes.
    pub quantisation_min: LossEntry,
    /// By having fewer slots than intervals.
    pub merge_min: LossEntry,
    /// Texels that lost intervals for want of slots.
    pub merged_texels: u64,
}

/// Distribution of a loss.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LossEntry {
    /// Over all covered texels.
    pub mean: f64,
    /// 99 in 100 texels lose no more.
    pub p99: f64,
    /// The worst texel.
    pub worst: f64,
    /// Where that is: atlas page, x, y. Null where nothing was lost.
    pub worst_at: Option<[u32; 3]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effects_of_older_sets_load_and_are_written_with_the_new_key() {
        let older = r#"{"effect": "sun", "on": true, "why": "a day", "turned_over_by": "--only ao"}"#;
        let effect: EffectEntry = serde_json::from_str(older).unwrap();
        assert_eq!(effect.toggled_by, "--only ao");
        let written = serde_json::to_value(&effect).unwrap();
        assert_eq!(written["toggled_by"], "--only ao");
        assert!(written.get("turned_over_by").is_none());
    }
}
