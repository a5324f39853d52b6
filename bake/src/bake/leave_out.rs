//! What the user leaves out: outline hulls, sky domes, collision shells and other surfaces that should neither be seen
//! nor cast a shadow.

use super::error::BakeError;
use crate::scene::{Alpha, Material, Scene, Selection, names};
use crate::warning::Warning;

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
        for instance in selection.instances {
            leave_out_instance(scene, instance);
        }
    }
    Ok(())
}

/// No alpha either, so that the set's own scene says the same to whoever reads it.
fn turn_into_air(material: &mut Material) {
    (material.alpha, material.base_color.w) = (Alpha::Invisible, 0.0);
}

/// Gives an instance a material of its own that is air, and a mesh of its own if others draw its mesh.
fn leave_out_instance(scene: &mut Scene, instance: usize) {
    let mesh = scene.instances[instance].mesh;
    let material = scene.meshes[mesh].material;
    if scene.materials[material].alpha == Alpha::Invisible {
        return;
    }
    let mut air = scene.materials[material].clone();
    turn_into_air(&mut air);
    scene.materials.push(air);
    let is_shared = scene.instances.iter().filter(|other| other.mesh == mesh).nth(1).is_some();
    if is_shared {
        scene.meshes.push(scene.meshes[mesh].clone());
        scene.instances[instance].mesh = scene.meshes.len() - 1;
    }
    let own = scene.instances[instance].mesh;
    scene.meshes[own].material = scene.materials.len() - 1;
}

/// What a scene has to name, for a message.
fn known(scene: &Scene) -> String {
    let kinds = ["materials", "nodes", "meshes"].into_iter().zip(names(scene));
    let list = |(kind, names): (&str, Vec<&str>)| match names.len() {
        0 => format!("no {kind} with names"),
        count if count > MOST_NAMES => {
            format!("{kind} {} and {} more", names[..MOST_NAMES].join(", "), count - MOST_NAMES)
        }
        _ => format!("{kind} {}", names.join(", ")),
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
    fn one_of_two_nodes_is_left_out_and_the_other_keeps_their_mesh() {
        let mut scene = SceneBuilder::new().block(Vec3::ZERO, Vec3::ONE).build();
        let far = DMat4::from_translation(DVec3::X * 5.0);
        scene.nodes.push(crate::scene::Node { name: Some("second".into()), ..scene.nodes[0].clone() });
        scene.instances.push(crate::scene::Instance { node: 1, bake_from_object: far, ..scene.instances[0] });
        leave_out(&mut scene, &["second".into()]).unwrap();
        assert_eq!([0, 1].map(|instance| scene.material(instance).alpha), [Alpha::Opaque, Alpha::Invisible]);
        assert_eq!(scene.meshes[0].positions, scene.meshes[1].positions);
        leave_out(&mut scene, &["node:0".into()]).unwrap();
        assert_eq!(scene.material(0).alpha, Alpha::Invisible);
        assert_eq!((scene.meshes.len(), scene.instances[0].mesh), (2, 0));
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
