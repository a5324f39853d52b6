//! `sunbake.json`: format version 1, field by field. Other programs read it, so a change here needs a new version.
//!
//! Lengths are in metres, angles in degrees, times in fractions of the path (0 to 1), unless a name says otherwise.
//! Vectors are in the scene's world space. File names are relative to the manifest's folder.

use serde::{Deserialize, Serialize};

/// Value of [`Manifest::format`].
pub const FORMAT: &str = "sunbake";
/// Value of [`Manifest::version`].
pub const VERSION: u32 = 1;

/// The content of `sunbake.json`.
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
    /// The sun's path; null if the sun does not rise or if only a lamp was baked.
    pub path: Option<PathEntry>,
    /// The path of a lamp that moves through the scene, if one was baked. Its t is the same as the sun's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lamp: Option<LampEntry>,
    /// How ambient light was baked, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ambient: Option<AmbientEntry>,
    /// 8 or 16: bits of each stored time.
    pub bits: u32,
    /// Pages of the atlas.
    pub atlases: Vec<AtlasEntry>,
    /// Placement on the pages: one entry per drawn primitive of each node of `scene.glb`.
    pub instances: Vec<InstanceEntry>,
    /// Which effects were baked, which not, and why.
    pub effects: Vec<EffectEntry>,
    /// Counts, times and sizes of the bake.
    pub stats: Stats,
    /// Minutes lost by storing.
    pub error: ErrorEntry,
}

/// The scene file that was baked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceEntry {
    /// File name without its folder.
    pub file: String,
    /// SHA-256, in lower-case hex, of the file and of the files that it names.
    pub sha256: String,
}

/// `scene.glb`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// File name.
    pub file: String,
    /// World position of bake space's origin, in metres.
    pub centre_m: [f64; 3],
    /// Density of the atlas, in texels per metre.
    pub texels_per_metre: f64,
    /// SHA-256 of the file, in lower-case hex: times are wrong for any other scene. Absent in older sets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

/// The sun's path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PathEntry {
    /// The place, if the path is that of a real day.
    pub place: Option<GeoLocation>,
    /// The local date at the path's start, `YYYY-MM-DD`, if it is a real day.
    pub date: Option<String>,
    /// Hours local clocks are ahead of UTC.
    pub utc_offset_h: Option<f64>,
    /// Angle by which the scene's north is turned from -Z towards +X.
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
    /// The axis of rotation, a unit vector.
    pub axis: [f64; 3],
    /// Direction at h = 0 and d = 0: a unit vector perpendicular to the axis.
    pub zero: [f64; 3],
    /// The declination d.
    pub declination_deg: f64,
    /// The hour angle h at the start and at the end.
    pub hour_angle_deg: [f64; 2],
    /// Path time at the start and at the end.
    pub t: [f64; 2],
}

/// A lamp's path and its bake. The lamp moves at constant speed along a straight line from each key to the next.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LampEntry {
    /// At least two keys, from t = 0 to t = 1, with ascending times.
    pub keys: Vec<LampKeyEntry>,
    /// Radius of the lamp.
    pub radius_m: f64,
    /// Minutes from t = 0 to t = 1; the same as the sun's if the set has a sun.
    pub duration_min: f64,
    /// Counts of the bake. Its seconds are included in the set's.
    pub stats: LampStats,
    /// Minutes lost by storing its times.
    pub error: ErrorEntry,
}

/// A position of the lamp at a path time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LampKeyEntry {
    /// Path time.
    pub t: f64,
    /// Position in world space, in metres.
    pub position: [f64; 3],
}

/// Counts of baking a lamp.
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
    /// Lanes across the sun's disc; one if the sun is a line along its path.
    pub lanes: Vec<LaneEntry>,
    /// The lamp's times; present on every page of a set with a lamp.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lamp: Option<LampMapsEntry>,
    /// What stands between neighbouring texels, where anything does: a PNG of grey (the way to the right neighbour) and
    /// alpha (to the lower), of the codes that [`crate::atlas::wall_code`] makes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<String>,
    /// The sun's shade occluder by occluder, where it was asked for. A reader may ignore it: `lanes` say when texels
    /// are lit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tracks: Option<TracksEntry>,
    /// Ambient visibility, 0 is occluded: a grey PNG; or, if some texel has two sides, an RGB PNG with the front in
    /// green, the back in blue and, for viewers, the greater of the two in red.
    pub ao: Option<String>,
    /// Bent normals of fronts, world space: RGB PNG of 16 bits, a code q meaning `(q - 32768) / 32767`. They are mean
    /// directions, so their length is at most 1.
    pub bent: Option<String>,
    /// Bent normals of backs, if some texel has two sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bent_back: Option<String>,
    /// Sky visibility in spherical harmonics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sky: Option<SkyMapsEntry>,
    /// Ambient light as OpenEXR of `f32`, if requested. Not needed for playback.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ambient_exr: Option<String>,
    /// Where storing lost minutes on this page, if requested. Not needed for playback.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss_map: Option<LossMapEntry>,
}

