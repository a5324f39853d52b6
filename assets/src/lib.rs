//! The sample scene of sunbake, made by code: a desert gas station at a crossroads.
//!
//! Shapes pour triangles into a [`soup`], [`weld`] indexes them, [`scene`] places them and [`glb`] writes the file.
//! Nothing depends on the platform: noise comes from integer hashes, sines from [`trig`], and positions are rounded to
//! a tenth of a millimetre. Metres, right-handed, +Y up, north is -Z and east is +X.

#![forbid(unsafe_code)]

mod glb;
mod ground;
mod letters;
mod material;
mod noise;
mod props;
mod round;
mod scene;
mod shapes;
mod solid;
mod soup;
mod station;
mod textures;
mod trig;
mod weld;

#[cfg(test)]
mod tests;

use glam::{DVec3, dvec3};
use scene::Scene;

/// How far the crossroads and the station are turned in the world, in degrees: the front faces the south-south-east.
const TURN_DEG: f64 = 22.0;

/// The gas station as the bytes of a GLB file.
pub fn gas_station() -> Vec<u8> {
    glb::write(&gas_station_scene())
}

fn gas_station_scene() -> Scene {
    let mut scene = Scene { turn_deg: TURN_DEG, ..Scene::default() };
    let ground = scene.open("ground", &ground::ground());
    scene.place("ground", ground, DVec3::ZERO);
    station::add(&mut scene);
    props::add(&mut scene);
    scene.camera("hero", dvec3(-20.0, 3.9, 24.0), dvec3(0.4, 3.85, 0.0), 42.0);
    scene.camera("fence", dvec3(-9.7, 1.35, -11.6), dvec3(-12.9, 0.5, -7.6), 50.0);
    scene.camera("overview", dvec3(-34.0, 24.0, 42.0), dvec3(1.0, 0.0, 1.0), 42.0);
    scene
}
