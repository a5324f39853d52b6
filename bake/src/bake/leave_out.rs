//! What the user leaves out: outline hulls, sky domes, collision shells and other surfaces that should neither be seen
//! nor cast a shadow.

use super::error::BakeError;
use crate::scene::{Alpha, Material, Mesh, Scene, Selection, first_of, names};
use crate::warning::Warning;
use std::collections::BTreeMap;

/// Share of texels that never see the sun above which a user is asked whether a shell shades the scene.
const SUSPICIOUS_SHARE: f64 = 0.75;

/// Names that a message lists, of each kind.
const MOST_NAMES: usize = 12;

/// Turns what these texts name into air: it is not drawn, casts nothing and has no texels.
pub(super) fn leave_out(scene: &mut Scene, texts: &[String]) -> Result<(), BakeError> {
    for text in texts {
        let selection = Selection::new(scene, text);
        if selection.is_empty() {
            return Err(BakeError::NothingNamed { name: text.clone(), known: known(scene) });
        }
        selection.materials.iter().for_each(|&index| turn_into_air(&mut scene.materials[index]));
        leave_out_instances(scene, &selection.instances);
    }
    Ok(())
}

/// No alpha either, so that the set's own scene says the same to whoever reads it.
fn turn_into_air(material: &mut Material) {
    (material.alpha, material.base_color.w) = (Alpha::Invisible, 0.0);
}

/// Gives instances a material that is air: one copy of each of their materials. Where others draw the same mesh, they
/// get one copy of that mesh.
fn leave_out_instances(scene: &mut Scene, instances: &[usize]) {
    let mut draws_of_mesh = vec![0; scene.meshes.len()];
    scene.instances.iter().for_each(|instance| draws_of_mesh[instance.mesh] += 1);
    let mut by_mesh: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    instances.iter().for_each(|&one| by_mesh.entry(scene.instances[one].mesh).or_default().push(one));
    let mut air_of_material = BTreeMap::new();
    for (mesh, instances) in by_mesh {
        let material = scene.meshes[mesh].material;
        if scene.materials[material].alpha == Alpha::Invisible {
            continue;
        }
        let air = *air_of_material.entry(material).or_insert_with(|| {
            scene.materials.push(scene.materials[material].clone());
            scene.materials.last_mut().into_iter().for_each(turn_into_air);
            scene.materials.len() - 1
        });
        if instances.len() < draws_of_mesh[mesh] {
            let copy = scene.meshes.len();
            scene.meshes.push(Mesh { material: air, ..scene.meshes[mesh].clone() });
            instances.into_iter().for_each(|one| scene.instances[one].mesh = copy);
        } else {
            scene.meshes[mesh].material = air;
        }
    }
}

/// What a scene has to name, for a message.
fn known(scene: &Scene) -> String {
    let kinds = ["materials", "nodes", "meshes"].into_iter().zip(names(scene));
    let list = |(kind, names): (&str, Vec<&str>)| match names.is_empty() {
        true => format!("no {kind} with names"),
        false => format!("{kind} {}", first_of(&names, MOST_NAMES)),
    };
    kinds.map(list).collect::<Vec<_>>().join("; ")
}

/// A word to the user of a scene that is dark nearly everywhere.
pub(super) fn darkness_warning(dark_texels: u64, texels: u64) -> Option<Warning> {
    let share = dark_texels as f64 / (texels as f64).max(1.0);
    (share > SUSPICIOUS_SHARE).then_some(Warning::Dark { share })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{SceneBuilder, block, opaque};
    use glam::{DMat4, DVec3, Vec3};

    #[test]
    fn some_nodes_of_a_mesh_are_left_out_and_the_others_keep_it() {
        let places = [0.0, 5.0, 10.0].map(|x| DMat4::from_translation(DVec3::X * x));
        let (positions, indices) = (vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2]);
        let mesh = Mesh { positions, indices, ..Mesh::default() };
        let mut scene = SceneBuilder::new().mesh_of(mesh, opaque(), &places).build();
        scene.nodes[1].name = Some("shell_a".into());
        scene.nodes[2].name = Some("shell_b".into());
        let materials = scene.materials.len();
        leave_out(&mut scene, &["shell_*".into()]).unwrap();
        let alphas = [0, 1, 2].map(|instance| scene.material(instance).alpha);
        assert_eq!(alphas, [Alpha::Opaque, Alpha::Invisible, Alpha::Invisible]);
        assert_eq!(scene.instances.iter().map(|i| i.mesh).collect::<Vec<_>>(), [0, 1, 1]);
        assert_eq!(scene.meshes[0].positions, scene.meshes[1].positions);
        leave_out(&mut scene, &["node:0".into()]).unwrap();
        assert_eq!(scene.material(0).alpha, Alpha::Invisible);
        assert_eq!((scene.meshes.len(), scene.materials.len()), (2, materials + 2));
    }

    #[test]
    fn a_material_left_out_is_air_and_an_unknown_one_is_named() {
        let shell = Material { name: Some("shell".into()), ..opaque() };
        let mut scene = SceneBuilder::new().soup_of(&block(Vec3::ZERO, Vec3::ONE), shell).build();
        leave_out(&mut scene, &["shell".into()]).unwrap();
        assert_eq!(scene.material(0).alpha, Alpha::Invisible);
        let message = leave_out(&mut scene, &["hull".into()]).unwrap_err().to_string();
        assert!(message.contains("hull") && message.contains("shell"), "{message}");
    }

    #[test]
    fn only_scenes_that_are_dark_nearly_everywhere_are_remarked_on() {
        assert_eq!(darkness_warning(70, 100), None);
        assert_eq!(darkness_warning(0, 0), None);
        assert!(darkness_warning(90, 100).is_some_and(|w| w.to_string().contains("90 %") && w.remedy().is_some()));
    }
}
