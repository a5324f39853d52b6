//! What hides the sun by mistake: sky domes, outline hulls, collision shells, water overhead.
//!
//! Such a thing makes a bake dark without an error, and the user should hear of it before the long part of the bake. So
//! some thousand rays go from points all over the scene to the sun along its path. A ray that nothing hides but one
//! object is light that the object alone takes away. An object that alone takes most of the light that the rest of the
//! scene would have is named; so is one that takes a little, if its name says what it is. Alpha masks count as solid
//! here, so what has one is never named.

use crate::scene::{Alpha, Geometry, Scene, label_of};
use crate::sun::SunPath;
use crate::trace::{Direction, Tracer};
use crate::warning::{Occluder, Warning};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Share of texels that never see the sun above which a user is asked whether a shell shades the scene.
const SUSPICIOUS_SHARE: f64 = 0.75;
/// Share of the others' light above which an object is named.
const NAMED_SHARE: f64 = 0.5;
/// The same for an object whose name says what it is.
const TELLING_SHARE: f64 = 0.02;
/// Least rays that an object alone must hide to be named. Without a telling name, also an eighth of all.
const LEAST_RAYS: usize = 12;
/// Points that rays start from.
const POINTS: usize = 2048;
/// Suns along the path that rays go to.
const SUNS: usize = 8;
/// Most objects that are named.
const MOST_NAMED: usize = 5;

/// Words in the names of what should not cast shadows.
const TELLING_WORDS: [&str; 20] = [
    "sky",
    "skydome",
    "skybox",
    "skysphere",
    "dome",
    "backdrop",
    "fog",
    "cloud",
    "clouds",
    "water",
    "ocean",
    "outline",
    "collision",
    "collider",
    "colonly",
    "convcolonly",
    "ucx",
    "ubx",
    "usp",
    "trigger",
];

/// A word to the user of a scene that is dark nearly everywhere.
pub(super) fn darkness_warning(dark_texels: u64, texels: u64) -> Option<Warning> {
    let share = dark_texels as f64 / (texels as f64).max(1.0);
    (share > SUSPICIOUS_SHARE).then_some(Warning::Dark { share })
}

/// Objects that alone hide much of the sun from the rest of the scene.
pub(super) fn occluder_warnings(scene: &Scene, geometry: &Geometry, tracer: &Tracer, path: &SunPath) -> Vec<Warning> {
    let suns: Vec<DVec3> =
        (0..SUNS).map(|index| path.direction((index as f64 + 0.5) / SUNS as f64)).filter(|sun| sun.y > 0.0).collect();
    let points = points(scene, geometry);
    let rays: Vec<Ray> = points
        .par_iter()
        .flat_map_iter(|point| suns.iter().filter_map(|&sun| Ray::trace(scene, geometry, tracer, point, sun)))
        .collect();
    let mut found = suspects(scene, &rays);
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found.truncate(MOST_NAMED);
    found.into_iter().map(Warning::Occluder).collect()
}

/// A point of a surface.
struct Point {
    triangle: u32,
    barycentric: [f64; 2],
}

/// Points over all that can be shaded, each instance's share by the fourth root of its area, so that a landscape
/// leaves some for a bench; the same points every time.
fn points(scene: &Scene, geometry: &Geometry) -> Vec<Point> {
    let area = |triangle: usize| {
        let [a, b, c] = geometry.triangles[triangle].map(|v| v.as_dvec3());
        if geometry.receives(scene, triangle) { (b - a).cross(c - a).length() } else { 0.0 }
    };
    let mut of_instance = vec![0.0; scene.instances.len()];
    (0..geometry.triangles.len()).for_each(|i| of_instance[geometry.instance[i] as usize] += area(i));
    let mut sum = 0.0;
    let weight = |triangle: usize| {
        let whole: f64 = of_instance[geometry.instance[triangle] as usize];
        if whole > 0.0 { area(triangle) / whole.powf(0.75) } else { 0.0 }
    };
    let below: Vec<f64> = (0..geometry.triangles.len())
        .map(|triangle| {
            sum += weight(triangle);
            sum
        })
        .collect();
    if sum <= 0.0 {
        return Vec::new();
    }
    let place = |k: usize| {
        let target = (k as f64 + 0.5) / POINTS as f64 * sum;
        let triangle = below.partition_point(|&area| area <= target).min(below.len() - 1) as u32;
        // Two golden sections make the R2 sequence of M. Roberts, folded over the diagonal into a triangle.
        let [u, v] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step| (k as f64 * step).fract());
        Point { triangle, barycentric: if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] } }
    };
    (0..POINTS).map(place).collect()
}

