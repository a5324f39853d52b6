//! `sunbake inspect SCENE`: what a scene has to name.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use sunbake::console::{Failure, print, print_json, warn};
use sunbake::scene::{LoadLimits, Role, Scene, load, load_without_pictures};
use sunbake::words::{counted, either};

/// A material, node or mesh.
#[derive(Debug, Serialize)]
struct NamedPart {
    /// What selects it, whatever it is called: `node:12`.
    index: String,
    name: Option<String>,
    /// Triangles that are drawn with it: of a node, those below it included.
    triangles: usize,
    /// What it does with light, where that is not the same as for most.
    role: Vec<String>,
}

/// What a scene has to name.
#[derive(Debug, Serialize)]
struct SceneParts {
    nodes: Vec<NamedPart>,
    meshes: Vec<NamedPart>,
    materials: Vec<NamedPart>,
}

/// Prints what a scene has to name, as text or JSON.
pub fn run(file: &Path, as_json: bool) -> Result<(), Failure> {
    let scene = load_what_can_be(file)?;
    let parts = parts(&scene);
    if as_json {
        return print_json(&parts);
    }
    let extent_m = 2.0 * scene.half_extent_m;
    let mut text = format!(
        "{}: {}, {:.1} x {:.1} x {:.1} m\n",
        file.display(),
        counted(scene.triangle_count() as u64, "triangle"),
        extent_m.x,
        extent_m.y,
        extent_m.z
    );
    for (kind, parts) in [("nodes", &parts.nodes), ("meshes", &parts.meshes), ("materials", &parts.materials)] {
        // Writing to a string does not fail.
        let _ = writeln!(text, "\n{kind}");
        for NamedPart { index, name, triangles, role } in parts {
            let name = name.as_deref().unwrap_or("-");
            let _ = writeln!(
                text,
                "  {index:<14}{name:<32}{triangles:>9} {:<11}{}",
                either(*triangles as u64, "triangle", "triangles"),
                role.join(", ")
            );
        }
    }
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    print(&(lines.join("\n") + "\n"))
}

/// The scene; where its pictures stop it from being read, without them, and a line that says so.
fn load_what_can_be(file: &Path) -> Result<Scene, Failure> {
    let limits = LoadLimits::default();
    let error = match load(file, &limits) {
        Ok(scene) => return Ok(scene),
        Err(error) => error,
    };
    match load_without_pictures(file, &limits) {
        Ok(scene) => {
            warn(&format!("{error}; listed all the same, without what pictures say of transparency"));
            Ok(scene)
        }
        // Something else stops it.
        Err(_) => Err(error.into()),
    }
}

/// What drawn instances have in common.
#[derive(Clone, Copy)]
struct Common {
    instances: usize,
    triangles: usize,
    is_left_out: bool,
    is_clear: bool,
    role: Option<Role>,
}

impl Common {
    const NOTHING: Self = Self { instances: 0, triangles: 0, is_left_out: true, is_clear: true, role: None };

    fn of(scene: &Scene, instance: usize) -> Self {
        let material = scene.material(instance);
        Self {
            instances: 1,
            triangles: scene.meshes[scene.instances[instance].mesh].triangle_count(),
            is_left_out: !scene.is_there(instance),
            is_clear: material.is_clear,
            role: Some(scene.instances[instance].role),
        }
    }

    fn with(self, other: Self) -> Self {
        let common = |a: Option<f64>, b: Option<f64>| a.filter(|_| a == b);
        let role = match (self.role, other.role) {
            (Some(a), Some(b)) => Some(Role {
                casts: a.casts || b.casts,
                receives: a.receives || b.receives,
                texels_per_metre: common(a.texels_per_metre, b.texels_per_metre),
                texels_per_metre_around: common(a.texels_per_metre_around, b.texels_per_metre_around),
            }),
            (a, b) => a.or(b),
        };
        Self {
            instances: self.instances + other.instances,
            triangles: self.triangles + other.triangles,
            is_left_out: self.is_left_out && other.is_left_out,
            is_clear: self.is_clear && other.is_clear,
            role,
        }
    }

    /// What most surfaces have not.
    fn words(&self) -> Vec<String> {
        let Some(role) = self.role else { return vec!["draws nothing".into()] };
        if self.is_left_out {
            return vec!["left out".into()];
        }
        let words = [
            self.is_clear.then(|| "lets light through".to_owned()),
            (!role.casts).then(|| "casts no shadow".to_owned()),
            (!role.receives).then(|| "takes no shadow".to_owned()),
            role.texels_per_metre.map(|density| format!("{density} texels a metre")),
            role.texels_per_metre_around.map(|density| format!("{density} texels a metre around it")),
        ];
        words.into_iter().flatten().collect()
    }

    fn named(&self, index: String, name: &Option<String>) -> NamedPart {
        NamedPart { index, name: name.clone(), triangles: self.triangles, role: self.words() }
    }
}

fn parts(scene: &Scene) -> SceneParts {
    let mut of_node = vec![Common::NOTHING; scene.nodes.len()];
    let mut of_mesh: BTreeMap<usize, (&Option<String>, Common)> = BTreeMap::new();
    let mut of_material: BTreeMap<usize, (&Option<String>, Common)> = BTreeMap::new();
    for (index, instance) in scene.instances.iter().enumerate() {
        let common = Common::of(scene, index);
        let (mesh, material) = (&scene.meshes[instance.mesh], scene.material(index));
        of_node[instance.node] = of_node[instance.node].with(common);
        let of_mesh = of_mesh.entry(mesh.gltf.0).or_insert((&mesh.name, Common::NOTHING));
        of_mesh.1 = of_mesh.1.with(common);
        if let Some(gltf) = material.gltf {
            let of_material = of_material.entry(gltf).or_insert((&material.name, Common::NOTHING));
            of_material.1 = of_material.1.with(common);
        }
    }
    // Parents come before their children.
    for node in (0..scene.nodes.len()).rev() {
        if let Some(parent) = scene.nodes[node].parent {
            of_node[parent] = of_node[parent].with(of_node[node]);
        }
    }
    let nodes = scene.nodes.iter().zip(&of_node).filter(|(node, _)| !node.is_copy(&scene.nodes));
    let listed = |kind: &str, all: BTreeMap<usize, (&Option<String>, Common)>| {
        all.into_iter().map(|(index, (name, common))| common.named(format!("{kind}:{index}"), name)).collect()
    };
    SceneParts {
        nodes: nodes.map(|(node, common)| common.named(format!("node:{}", node.gltf), &node.name)).collect(),
        meshes: listed("mesh", of_mesh),
        materials: listed("material", of_material),
    }
}
