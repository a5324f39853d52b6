//! Materials that the user leaves out: outline hulls, sky domes and other surfaces that should neither be seen nor cast
//! a shadow.

use super::error::BakeError;
use crate::scene::{Alpha, Scene};
use crate::warning::Warning;

/// Share of texels that never see the sun above which a user is asked whether a shell shades the scene.
const SUSPICIOUS_SHARE: f64 = 0.75;

/// Turns every material of these names into air: it is not drawn, casts nothing and has no texels.
pub(super) fn leave_out(scene: &mut Scene, names: &[String]) -> Result<(), BakeError> {
    for name in names {
        let mut found = false;
        for material in scene.materials.iter_mut().filter(|m| m.name.as_ref() == Some(name)) {
            // No alpha, so that the set's own scene says the same to whoever reads it.
            (material.alpha, material.base_color.w, found) = (Alpha::Invisible, 0.0, true);
        }
        if !found {
            let known: Vec<&str> = scene.materials.iter().filter_map(|m| m.name.as_deref()).take(20).collect();
            return Err(BakeError::NoSuchMaterial { name: name.clone(), known: known.join(", ") });
        }
    }
    Ok(())
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
    use glam::Vec3;

    #[test]
    fn a_material_left_out_is_air_and_an_unknown_one_is_named() {
        let shell = crate::scene::Material { name: Some("shell".into()), ..opaque() };
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
