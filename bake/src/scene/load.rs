//! Loads a file into a [`Scene`]. Each step has a module of its own.

use super::{
    Dropped, Instance, LoadError, LoadLimits, Mesh, Role, Scene, SceneCamera, Source,
    accessors::Reader,
    cameras, container,
    container::Container,
    document::Document,
    file::SceneFile,
    images,
    limits::{MemoryBudget, WarningLog},
    materials, nodes,
    nodes::NodeTree,
    primitives::{self, DrawnMeshes},
    refuse,
    resources::{Buffers, Fetcher},
    roles,
};
use glam::{DMat4, DVec3};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::Arc,
};

/// Loads a glTF or GLB file.
///
/// # Errors
///
/// If the file cannot be read, is not glTF 2, contradicts itself in data that shadows depend on, requires an
/// unsupported extension, names files outside its folder, needs more memory than `limits` allow, or draws no triangles.
/// Problems that affect only the look are [`Scene::warnings`].
pub fn load(path: &Path, limits: &LoadLimits) -> Result<Scene, LoadError> {
    let budget = MemoryBudget::new(limits);
    let bytes = container::read_file(path, &budget, CHECK_PATH)?;
    parse_within(path, &Arc::new(bytes), &budget, Pictures::Read)
}

/// Loads a glTF or GLB file without its pictures, wherever they lie: what it has to name, and its geometry. Surfaces
/// have the alpha of their factors and vertices alone.
///
/// # Errors
///
/// As [`load`], but for pictures.
pub fn load_without_pictures(path: &Path, limits: &LoadLimits) -> Result<Scene, LoadError> {
    let budget = MemoryBudget::new(limits);
    let bytes = container::read_file(path, &budget, CHECK_PATH)?;
    parse_within(path, &Arc::new(bytes), &budget, Pictures::Skip)
}

/// What to do about a scene that cannot be read.
const CHECK_PATH: &str = "check the path and its permissions";

/// Whether images are read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pictures {
    Read,
    Skip,
}

/// Reads the bytes of a glTF or GLB file. Messages name it by `path`, and files that it names are looked for beside
/// that.
///
/// # Errors
///
/// As [`load`].
pub fn parse(path: &Path, bytes: &[u8], limits: &LoadLimits) -> Result<Scene, LoadError> {
    parse_within(path, &Arc::new(bytes.to_vec()), &MemoryBudget::new(limits), Pictures::Read)
}

fn parse_within(
    path: &Path,
    bytes: &Arc<Vec<u8>>,
    budget: &MemoryBudget,
    wanted: Pictures,
) -> Result<Scene, LoadError> {
    let Container { json, binary } = Container::parse(path, bytes, budget)?;
    let doc = Document { root: json };
    refuse::check_required(&doc)?;
    let mut log = WarningLog::default();
    let mut fetcher = Fetcher::new(path, bytes, budget);
    let buffers = Buffers::read(&doc, bytes, binary.as_ref(), &mut fetcher);
    let reader = Reader { doc: &doc, buffers: &buffers, budget };
    let tree = nodes::read(reader, &mut log)?;
    let mut drawn = primitives::read(reader, &tree, &mut log)?;
    let triangle_count: u64 = drawn.draws.iter().map(|&(_, mesh)| triangle_count(&drawn, mesh)).sum();
    budget.take(triangle_count, BYTES_PER_TRIANGLE, || format!("placing {triangle_count} triangles"))?;
    let bounds = keep_placeable(&mut drawn, &tree, &mut log);
    let Some(bounds) = bounds else { return Err(no_triangles(path, &drawn, log)) };
    let drafts = materials::read(&doc, &mut drawn, &mut log)?;
    let (needed, pictures) = match wanted {
        Pictures::Read => (materials::needed_images(&drafts), images::fetch(&doc, &mut fetcher)),
        Pictures::Skip => Default::default(),
    };
    let (images, decoded) = images::read(&doc, &buffers, &pictures, budget, &needed)?;
    let materials = materials::finish(drafts, &decoded, &drawn, &mut log)?;
    if doc.root.get("animations").is_some() {
        log.warn("they are not played; every node has its rest pose", "animations");
    }
    let centre_m = bounds.rounded_centre();
    let cameras: Vec<SceneCamera> = cameras::read(&doc, &tree, centre_m, &mut log);
    let sun_direction = cameras::sun_direction(&doc, &tree);
    let mut scene = Scene {
        source: source(path, fetcher),
        instances: drawn.draws.iter().map(|&draw| instance(&tree, draw, centre_m)).collect(),
        sun_direction,
        nodes: tree.nodes,
        meshes: drawn.meshes,
        materials,
        images,
        cameras,
        centre_m,
        half_extent_m: (bounds.high - bounds.low) * 0.5,
        dropped: drawn.dropped,
        warnings: log.into_warnings(),
        file: None,
    };
    roles::read(&doc, &mut scene)?;
    scene.file = Some(Arc::new(SceneFile::new(doc, buffers, pictures)));
    Ok(scene)
}

