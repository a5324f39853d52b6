//! What a set shows at points of surfaces, evaluated as a runtime does: by each filter of its stored times, and no more
//! than the share of the disc that is above the surface's plane. The runtime's `playback.rs` is the twin.

use super::error::CostError;
use super::metric;
use super::truth::{GroundTruth, SurfaceSample};
use crate::atlas::{Atlas, Footprint};
use crate::disk::read::BakedSet;
use crate::maps::{Bits, LaneMaps, PageMaps, decode_share, edge_sample, sharpened, soft_visibility};
use crate::scene::{Geometry, LoadLimits, Scene};
use crate::sun::SunPath;
use crate::tracks::tracked_visibility;
use rayon::prelude::*;

/// Largest distance of a triangle from where it was, as a share of the scene's half size.
const MOST_MOVED: f64 = 1e-4;

/// How stored times are filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Filter {
    /// The nearest texel is evaluated.
    Nearest,
    /// Four texels are evaluated, and blended.
    Bilinear,
    /// Distances in time from edges are blended, and evaluated.
    Sharp,
    /// Times are blended occluder by occluder, and evaluated.
    Tracks,
}

impl Filter {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Nearest, Self::Bilinear, Self::Sharp, Self::Tracks];
}

/// Errors of a set at each point.
pub(super) struct PlaybackErrors {
    /// Of the sun, as path time, by each filter that the set allows.
    pub sun_t: Vec<(Filter, Vec<f64>)>,
    /// Of ambient visibility; none where the set has none.
    pub ambient: Option<Vec<f64>>,
}

/// Compares a set with the truth; `of` is the scene that the points lie on.
pub(super) fn errors(set: &BakedSet, truth: &GroundTruth, of: &Scene) -> Result<PlaybackErrors, CostError> {
    let scene = set.scene(&LoadLimits::default())?;
    let geometry = Geometry::new(&scene);
    let atlas = set.manifest.atlas(&scene);
    check(truth, of, &scene, &geometry)?;
    let blend_at = |place| {
        let (page, footprint) = blend(place, &scene, &geometry, &atlas);
        let walls = set.pages[page].walls.as_ref();
        (page, walls.map_or(footprint, |codes| footprint.beside_walls(codes)))
    };
    let blends: Vec<(usize, Footprint)> = truth.points.iter().map(blend_at).collect();
    let shown = PlayedMaps { pages: &set.pages, bits: set.bits, path: set.path.as_ref() };
    Ok(shown.errors(truth, &blends))
}

/// Maps as playback evaluates them.
pub(super) struct PlayedMaps<'a> {
    pub pages: &'a [PageMaps],
    pub bits: Bits,
    /// The sun's path, if there is a sun.
    pub path: Option<&'a SunPath>,
}

