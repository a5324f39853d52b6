//! Cuts a mesh into charts and flattens them.
//!
//! Theory: segmentation into charts within a normal cone, each flattened by least squares conformal maps (Lévy et al.,
//! 2002) and as-rigid-as-possible refinement (Liu et al., 2008). The `uvunwrap` crate does this.
//!
//! Practice:
//! * A mesh is unwrapped once, independent of its size on any page; meshes are unwrapped in parallel and the work can
//!   be cancelled. Charts are measured here and packed by [`super::arrange`].
//! * Positions are taken relative to the middle of the mesh in `f64` and scaled by a power of two to a size of about
//!   one, so that map coordinates lose no digits and absolute epsilons have no effect.
//! * A height field (all normals well within 90 degrees of one axis) is flattened by projection: least squares on a
//!   terrain of 100,000 triangles takes half a minute and gives no better result. Other large meshes get a limit on
//!   chart area, because the solver's time grows faster than the chart.
//! * Triangles too thin for `f32` texture coordinates collapse onto a corner of a neighbour. If unwrapping fails, every
//!   triangle becomes a chart.

use crate::scene::Mesh;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use uvunwrap::{Density, Error, MeshInput, Options, OutputMesh, Packing};

/// Least number of triangles for the height field test.
const HEIGHT_FIELD_TRIANGLES: usize = 1_000;
/// Least cosine between a height field's axis and its triangles' normals: texels stretch by at most its inverse.
const HEIGHT_FIELD_COS: f64 = 0.2;
/// Approximate number of triangles in a chart of a large mesh.
const CHART_TRIANGLES: usize = 4_000;

/// Marks a vertex without a chart.
const NO_CHART: u32 = u32::MAX;
/// Approximate bound on the pairs compared to find the nearest charted vertex of uncharted ones.
const NEAREST_WORK: usize = 100_000_000;

/// A mesh cut into charts, each flattened in its own frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Charts {
    /// For each new vertex, the mesh vertex it copies.
    pub vertices: Vec<u32>,
    /// Three per triangle of the mesh, in its order, into `vertices`.
    pub indices: Vec<u32>,
    /// For each new vertex, its position in its chart's bounding box, in units of object space from the box's corner.
    pub points: Vec<DVec2>,
    /// For each new vertex, its chart.
    pub chart_of: Vec<u32>,
    /// Size of each chart's bounding box, in units of object space.
    pub sizes: Vec<DVec2>,
    /// Texels a metre of each chart, if not those of its instance. Empty where no chart has its own.
    own_densities: Vec<Option<f64>>,
    /// Triangles, sorted by chart.
    by_chart: Vec<u32>,
    /// Where each chart's triangles start in `by_chart`; one more at the end.
    first_of: Vec<u32>,
}

impl Charts {
    /// The triangles of a chart, as triples into `points`.
    pub fn triangles_of(&self, chart: usize) -> impl Iterator<Item = [u32; 3]> {
        let range = self.first_of[chart] as usize..self.first_of[chart + 1] as usize;
        self.by_chart[range].iter().map(|&t| [0, 1, 2].map(|k| self.indices[3 * t as usize + k]))
    }

    /// Whether some chart has a density of its own.
    pub fn has_own_densities(&self) -> bool {
        !self.own_densities.is_empty()
    }

    /// Texels a metre of a chart, if not those of its instance.
    pub fn own_density(&self, chart: usize) -> Option<f64> {
        self.own_densities.get(chart).copied().flatten()
    }

    /// Area of the flattened triangles of each chart, in square units of object space.
    pub fn areas(&self) -> impl Iterator<Item = f64> {
        (0..self.sizes.len()).map(|chart| {
            let area = |t: [u32; 3]| {
                let [a, b, c] = t.map(|k| self.points[k as usize]);
                (b - a).perp_dot(c - a).abs() * 0.5
            };
            self.triangles_of(chart).map(area).sum()
        })
    }

    /// Adds the charts of some of the mesh's triangles, which were unwrapped apart.
    fn append(&mut self, part: Self, triangles: &[usize], own_density: Option<f64>) {
        let (first_vertex, first_chart) = (self.vertices.len() as u32, self.sizes.len() as u32);
        for (&triangle, corners) in triangles.iter().zip(part.indices.chunks_exact(3)) {
            let whole = &mut self.indices[3 * triangle..3 * triangle + 3];
            whole.iter_mut().zip(corners).for_each(|(index, corner)| *index = first_vertex + corner);
        }
        self.vertices.extend(part.vertices);
        self.points.extend(part.points);
        self.chart_of.extend(part.chart_of.into_iter().map(|chart| first_chart + chart));
        self.own_densities.extend(part.sizes.iter().map(|_| own_density));
        self.sizes.extend(part.sizes);
    }

    /// Sorts triangles by chart.
    fn sorted(mut self) -> Self {
        let chart = |t: &u32| self.chart_of[self.indices[3 * *t as usize] as usize];
        let mut by_chart: Vec<u32> = (0..self.indices.len() as u32 / 3).collect();
        by_chart.sort_by_key(chart);
        let first_of = (0..=self.sizes.len() as u32).map(|c| by_chart.partition_point(|t| chart(t) < c) as u32);
        (self.first_of, self.by_chart) = (first_of.collect(), by_chart);
        self
    }