/// Memory that a drawn triangle takes in geometry and BVH.
const BYTES_PER_TRIANGLE: u64 = 128;

/// Largest coordinate: beyond it, products in `f32` overflow while tracing.
const FARTHEST_M: f64 = 1e15;

fn triangle_count(drawn: &DrawnMeshes, mesh: usize) -> u64 {
    drawn.meshes.get(mesh).map_or(0, |mesh| mesh.triangle_count() as u64)
}

fn source(path: &Path, fetcher: Fetcher) -> Source {
    let file_name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Source { file_name, sha256: fetcher.into_sha256() }
}

fn no_triangles(path: &Path, drawn: &DrawnMeshes, log: WarningLog) -> LoadError {
    let Dropped { repeated_index, zero_area, non_finite } = drawn.dropped;
    let counted = [(repeated_index, "repeat an index"), (zero_area, "have no area"), (non_finite, "are not finite")];
    let dropped = counted.iter().filter(|(count, _)| *count > 0);
    let mut reasons: Vec<String> = dropped.map(|(count, what)| format!("{count} of its triangles {what}")).collect();
    reasons.extend(log.into_warnings().iter().take(3).map(ToString::to_string));
    if reasons.is_empty() {
        reasons.push("no node of its default scene draws a mesh; put its meshes under nodes of that scene".into());
    }
    LoadError::NoTriangles { path: path.to_owned(), cause: reasons.join("; ") }
}

/// A bounding box in world space, in metres.
#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    fn of(mesh: &Mesh, world_from_object: &DMat4) -> Self {
        let empty = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        mesh.positions.iter().fold(empty, |b, p| {
            let p = world_from_object.transform_point3(p.as_dvec3());
            Self { low: b.low.min(p), high: b.high.max(p) }
        })
    }

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn is_placeable(self) -> bool {
        self.low.is_finite() && self.high.is_finite() && self.low.abs().max(self.high.abs()).max_element() < FARTHEST_M
    }

    /// The centre, rounded to a power of two near a thousandth of the scene's size. The subtraction of such a number is
    /// exact, and a scene moved by whole metres is baked from the same numbers.
    fn rounded_centre(self) -> DVec3 {
        let size = (self.high - self.low).max_element().max(f64::MIN_POSITIVE);
        let step = (size.log2().floor() - 10.0).exp2();
        let centre = (self.low + self.high) * 0.5;
        // Adding zero turns -0 into 0.
        let rounded = (centre / step).round() * step + DVec3::ZERO;
        if rounded.is_finite() { rounded } else { centre }
    }
}

/// Removes draws whose coordinates overflow, then meshes that nothing draws. Returns the bounds of the rest; `None` if
/// nothing is left.
fn keep_placeable(drawn: &mut DrawnMeshes, tree: &NodeTree, log: &mut WarningLog) -> Option<Bounds> {
    let mut all: Option<Bounds> = None;
    let DrawnMeshes { draws, meshes, .. } = drawn;
    draws.retain(|&(node, mesh)| {
        let Some((placed, mesh)) = tree.nodes.get(node).zip(meshes.get(mesh)) else { return false };
        let bounds = Bounds::of(mesh, &placed.world_from_node);
        if bounds.is_placeable() {
            all = Some(all.map_or(bounds, |all| all.union(bounds)));
        } else {
            log.warn("its coordinates are beyond 1e15 m; left out", placed.name.clone().unwrap_or("a node".into()));
        }
        bounds.is_placeable()
    });
    drop_undrawn(drawn);
    all
}

fn drop_undrawn(drawn: &mut DrawnMeshes) {
    let kept: BTreeSet<usize> = drawn.draws.iter().map(|&(_, mesh)| mesh).collect();
    let new_from_old: BTreeMap<usize, usize> = kept.iter().enumerate().map(|(new, &old)| (old, new)).collect();
    let mut old = 0..;
    drawn.meshes.retain(|_| old.next().is_some_and(|old| kept.contains(&old)));
    let mut old = 0..;
    drawn.file_material.retain(|_| old.next().is_some_and(|old| kept.contains(&old)));
    for (_, mesh) in &mut drawn.draws {
        *mesh = new_from_old.get(mesh).copied().unwrap_or_default();
    }
}

fn instance(tree: &NodeTree, (node, mesh): (usize, usize), centre_m: DVec3) -> Instance {
    let mut bake_from_object = tree.nodes.get(node).map_or(DMat4::IDENTITY, |node| node.world_from_node);
    bake_from_object.w_axis -= centre_m.extend(0.0);
    Instance { node, mesh, bake_from_object, is_mirrored: bake_from_object.determinant() < 0.0, role: Role::default() }
}
