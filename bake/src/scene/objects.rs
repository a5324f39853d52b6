//! What a user asks for objects by their names: to leave them out, to change their [`Role`].

use super::names::{count_in_file, is_in_file, named_index};
use super::{Alpha, Role, Scene, Selection, first_of, is_density, names};

/// What is asked for objects, by names as [`Selection`] reads them. Wishes come before those in the file's `extras`
/// ([`Role`]); of two that name the same object, the later one counts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ObjectWishes {
    /// What is neither drawn nor baked and casts nothing: outline hulls, sky domes, collision shells.
    pub leave_out: Vec<String>,
    /// What is drawn and baked, and lets all light through.
    pub no_cast: Vec<String>,
    /// What is drawn and casts, has no texels, and is lit wherever it faces the light.
    pub no_receive: Vec<String>,
    /// Texels a metre, above 0.
    pub density: Vec<(String, f64)>,
    /// Least texels a metre on it and around it, above 0 ([`Role::texels_per_metre_around`]).
    pub density_around: Vec<(String, f64)>,
}

/// One kind of wish.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// To leave it out.
    LeaveOut,
    /// To let it cast no shadow.
    NoCast,
    /// To let nothing shade it.
    NoReceive,
    /// To give it texels of its own size.
    Density,
}

impl Wish {
    /// What the user wanted, to be read after "to".
    fn verb(self) -> &'static str {
        match self {
            Self::LeaveOut => "leave out",
            Self::NoCast => "free of its shadow",
            Self::NoReceive => "free of shadows on it",
            Self::Density => "give a density",
        }
    }
}

/// Why a wish cannot be granted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ObjectError {
    /// The name names nothing.
    #[error("the scene has no material, node or mesh named {name:?} to {}; it has {known}", wish.verb())]
    NothingNamed {
        /// What was wanted.
        wish: Wish,
        /// The name that was given.
        name: String,
        /// What there is, as far as fits.
        known: String,
    },
    /// The index is beyond the end of its list.
    #[error("the scene has no {name} to {}; it has {}", wish.verb(), indices(kind, *count))]
    NoIndex {
        /// What was wanted.
        wish: Wish,
        /// The name that was given: `node:99`.
        name: String,
        /// What it is an index of: `node`, `mesh`, `material`.
        kind: &'static str,
        /// How many the file has.
        count: usize,
    },
    /// The file has it, and it draws nothing.
    #[error("nothing is drawn of {name:?}, so there is nothing to {}", wish.verb())]
    DrawsNothing {
        /// What was wanted.
        wish: Wish,
        /// The name that was given.
        name: String,
    },
    /// All that the name names is left out.
    #[error(
        "{name:?} is left out of the scene, so there is nothing to {}; take one of the two wishes back",
        wish.verb()
    )]
    LeftOut {
        /// What was wanted.
        wish: Wish,
        /// The name that was given.
        name: String,
    },
    /// All that the name names takes no shadows.
    #[error("nothing shades {name:?}, so it has no texels to give a density; take one of the two wishes back")]
    NoTexels {
        /// The name that was given.
        name: String,
    },
    /// One name has two densities.
    #[error("{name:?} is to have {first} and {second} texels a metre; give one of them")]
    TwoDensities {
        /// The name that was given.
        name: String,
        /// A density.
        first: f64,
        /// Another.
        second: f64,
    },
    /// A density makes no sense ([`crate::scene::is_density`]).
    #[error("{name:?} is to have {density} texels a metre: give a number from 0.000001 to 1000000")]
    Density {
        /// The name that was given.
        name: String,
        /// What was asked for.
        density: f64,
    },
}

/// Names that a message lists, of each kind.
const MOST_NAMES: usize = 12;

