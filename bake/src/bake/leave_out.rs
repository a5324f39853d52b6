//! What the user leaves out: outline hulls, sky domes, collision shells and other surfaces that should neither be seen
//! nor cast a shadow.

use super::error::BakeError;
use crate::scene::{Alpha, Scene, Selection, first_of, names};
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
        selection.materials.iter().for_each(|&index| scene.materials[index].alpha = Alpha::Invisible);
        scene.turn_into_air(&selection.instances);
    }
    Ok(())
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
    use crate::scene::{Material, Mesh};
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
