//! Shadow maps compared with truth: at several times of day, through cameras around the scene, two of them in shadow.

use super::masks::{camera_in_shadow, cameras_around, mask};
use crate::View;
use crate::compare::Defects;
use crate::gpu::{Gpu, GpuError};
use crate::image::Raster;
use crate::light::Moment;
use crate::shadow_maps::{MapSettings, reach_m};
use crate::shot::Shot;
use crate::stage::Stage;
use crate::technique::{LightKind, ShadowMaps, Technique, Truth};
use glam::DVec3;
use sunbake::trace::Hit;

/// Rays of soft truth.
const SOFT_RAYS: u32 = 64;

/// A shot, with hard and soft truth of the sun.
pub struct ReferenceShot<'a> {
    /// The shot.
    pub shot: Shot<'a>,
    /// Visibility of the sun's centre, 0 or 1.
    pub hard: Raster<f32>,
    /// Visibility of the sun's disc, 0 to 1.
    pub soft: Raster<f32>,
}

/// Moments of a day, each seen by several cameras.
pub struct ReferenceDay<'a> {
    /// The stage that is looked at.
    pub stage: &'a Stage,
    /// Moments, with the shots of each.
    pub all: Vec<(Moment, Vec<ReferenceShot<'a>>)>,
}

impl<'a> ReferenceDay<'a> {
    /// A stage at `times` through six cameras, two of them in shadow; pictures of `edge_px` squared.
    pub fn new(stage: &'a Stage, edge_px: u32, times: impl Iterator<Item = f64>) -> Self {
        let seen = |t: f64| {
            let moment = Moment::new(stage.path.as_ref(), t);
            let towards = moment.sun_direction.as_dvec3();
            let inside = [1, 2].into_iter().filter_map(|pick| camera_in_shadow(stage, towards, pick));
            let view = |camera| View::new(&camera, [edge_px; 2], &stage.scene);
            let views = cameras_around(stage).into_iter().chain(inside).map(view);
            (moment, views.map(|view| ReferenceShot::new(stage, view, &moment)).collect())
        };
        Self { stage, all: times.map(seen).collect() }
    }
}

impl<'a> ReferenceShot<'a> {
    /// A view of a stage at a moment.
    pub fn new(stage: &'a Stage, view: View, moment: &Moment) -> Self {
        let shot = Shot::new(stage, view);
        let hard = mask(&mut Truth::Hard, &shot, moment, LightKind::Sun);
        let soft = mask(&mut Truth::Soft { rays: SOFT_RAYS }, &shot, moment, LightKind::Sun);
        Self { shot, hard, soft }
    }

    /// Errors and defects of shadow maps in it.
    pub fn defects(&self, maps: &mut ShadowMaps, moment: &Moment) -> Result<Defects, GpuError> {
        let drawn = maps.visibility(&self.shot, moment)?;
        let depths_m = maps.renderer().depths_m(&self.shot.view)?;
        let settings = *maps.settings();
        let variant = settings.variant;
        let truth = if variant.is_soft() { &self.soft } else { &self.hard };
        let held = maps.renderer().maps().to_vec();
        let reach = |point_m| reach_m(&settings, &held, point_m);
        Ok(Defects::new(&self.shot, moment, variant.is_soft(), [&drawn, truth], &depths_m, reach))
    }
}

/// Errors and defects of a whole day. `says_where` prints which pictures have acne or leaks.
pub fn defects_of(gpu: &Gpu, day: &ReferenceDay, settings: MapSettings, says_where: bool) -> Result<Defects, GpuError> {
    let mut maps = ShadowMaps::new(gpu, day.stage, settings)?;
    let mut all = Defects::default();
    for (moment, seen) in &day.all {
        for (camera, seen) in seen.iter().enumerate() {
            let found = seen.defects(&mut maps, moment)?;
            if says_where && found.acne.len() + found.leaks.len() > 0 {
                println!(
                    "{} {} t {:.3} camera {camera}: acne {} leaks {}",
                    settings.variant,
                    settings.size_texels,
                    moment.t,
                    found.acne.len(),
                    found.leaks.len()
                );
            }
            all.add(&found);
        }
    }
    Ok(all)
}

/// The points that a shot's pixels show, in world space. Pixels without a surface are left out.
pub fn surface_points(shot: &Shot) -> Vec<(usize, DVec3)> {
    let geometry = &shot.stage.geometry;
    let point = |hit: &Hit| geometry.point(hit.triangle as usize, hit.barycentric) + shot.stage.scene.centre_m;
    shot.hits().iter().enumerate().filter_map(|(i, hit)| Some((i, point(hit.as_ref()?)))).collect()
}