impl ObjectWishes {
    /// Grants all wishes.
    ///
    /// # Errors
    ///
    /// If a name names nothing, or wishes contradict each other. The scene may be half changed then.
    pub fn apply_to(&self, scene: &mut Scene) -> Result<(), ObjectError> {
        check_densities(&self.density)?;
        check_densities(&self.density_around)?;
        for name in &self.leave_out {
            let selection = select(scene, Wish::LeaveOut, name)?;
            selection.materials.iter().for_each(|&index| scene.materials[index].alpha = Alpha::Invisible);
            scene.turn_into_air(&selection.instances);
        }
        for name in &self.no_cast {
            change(scene, Wish::NoCast, name, |role| role.casts = false)?;
        }
        for name in &self.no_receive {
            change(scene, Wish::NoReceive, name, |role| role.receives = false)?;
        }
        for (name, density) in &self.density {
            let changed = change(scene, Wish::Density, name, |role| role.texels_per_metre = Some(*density))?;
            if !changed.iter().any(|&instance| scene.receives(instance)) {
                return Err(ObjectError::NoTexels { name: name.clone() });
            }
        }
        for (name, density) in &self.density_around {
            change(scene, Wish::Density, name, |role| role.texels_per_metre_around = Some(*density))?;
        }
        Ok(())
    }
}

fn check_densities(densities: &[(String, f64)]) -> Result<(), ObjectError> {
    for (index, (name, density)) in densities.iter().enumerate() {
        let (name, second) = (name.clone(), *density);
        if !is_density(second) {
            return Err(ObjectError::Density { name, density: second });
        }
        let other = densities[..index].iter().find(|other| other.0 == name && other.1 != second);
        if let Some(&(_, first)) = other {
            return Err(ObjectError::TwoDensities { name, first, second });
        }
    }
    Ok(())
}

/// Changes the roles of what is named and there. Gives its instances.
fn change(scene: &mut Scene, wish: Wish, name: &str, to: impl Fn(&mut Role)) -> Result<Vec<usize>, ObjectError> {
    let named = select(scene, wish, name)?.all_instances(scene);
    let instances: Vec<usize> = named.into_iter().map(|index| index as usize).filter(|&i| scene.is_there(i)).collect();
    if instances.is_empty() {
        return Err(ObjectError::LeftOut { wish, name: name.to_owned() });
    }
    instances.iter().for_each(|&instance| to(&mut scene.instances[instance].role));
    Ok(instances)
}

fn select(scene: &Scene, wish: Wish, name: &str) -> Result<Selection, ObjectError> {
    let selection = Selection::new(scene, name);
    match selection.is_empty() {
        true => Err(not_found(scene, wish, name.to_owned())),
        false => Ok(selection),
    }
}

/// Why a name selects nothing.
fn not_found(scene: &Scene, wish: Wish, name: String) -> ObjectError {
    let index = named_index(&name);
    let beyond = index.map(|(kind, index)| (kind, index, count_in_file(scene, kind)));
    match beyond {
        Some((kind, index, count)) if index >= count => ObjectError::NoIndex { wish, name, kind, count },
        Some(_) => ObjectError::DrawsNothing { wish, name },
        None if is_in_file(scene, &name) => ObjectError::DrawsNothing { wish, name },
        None => ObjectError::NothingNamed { wish, name, known: known(scene) },
    }
}

