//! From a bag of triangles to indexed primitives: rounds positions, drops what rounding made degenerate, averages
//! normals inside patches and shares equal vertices.

use std::collections::HashMap;

use glam::{DVec3, dvec3};

use crate::material::Material;
use crate::soup::{Soup, Tri};

/// Positions are whole multiples of this, in metres: a last bit of arithmetic never shows in the file.
const POSITION_STEP_PER_M: f64 = 10_000.0;
/// Twice the least area (m²) a triangle keeps.
const LEAST_DOUBLE_AREA_M2: f64 = 1e-7;

/// A position in steps; equal keys are the same point.
pub(crate) type PointKey = [i64; 3];

/// Triangles of one material, indexed.
#[derive(Debug, Clone)]
pub(crate) struct Primitive {
    pub(crate) material: Material,
    pub(crate) positions_m: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) uvs: Vec<[f32; 2]>,
    pub(crate) indices: Vec<u32>,
}

/// The rounded position's key.
pub(crate) fn point_key(p_m: DVec3) -> PointKey {
    let p = (p_m * POSITION_STEP_PER_M).round();
    [p.x as i64, p.y as i64, p.z as i64]
}

fn rounded(p_m: DVec3) -> DVec3 {
    let k = point_key(p_m);
    dvec3(k[0] as f64, k[1] as f64, k[2] as f64) / POSITION_STEP_PER_M
}

/// Indexes a soup: one primitive a material, in the order in which the materials first appear.
pub(crate) fn weld(soup: &Soup) -> Vec<Primitive> {
    let tris = rounded_tris(soup);
    let fans = fans(soup, &tris);
    let mut builder = Builder::default();
    for (tri, face) in &tris {
        let patch = soup.patches[tri.patch];
        for c in &tri.corners {
            let fan = &fans[&(patch.group, point_key(c.position_m))];
            let normal = average(fan, face.normal, patch.crease.least_cosine());
            builder.corner(patch.material, c.position_m, normal, c.uv_m.to_array());
        }
    }
    builder.primitives
}

/// A face's unit normal, and twice its area in square metres.
#[derive(Debug, Clone, Copy)]
struct Face {
    normal: DVec3,
    double_area_m2: f64,
}

fn rounded_tris(soup: &Soup) -> Vec<(Tri, Face)> {
    let mut kept = Vec::with_capacity(soup.tris.len());
    for tri in &soup.tris {
        let mut tri = *tri;
        for c in &mut tri.corners {
            c.position_m = rounded(c.position_m);
        }
        let [a, b, c] = tri.corners.map(|c| c.position_m);
        let cross = (b - a).cross(c - a);
        let double_area_m2 = cross.length();
        if double_area_m2 > LEAST_DOUBLE_AREA_M2 {
            kept.push((tri, Face { normal: cross / double_area_m2, double_area_m2 }));
        }
    }
    kept
}

type Fans = HashMap<(usize, PointKey), Vec<Face>>;

/// All faces around each point of each group of patches.
fn fans(soup: &Soup, tris: &[(Tri, Face)]) -> Fans {
    let mut fans = Fans::new();
    for (tri, face) in tris {
        for c in &tri.corners {
            let group = soup.patches[tri.patch].group;
            fans.entry((group, point_key(c.position_m))).or_default().push(*face);
        }
    }
    fans
}

fn average(fan: &[Face], own: DVec3, least_cosine: f64) -> DVec3 {
    let near = fan.iter().filter(|f| f.normal.dot(own) >= least_cosine);
    near.map(|f| f.normal * f.double_area_m2).sum::<DVec3>().normalize_or(own)
}

#[derive(Default)]
struct Builder {
    primitives: Vec<Primitive>,
    shared: HashMap<(Material, PointKey, [i32; 5]), u32>,
}

impl Builder {
    fn corner(&mut self, material: Material, position_m: DVec3, normal: DVec3, uv_m: [f64; 2]) {
        let spec = material.spec();
        let uv = match spec.texture {
            Some(_) => uv_m.map(|v| (v / spec.tile_m * 10_000.0).round() as i32),
            None => [0, 0],
        };
        let n = normal.to_array().map(|v| (v * 10_000.0).round() as i32);
        let key = (material, point_key(position_m), [n[0], n[1], n[2], uv[0], uv[1]]);
        let primitive = self.primitive(material);
        let next = primitive.positions_m.len() as u32;
        let index = *self.shared.entry(key).or_insert(next);
        let primitive = self.primitive(material);
        primitive.indices.push(index);
        if index == next {
            primitive.positions_m.push(position_m.as_vec3().to_array());
            let n = dvec3(f64::from(n[0]), f64::from(n[1]), f64::from(n[2])).normalize();
            primitive.normals.push(n.as_vec3().to_array());
            primitive.uvs.push(uv.map(|v| (f64::from(v) / 10_000.0) as f32));
        }
    }

    fn primitive(&mut self, material: Material) -> &mut Primitive {
        let found = self.primitives.iter().position(|p| p.material == material);
        let at = found.unwrap_or_else(|| {
            self.primitives.push(Primitive::empty(material));
            self.primitives.len() - 1
        });
        &mut self.primitives[at]
    }
}

impl Primitive {
    fn empty(material: Material) -> Self {
        Self { material, positions_m: vec![], normals: vec![], uvs: vec![], indices: vec![] }
    }
}
