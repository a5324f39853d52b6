//! What a bake writes into its manifest.

use super::Prepared;
use crate::atlas::Atlas;
use crate::disk::manifest::{self, ArcEntry, InstanceEntry, Manifest, PathEntry, Stats};
use crate::disk::write::SCENE_FILE;
use crate::scene::{Alpha, Scene};
use crate::settings::BakeSettings;
use crate::sun::{self, SunPath};

/// What the manifest says of the request; the rest is left empty.
pub(super) fn manifest_of(prepared: &Prepared, atlas: &Atlas, settings: &BakeSettings) -> Manifest {
    let Prepared { scene, path, plan, .. } = prepared;
    Manifest {
        format: manifest::FORMAT.into(),
        version: manifest::VERSION,
        generator: concat!("sunbake ", env!("CARGO_PKG_VERSION")).into(),
        source: manifest::SourceEntry { file: scene.source.file_name.clone(), sha256: scene.source.sha256.clone() },
        scene: manifest::SceneEntry {
            file: SCENE_FILE.into(),
            centre_m: scene.centre_m.to_array(),
            texels_per_metre: atlas.texels_per_metre,
        },
        path: path.as_ref().map(path_entry),
        bits: settings.bits.count(),
        atlases: Vec::new(),
        instances: Vec::new(),
        effects: plan.entries(),
        stats: Stats::default(),
        error: manifest::ErrorEntry::default(),
    }
}

fn path_entry(path: &SunPath) -> PathEntry {
    let day = path.day.as_ref();
    let both = |text: &dyn Fn(f64) -> Option<String>| Some([text(0.0)?, text(1.0)?]);
    PathEntry {
        place: day.map(|d| manifest::Place { latitude_deg: d.latitude_deg, longitude_deg: d.longitude_deg }),
        date: day.map(|d| d.date.clone()),
        utc_offset_h: day.map(|d| d.utc_offset_h),
        north_deg: day.map(|d| d.north_deg),
        local: both(&|t| path.local_text(t)),
        utc: both(&|t| path.utc_text(t).map(|text| text + "Z")),
        start_min: day.map(|d| d.start_min),
        duration_min: path.duration_min,
        angular_radius_deg: path.angular_radius_rad.to_degrees(),
        ephemeris_error_deg: day.map(|d| d.ephemeris_error_deg),
        arcs: path.arcs().iter().map(arc_entry).collect(),
    }
}

fn arc_entry(arc: &sun::SunArc) -> ArcEntry {
    ArcEntry {
        axis: arc.axis.to_array(),
        zero: arc.zero.to_array(),
        declination_deg: arc.declination_rad.to_degrees(),
        hour_angle_deg: arc.hour_angle_rad.map(f64::to_degrees),
        t: arc.t,
    }
}

pub(super) fn instance_entries(scene: &Scene, atlas: &Atlas, written: &[(usize, usize)]) -> Vec<InstanceEntry> {
    let entry = |(index, &(node, primitive)): (usize, &(usize, usize))| {
        let placement = &atlas.placements[index];
        let material = scene.material(index);
        InstanceEntry {
            node,
            primitive,
            atlas: (material.alpha != Alpha::Air).then_some(placement.page),
            uv_set: 1,
            uv_scale: placement.scale.to_array(),
            uv_offset: placement.offset.to_array(),
            double_sided: material.is_double_sided,
        }
    };
    written.iter().enumerate().map(entry).collect()
}

/// Most layers that may be asked for.
const MOST_LAYERS: u64 = 16;

/// Advice where slots ran out, in words that know the flag already given.
pub(super) fn loss_warning(manifest: &Manifest, settings: &BakeSettings) -> Option<String> {
    let merge = &manifest.error.merge_min;
    let needed = manifest.stats.most_intervals.div_ceil(4);
    let advice = match needed {
        ..=MOST_LAYERS => format!("--layers {needed} keeps them all"),
        _ if settings.layer_cap as u64 >= MOST_LAYERS => "that is as many as there are".into(),
        _ => format!("--layers {MOST_LAYERS} keeps more of them"),
    };
    (manifest.error.merged_texels > 0).then(|| {
        format!(
            "{} texels have more intervals than --layers {} holds: the worst is wrong for {:.1} minutes of the day; {advice}",
            manifest.error.merged_texels, settings.layer_cap, merge.worst
        )
    })
}