/// `185 nodes, node:0 to node:184`.
fn indices(kind: &str, count: usize) -> String {
    let kinds = match (kind, count) {
        (_, 1) => kind,
        ("node", _) => "nodes",
        ("mesh", _) => "meshes",
        _ => "materials",
    };
    match count {
        0 => format!("no {kinds}"),
        1 => format!("1 {kinds}, {kind}:0"),
        _ => format!("{count} {kinds}, {kind}:0 to {kind}:{}", count - 1),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Mesh};
    use crate::testing::{SceneBuilder, block, opaque};
    use glam::{DMat4, DVec3, Vec3};

    fn leave_out(scene: &mut Scene, names: &[&str]) -> Result<(), ObjectError> {
        let leave_out = names.iter().map(ToString::to_string).collect();
        ObjectWishes { leave_out, ..ObjectWishes::default() }.apply_to(scene)
    }

    /// Three places of one triangle: nodes `shell_a`, `shell_b` and one without a name.
    fn three() -> Scene {
        let places = [0.0, 5.0, 10.0].map(|x| DMat4::from_translation(DVec3::X * x));
        let (positions, indices) = (vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2]);
        let mesh = Mesh { positions, indices, ..Mesh::default() };
        let steel = Material { name: Some("steel".into()), ..opaque() };
        let mut scene = SceneBuilder::new().mesh_of(mesh, steel, &places).build();
        scene.nodes[1].name = Some("shell_a".into());
        scene.nodes[2].name = Some("shell_b".into());
        scene
    }

    #[test]
    fn some_nodes_of_a_mesh_are_left_out_and_the_others_keep_it() {
        let mut scene = three();
        let materials = scene.materials.len();
        leave_out(&mut scene, &["shell_*"]).unwrap();
        let alphas = [0, 1, 2].map(|instance| scene.material(instance).alpha);
        assert_eq!(alphas, [Alpha::Opaque, Alpha::Invisible, Alpha::Invisible]);
        assert_eq!(scene.instances.iter().map(|i| i.mesh).collect::<Vec<_>>(), [0, 1, 1]);
        assert_eq!(scene.meshes[0].positions, scene.meshes[1].positions);
        leave_out(&mut scene, &["node:0"]).unwrap();
        assert_eq!(scene.material(0).alpha, Alpha::Invisible);
        assert_eq!((scene.meshes.len(), scene.materials.len()), (2, materials + 1));
    }

    #[test]
    fn a_material_left_out_is_air_and_an_unknown_one_is_named() {
        let shell = Material { name: Some("shell".into()), ..opaque() };
        let mut scene = SceneBuilder::new().soup_of(&block(Vec3::ZERO, Vec3::ONE), shell).build();
        leave_out(&mut scene, &["shell"]).unwrap();
        assert_eq!(scene.material(0).alpha, Alpha::Invisible);
        let message = leave_out(&mut scene, &["hull"]).unwrap_err().to_string();
        assert!(message.contains("hull") && message.contains("shell"), "{message}");
    }

    #[test]
    fn wishes_change_the_roles_of_what_they_name() {
        let mut scene = three();
        let wishes = ObjectWishes {
            no_cast: vec!["shell_a".into()],
            no_receive: vec!["node:2".into()],
            density: vec![("steel".into(), 4.0), ("node:0".into(), 40.0)],
            ..ObjectWishes::default()
        };
        wishes.apply_to(&mut scene).unwrap();
        let role =
            |casts, receives, density| Role { casts, receives, texels_per_metre: Some(density), ..Role::default() };
        let roles: Vec<Role> = scene.instances.iter().map(|instance| instance.role).collect();
        assert_eq!(roles, [role(true, true, 40.0), role(false, true, 4.0), role(true, false, 4.0)]);
        assert_eq!(
            [0, 1, 2].map(|i| (scene.casts(i), scene.receives(i))),
            [(true, true), (false, true), (true, false)]
        );
    }

    #[test]
    fn contradictions_are_told_in_one_line() {
        let wishes = |leave_out: &str, no_receive: &str, density: &[(&str, f64)]| ObjectWishes {
            leave_out: leave_out.split_whitespace().map(Into::into).collect(),
            no_receive: no_receive.split_whitespace().map(Into::into).collect(),
            density: density.iter().map(|&(name, density)| (name.into(), density)).collect(),
            ..ObjectWishes::default()
        };
        for (wishes, expected) in [
            (wishes("steel", "shell_a", &[]), "\"shell_a\" is left out"),
            (wishes("", "steel", &[("shell_*", 3.0)]), "no texels"),
            (wishes("", "", &[("steel", 3.0), ("steel", 4.0)]), "3 and 4 texels"),
            (wishes("", "", &[("steel", -1.0)]), "from 0.000001"),
            (wishes("", "", &[("wood", 1.0)]), "\"wood\" to give a density; it has materials steel"),
            (wishes("node:99", "", &[]), "no node:99 to leave out; it has 3 nodes, node:0 to node:2"),
            (wishes("", "mesh:1", &[]), "no mesh:1 to free of shadows on it; it has 1 mesh, mesh:0"),
        ] {
            let message = wishes.apply_to(&mut three()).unwrap_err().to_string();
            assert!(message.contains(expected) && !message.contains('\n'), "{message}");
        }
        let some_are_left = wishes("shell_a", "shell_*", &[]);
        assert_eq!(some_are_left.apply_to(&mut three()), Ok(()));
    }
}
