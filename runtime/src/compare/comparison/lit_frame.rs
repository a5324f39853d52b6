//! Lit pictures of a frame, put together from two: light is linear in visibility, so any technique's picture lies
//! between the scene with the sun hidden and the scene with the sun seen everywhere.

use super::frame_indices;
use crate::camera::View;
use crate::image::Raster;
use crate::light::Moment;
use crate::shade::lit_picture;
use crate::shot::Shot;
use crate::stage::Stage;
use glam::Vec3;

/// A frame's light with the sun hidden and with the sun seen everywhere.
pub struct LitFrame {
    /// Index in [`super::Comparison::views`].
    pub camera: usize,
    /// Index in [`super::Comparison::times`].
    pub time: usize,
    /// Linear light where no surface sees the sun.
    pub without_sun: Raster<Vec3>,
    /// Linear light where every surface that faces the sun sees it.
    pub full_sun: Raster<Vec3>,
    /// Visibility of the sun by the reference, 0 to 1.
    pub reference: Raster<f32>,
}

/// All frames, with an empty reference.
pub(super) fn lit_frames(stage: &Stage, views: &[View], times: &[f64]) -> Vec<LitFrame> {
    let shots: Vec<Shot> = views.iter().map(|view| Shot::new(stage, *view)).collect();
    let frame = |(camera, time): (usize, usize)| {
        let shot = &shots[camera];
        let moment = Moment::new(stage.path.as_ref(), times[time]);
        let [without_sun, full_sun] =
            [0.0, 1.0].map(|seen| lit_picture(shot, &moment, &Raster::filled(shot.view.size, seen), None));
        LitFrame { camera, time, without_sun, full_sun, reference: Raster { size: [0, 0], pixels: Vec::new() } }
    };
    frame_indices(views.len(), times.len()).map(frame).collect()
}

/// A frame's linear light, given the visibility of the sun, 0 to 1. NaN is shown as full sun.
pub fn lit_picture_of(frame: &LitFrame, visibility: &Raster<f32>) -> Raster<Vec3> {
    let pixels = frame.without_sun.pixels.iter().zip(&frame.full_sun.pixels).zip(&visibility.pixels);
    let light =
        |((dark, bright), &seen): ((&Vec3, &Vec3), &f32)| dark.lerp(*bright, if seen.is_nan() { 1.0 } else { seen });
    Raster { size: frame.without_sun.size, pixels: pixels.map(light).collect() }
}

/// Visibility as codes from 0 to 255. NaN becomes 0.
pub fn visibility_codes(visibility: &Raster<f32>) -> Raster<u8> {
    let code = |&seen: &f32| (seen.clamp(0.0, 1.0) * 255.0).round() as u8;
    Raster { size: visibility.size, pixels: visibility.pixels.iter().map(code).collect() }
}