/// Shadow tracks of a page ([`crate::tracks`]).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TracksEntry {
    /// Where each texel's spans are: an RGBA PNG of 8 bits, as large as the page. The four are the bytes of one number,
    /// red the lowest: 64 times the index of the first span, plus how many there are, at most 63.
    pub lists: String,
    /// The spans, row after row: an RGB PNG of 16 bits, 2048 wide. Red is the number of the track; green is when its
    /// shade starts and blue when it ends, q / 65535 of the path. A texel's ascend by track.
    pub spans: String,
    /// How many spans there are. Zeros fill the last row.
    pub count: u32,
}

/// Sky visibility: with sky radiance `L = sum of L_i Y_i`, a diffuse surface reflects `albedo * sum of L_i T_i`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SkyMapsEntry {
    /// `sh2`: real spherical harmonics up to degree two, in the order (0, 0), (1, -1), (1, 0), (1, 1), (2, -2) to (2,
    /// 2), orthonormal, of directions in world space: Y(1, -1) is proportional to y, Y(1, 0) to z, Y(1, 1) to x.
    pub basis: String,
    /// Coefficients T of fronts, three a file: RGB PNGs of 16 bits, a code q meaning `(q - 32768) / 32767`.
    pub front: [String; 3],
    /// The same of backs, if some texel has two sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back: Option<[String; 3]>,
}

/// Settings and results of baking ambient light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AmbientEntry {
    /// Rays per texel and side; with `error`, the largest number of them.
    pub rays: u32,
    /// The error of ambient visibility (0 to 1) that texels were estimated to, with 95 % confidence; null: all texels
    /// have the same number of rays.
    pub error: Option<f64>,
    /// Distance beyond which surfaces do not occlude; at distance d they occlude by `(1 - (d / distance_m)^2)^2`. Null:
    /// no limit.
    pub distance_m: Option<f64>,
    /// Sample points per texel along each axis.
    pub supersample: u32,
    /// 8 or 16: bits of the occlusion textures.
    pub bits: u32,
    /// Rays traced in all.
    pub rays_traced: u64,
    /// Texels inside a solid. Those beside a visible texel have its value, the others 0.
    pub buried_texels: u64,
    /// Sides of texels whose error may exceed `error`, because the number of rays was not enough: those that the code
    /// calls unconverged.
    #[serde(default)]
    pub unsettled_texels: u64,
    /// Differences between the two sides of chart borders.
    pub seams: SeamEntry,
    /// The scene with ambient visibility at its vertices, if requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<VertexEntry>,
}

/// Differences of filtered ambient visibility (0 to 1) between the two sides of chart borders of one surface, at points
/// half a texel apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SeamEntry {
    /// Number of points.
    pub points: u64,
    /// Points whose sides differ by more than 0.25: assumed to be real differences, left unchanged, and excluded below.
    pub differing: u64,
    /// Mean difference before texels at chart borders were adjusted.
    pub mean_before: f64,
    /// Mean difference as written.
    pub mean: f64,
    /// 99th percentile of the difference; of several pages, the largest.
    pub p99: f64,
    /// Largest difference.
    pub worst: f64,
}

/// A scene with ambient visibility at its vertices. Not needed for playback.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VertexEntry {
    /// File name.
    pub file: String,
    /// `COLOR_0` or `_AO`.
    pub attribute: String,
}

/// Minutes lost by storing, for each texel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LossMapEntry {
    /// PNG: total minutes lost, from black over violet, red and orange to pale yellow; transparent without a surface.
    pub picture: String,
    /// OpenEXR of two `f32` channels, in minutes: `layers`, lost for lack of slots, and `bits`, lost by rounding.
    pub numbers: String,
    /// Colour scale: `sqrt`, so that a quarter of `scale_max_min` has the middle colour.
    pub scale: String,
    /// Minutes of the brightest colour.
    pub scale_max_min: f64,
}

/// A lane across the sun's disc. Its times follow the path with the offset added to every arc's declination, and its
/// window is `sqrt(1 - (offset / angular radius)^2)` of the sun's width.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LaneEntry {
    /// The lane's declination less the centre's.
    pub offset_deg: f64,
    /// Share of the disc's area, 0 to 1; a page's weights add up to 1.
    pub weight: f64,
    /// Texture pairs: channel c of layer l holds interval 4 l + c.
    pub layers: Vec<LayerEntry>,
}

/// A lamp's times on a page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LampMapsEntry {
    /// Texture pairs: channel c of layer l holds interval 4 l + c.
    pub layers: Vec<LayerEntry>,
}

