//! From a file to a [`Scene`]: the flow of loading, one step a module.

use super::{
    Camera, Instance, LoadError, LoadLimits, Mesh, Scene, Source,
    accessors::Reader,
    cameras, container,
    container::Container,
    document::Document,
    images,
    limits::{Budget, Log},
    materials, nodes,
    nodes::Tree,
    primitives::{self, Drawn},
    refuse,
    resources::{Buffers, Fetcher},
};
use glam::{DMat4, DVec3};
use std::path::Path;

/// Loads a glTF or GLB file.
///
/// # Errors
///
/// Where the file cannot be read, is no glTF 2, contradicts itself in something that shadows depend on, requires an
/// extension that is not supported, names files outside its folder, needs more memory than `limits` allow, or draws no
/// triangles. What touches only the look is a warning in [`Scene::warnings`].
pub fn load(path: &Path, limits: &LoadLimits) -> Result<Scene, LoadError> {
    let budget = Budget::new(limits);
    let bytes = container::read_file(path, &budget, "check the path and its permissions")?;
    let Container { json, binary } = Container::parse(path, &bytes, &budget)?;
    let doc = Document { root: json };
    refuse::check_required(&doc)?;
    let mut log = Log::default();
    let mut fetcher = Fetcher::new(path, &bytes, &budget);
    let buffers = Buffers::read(&doc, binary, &mut fetcher)?;
    let tree = nodes::read(&doc, &mut log)?;
    let reader = Reader { doc: &doc, buffers: &buffers, budget: &budget };
    let mut drawn = primitives::read(reader, &tree, &mut log)?;
    let bounds = keep_placeable(&mut drawn, &tree, &mut log);
    let Some(bounds) = bounds else { return Err(no_triangles(path, &drawn, log)) };
    let triangle_count: u64 = drawn.draws.iter().map(|&(_, mesh)| triangle_count(&drawn, mesh)).sum();
    budget.take(triangle_count, BYTES_PER_TRIANGLE, || format!("placing {triangle_count} triangles"))?;
    let drafts = materials::read(&doc, &mut drawn, &mut log)?;
    let needed = materials::needed_images(&drafts);
    let (images, decoded) = images::read(&doc, &buffers, &mut fetcher, &budget, &needed)?;
    let materials = materials::finish(drafts, &decoded, &drawn, &mut log)?;
    if doc.root.get("animations").is_some() {
        log.warn("they are not played; every node stands where the file puts it", "animations");
    }
    let centre_m = bounds.rounded_centre();
    let cameras: Vec<Camera> = cameras::read(&doc, &tree, centre_m, &mut log);
    Ok(Scene {
        source: source(path, fetcher),
        instances: drawn.draws.iter().map(|&draw| instance(&tree, draw, centre_m)).collect(),
        sun_direction: cameras::sun_direction(&doc, &tree),
        nodes: tree.nodes,
        meshes: drawn.meshes,
        materials,
        images,
        cameras,
        centre_m,
        half_extent_m: (bounds.high - bounds.low) * 0.5,
        dropped: drawn.dropped,
        warnings: log.into_sentences(),
    })
}

/// What a drawn triangle takes later on, in geometry and BVH.
const BYTES_PER_TRIANGLE: u64 = 128;

/// Coordinates beyond this cannot be multiplied in `f32`, which tracing does.
const FARTHEST_M: f64 = 1e15;

fn triangle_count(drawn: &Drawn, mesh: usize) -> u64 {
    drawn.meshes.get(mesh).map_or(0, |mesh| mesh.triangle_count() as u64)
}

fn source(path: &Path, fetcher: Fetcher) -> Source {
    let file_name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Source { file_name, sha256: fetcher.into_sha256() }
}

fn no_triangles(path: &Path, drawn: &Drawn, log: Log) -> LoadError {
    let mut reasons = log.into_sentences();
    reasons.truncate(3);
    let dropped = drawn.dropped;
    if dropped.total() > 0 {
        reasons.push(format!(
            "of {} triangles {} repeat an index, {} have no area and {} are not finite",
            dropped.total(),
            dropped.repeated_index,
            dropped.zero_area,
            dropped.non_finite
        ));
    }
    if reasons.is_empty() {
        reasons.push("no node of its scene draws a mesh".into());
    }
    LoadError::NoTriangles { path: path.to_owned(), cause: reasons.join("; ") }
}

/// A box in world space.
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
        let rounded = (centre / step).round() * step;
        if rounded.is_finite() { rounded } else { centre }
    }
}

/// Leaves out draws whose coordinates overflow, then meshes without a draw. The bounds of what is left, if anything is.
fn keep_placeable(drawn: &mut Drawn, tree: &Tree, log: &mut Log) -> Option<Bounds> {
    let mut all: Option<Bounds> = None;
    let Drawn { draws, meshes, .. } = drawn;
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

fn drop_undrawn(drawn: &mut Drawn) {
    let mut new_from_old = vec![None; drawn.meshes.len()];
    drawn.draws.iter().for_each(|&(_, mesh)| new_from_old[mesh] = Some(0));
    let mut count = 0;
    for slot in new_from_old.iter_mut().flatten() {
        *slot = count;
        count += 1;
    }
    let mut keep = new_from_old.iter().map(Option::is_some);
    drawn.meshes.retain(|_| keep.next().unwrap_or(true));
    let mut keep = new_from_old.iter().map(Option::is_some);
    drawn.file_material.retain(|_| keep.next().unwrap_or(true));
    drawn.draws.iter_mut().for_each(|(_, mesh)| *mesh = new_from_old[*mesh].unwrap_or_default());
}

fn instance(tree: &Tree, (node, mesh): (usize, usize), centre_m: DVec3) -> Instance {
    let mut bake_from_object = tree.nodes.get(node).map_or(DMat4::IDENTITY, |node| node.world_from_node);
    bake_from_object.w_axis -= centre_m.extend(0.0);
    Instance { node, mesh, bake_from_object, is_mirrored: bake_from_object.determinant() < 0.0 }
}
