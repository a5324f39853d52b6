//! A colour map: from black over violet, red and orange to pale yellow. Brightness grows all the way, so that a map can
//! also be read in grey.

use glam::Vec3;

/// sRGB stops at even steps.
const STOPS: [[f32; 3]; 6] = [
    [16.0, 14.0, 22.0],
    [72.0, 24.0, 102.0],
    [158.0, 40.0, 100.0],
    [226.0, 88.0, 50.0],
    [250.0, 170.0, 52.0],
    [252.0, 250.0, 190.0],
];

/// The sRGB colour of a number from 0 to 1; others are clamped.
pub fn heat(share: f32) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f32;
    let low = (place as usize).min(STOPS.len() - 2);
    let color = Vec3::from_array(STOPS[low]).lerp(Vec3::from_array(STOPS[low + 1]), place - low as f32);
    color.to_array().map(|c| c.round() as u8)
}
