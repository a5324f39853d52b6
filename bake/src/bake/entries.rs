//! What a bake writes into its manifest.

use super::prepare::Prepared;
use crate::atlas::Atlas;
use crate::disk::manifest::{self, ArcEntry, ErrorEntry, InstanceEntry, LampEntry, Manifest, PathEntry, Stats};
use crate::disk::write::SCENE_FILE;
use crate::glb::{WrittenPlace, WrittenScene};
use crate::lamp::{LampKey, LampPath};
use crate::scene::Scene;
use crate::settings::BakeSettings;
use crate::sun::{self, SunPath};
use crate::warning::{Light, Warning};

/// What the manifest says of the request; the rest is left empty.
pub(super) fn manifest_of(prepared: &Prepared, atlas: &Atlas, settings: &BakeSettings) -> Manifest {
    let Prepared { scene, path, lamp, plan, .. } = prepared;
    Manifest {
        format: manifest::FORMAT.into(),
        version: manifest::VERSION,
        generator: concat!("sunbake ", env!("CARGO_PKG_VERSION")).into(),
        source: manifest::SourceEntry { file: scene.source.file_name.clone(), sha256: scene.source.sha256.clone() },
        scene: manifest::SceneEntry {
            file: SCENE_FILE.into(),
            centre_m: scene.centre_m.to_array(),
            texels_per_metre: atlas.texels_per_metre,
            sha256: None,
        },
        path: path.as_ref().map(path_entry),
        lamp: lamp.as_ref().map(lamp_entry),
        ambient: None,
        bits: settings.bits.count(),
        atlases: Vec::new(),
        instances: Vec::new(),
        effects: plan.entries(),
        stats: Stats::default(),
        error: ErrorEntry::default(),
    }
}

fn path_entry(path: &SunPath) -> PathEntry {
    let day = path.day.as_ref();
    let both = |text: &dyn Fn(f64) -> Option<String>| Some([text(0.0)?, text(1.0)?]);
    PathEntry {
        place: day.map(|d| manifest::GeoLocation { latitude_deg: d.latitude_deg, longitude_deg: d.longitude_deg }),
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

/// The path; what baking it took and lost is left empty.
fn lamp_entry(lamp: &LampPath) -> LampEntry {
    let key = |key: &LampKey| manifest::LampKeyEntry { t: key.t, position: key.position_m.to_array() };
    LampEntry {
        keys: lamp.keys().iter().map(key).collect(),
        radius_m: lamp.radius_m(),
        duration_min: lamp.duration_min(),
        stats: manifest::LampStats::default(),
        error: ErrorEntry::default(),
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

pub(super) fn instance_entries(scene: &Scene, atlas: &Atlas, written: &WrittenScene) -> Vec<InstanceEntry> {
    let entry = |(index, &WrittenPlace { node, primitive, uv_set }): (usize, &WrittenPlace)| {
        let placement = &atlas.placements[index];
        let role = scene.instances[index].role;
        InstanceEntry {
            node,
            primitive,
            atlas: scene.receives(index).then_some(placement.page),
            casts: role.casts,
            // What is left out is not there, whatever else was asked for it.
            receives: role.receives || !scene.is_there(index),
            uv_set,
            // Coordinates that are the page's own already are not moved again.
            uv_scale: if written.has_page_uvs { [1.0; 2] } else { placement.scale.to_array() },
            uv_offset: if written.has_page_uvs { [0.0; 2] } else { placement.offset.to_array() },
            double_sided: scene.material(index).is_double_sided,
        }
    };
    written.places.iter().enumerate().map(entry).collect()
}

/// Where slots ran out: of the sun, of the lamp.
pub(super) fn loss_warnings(manifest: &Manifest, settings: &BakeSettings) -> Vec<Warning> {
    let warning = |light, error: &ErrorEntry, most_intervals: u64| {
        (error.merged_texels > 0).then(|| Warning::Merged {
            light,
            texels: error.merged_texels,
            layer_cap: settings.layer_cap,
            worst_min: error.merge_min.worst,
            needed_layers: most_intervals.div_ceil(4),
        })
    };
    let sun = warning(Light::Sun, &manifest.error, manifest.stats.most_intervals);
    let lamp = manifest.lamp.as_ref();
    let lamp = lamp.and_then(|lamp| warning(Light::Lamp, &lamp.error, lamp.stats.most_intervals));
    sun.into_iter().chain(lamp).collect()
}