    /// Total area of the flattened triangles, in square units of object space.
    pub fn area(&self) -> f64 {
        let area = |t: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|k| self.points[t[k] as usize]);
            (b - a).perp_dot(c - a).abs() * 0.5
        };
        self.indices.chunks_exact(3).map(area).sum()
    }
}

/// Unwraps a mesh. `keep_going` is called repeatedly; returns `None` if it returned false.
pub(super) fn unwrap(mesh: &Mesh, keep_going: &(dyn Fn() -> bool + Sync)) -> Option<Charts> {
    if mesh.indices.is_empty() {
        return Some(Charts::default());
    }
    let (positions, unit) = normalise(mesh);
    match generate(mesh, &positions, keep_going) {
        Ok((output, extent)) => Some(measure(mesh, &output, extent * unit).sorted()),
        Err(Error::Cancelled) => None,
        Err(_) => Some(each_triangle_alone(mesh).sorted()),
    }
}

/// Unwraps a mesh whose triangles have densities of their own, each density apart.
pub(super) fn unwrap_apart(
    mesh: &Mesh,
    densities: &[Option<f64>],
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Option<Charts> {
    let mut groups: BTreeMap<Option<u64>, Vec<usize>> = BTreeMap::new();
    for (triangle, density) in densities.iter().enumerate() {
        groups.entry(density.map(f64::to_bits)).or_default().push(triangle);
    }
    let mut charts = Charts { indices: vec![0; mesh.indices.len()], ..Charts::default() };
    for (density, triangles) in groups {
        let indices = triangles.iter().flat_map(|&t| mesh.indices[3 * t..3 * t + 3].iter().copied()).collect();
        let part = unwrap(&Mesh { indices, ..mesh.clone() }, keep_going)?;
        charts.append(part, &triangles, density.map(f64::from_bits));
    }
    Some(charts.sorted())
}

/// Positions relative to the middle of the mesh, at most 1 along each axis, and the power of two that divided them.
fn normalise(mesh: &Mesh) -> (Vec<[f32; 3]>, f64) {
    let corners = mesh.indices.iter().map(|&i| mesh.positions[i as usize]);
    let low = corners.clone().reduce(|a, b| a.min(b)).unwrap_or_default();
    let high = corners.reduce(|a, b| a.max(b)).unwrap_or_default();
    let centre = ((low.as_dvec3() + high.as_dvec3()) * 0.5).as_vec3().as_dvec3();
    let extent = (high.as_dvec3() - low.as_dvec3()).max_element();
    let unit = if extent > 0.0 { extent.log2().ceil().exp2() } else { 1.0 };
    let place = |p: &glam::Vec3| ((p.as_dvec3() - centre) / unit).as_vec3().clamp_length_max(4.0).to_array();
    (mesh.positions.iter().map(place).collect(), unit)
}

/// Runs `uvunwrap`; returns its mesh, and the size of the page that its coordinates are relative to.
fn generate(
    mesh: &Mesh,
    positions: &[[f32; 3]],
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Result<(OutputMesh, DVec2), Error> {
    let count = mesh.triangle_count() as f64;
    let area = surface_area(positions, &mesh.indices);
    let projected = height_field(positions, &mesh.indices);
    let input = MeshInput { existing_uvs: projected.as_deref(), ..MeshInput::new(positions, &mesh.indices) };
    let large = mesh.triangle_count() > 2 * CHART_TRIANGLES;
    let options = Options {
        max_chart_area: if large { (area * CHART_TRIANGLES as f64 / count) as f32 } else { 0.0 },
        density: Density::Fixed { texels_per_unit: packing_density(count, area), page_size: None },
        padding: 0,
        packing: Packing::Fast,
        ..Options::default()
    };
    let mut atlas = uvunwrap::generate_with_progress(&[input], &options, |_| keep_going())?;
    let extent = DVec2::new(f64::from(atlas.width), f64::from(atlas.height)) / f64::from(atlas.texels_per_unit);
    Ok((atlas.meshes.swap_remove(0), extent))
}

/// A density at which `uvunwrap`'s own packing, whose result is not used, is fast: four texels per triangle.
fn packing_density(triangles: f64, area: f64) -> f32 {
    let density = (4.0 * triangles / area).sqrt() as f32;
    if density.is_finite() && density > 0.0 { density.min(1e6) } else { 1.0 }
}

fn surface_area(positions: &[[f32; 3]], indices: &[u32]) -> f64 {
    indices.chunks_exact(3).map(|t| cross(positions, t).length() * 0.5).sum()
}

/// Normal of a triangle with twice its area as length.
fn cross(positions: &[[f32; 3]], triangle: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(positions[triangle[k] as usize].map(f64::from)));
    (b - a).cross(c - a)
}

/// Coordinates by projection along the mean normal, if the mesh is a height field.
fn height_field(positions: &[[f32; 3]], indices: &[u32]) -> Option<Vec<[f32; 2]>> {
    if indices.len() < 3 * HEIGHT_FIELD_TRIANGLES {
        return None;
    }
    let axis = indices.chunks_exact(3).map(|t| cross(positions, t)).sum::<DVec3>().try_normalize()?;
    let faces_axis = |t: &[u32]| {
        let normal = cross(positions, t);
        normal.dot(axis) >= HEIGHT_FIELD_COS * normal.length()
    };
    if !indices.chunks_exact(3).all(faces_axis) {
        return None;
    }
    let (u, v) = axis.any_orthonormal_pair();
    let project = |p: &[f32; 3]| {
        let p = DVec3::from(p.map(f64::from));
        [u.dot(p) as f32, v.dot(p) as f32]
    };
    Some(positions.iter().map(project).collect())
}

/// Splits the output into charts with their own bounding boxes. `extent` is the page's size in units of object space.
fn measure(mesh: &Mesh, output: &OutputMesh, extent: DVec2) -> Charts {
    let first = output.vertices.iter().filter_map(|v| v.chart).min().unwrap_or(0);
    let count = output.vertices.iter().filter_map(|v| v.chart).max().map_or(0, |last| last - first + 1);
    if count == 0 {
        return one_point(mesh);
    }
    let mut low = vec![DVec2::INFINITY; count as usize];
    let mut high = vec![DVec2::NEG_INFINITY; count as usize];
    let mut charts = Charts { indices: output.indices.clone(), ..Charts::default() };
    for vertex in &output.vertices {
        let point = DVec2::from(vertex.uv.map(f64::from)) * extent;
        let chart = vertex.chart.map_or(NO_CHART, |c| c - first);
        charts.vertices.push(vertex.xref);
        charts.points.push(point);
        charts.chart_of.push(chart);
        if let Some(low) = low.get_mut(chart as usize) {
            *low = low.min(point);
            high[chart as usize] = high[chart as usize].max(point);
        }
    }
    place_uncharted(mesh, &mut charts);
    for (point, &chart) in charts.points.iter_mut().zip(&charts.chart_of) {
        *point -= low[chart as usize];
    }
    charts.sizes = low.iter().zip(&high).map(|(l, h)| (*h - *l).max(DVec2::ZERO)).collect();
    charts
}

/// Moves vertices without a chart (of triangles without area and without charted neighbours) to the nearest charted
/// vertex. A triangle moves to a single point, so that it does not stretch across charts.
fn place_uncharted(mesh: &Mesh, charts: &mut Charts) {
    let (charted, uncharted): (Vec<u32>, Vec<u32>) =
        (0..charts.vertices.len() as u32).partition(|&v| charts.chart_of[v as usize] != NO_CHART);
    let stride = (uncharted.len() * charted.len() / NEAREST_WORK).max(1);
    let place = |charts: &Charts, v: u32| mesh.positions[charts.vertices[v as usize] as usize].as_dvec3();
    for corner in (0..charts.indices.len()).step_by(3) {
        let triangle = [0, 1, 2].map(|k| charts.indices[corner + k]);
        if triangle.iter().all(|&v| charts.chart_of[v as usize] != NO_CHART) {
            continue;
        }
        let own = triangle.iter().copied().find(|&v| charts.chart_of[v as usize] != NO_CHART);
        let from = place(charts, triangle[0]);
        let distance = |v: &u32| place(charts, *v).distance_squared(from);
        let nearest = || charted.iter().copied().step_by(stride).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(target) = own.or_else(nearest) else { return };
        for v in triangle.map(|v| v as usize) {
            if charts.chart_of[v] == NO_CHART {
                charts.points[v] = charts.points[target as usize];
                charts.chart_of[v] = charts.chart_of[target as usize];
            }
        }
    }
}

/// A mesh without area: a single chart that is a point.
fn one_point(mesh: &Mesh) -> Charts {
    Charts {
        vertices: (0..mesh.positions.len() as u32).collect(),
        indices: mesh.indices.clone(),
        points: vec![DVec2::ZERO; mesh.positions.len()],
        chart_of: vec![0; mesh.positions.len()],
        sizes: vec![DVec2::ZERO],
        ..Charts::default()
    }
}

/// Makes every triangle a chart, with its first edge along u.
fn each_triangle_alone(mesh: &Mesh) -> Charts {
    let mut charts = Charts::default();
    for (chart, triangle) in mesh.indices.chunks_exact(3).enumerate() {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize].as_dvec3());
        let along = (b - a).normalize_or_zero();
        let third = DVec2::new((c - a).dot(along), (c - a).reject_from_normalized(along).length());
        let points = [DVec2::ZERO, DVec2::new((b - a).length(), 0.0), third];
        let low = points.iter().fold(DVec2::INFINITY, |low, &p| low.min(p));
        let high = points.iter().fold(DVec2::NEG_INFINITY, |high, &p| high.max(p));
        charts.indices.extend((0..3).map(|k| charts.vertices.len() as u32 + k));
        charts.vertices.extend(triangle);
        charts.points.extend(points.map(|p| p - low));
        charts.chart_of.extend([chart as u32; 3]);
        charts.sizes.push(high - low);
    }
    charts
}
