//! The shop: walls with real openings as one closed solid, window frames, doors, awnings and the ladder.

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::material::Material;
use crate::shapes::turned;
use crate::solid::{Carved, block};
use crate::soup::Soup;

/// Height of the floor above the lot.
pub(crate) const FLOOR_M: f64 = 0.12;
/// Height of the turquoise band and of the front windows' sills.
const SILL_M: f64 = 0.75;
/// Height of the roof's upper face.
const ROOF_M: f64 = 3.4;

/// Front windows: range of x, range of y, number of panes.
const FRONT_WINDOWS: [([f64; 2], [f64; 2], usize); 3] =
    [([0.7, 4.4], [SILL_M, 2.6], 4), ([6.5, 8.6], [SILL_M, 2.6], 2), ([9.8, 11.2], [1.55, 2.4], 2)];

fn carved() -> Carved {
    let mut solids = vec![
        block([0.0, 12.0], [-0.3, ROOF_M], [-10.0, -3.0]),
        block([-0.6, 12.6], [3.08, 3.26], [-3.0, -2.0]),
        block([3.2, 5.1], [ROOF_M, 3.65], [-7.85, -5.95]),
    ];
    for (x, z) in [
        ([0.0, 12.0], [-10.0, -9.8]),
        ([0.0, 12.0], [-3.2, -3.0]),
        ([0.0, 0.2], [-10.0, -3.0]),
        ([11.8, 12.0], [-10.0, -3.0]),
    ] {
        solids.push(block(x, [ROOF_M, 3.95], z));
    }
    let mut holes = vec![
        block([0.25, 9.0], [FLOOR_M, 3.15], [-9.75, -3.25]),
        block([9.15, 11.75], [FLOOR_M, 3.15], [-9.75, -3.25]),
        block([9.0, 9.15], [FLOOR_M, 2.2], [-6.4, -5.5]),
        block([3.4, 4.9], [3.15, 3.65], [-7.65, -6.15]),
        block([4.9, 6.0], [FLOOR_M, 2.4], [-3.25, -3.0]),
        block([0.0, 0.25], [1.0, 2.3], [-8.3, -6.4]),
        block([11.75, 12.0], [1.0, 2.3], [-6.3, -4.6]),
        block([11.75, 12.0], [FLOOR_M, 2.2], [-9.0, -8.1]),
        block([1.6, 2.6], [2.2, 2.7], [-10.0, -9.75]),
        block([6.4, 7.4], [2.2, 2.7], [-10.0, -9.75]),
    ];
    holes.extend(FRONT_WINDOWS.map(|(x, y, _)| block(x, y, [-3.25, -3.0])));
    Carved { solids, holes }
}

/// Walls, floor, roof, parapet and eaves.
pub(crate) fn shell() -> Soup {
    let mut soup = Soup::default();
    soup.carved(&carved(), 2.5, look);
    soup
}

fn look(p_m: DVec3, normal: DVec3) -> Material {
    let inside = block([0.24, 11.76], [0.0, 3.16], [-9.76, -3.24]).holds(p_m);
    if inside {
        return if normal.y > 0.5 && p_m.y < 0.2 { Material::FloorTiles } else { Material::Plaster };
    }
    if normal.y > 0.5 && p_m.y > ROOF_M - 0.01 && p_m.y < 3.6 {
        return Material::RoofGravel;
    }
    let eaves = p_m.z > -2.99 && p_m.y > 3.0;
    if eaves && normal.y.abs() < 0.5 {
        return Material::PaintRed;
    }
    if p_m.y < SILL_M { Material::StuccoTurquoise } else { Material::Stucco }
}

/// Frames in all windows, doors that stand open, bars in front of the back window.
pub(crate) fn joinery() -> Soup {
    let mut soup = Soup::default();
    for (x, y, panes) in FRONT_WINDOWS {
        let half = dvec2(x[1] - x[0], y[1] - y[0]) * 0.5;
        soup.put(&window(half, panes, 1), turned(dvec3(x[0] + half.x, y[0] + half.y, -3.12), 0.0));
    }
    soup.put(&window(dvec2(0.95, 0.65), 3, 2), turned(dvec3(0.12, 1.65, -7.35), 90.0));
    soup.put(&window(dvec2(0.85, 0.65), 3, 2), turned(dvec3(11.88, 1.65, -5.45), 90.0));
    soup.put(&door(1.06, 2.24), turned(dvec3(4.93, FLOOR_M + 0.02, -3.1), 68.0));
    soup.put(&door(0.86, 2.04), turned(dvec3(11.9, FLOOR_M + 0.02, -8.13), 20.0));
    for x_m in [1.75, 1.92, 2.10, 2.28, 2.45, 6.55, 6.72, 6.90, 7.08, 7.25] {
        soup.tube(Material::Iron, &[dvec3(x_m, 2.16, -9.9), dvec3(x_m, 2.74, -9.9)], 0.012, 6);
    }
    soup
}