impl PlayedMaps<'_> {
    /// Errors at points; of each point, its page and the texels that it reads.
    pub fn errors(&self, truth: &GroundTruth, blends: &[(usize, Footprint)]) -> PlaybackErrors {
        let read_points = || truth.points.par_iter().zip(blends);
        let sun_errors = |filter: Filter| {
            let sun_t = read_points().zip(&truth.sun).map(|((place, (page, blend)), true_sun)| {
                let shown = self.path.map(|path| self.sun(&self.pages[*page], path, place, blend, filter));
                metric::mean_difference_t(&shown.unwrap_or_else(|| vec![0.0; true_sun.len()]), true_sun)
            });
            (filter, sun_t.collect())
        };
        let has_tracks = self.pages.iter().any(|page| page.tracks.is_some());
        let filters = Filter::ALL.into_iter().filter(|filter| *filter != Filter::Tracks || has_tracks);
        let sun_t = filters.map(sun_errors).collect();
        let ambient = read_points().zip(&truth.ambient).map(|((place, (page, blend)), true_ambient)| {
            Some(f64::from((played_ambient(&self.pages[*page], place, blend)? - true_ambient).abs()))
        });
        PlaybackErrors { sun_t, ambient: ambient.collect() }
    }

    /// Visible share of the disc at the point's moments.
    fn sun(
        &self,
        page: &PageMaps,
        path: &SunPath,
        place: &SurfaceSample,
        blend: &Footprint,
        filter: Filter,
    ) -> Vec<f32> {
        let inverse_angular_diameter = 0.5 / path.angular_radius_rad.max(1e-9);
        let geometric_normal = place.geometric_normal();
        let chords: Vec<f32> = page.lanes.iter().map(|lane| lane.lane.chord(path.angular_radius_rad) as f32).collect();
        let at = |t: f64| {
            let share =
                (0.5 + geometric_normal.dot(path.direction(t)) * inverse_angular_diameter).clamp(0.0, 1.0) as f32;
            if share <= 0.0 {
                return 0.0;
            }
            let (t, width_t) = (t as f32, path.width_t(t) as f32);
            let of_lanes = |of_lane: &dyn Fn(&LaneMaps, f32) -> f32| -> f32 {
                let lanes = page.lanes.iter().zip(&chords);
                lanes.map(|(lane, chord)| lane.lane.weight as f32 * of_lane(lane, width_t * chord)).sum()
            };
            let of_texel =
                |texel| of_lanes(&|lane, width_t| soft_visibility(&lane.layers, texel, self.bits, t, width_t));
            let seen = match (filter, &page.tracks) {
                (Filter::Nearest, _) => of_texel(blend.nearest()),
                (Filter::Bilinear, _) => blend.blend(of_texel),
                (Filter::Tracks, Some(tracks)) => tracked_visibility(tracks, blend, t, width_t),
                (Filter::Sharp | Filter::Tracks, _) => of_lanes(&|lane, width_t| {
                    sharpened(blend.blend(|texel| edge_sample(&lane.layers, texel, self.bits, t, width_t)))
                }),
            };
            share.min(seen)
        };
        metric::moments(place.start).map(at).collect()
    }
}

/// Refuses a set whose scene has its triangles elsewhere than the scene of the points.
fn check(truth: &GroundTruth, of: &Scene, scene: &Scene, geometry: &Geometry) -> Result<(), CostError> {
    let most_m = MOST_MOVED * of.half_extent_m.length();
    for place in &truth.points {
        let triangle = place.surface.triangle;
        let is_there = (triangle as usize) < geometry.triangles.len();
        let apart_m = if is_there {
            let found = geometry.point(triangle as usize, place.barycentric) + scene.centre_m;
            found.distance(place.surface.position_m + of.centre_m)
        } else {
            f64::INFINITY
        };
        if apart_m.is_nan() || apart_m > most_m {
            return Err(CostError::Moved { triangle, apart_m });
        }
    }
    Ok(())
}

/// The page of a point, and the texels around it with their weights.
pub(super) fn blend(place: &SurfaceSample, scene: &Scene, geometry: &Geometry, atlas: &Atlas) -> (usize, Footprint) {
    let surface = geometry.surface(place.surface.triangle as usize);
    let page = atlas.placements[surface.instance].page as usize;
    let size = atlas.pages[page];
    let layout = &atlas.layouts[scene.instances[surface.instance].mesh];
    let corner = |k: usize| {
        let vertex = layout.indices[3 * surface.mesh_triangle + k] as usize;
        atlas.texel(surface.instance, layout.uvs[vertex], size)
    };
    let [u, v] = place.barycentric;
    let at = corner(0) * (1.0 - u - v) + corner(1) * u + corner(2) * v;
    (page, Footprint::new(at - 0.5, size))
}

/// Ambient visibility that the set shows at a point.
fn played_ambient(page: &PageMaps, place: &SurfaceSample, blend: &Footprint) -> Option<f32> {
    let ambient = page.ambient.as_ref()?;
    let side = ambient.back.as_ref().filter(|_| place.is_back).unwrap_or(&ambient.front);
    Some(blend.blend(|texel| decode_share(side.visibility[texel])))
}
