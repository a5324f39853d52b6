//! Objects that are too small for their texels.

use crate::atlas::{Atlas, is_drawn_together};
use crate::scene::{Instance, Scene, each_once, label_of};
use crate::warning::Warning;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Width in texels below which an object is narrow.
const NARROW_TEXELS: f64 = 2.0;
/// Width in texels at which it would be well drawn.
const GOOD_TEXELS: f64 = 8.0;
/// Most objects that are named.
const MOST_NAMED: usize = 3;

/// A word about objects that are narrower than two texels, their own or those around them, if there are any.
pub(super) fn narrow_warning(scene: &Scene, atlas: &Atlas) -> Option<Warning> {
    let texels = TexelWidths::new(scene, atlas);
    let is_narrow = |&(width_m, _, texel_m): &(f64, usize, f64)| width_m < NARROW_TEXELS * texel_m;
    let measured = (0..scene.instances.len()).into_par_iter().filter(|&instance| scene.is_there(instance));
    let measured = measured.map(|instance| {
        let width_m = width_m(scene, instance);
        (width_m, instance, texels.on_or_around(scene, instance, width_m))
    });
    let mut narrow: Vec<_> = measured.filter(is_narrow).collect();
    narrow.sort_by(|a, b| a.0.total_cmp(&b.0));
    let &(least_m, _, texel_m) = narrow.first()?;
    let label = |&(_, instance, _): &(f64, usize, f64)| label_of(scene, &BTreeSet::from([instance as u32])).1;
    Some(Warning::Narrow {
        count: narrow.len(),
        objects: each_once(narrow.iter().take(MOST_NAMED).map(label).collect()),
        texel_m,
        texels_per_metre: GOOD_TEXELS / least_m.max(1e-6),
    })
}

/// Widths of the texels of all that has some, and where they lie.
struct TexelWidths<'a> {
    atlas: &'a Atlas,
    /// Width in metres, of those that have texels.
    of_instances: Vec<Option<f64>>,
    widest_m: f64,
    boxes: Vec<[DVec3; 2]>,
}

impl<'a> TexelWidths<'a> {
    fn new(scene: &Scene, atlas: &'a Atlas) -> Self {
        let widths_m = atlas.texel_widths_m(scene).into_iter().enumerate();
        let has_texels = |instance: usize| scene.receives(instance) && !atlas.placements[instance].is_empty();
        let of_instances: Vec<_> = widths_m.map(|(i, width_m)| Some(width_m).filter(|_| has_texels(i))).collect();
        let widest_m = of_instances.iter().flatten().copied().fold(0.0, f64::max);
        let boxes = (0..scene.instances.len()).into_par_iter().map(|i| box_of(scene, i)).collect();
        Self { atlas, of_instances, widest_m, boxes }
    }

    /// Width of the widest texels of an object and, if it casts a shadow, of what reaches into its box, made larger by
    /// the object's size on all sides: there its shadow falls.
    fn on_or_around(&self, scene: &Scene, instance: usize, width_m: f64) -> f64 {
        let own_m = self.of_instances[instance].unwrap_or(0.0);
        if !scene.casts(instance) || width_m >= NARROW_TEXELS * self.widest_m {
            return own_m;
        }
        let [low, high] = self.boxes[instance];
        let reach_m = (high - low).max_element();
        let [low, high] = [low - reach_m, high + reach_m];
        let is_near = |[from, to]: &[DVec3; 2]| from.cmple(high).all() && to.cmpge(low).all();
        let has_own = scene.instances[instance].role.texels_per_metre_around.is_some();
        let near = self.boxes.iter().zip(&self.of_instances).enumerate().filter(|(_, (place, _))| is_near(place));
        let width_m = |(other, (_, width_m)): (usize, (_, &Option<f64>))| {
            // Triangles around it are denser than those farther away, which do not count.
            width_m.map(|mean_m| if has_own { self.widest_within(scene, other, [low, high]) } else { mean_m })
        };
        near.filter_map(width_m).fold(own_m, f64::max)
    }

