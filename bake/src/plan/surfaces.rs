//! What is decided about surfaces.

use super::{Decision, Effect, Facts};
use crate::scene::{Alpha, Geometry, Scene};

/// What the scene's materials and normals call for.
pub(super) fn decisions(scene: &Scene, wants_smooth: bool, has_times: bool) -> [Decision; 4] {
    [
        of_surfaces(scene, Effect::AlphaMask, |instance| {
            scene.casts(instance) && matches!(scene.material(instance).alpha, Alpha::Mask { .. })
        }),
        of_surfaces(scene, Effect::DoubleSided, |instance| {
            scene.receives(instance) && scene.material(instance).is_double_sided
        }),
        of_smooth(scene, wants_smooth, has_times),
        Decision { effect: Effect::Walls, is_on: !scene.instances.is_empty(), facts: Facts::Walls { pages: None } },
    ]
}

/// Triangles are counted only where it matters.
fn of_smooth(scene: &Scene, is_asked: bool, has_times: bool) -> Decision {
    let count = || Geometry::new(scene).smooth_count();
    let triangles = if is_asked && has_times { count() } else { 0 };
    let facts = Facts::Smooth { is_asked, has_times, triangles };
    Decision { effect: Effect::SmoothTerminator, is_on: triangles > 0, facts }
}

/// An effect that is on where some instance calls for it.
fn of_surfaces(scene: &Scene, effect: Effect, has_effect: impl Fn(usize) -> bool) -> Decision {
    let instances = scene.instances.iter().enumerate().filter(|(index, _)| has_effect(*index));
    let [surfaces, triangles] = instances.fold([0, 0], |[surfaces, triangles], (_, instance)| {
        [surfaces + 1, triangles + scene.meshes[instance.mesh].triangle_count()]
    });
    Decision { effect, is_on: surfaces > 0, facts: Facts::Surfaces { surfaces, triangles } }
}