/// A ray towards the sun.
struct Ray {
    /// The instance that it starts from.
    from: u32,
    /// The instances that hide the sun from it, each once.
    hidden_by: BTreeSet<u32>,
}

impl Ray {
    /// `None` if the surface turns away from the sun.
    fn trace(scene: &Scene, geometry: &Geometry, tracer: &Tracer, point: &Point, sun: DVec3) -> Option<Self> {
        let from = geometry.instance[point.triangle as usize];
        let front = geometry.normal(point.triangle as usize);
        let is_front = front.dot(sun) > 0.0;
        if !is_front && !scene.material(from as usize).is_double_sided {
            return None;
        }
        let side = if is_front { front } else { -front };
        let origin_m = tracer.lift(geometry.point(point.triangle as usize, point.barycentric), side, point.triangle);
        let mut hidden_by = BTreeSet::new();
        tracer.for_each_hit(origin_m, &Direction::new(sun), |triangle, _| {
            hidden_by.insert(geometry.instance[triangle as usize]);
        });
        Some(Self { from, hidden_by })
    }
}

/// What might be one mistake: all that has one material, or one instance.
struct Group {
    instances: BTreeSet<u32>,
    /// Rays of others that it alone hides.
    alone: usize,
    /// Rays of others that nothing hides.
    free: usize,
    /// All rays of others.
    others: usize,
}

impl Group {
    fn new(instances: BTreeSet<u32>, rays: &[Ray]) -> Self {
        let mut group = Self { instances, alone: 0, free: 0, others: 0 };
        for ray in rays.iter().filter(|ray| !group.instances.contains(&ray.from)) {
            group.others += 1;
            group.free += usize::from(ray.hidden_by.is_empty());
            group.alone += usize::from(!ray.hidden_by.is_empty() && ray.hidden_by.is_subset(&group.instances));
        }
        group
    }

    /// Share of the light of others that it takes.
    fn share(&self) -> f64 {
        self.alone as f64 / ((self.alone + self.free) as f64).max(1.0)
    }

    fn is_suspicious(&self, is_telling: bool) -> bool {
        let (least, share) = match is_telling {
            true => (LEAST_RAYS, TELLING_SHARE),
            false => (LEAST_RAYS.max(self.others / 8), NAMED_SHARE),
        };
        self.alone >= least && self.share() >= share
    }
}

fn suspects(scene: &Scene, rays: &[Ray]) -> Vec<Occluder> {
    let hiding: BTreeSet<u32> = rays.iter().flat_map(|ray| ray.hidden_by.iter().copied()).collect();
    let mut of_material: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
    for (index, instance) in scene.instances.iter().enumerate().filter(|(index, _)| scene.casts(*index)) {
        of_material.entry(scene.meshes[instance.mesh].material).or_default().insert(index as u32);
    }
    let mut named = BTreeSet::new();
    let mut found = Vec::new();
    // Single objects first: a material that more than the mistake has would take away too much.
    let single = hiding.iter().map(|&index| BTreeSet::from([index]));
    let several = of_material.into_values().filter(|all| all.len() > 1 && !all.is_disjoint(&hiding));
    for instances in single.chain(several) {
        let has_mask = |&index: &u32| matches!(scene.material(index as usize).alpha, Alpha::Mask { .. });
        if instances.iter().any(has_mask) || !instances.is_disjoint(&named) {
            continue;
        }
        let group = Group::new(instances, rays);
        // A water tank does not make all galvanised iron water.
        let is_telling = group.instances.iter().all(|&index| is_telling(scene, index as usize));
        if group.is_suspicious(is_telling) {
            named.extend(&group.instances);
            let (object, name) = label_of(scene, &group.instances);
            found.push(Occluder { object, name, share: group.share() });
        }
    }
    found
}

/// Whether a name of an instance says that it should cast nothing.
fn is_telling(scene: &Scene, index: usize) -> bool {
    let instance = &scene.instances[index];
    let names = [&scene.nodes[instance.node].name, &scene.meshes[instance.mesh].name, &scene.material(index).name];
    names.into_iter().flatten().any(|name| words(name).iter().any(|word| TELLING_WORDS.contains(&word.as_str())))
}

