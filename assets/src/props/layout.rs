//! Where the props stand. All places are in the station's frame, in metres.

use glam::{DQuat, DVec3, dvec3};

use super::cactus::{Arm, saguaro};
use super::wires::{Pole, pole, transformer, wires};
use super::{booth, clutter, fence, pergola, sign, tank, tarp, tree};
use crate::ground::height_m;
use crate::material::Material;
use crate::noise::Rng;
use crate::scene::{Content, MeshId, Node, Scene};
use crate::shapes::turn_about;

/// The car's place and how far it is turned, in degrees.
const CAR_M: DVec3 = dvec3(-6.3, 0.0, 3.0);
const CAR_DEG: f64 = -22.0;

/// Adds everything around the station.
pub(crate) fn add(scene: &mut Scene) {
    add_landmarks(scene);
    add_car(scene);
    add_seats(scene);
    add_fences(scene);
    add_poles(scene);
    add_clutter(scene);
    add_tyres(scene);
    add_plants(scene);
    add_desert(scene);
}

fn on_ground(x_m: f64, z_m: f64) -> DVec3 {
    dvec3(x_m, height_m(x_m, z_m), z_m)
}

fn add_landmarks(scene: &mut Scene) {
    let sign = scene.closed("roadside sign", &sign::sign());
    scene.place_turned("roadside sign", sign, on_ground(-12.9, 3.6), -24.0);
    let tank = scene.closed("water tank", &tank::water_tank());
    scene.place_turned("water tank", tank, on_ground(9.4, -14.6), 12.0);
    let tower = scene.closed("wind pump tower", &tank::wind_tower());
    let at_m = on_ground(20.5, -9.0);
    scene.place_turned("wind pump tower", tower, at_m, 20.0);
    let wheel = scene.closed("wind pump wheel", &tank::wind_wheel());
    scene.place_turned("wind pump wheel", wheel, at_m + DVec3::Y * 9.75, -48.0);
    let booth = scene.closed("phone booth", &booth::booth());
    scene.place_turned("phone booth", booth, dvec3(-2.3, 0.0, -1.7), -14.0);
}

fn add_car(scene: &mut Scene) {
    let at_m = CAR_M;
    let degrees = CAR_DEG;
    let cloth = scene.open("tarpaulin", &tarp::tarpaulin());
    scene.place_turned("tarpaulin", cloth, at_m, degrees);
    let underside = scene.closed("car underside", &tarp::underside());
    scene.place_turned("car underside", underside, at_m, degrees);
}

fn add_seats(scene: &mut Scene) {
    let shade = scene.closed("pergola", &pergola::pergola());
    scene.place_turned("pergola", shade, dvec3(-7.2, 0.0, -6.2), 8.0);
    let bench = scene.closed("bench", &pergola::bench());
    scene.place_turned("bench", bench, dvec3(-8.1, 0.0, -7.1), 8.0);
    scene.place_scaled("bench mirrored", bench, dvec3(-6.1, 0.0, -7.35), 8.0, dvec3(-1.0, 1.0, 1.0));
    scene.place_turned("bench by the shop", bench, dvec3(-0.45, 0.0, -6.0), -90.0);
    let table = scene.closed("table", &pergola::table());
    scene.place("table", table, dvec3(-7.2, 0.0, -5.7));
}

fn add_fences(scene: &mut Scene) {
    let panels =
        [501, 502, 503].map(|seed| scene.closed(&format!("picket panel {}", seed - 500), &fence::picket_panel(seed)));
    for k in 0..6_usize {
        let z_m = -13.4 + fence::PANEL_M * k as f64;
        scene.place_turned(&format!("fence west {k}"), panels[k * 2 % 3], on_ground(-13.6, z_m), -90.0);
    }
    for k in 0..6_usize {
        let x_m = -13.6 + fence::PANEL_M * k as f64;
        scene.place(&format!("fence north {k}"), panels[(k * 2 + 1) % 3], on_ground(x_m, -13.4));
    }
    let post = scene.closed("fence post", &fence::post());
    let feet_m: Vec<DVec3> = (0..13).map(|k| on_ground(-9.0 + 4.0 * f64::from(k), 25.2)).collect();
    for (k, &at_m) in feet_m.iter().enumerate() {
        scene.place_turned(&format!("post south {k}"), post, at_m, 70.0 * k as f64);
    }
    let strands = scene.closed("fence strands", &fence::strands(&feet_m));
    scene.place("fence strands", strands, DVec3::ZERO);
}

