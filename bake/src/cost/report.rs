//! `report.json` of `sunbake cost`: format version 1, field by field. Other programs read it, so a change here is a
//! change of version. `bake/schemas/cost.schema.json` is the same as a JSON schema.

use crate::report::Machine;
use serde::{Deserialize, Serialize};

/// What `format` says.
pub const FORMAT: &str = "sunbake-cost";
/// What `version` says.
pub const VERSION: u32 = 1;

/// The whole of `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CostReport {
    /// Always `sunbake-cost`.
    pub format: String,
    /// Always 1.
    pub version: u32,
    /// Program and version that measured.
    pub generator: String,
    /// The scene that was measured.
    pub scene: MeasuredScene,
    /// The sun's path.
    pub sun: MeasuredSun,
    /// The machine on which all seconds were measured.
    pub machine: Machine,
    /// Seconds that were allowed.
    pub budget_s: f64,
    /// Seconds that it took.
    pub spent_s: f64,
    /// Share of the cores' time that this process got while it measured with all its threads, 0 to 1; null where the
    /// system does not tell. Where it is well below 1, other processes ran, and seconds are longer than on an idle
    /// machine.
    pub cores_share: Option<f64>,
    /// What errors are measured against.
    pub reference: CostReference,
    /// The measurements, by what was varied.
    pub sweeps: Vec<Sweep>,
    /// Recommendations: one or two sentences each.
    pub advice: Vec<String>,
    /// What a user should know about the scene: one sentence each.
    pub warnings: Vec<String>,
}

/// The scene file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeasuredScene {
    /// File name without its folder.
    pub file: String,
    /// SHA-256 of the file and of what it refers to.
    pub sha256: String,
    /// Triangles of all instances.
    pub triangles: u64,
}

/// The sun's path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MeasuredSun {
    /// Start and end by local clocks, `YYYY-MM-DDTHH:MM:SS`; null unless it is a real day.
    pub local: Option<[String; 2]>,
    /// Minutes from start to end.
    pub duration_min: f64,
    /// Angular radius of the disc.
    pub angular_radius_deg: f64,
}

/// What errors are measured against.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CostReference {
    /// Points that whole bakes are compared at, drawn evenly by area over all surfaces that are baked. Points inside
    /// solids are left out. On double-sided surfaces each point belongs to one side, chosen at random.
    pub points: u64,
    /// Of the points drawn, how many lie inside a solid.
    pub buried_points: u64,
    /// Lanes across the disc of the exact answer that whole bakes are compared with.
    pub lanes: u64,
    /// Moments of the day at which soft visibility is compared, evenly spaced from a start that differs from point to
    /// point.
    pub moments: u64,
    /// Rays of sky for the reference ambient visibility of a point.
    pub point_rays: u64,
    /// Edge of the page whose texels the sweeps sample, in texels.
    pub page_size_texels: u32,
    /// Texels of that page that stand for a point of a surface.
    pub page_texels: u64,
    /// Of these, how many the sweeps measure, in runs of neighbours.
    pub measured_texels: u64,
    /// Rays of sky for the reference ambient visibility of a texel.
    pub texel_rays: u64,
}

/// Measurements in which one thing was varied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Sweep {
    /// Which one: `presets`, `filters`, `sizes`, `disc`, `engines`, `bits`, `layers`, `lanes` or `sky`.
    pub id: String,
    /// Its title.
    pub title: String,
    /// `whole bakes` or `texels`: see the reference.
    pub measured_on: String,
    /// Which error.
    pub meaning: String,
    /// The settings, from cheap to expensive.
    pub rows: Vec<CostRow>,
    /// Name of the row after which more time gains little: the curve's knee, in logarithms of time and error. Null
    /// where too few rows are measured, or the curve has none.
    pub knee: Option<String>,
}

/// A setting with its time, its bytes and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CostRow {
    /// What was set, as on the command line.
    pub name: String,
    /// The sort of setting, where a sweep has several that make a curve each: `rays`, `bisect`, `exact`.
    pub curve: String,
    /// How it was measured, if it was. If not, `note` says why, and there are no numbers but the prediction.
    pub how: How,
    /// Why it was not measured, or a remark.
    pub note: Option<String>,
    /// Seconds that were predicted for the measurement, from runs before; null where none was needed.
    pub predicted_s: Option<f64>,
    /// Seconds: of a whole bake, all its steps; of a sparse bake, a prediction of that; of a setting at texels, the
    /// step that it changes, scaled to all texels of the page.
    pub seconds: Option<f64>,
    /// Bytes of all files of the set; null where none were written.
    pub disk_bytes: Option<u64>,
    /// Bytes on the GPU of what was varied: of a whole bake, all its maps; of `--tracks`, those that it draws.
    pub gpu_bytes: Option<u64>,
    /// Texels that stand for a point of a surface; null for settings at texels.
    pub texels: Option<u64>,
    /// Minutes of sun wrong; null where the setting does not concern the sun.
    pub sun_min: Option<ErrorSummary>,
    /// Error of ambient visibility; null where the setting does not concern it.
    #[serde(rename = "open")]
    pub ambient: Option<ErrorSummary>,
}

impl CostRow {
    /// Whether it has numbers.
    pub fn is_measured(&self) -> bool {
        self.how != How::NotRun
    }

    /// A row without numbers.
    pub(super) fn not_run(name: &str, why: &str) -> Self {
        Self {
            name: name.into(),
            curve: String::new(),
            how: How::NotRun,
            note: Some(why.into()),
            predicted_s: None,
            seconds: None,
            disk_bytes: None,
            gpu_bytes: None,
            texels: None,
            sun_min: None,
            ambient: None,
        }
    }

    /// The error of the sun or, where there is none, of ambient visibility.
    pub(super) fn error(&self) -> Option<&ErrorSummary> {
        self.sun_min.as_ref().or(self.ambient.as_ref())
    }
}

/// How a row was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum How {
    /// Whole bake: a set was baked and read from its files.
    Baked,
    /// Sparse bake: only the texels that the points read were baked. The error is that of the whole bake, the seconds
    /// are predicted.
    Sampled,
    /// The setting was varied on a sample of the page's texels.
    #[serde(rename = "turned")]
    AtTexels,
    /// Not measured.
    NotRun,
}

/// Summary of an error over points or texels, of absolute values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ErrorSummary {
    /// Mean.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// 99th percentile.
    pub p99: f64,
    /// The largest.
    pub worst: f64,
}

impl CostReport {
    /// The measurements in which this was varied.
    pub fn sweep(&self, id: &str) -> Option<&Sweep> {
        self.sweeps.iter().find(|sweep| sweep.id == id)
    }

    /// The report as indented JSON.
    pub fn json(&self) -> String {
        // Numbers, strings and lists: serialising cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

impl Sweep {
    /// The setting of this name, if it was measured.
    pub fn measured(&self, name: &str) -> Option<&CostRow> {
        self.rows.iter().find(|row| row.name == name && row.is_measured())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_committed_schema_is_the_codes() {
        let mut schema = schemars::schema_for!(CostReport);
        schema.insert("title".into(), "report.json of sunbake cost".into());
        let made = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/cost.schema.json");
        if std::env::var_os("BLESS").is_some() {
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(&file, &made).unwrap();
        }
        let committed = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(committed == made, "{} is not what the code makes: run this test with BLESS=1", file.display());
    }
}
