//! Objects that are too small for their texels.

use crate::atlas::Atlas;
use crate::scene::{Scene, each_once, label_of};
use crate::warning::Warning;
use glam::DVec3;
use std::collections::BTreeSet;

/// Width in texels below which an object is narrow.
const NARROW_TEXELS: f64 = 2.0;
/// Width in texels at which it would be well drawn.
const GOOD_TEXELS: f64 = 8.0;
/// Most objects that are named.
const MOST_NAMED: usize = 3;

/// A word about objects that are narrower than two texels, if there are any.
pub(super) fn narrow_warning(scene: &Scene, atlas: &Atlas) -> Option<Warning> {
    let widths_m = atlas.texel_widths_m(scene);
    let texel_m = |instance: usize| widths_m[instance];
    let received = (0..scene.instances.len()).filter(|&instance| scene.receives(instance));
    let widths = received.map(|instance| (width_m(scene, instance), instance));
    let mut narrow: Vec<_> = widths.filter(|&(width_m, i)| width_m < NARROW_TEXELS * texel_m(i)).collect();
    narrow.sort_by(|a, b| a.0.total_cmp(&b.0));
    let &(least_m, least) = narrow.first()?;
    let label = |&(_, instance): &(f64, usize)| label_of(scene, &BTreeSet::from([instance as u32])).1;
    Some(Warning::Narrow {
        count: narrow.len(),
        objects: each_once(narrow.iter().take(MOST_NAMED).map(label).collect()),
        texel_m: texel_m(least),
        texels_per_metre: GOOD_TEXELS / least_m.max(1e-6),
    })
}

/// The middle one of an instance's three extents along its own axes: the width of a plank, of a wire its thickness.
fn width_m(scene: &Scene, instance: usize) -> f64 {
    let instance = &scene.instances[instance];
    let positions = || scene.meshes[instance.mesh].positions.iter().map(|p| p.as_dvec3());
    let low = positions().fold(DVec3::INFINITY, DVec3::min);
    let high = positions().fold(DVec3::NEG_INFINITY, DVec3::max);
    let axes = instance.bake_from_object;
    let scale = DVec3::from([axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.truncate().length()));
    let mut extents = ((high - low) * scale).to_array();
    extents.sort_by(f64::total_cmp);
    extents[1].max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::{self, AtlasSettings, Density};
    use crate::testing::{SceneBuilder, block, floor, opaque};
    use glam::{Vec2, Vec3};

    #[test]
    fn what_is_narrower_than_two_texels_is_named_unless_it_has_its_own_density() {
        let material = |name: &str| crate::scene::Material { name: Some(name.into()), ..opaque() };
        let mut scene = SceneBuilder::new()
            .soup_of(&floor(Vec2::splat(-50.0), Vec2::splat(50.0), 0.0), material("ground"))
            .soup_of(&block(Vec3::ZERO, Vec3::new(3.0, 0.1, 0.5)), material("plank"))
            .build();
        let settings = AtlasSettings { density: Density::TexelsPerMetre(2.0), ..AtlasSettings::default() };
        let warning = |scene: &Scene| narrow_warning(scene, &atlas::build(scene, &settings, &|_| true).unwrap());
        let Some(Warning::Narrow { count: 1, objects, texels_per_metre, .. }) = warning(&scene) else {
            panic!("a plank of half a metre has one texel across")
        };
        assert_eq!((objects, texels_per_metre), (vec!["plank".to_owned()], 16.0));
        scene.instances[1].role.texels_per_metre = Some(16.0);
        assert_eq!(warning(&scene), None);
    }
}