/// A frame with `panes` panes side by side and `rows` rows, centred on the origin in the XY plane.
fn window(half_m: DVec2, panes: usize, rows: usize) -> Soup {
    let mut soup = Soup::default();
    let (x, y) = (half_m.x, half_m.y);
    let bar = |soup: &mut Soup, x: [f64; 2], y: [f64; 2], deep: f64| {
        soup.block(Material::PaintWhite, x, y, [-deep, deep]);
    };
    for k in 0..=panes {
        let at = -x + 2.0 * x * k as f64 / panes as f64;
        let wide = if k == 0 || k == panes { 0.05 } else { 0.025 };
        bar(&mut soup, [at - wide, at + wide], [-y - 0.03, y + 0.03], 0.05);
    }
    for k in 0..=rows {
        let at = -y + 2.0 * y * k as f64 / rows as f64;
        let wide = if k == 0 || k == rows { 0.05 } else { 0.02 };
        bar(&mut soup, [-x - 0.03, x + 0.03], [at - wide, at + wide], 0.042);
    }
    bar(&mut soup, [-x - 0.08, x + 0.08], [-y - 0.07, -y - 0.02], 0.16);
    soup
}

/// A door leaf without its glass, hinged on the Z axis, closed along +X.
fn door(wide_m: f64, high_m: f64) -> Soup {
    let mut soup = Soup::default();
    let mut part = |x: [f64; 2], y: [f64; 2], deep: f64| {
        soup.block(Material::PaintRed, x, y, [-deep, deep]);
    };
    part([0.0, 0.12], [0.0, high_m], 0.024);
    part([wide_m - 0.12, wide_m], [0.0, high_m], 0.024);
    part([0.1, wide_m - 0.1], [0.02, 0.70], 0.020);
    part([0.1, wide_m - 0.1], [high_m - 0.14, high_m - 0.02], 0.020);
    part([0.1, wide_m - 0.1], [1.28, 1.36], 0.020);
    soup.tube(Material::Iron, &[dvec3(0.06, 1.05, 0.06), dvec3(wide_m - 0.06, 1.05, 0.06)], 0.014, 6);
    soup
}

/// A sloping awning of slats on two arms; the wall is the plane z = 0, the awning reaches to +Z.
pub(crate) fn awning() -> Soup {
    let mut soup = Soup::default();
    let count = 9;
    for k in 0..count {
        let x_m = -1.2 + 2.4 * (f64::from(k) + 0.5) / f64::from(count);
        let material = if k % 2 == 0 { Material::PaintRed } else { Material::PaintWhite };
        soup.beam(material, dvec3(x_m, 0.22, -0.03), dvec3(x_m, -0.25, 0.95), 0.245, 0.03);
    }
    for x_m in [-1.12, 1.12] {
        soup.tube(Material::Iron, &[dvec3(x_m, -0.50, -0.03), dvec3(x_m, -0.24, 0.88)], 0.014, 6);
    }
    soup.tube(Material::Iron, &[dvec3(-1.2, -0.21, 0.82), dvec3(1.2, -0.21, 0.82)], 0.016, 6);
    soup
}

/// A fixed ladder to the roof; the wall is the plane z = 0, the ladder stands in front of it in +Z.
pub(crate) fn ladder() -> Soup {
    let mut soup = Soup::default();
    for x_m in [-0.23, 0.23] {
        let rail = [
            dvec3(x_m, 0.35, 0.20),
            dvec3(x_m, 4.75, 0.20),
            dvec3(x_m, 4.95, 0.06),
            dvec3(x_m, 4.95, -0.35),
            dvec3(x_m, 3.4, -0.55),
        ];
        soup.tube(Material::PaintMustard, &rail, 0.022, 6);
        for y_m in [0.8, 2.0, 3.3] {
            soup.beam(Material::Iron, dvec3(x_m, y_m, -0.03), dvec3(x_m, y_m, 0.20), 0.025, 0.05);
        }
    }
    for k in 0..13 {
        let y_m = 0.55 + 0.3 * f64::from(k);
        soup.tube(Material::PaintMustard, &[dvec3(-0.25, y_m, 0.20), dvec3(0.25, y_m, 0.20)], 0.014, 6);
    }
    soup
}
