//! Where texels are denser: around objects that ask for it.
//!
//! A mesh's triangles that lie in the zone of an object are unwrapped apart from its others, so that their charts can
//! have a density of their own. Zones that overlap count by the higher density.

use crate::scene::{Instance, Scene};
use glam::DVec3;

/// A box in bake space, metres, and the least density of texels in it.
#[derive(Debug, Clone, Copy)]
struct Zone {
    low: DVec3,
    high: DVec3,
    texels_per_metre: f64,
}

/// The zones of a scene.
#[derive(Debug, Clone, Default)]
pub(super) struct Zones(Vec<Zone>);

impl Zones {
    /// Of objects that ask for a density around them.
    pub fn new(scene: &Scene) -> Self {
        let zone = |(index, instance): (usize, &Instance)| {
            let texels_per_metre = instance.role.texels_per_metre_around.filter(|_| scene.is_there(index))?;
            let (low, high) = corners_of(scene, instance)
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            let reach_m = (high - low).max_element();
            (reach_m >= 0.0).then_some(Zone { low: low - reach_m, high: high + reach_m, texels_per_metre })
        };
        Self(scene.instances.iter().enumerate().filter_map(zone).collect())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// For each triangle of an instance's mesh, the density that the zones it reaches into ask for, if that is more
    /// than the instance's own.
    pub fn densities(&self, scene: &Scene, instance: usize) -> Vec<Option<f64>> {
        let instance = &scene.instances[instance];
        let own = instance.role.texels_per_metre.unwrap_or(0.0);
        let corners: Vec<DVec3> = corners_of(scene, instance).collect();
        let density = |triangle: &[DVec3]| {
            let low = triangle.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = triangle.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            let meets = |zone: &&Zone| low.cmple(zone.high).all() && high.cmpge(zone.low).all();
            let asked = self.0.iter().filter(meets).map(|zone| zone.texels_per_metre);
            asked.filter(|&density| density > own).reduce(f64::max)
        };
        corners.chunks_exact(3).map(density).collect()
    }
}

/// Corners of all triangles of an instance, bake space.
fn corners_of<'a>(scene: &'a Scene, instance: &'a Instance) -> impl Iterator<Item = DVec3> + 'a {
    let mesh = &scene.meshes[instance.mesh];
    let place = |index: &u32| instance.bake_from_object.transform_point3(mesh.positions[*index as usize].as_dvec3());
    mesh.indices.iter().map(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::{self, AtlasSettings};
    use crate::testing::{SceneBuilder, block};
    use glam::{Vec2, Vec3};

    /// A floor of 40 by 40 squares of a metre, and a crate in its middle.
    fn yard() -> Scene {
        let square = |x: i32, z: i32| {
            let [low, high] = [Vec2::new(x as f32, z as f32), Vec2::new(x as f32 + 1.0, z as f32 + 1.0)];
            crate::testing::floor(low, high, 0.0)
        };
        let squares = (-20..20).flat_map(|x| (-20..20).flat_map(move |z| square(x, z)));
        SceneBuilder::new()
            .soup(&squares.collect::<Vec<_>>())
            .soup(&block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5)))
            .build()
    }

    /// B21.
    #[test]
    fn the_ground_around_an_object_is_dense_and_the_rest_is_not() {
        let mut scene = yard();
        scene.instances[1].role.texels_per_metre_around = Some(30.0);
        let settings = AtlasSettings { page_size_texels: 512, ..AtlasSettings::default() };
        let atlas = atlas::build(&scene, &settings, &|_| true).unwrap();
        let layout = &atlas.layouts[scene.instances[0].mesh];
        let page = atlas.pages[0];
        let density = |triangle: usize| {
            let corners = [0, 1, 2].map(|k| layout.indices[3 * triangle + k] as usize);
            let [a, b, c] = corners.map(|vertex| atlas.texel(0, layout.uvs[vertex], page));
            // Each triangle is half a square metre.
            (b - a).perp_dot(c - a).abs().sqrt()
        };
        let middle = |triangle: usize| {
            let mesh = &scene.meshes[scene.instances[0].mesh];
            let corners = [0, 1, 2].map(|k| mesh.positions[mesh.indices[3 * triangle + k] as usize]);
            (corners[0] + corners[1] + corners[2]) / 3.0
        };
        let mut counts = [0, 0];
        for triangle in 0..layout.indices.len() / 3 {
            let at = middle(triangle);
            let far = at.x.abs().max(at.z.abs());
            if far < 1.5 {
                assert!((29.0..31.0).contains(&density(triangle)), "{} at {at}", density(triangle));
                counts[0] += 1;
            } else if far > 3.0 {
                assert!((3.0..14.0).contains(&density(triangle)), "{} at {at}", density(triangle));
                counts[1] += 1;
            }
        }
        assert!(counts[0] > 10 && counts[1] > 1000, "{counts:?}");
        let of_crate = atlas.texels_per_metre_of(&scene, 1);
        assert!((29.0..31.0).contains(&of_crate), "{of_crate}");
    }
}