/// The words of a name, in small letters: `SkySphere_2` has the words `sky`, `sphere` and `skysphere`.
fn words(name: &str) -> Vec<String> {
    let mut words = Vec::new();
    for part in name.split(|c: char| !c.is_alphabetic()).filter(|part| !part.is_empty()) {
        let mut word = String::new();
        let mut was_small = false;
        for letter in part.chars() {
            if letter.is_uppercase() && was_small {
                words.push(std::mem::take(&mut word));
            }
            was_small = letter.is_lowercase();
            word.extend(letter.to_lowercase());
        }
        words.push(word);
        words.push(part.to_lowercase());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;
    use crate::sun::{self, DayOutcome, DayRequest};
    use crate::testing::{SceneBuilder, block, floor, opaque};
    use glam::{Vec2, Vec3};

    fn found(scene: &Scene) -> Vec<(String, f64)> {
        let geometry = Geometry::new(scene);
        let tracer = Tracer::new(scene, &geometry);
        let request = DayRequest::new(Some([48.2, 16.4]), None).unwrap();
        let DayOutcome::Path(path) = sun::day(&request).unwrap() else { panic!("a summer's day has a sun") };
        let name = |warning| match warning {
            Warning::Occluder(Occluder { name, share, .. }) => (name, share),
            other => panic!("{other}"),
        };
        occluder_warnings(scene, &geometry, &tracer, &path).into_iter().map(name).collect()
    }

    fn named(name: &str) -> Material {
        Material { name: Some(name.into()), ..opaque() }
    }

    fn yard() -> SceneBuilder {
        let ground = floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0);
        SceneBuilder::new()
            .soup_of(&ground, named("ground"))
            .soup_of(&block(Vec3::new(-0.5, 0.0, -0.5), Vec3::new(0.5, 1.0, 0.5)), named("crate"))
    }

    #[test]
    fn an_open_yard_has_nothing_to_name() {
        assert_eq!(found(&yard().build()), []);
        assert_eq!(found(&SceneBuilder::new().build()), []);
    }

    /// B21.
    #[test]
    fn a_dome_is_named_whatever_it_is_called_and_a_shell_if_its_name_tells() {
        let dome = block(Vec3::splat(-50.0), Vec3::splat(50.0));
        assert_eq!(found(&yard().soup_of(&dome, named("d")).build()), [("d".to_owned(), 1.0)]);
        let mut nameless = yard().soup(&dome).build();
        nameless.nodes[2].gltf = 7;
        assert_eq!(found(&nameless), [("node:7".to_owned(), 1.0)]);
        let shell = block(Vec3::new(-1.2, 0.0, -1.2), Vec3::new(1.2, 2.0, 1.2));
        let telling = found(&yard().soup_of(&shell, named("crate_Collision.001")).build());
        assert_eq!(telling[0].0, "crate_Collision.001");
        assert_eq!(found(&yard().soup_of(&shell, named("cupboard")).build()), []);
    }

    #[test]
    fn a_material_is_named_for_the_names_of_objects_only_if_all_of_them_tell() {
        // Two shells in one place: neither alone hides anything.
        let shell = block(Vec3::new(-1.2, 0.0, -1.2), Vec3::new(1.2, 2.0, 1.2));
        let mut scene = yard().soup_of(&shell, named("iron")).soup_of(&shell, named("iron")).build();
        scene.meshes[3].material = scene.meshes[2].material;
        scene.nodes[2].name = Some("water".into());
        assert_eq!(found(&scene), []);
        scene.nodes[3].name = Some("water.001".into());
        assert_eq!(found(&scene)[0].0, "iron");
    }

    #[test]
    fn words_are_told_apart_by_signs_and_capitals() {
        for (name, telling) in [
            ("SkySphere", true),
            ("sky_01", true),
            ("UCX_crate", true),
            ("crate-colonly", true),
            ("Water.002", true),
            ("Skylight", false),
            ("column", false),
            ("canopy_col_2", false),
            ("whisky", false),
            ("", false),
        ] {
            assert_eq!(words(name).iter().any(|word| TELLING_WORDS.contains(&word.as_str())), telling, "{name}");
        }
    }

    #[test]
    fn only_scenes_that_are_dark_nearly_everywhere_are_remarked_on() {
        assert_eq!(darkness_warning(70, 100), None);
        assert_eq!(darkness_warning(0, 0), None);
        assert!(darkness_warning(90, 100).is_some_and(|w| w.to_string().contains("90 %") && w.remedy().is_some()));
    }
}