fn add_poles(scene: &mut Scene) {
    let poles = [(-61.5, -3.0), (-37.5, 2.0), (-13.1, -2.0), (10.6, 3.0), (34.8, -1.0), (59.0, 2.0)]
        .map(|(x_m, degrees)| Pole { x_m, z_m: 11.2, degrees });
    let mesh = scene.closed("pole", &pole());
    for (k, pole) in poles.iter().enumerate() {
        scene.place_turned(&format!("pole {k}"), mesh, pole.foot_m(), pole.degrees);
    }
    let can = scene.closed("transformer", &transformer());
    scene.place_turned("transformer", can, poles[3].foot_m() + dvec3(-0.45, 6.0, 0.02), 3.0);
    let lines = scene.closed("wires", &wires(&poles, dvec3(11.3, 5.45, -4.1), 3));
    scene.place("wires", lines, DVec3::ZERO);
}

fn add_clutter(scene: &mut Scene) {
    let rusty = scene.closed("barrel rusty", &clutter::barrel(Material::Rust));
    let painted = scene.closed("barrel painted", &clutter::barrel(Material::PaintTurquoise));
    let places = [(12.6, -6.9), (12.7, -7.6), (13.3, -7.2), (-1.1, -9.5), (12.2, -10.9)];
    for (k, (x_m, z_m)) in places.into_iter().enumerate() {
        let mesh = if k % 2 == 0 { rusty } else { painted };
        scene.place_turned(&format!("barrel {k}"), mesh, dvec3(x_m, -0.02, z_m), 75.0 * k as f64);
    }
    lay(scene, "barrel on its side", rusty, dvec3(14.4, 0.28, -5.4), 90.0, 35.0);
}

/// Places a mesh tipped by `tip_deg` around X and then turned by `degrees`.
fn lay(scene: &mut Scene, name: &str, mesh: MeshId, at_m: DVec3, tip_deg: f64, degrees: f64) {
    let turn = DQuat::from_mat3(&(turn_about(DVec3::Y, degrees) * turn_about(DVec3::X, tip_deg)));
    scene.nodes.push(Node { name: name.to_owned(), content: Content::Mesh(mesh), at_m, turn, scale: DVec3::ONE });
}

fn add_tyres(scene: &mut Scene) {
    let tyre = scene.closed("tyre", &clutter::tyre());
    for k in 0..4 {
        let shift = 0.05 * f64::from((k * 7) % 3 - 1);
        let at_m = dvec3(13.0 + shift, 0.09 + 0.205 * f64::from(k), -3.3 - shift);
        scene.place_turned(&format!("tyre pile {k}"), tyre, at_m, 40.0 * f64::from(k));
    }
    scene.place("tyre flat 1", tyre, dvec3(13.85, 0.09, -3.0));
    lay(scene, "tyre leaning 1", tyre, dvec3(13.55, 0.31, -3.45), 72.0, 60.0);
    lay(scene, "tyre leaning 2", tyre, dvec3(-0.22, 0.32, -3.55), 76.0, -90.0);
    let car = crate::shapes::turned(CAR_M, CAR_DEG);
    for (k, (x_m, z_m)) in [(-1.35, -0.74), (-1.35, 0.74), (1.38, -0.74), (1.38, 0.74)].into_iter().enumerate() {
        lay(scene, &format!("car tyre {k}"), tyre, car.transform_point3(dvec3(x_m, 0.325, z_m)), 90.0, CAR_DEG);
    }
}

