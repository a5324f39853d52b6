//! The station itself. Its frame: metres, +Z towards the main road (the front), the lot at y = 0.

mod canopy;
mod interior;
mod pump;
mod roof;
mod shop;

use glam::{DVec3, dvec3};

use crate::scene::Scene;

/// Adds the shop with all that is in it and on it, the canopy and the pumps.
pub(crate) fn add(scene: &mut Scene) {
    add_shop(scene);
    add_interior(scene);
    add_roof(scene);
    add_forecourt(scene);
}

fn add_shop(scene: &mut Scene) {
    let shell = scene.closed("shop", &shop::shell());
    scene.place("shop", shell, DVec3::ZERO);
    let joinery = scene.closed("shop joinery", &shop::joinery());
    scene.place("window frames and doors", joinery, DVec3::ZERO);
    let awning = scene.closed("awning", &shop::awning());
    scene.place_turned("awning west", awning, dvec3(0.0, 2.42, -7.35), -90.0);
    scene.place_turned("awning east", awning, dvec3(12.0, 2.42, -5.45), 90.0);
    let ladder = scene.closed("ladder", &shop::ladder());
    scene.place_turned("ladder", ladder, dvec3(0.0, 0.0, -4.35), -90.0);
}

fn add_interior(scene: &mut Scene) {
    let counter = scene.closed("counter", &interior::counter());
    scene.place("counter", counter, dvec3(0.0, 0.0, 0.0));
    let shelf = scene.closed("shelf", &interior::shelf());
    scene.place("shelf 1", shelf, dvec3(2.3, 0.1, -6.3));
    scene.place_scaled("shelf 2", shelf, dvec3(4.4, 0.1, -6.3), 0.0, dvec3(-1.0, 1.0, 1.0));
    scene.place_turned("shelf 3", shelf, dvec3(3.3, 0.1, -9.42), 90.0);
    let fridge = scene.closed("fridge", &interior::fridge());
    scene.place_turned("fridge", fridge, dvec3(0.62, 0.1, -8.9), 90.0);
    let fan = scene.closed("ceiling fan", &interior::fan());
    scene.place_turned("ceiling fan", fan, dvec3(4.15, 3.45, -6.9), 17.0);
    let stool = scene.closed("stool", &interior::stool());
    for (k, x_m) in [6.75, 7.5, 8.25].into_iter().enumerate() {
        scene.place(&format!("stool {}", k + 1), stool, dvec3(x_m, 0.1, -5.35));
    }
}

fn add_roof(scene: &mut Scene) {
    let cooler = scene.closed("air conditioner", &roof::air_conditioner());
    scene.place_turned("air conditioner", cooler, dvec3(8.7, 3.38, -6.6), 4.0);
    scene.place_turned("air conditioner small", cooler, dvec3(10.6, 3.38, -8.4), 94.0);
    let aerial = scene.closed("aerial", &roof::aerial());
    scene.place_turned("aerial", aerial, dvec3(1.3, 3.3, -9.2), 35.0);
    let vent = scene.closed("vent", &roof::vent());
    scene.place("vent 1", vent, dvec3(6.6, 3.3, -8.6));
    scene.place_scaled("vent 2", vent, dvec3(2.2, 3.3, -5.0), 40.0, dvec3(0.8, 0.75, 0.8));
    let mast = scene.closed("service mast", &roof::service_mast());
    scene.place("service mast", mast, dvec3(11.3, 3.3, -4.2));
}

fn add_forecourt(scene: &mut Scene) {
    let canopy = scene.closed("canopy", &canopy::canopy());
    scene.place("canopy", canopy, DVec3::ZERO);
    let post = scene.closed("canopy post", &canopy::post());
    for (k, (x_m, z_m)) in [(-1.5, 1.7), (-1.5, 7.3), (7.9, 1.7), (7.9, 7.3)].into_iter().enumerate() {
        scene.place(&format!("canopy post {}", k + 1), post, dvec3(x_m, -0.1, z_m));
    }
    let name = scene.closed("standing letters", &canopy::standing_name());
    scene.place("standing letters", name, dvec3(3.2, 4.83, 8.05));
    let island = scene.closed("pump island", &pump::island());
    let pump = scene.closed("pump", &pump::pump());
    for (k, x_m) in [0.5, 5.9].into_iter().enumerate() {
        scene.place(&format!("pump island {}", k + 1), island, dvec3(x_m, -0.1, 4.6));
        scene.place(&format!("pump {}", 2 * k + 1), pump, dvec3(x_m - 0.95, 0.14, 4.6));
        let mirror = dvec3(-1.0, 1.0, 1.0);
        scene.place_scaled(&format!("pump {}", 2 * k + 2), pump, dvec3(x_m + 0.95, 0.14, 4.6), 0.0, mirror);
    }
    let ice = scene.closed("ice box", &pump::ice_box());
    scene.place("ice box", ice, dvec3(9.2, -0.02, -2.6));
}