    /// Width of the widest texels of an instance's triangles that reach into a box.
    fn widest_within(&self, scene: &Scene, instance: usize, [low, high]: [DVec3; 2]) -> f64 {
        let Instance { mesh, bake_from_object, .. } = &scene.instances[instance];
        let (mesh, layout) = (&scene.meshes[*mesh], &self.atlas.layouts[*mesh]);
        let page = self.atlas.pages[self.atlas.placements[instance].page as usize];
        let width_m = |(corners, own): (&[u32], &[u32])| {
            let place = |k: usize| bake_from_object.transform_point3(mesh.positions[corners[k] as usize].as_dvec3());
            let [a, b, c] = [0, 1, 2].map(place);
            if !(a.min(b).min(c).cmple(high).all() && a.max(b).max(c).cmpge(low).all()) {
                return 0.0;
            }
            let on_page = [0, 1, 2].map(|k| self.atlas.texel(instance, layout.uvs[own[k] as usize], page));
            let [p, q, r] = on_page;
            let texels = (q - p).perp_dot(r - p).abs();
            if texels > 0.0 && !is_drawn_together(&on_page) {
                ((b - a).cross(c - a).length() / texels).sqrt()
            } else {
                0.0
            }
        };
        mesh.indices.chunks_exact(3).zip(layout.indices.chunks_exact(3)).map(width_m).fold(0.0, f64::max)
    }
}

/// Least and greatest coordinates of an instance, bake space.
fn box_of(scene: &Scene, instance: usize) -> [DVec3; 2] {
    let instance = &scene.instances[instance];
    let positions = scene.meshes[instance.mesh].positions.iter();
    let placed = positions.map(|p| instance.bake_from_object.transform_point3(p.as_dvec3()));
    placed.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
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
    fn a_density_around_an_object_that_does_not_fit_its_page_is_told() {
        let mut scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-16.0), Vec2::splat(16.0), 0.0))
            .soup(&block(Vec3::ZERO, Vec3::splat(0.1)))
            .build();
        scene.instances[1].role.texels_per_metre_around = Some(80.0);
        let settings = AtlasSettings { page_size_texels: 512, ..AtlasSettings::default() };
        let built = atlas::build(&scene, &settings, &|_| true).unwrap();
        // The ground's two triangles both reach there, and 32 metres have 512 texels at most.
        let told = built.warnings.iter().find_map(|warning| match warning {
            Warning::LessDensity { asked_per_metre, reached_per_metre, .. } => {
                Some([*asked_per_metre, *reached_per_metre])
            }
            _ => None,
        });
        assert!(told.is_some_and(|[asked, reached]| asked == 80.0 && (10.0..16.0).contains(&reached)), "{told:?}");
        let narrow = narrow_warning(&scene, &built);
        assert!(matches!(narrow, Some(Warning::Narrow { count: 1, .. })), "{narrow:?}");
        let larger = AtlasSettings { page_size_texels: 4096, ..settings };
        let built = atlas::build(&scene, &larger, &|_| true).unwrap();
        assert!(built.warnings.iter().all(|warning| !matches!(warning, Warning::LessDensity { .. })));
        assert_eq!(narrow_warning(&scene, &built), None);
    }

    #[test]
    fn what_is_narrower_than_two_texels_is_named_until_texels_on_it_and_around_it_are_dense() {
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
        // Its own texels are narrow now, and those of the ground, where its shadow falls, are not.
        scene.instances[1].role.texels_per_metre = Some(16.0);
        assert!(matches!(warning(&scene), Some(Warning::Narrow { count: 1, texel_m, .. }) if texel_m > 0.4));
        scene.instances[1].role.casts = false;
        assert_eq!(warning(&scene), None);
        // Dense only around it: the ground's two triangles reach there.
        scene.instances[1].role = crate::scene::Role { texels_per_metre_around: Some(16.0), ..Default::default() };
        assert_eq!(warning(&scene), None);
    }
}