fn add_trees(scene: &mut Scene) {
    let tree = tree::mesquite(33);
    let wood = scene.closed("tree wood", &tree.wood);
    let leaves = scene.open("tree leaves", &tree.leaves);
    for (k, (x_m, z_m, degrees, size)) in [(-6.4, -11.2, 0.0, 1.0), (24.0, 4.0, 130.0, 0.9)].into_iter().enumerate() {
        for (part, mesh) in [("wood", wood), ("leaves", leaves)] {
            scene.place_scaled(&format!("tree {k} {part}"), mesh, on_ground(x_m, z_m), degrees, DVec3::splat(size));
        }
    }
}

fn add_plants(scene: &mut Scene) {
    add_trees(scene);
    let arm = |from_m, degrees, out_m, up_m| Arm { from_m, degrees, out_m, up_m };
    let tall = scene.closed(
        "saguaro tall",
        &saguaro(5.2, &[arm(1.9, 20.0, 0.75, 2.1), arm(2.5, 195.0, 0.70, 1.5), arm(3.2, 100.0, 0.5, 0.9)]),
    );
    let short = scene.closed("saguaro short", &saguaro(3.1, &[arm(1.3, -30.0, 0.55, 1.1)]));
    for (k, (x_m, z_m, degrees)) in
        [(-28.5, 5.0, 30.0), (19.5, 7.0, 140.0), (1.0, -20.0, 80.0), (34.0, -6.0, 10.0)].into_iter().enumerate()
    {
        scene.place_turned(&format!("saguaro tall {k}"), tall, on_ground(x_m, z_m), degrees);
    }
    for (k, (x_m, z_m, degrees)) in [(-27.0, 3.4, 200.0), (27.5, -3.0, 60.0), (6.0, 27.5, 20.0)].into_iter().enumerate()
    {
        scene.place_scaled(&format!("saguaro short {k}"), short, on_ground(x_m, z_m), degrees, DVec3::splat(0.85));
    }
}

/// Whether a bush or a boulder may lie here: off the roads, the lot and what stands on it.
fn is_open_land(x_m: f64, z_m: f64) -> bool {
    let on_lot = (-14.5..17.0).contains(&x_m) && (-13.0..12.0).contains(&z_m);
    let on_road = (z_m - 17.0).abs() < 5.6 || (x_m + 20.0).abs() < 5.6;
    !on_lot && !on_road
}

fn add_desert(scene: &mut Scene) {
    let shrubs = [601, 602].map(|seed| scene.open(&format!("shrub {}", seed - 600), &clutter::shrub(seed)));
    let rocks = [701, 702, 703].map(|seed| scene.closed(&format!("rock {}", seed - 700), &clutter::rock(seed)));
    scatter(scene, "shrub", &shrubs, 46, 0.7..1.5, 0.0, &mut Rng::new(61));
    scatter(scene, "rock", &rocks, 32, 0.35..1.4, 0.05, &mut Rng::new(62));
}

fn scatter(
    scene: &mut Scene,
    name: &str,
    meshes: &[MeshId],
    count: usize,
    size: std::ops::Range<f64>,
    sunk_m: f64,
    rng: &mut Rng,
) {
    let mut placed = 0;
    while placed < count {
        let (x_m, z_m) = (rng.range(-44.0, 48.0), rng.range(-42.0, 40.0));
        let (degrees, scale) = (rng.range(0.0, 360.0), rng.range(size.start, size.end));
        if is_open_land(x_m, z_m) {
            let mesh = meshes[placed % meshes.len()];
            let at_m = on_ground(x_m, z_m) - DVec3::Y * sunk_m;
            scene.place_scaled(&format!("{name} {placed}"), mesh, at_m, degrees, DVec3::splat(scale));
            placed += 1;
        }
    }
}