/// A pair of RGBA textures. A code q of b bits means t = q / (2^b - 1); an unused slot has rise = max and fall = 0.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LayerEntry {
    /// Interval starts.
    pub rise: String,
    /// Interval ends.
    pub fall: String,
}

/// Placement of a drawn primitive's texels: `page_uv = uv * uv_scale + uv_offset`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InstanceEntry {
    /// Index of the node in `scene.glb`.
    pub node: usize,
    /// Index of the primitive within the node's mesh.
    pub primitive: usize,
    /// Index in `atlases`; null for what is not baked: what takes no shadows (`receives` is false then) is drawn in
    /// full light, everything else was left out.
    pub atlas: Option<u32>,
    /// Whether it hides light. Absent where it does.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub casts: bool,
    /// Whether others shade it. Absent where they do.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub receives: bool,
    /// Which `TEXCOORD_n` of `scene.glb` holds `uv`. In a set with ambient occlusion these are page coordinates
    /// already, for viewers: the scale is 1 and the offset 0.
    pub uv_set: u32,
    /// In page coordinates, v from the top.
    pub uv_scale: [f32; 2],
    /// In page coordinates, v from the top.
    pub uv_offset: [f32; 2],
    /// Whether the times are for both sides. If so, a face is lit only while the sun is in front of it.
    pub double_sided: bool,
}

fn yes() -> bool {
    true
}

fn is_true(value: &bool) -> bool {
    *value
}

/// Name of the effect that players have to know of: light ends on smooth surfaces where their shading normals say.
pub const SMOOTH_TERMINATOR: &str = "smooth-terminator";

/// One effect: on or off, and why. Cost and toggle are text for people; older sets lack them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct EffectEntry {
    /// The effect's name.
    pub effect: String,
    /// Whether it was baked.
    pub on: bool,
    /// The reason why it is on or off.
    pub why: String,
    /// What the effect costs, or would cost if it were on.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub cost: String,
    /// The flag, or the property of the scene, that would switch it on or off.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[serde(alias = "turned_over_by")]
    pub toggled_by: String,
}

/// Counts, times and sizes of a bake.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// Triangles over all instances.
    pub triangles: u64,
    /// Triangles of the file that were left out: repeated index, no area, not finite.
    pub dropped_triangles: u64,
    /// Covered texels: those with a surface point.
    pub texels: u64,
    /// Texels of all pages, covered or not.
    pub page_texels: u64,
    /// Charts of the atlas.
    pub charts: u64,
    /// Lit intervals found, over all lanes.
    pub intervals: u64,
    /// Texels that never see the sun, along any lane.
    #[serde(default)]
    pub dark_texels: u64,
    /// Buried texels that show the times that their visible neighbours agree on.
    #[serde(default)]
    pub filled_texels: u64,
    /// Most lit intervals of any texel along one lane.
    pub most_intervals: u64,
    /// What came of the search for shadow tracks, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tracks: Option<TrackStats>,
    /// Engine and its parameters, as given on the command line.
    pub engine: String,
    /// Rays traced for times; 0 for the exact engine.
    pub rays: u64,
    /// Hierarchy nodes that the exact engine visited: sixteen boxes, or the corners of sixteen triangles, each.
    #[serde(default)]
    pub node_tests: u64,
    /// Triangles that the exact engine solved.
    #[serde(default)]
    pub triangle_tests: u64,
    /// Bytes of all files of the set except the manifest.
    pub bytes: u64,
    /// Threads used.
    pub threads: usize,
    /// Wall-clock seconds of each step.
    pub seconds: StepSeconds,
}

/// What came of the search for shadow tracks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackStats {
    /// Texels that have tracks: shade moves at them or beside them.
    pub texels: u64,
    /// Texels that have more spans than can be stored, and so merged shade.
    pub crowded_texels: u64,
    /// Spans that are stored, those of merged shade among them.
    pub spans: u64,
    /// Bytes on a GPU.
    pub gpu_bytes: u64,
    /// Seconds of the search; also among those of lit intervals.
    pub seconds: f64,
}

/// Wall-clock seconds of each step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSeconds {
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

/// Loss by storing, over covered texels, in minutes of the path. With several lanes, a texel's loss is their weighted
/// mean.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEntry {
    /// Loss by rounding times to codes.
    pub quantisation_min: LossEntry,
    /// Loss by having fewer slots than intervals.
    pub merge_min: LossEntry,
    /// Texels that lost intervals for lack of slots.
    pub merged_texels: u64,
}

/// Distribution of a loss over covered texels, in minutes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LossEntry {
    /// Mean.
    pub mean: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Largest loss of a texel.
    pub worst: f64,
    /// The texel with the largest loss: atlas page, x, y. Null if nothing was lost.
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
