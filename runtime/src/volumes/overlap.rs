//! How many prisms may contain one point. Eight bits of stencil count to 255, and 256 would read as lit.
//!
//! Seen from the light, a prism is its triangle, and the number of triangles at one spot bounds the count at any pixel.
//! The light's view is split in two, again and again, until few enough triangles reach into a cell, or the cell is so
//! small that more splits do not separate them. The sun's view is a plane. A lamp's view is the sphere around it, split
//! as a cube, where a triangle is a cone of three planes through the lamp. The bound may be too high, never too low:
//! where the edges of a stack lie close together, cells would have to become as small as what lies between them, and
//! the search ends when its effort is spent.

use super::casters::Casters;
use super::light::Light;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Splits after which triangles in one cell count as overlapping.
const DEEPEST: u32 = 48;
/// Triangles that a search may visit before it gives up: so many, and so many for each that casts. Real scenes need 10
/// to 75 for each; a stack of 128 boxes needs ten million (a tenth of a second).
const EFFORT: usize = 1 << 24;
const EFFORT_EACH: usize = 256;
/// How many triangles a median is estimated from.
const SAMPLE: usize = 63;
/// By how much boxes are grown to allow for rounding to `f32`, for coordinates between -1 and 1.
const GROWTH: f32 = 2e-6;

/// A box with least and greatest coordinates.
type CellBounds = [Vec3; 2];

/// A part of the light's view, and after how many splits.
struct Cell {
    bounds: CellBounds,
    depth: u32,
}

/// All triangles in the light's view.
struct TrianglesInLightView {
    view: LightView,
    corners: Vec<[Vec3; 3]>,
    /// Bounding boxes; empty where a triangle casts nothing.
    bounds: Vec<CellBounds>,
    /// The first triangle of each caster, ascending.
    starts: Vec<usize>,
}

/// Splits the casting triangles into a few runs, none of which has more than `most` prisms at one spot. A caster that
/// has more than that by itself is split, others are not: what a smooth solid spares is taken from its own count.
pub fn runs(casters: &Casters, facings: &[i8], light: &Light, most: usize) -> Vec<Range<usize>> {
    let casting = facings.iter().filter(|&&facing| facing != 0).count();
    if casting <= most {
        return std::iter::once(0..facings.len()).collect();
    }
    let view = LightView::new(casters, light);
    let seen = |triangle: usize| match facings[triangle] {
        0 => ([Vec3::ZERO; 3], [Vec3::INFINITY, Vec3::NEG_INFINITY]),
        _ => view.project(&casters.corners_m(triangle)),
    };
    let (corners, bounds) = (0..facings.len()).into_par_iter().map(seen).unzip();
    let mut found = Vec::new();
    let starts = casters.all.iter().map(|caster| caster.triangles.start).collect();
    TrianglesInLightView { view, corners, bounds, starts }.split(0..facings.len(), most, &mut found);
    found
}

impl TrianglesInLightView {
    fn split(&self, run: Range<usize>, most: usize, found: &mut Vec<Range<usize>>) {
        let casting: Vec<u32> = run.clone().filter(|&i| self.bounds[i][0].x.is_finite()).map(|i| i as u32).collect();
        let whole = Cell { bounds: self.view.space(), depth: 0 };
        if casting.len() <= most || !self.exceeds(&casting, &whole, most, EFFORT + EFFORT_EACH * casting.len()) {
            return found.push(run);
        }
        let middle = self.cut(&run);
        self.split(run.start..middle, most, found);
        self.split(middle..run.end, most, found);
    }

    /// Where to split a run: between two casters, near its middle.
    fn cut(&self, run: &Range<usize>) -> usize {
        let middle = run.start + run.len() / 2;
        let next = self.starts.partition_point(|&start| start < middle);
        let around = next.saturating_sub(1)..self.starts.len().min(next + 1);
        let inside = self.starts[around].iter().copied().filter(|&start| run.start < start && start < run.end);
        inside.min_by_key(|start| start.abs_diff(middle)).unwrap_or(middle)
    }

    /// Where to split a cell: at the median of the middles of the triangles' parts in it, estimated from a sample.
    /// Cells become small where a scene is dense, and a wide plain costs no cuts.
    fn middle(&self, of: &[u32], cell: &CellBounds, axis: usize) -> f32 {
        let middle = |&i: &u32| {
            let [low, high] = &self.bounds[i as usize];
            0.5 * (low[axis].max(cell[0][axis]) + high[axis].min(cell[1][axis]))
        };
        let mut sample: Vec<f32> = of.iter().step_by(of.len().div_ceil(SAMPLE)).map(middle).collect();
        let half = sample.len() / 2;
        *sample.select_nth_unstable_by(half, f32::total_cmp).1
    }

    /// Whether more than `most` of these triangles, all of which reach into a cell, may share a part of it that is as
    /// small as cells get, or as small as cells that `effort` visited triangles can tell apart. The effort is divided
    /// and not shared, so that the result does not depend on threads.
    fn exceeds(&self, of: &[u32], cell: &Cell, most: usize, effort: usize) -> bool {
        if of.len() <= most || !self.view.has_spots_in(&cell.bounds) {
            return false;
        }
        if cell.depth == DEEPEST || of.len() > effort {
            return true;
        }
        let [low, high] = cell.bounds;
        let axis = (high - low).max_position();
        let middle = self.middle(of, &cell.bounds, axis);
        let half = |is_upper: bool| {
            let mut half = Cell { bounds: cell.bounds, depth: cell.depth + 1 };
            half.bounds[usize::from(!is_upper)][axis] = middle;
            let kept = self.reaching(of, &half, |&[low, high]| match is_upper {
                true => high[axis] >= middle,
                false => low[axis] <= middle,
            });
            (half, kept)
        };
        // Calls with many triangles are worth a thread each.
        let is_long = of.len() > 2048;
        let halves: [_; 2] = match is_long {
            true => rayon::join(|| half(false), || half(true)).into(),
            false => [half(false), half(true)],
        };
        let unsettled = |kept: &[u32]| if kept.len() > most { kept.len() } else { 0 };
        let all = halves.iter().map(|(_, kept)| unsettled(kept)).sum::<usize>().max(1);
        let exceeds = |(half, kept): &(Cell, Vec<u32>)| {
            let share = (effort - of.len()) as f64 * unsettled(kept) as f64 / all as f64;
            self.exceeds(kept, half, most, share as usize)
        };
        if is_long {
            let (lower, upper) = rayon::join(|| exceeds(&halves[0]), || exceeds(&halves[1]));
            return lower || upper;
        }
        halves.iter().any(exceeds)
    }

    /// The triangles that reach into a half of their cell, where their boxes do.
    fn reaching(&self, of: &[u32], half: &Cell, is_box_in: impl Fn(&CellBounds) -> bool) -> Vec<u32> {
        let size = (half.bounds[1] - half.bounds[0]).max_element();
        let is_kept = |&i: &u32| {
            let bounds @ [low, high] = &self.bounds[i as usize];
            // For a triangle much smaller than the cell the box is exact enough.
            let is_small = || (*high - *low).max_element() < 0.5 * size;
            is_box_in(bounds) && (is_small() || self.view.reaches(&self.corners[i as usize], &half.bounds))
        };
        of.iter().copied().filter(is_kept).collect()
    }
}

/// The light's view, in coordinates between -1 and 1.
enum LightView {
    /// Across the sun's rays.
    Plane { across: [DVec3; 2], middle_m: DVec3, per_metre: f64 },
    /// Around a lamp.
    Sphere { centre_m: DVec3 },
}

impl LightView {
    fn new(casters: &Casters, light: &Light) -> Self {
        match light {
            Light::Lamp { position_m, .. } => Self::Sphere { centre_m: *position_m },
            Light::Sun { towards } => {
                let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                for caster in &casters.all {
                    (low, high) = (low.min(caster.bounds_m[0]), high.max(caster.bounds_m[1]));
                }
                let per_metre = 1.0 / (0.5 * (high - low).length()).max(f64::MIN_POSITIVE);
                let (right, up) = towards.any_orthonormal_pair();
                Self::Plane { across: [right, up], middle_m: 0.5 * (low + high), per_metre }
            }
        }
    }

    /// The whole view. A plane has no depth to be halved.
    fn space(&self) -> CellBounds {
        let half = match self {
            Self::Plane { .. } => Vec3::new(2.0, 2.0, 0.0),
            Self::Sphere { .. } => Vec3::splat(2.0),
        };
        [-half, half]
    }

    /// Whether a cell holds a part of the view: of the cube around a lamp, only the sphere counts.
    fn has_spots_in(&self, [low, high]: &CellBounds) -> bool {
        match self {
            Self::Plane { .. } => true,
            Self::Sphere { .. } => {
                let nearest = Vec3::ZERO.clamp(*low, *high);
                let furthest = low.abs().max(high.abs());
                nearest.length() <= 1.0 + GROWTH && furthest.length() >= 1.0 - GROWTH
            }
        }
    }

    /// A triangle in the view, and its box.
    fn project(&self, corners: &[DVec3; 3]) -> ([Vec3; 3], CellBounds) {
        match self {
            Self::Plane { across, middle_m, per_metre } => {
                let seen = corners.map(|corner| {
                    let from_middle = (corner - middle_m) * *per_metre;
                    Vec3::new(from_middle.dot(across[0]) as f32, from_middle.dot(across[1]) as f32, 0.0)
                });
                let [low, high] = [seen[0].min(seen[1]).min(seen[2]), seen[0].max(seen[1]).max(seen[2])];
                (seen, [low - GROWTH, high + GROWTH])
            }
            Self::Sphere { centre_m } => {
                // A spherical triangle lies within the cap around its middle that holds its corners. Beyond a
                // hemisphere the cap may be the wrong one, and the whole sphere is taken.
                let seen = corners.map(|corner| (corner - centre_m).normalize_or_zero());
                let middle = (seen[0] + seen[1] + seen[2]).normalize_or_zero();
                let reach = seen.iter().map(|s| s.distance(middle)).fold(0.0, f64::max);
                let reach = if reach < 1.4 { reach } else { 2.0 };
                let bounds = [(middle - reach).as_vec3() - GROWTH, (middle + reach).as_vec3() + GROWTH];
                (seen.map(|s| s.as_vec3()), bounds)
            }
        }
    }

    /// Whether a triangle may reach into a cell: the cell is not beyond any of its edges.
    fn reaches(&self, corners: &[Vec3; 3], [low, high]: &CellBounds) -> bool {
        (0..3).all(|k| {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            let normal = match self {
                Self::Plane { .. } => Vec3::new(b.y - a.y, a.x - b.x, 0.0),
                Self::Sphere { .. } => a.cross(b),
            };
            let inwards = if normal.dot(c - a) < 0.0 { -normal } else { normal };
            let furthest = Vec3::select(inwards.cmpgt(Vec3::ZERO), *high, *low) - a;
            let tolerance = GROWTH * (inwards.abs() + furthest.abs()).element_sum();
            inwards.dot(furthest) >= -tolerance
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::Stage;
    use glam::Vec2;
    use sunbake::testing::{SceneBuilder, block, floor};

    const NOON: Light = Light::Sun { towards: DVec3::Y };

    fn runs_of(sheets: usize, gap: f32, light: &Light) -> usize {
        let sheet = |i: usize| floor(Vec2::splat(gap * i as f32), Vec2::splat(gap * i as f32 + 1.0), i as f32 * 0.01);
        let triangles: Vec<_> = (0..sheets).flat_map(sheet).collect();
        let stage = Stage::plain(SceneBuilder::new().soup(&triangles).build(), None);
        let casters = Casters::new(&stage);
        let facings = light.facings(&casters, true).of_triangle;
        runs(&casters, &facings, light, 255).len()
    }

    #[test]
    fn as_many_sheets_as_bits_can_count_are_one_run_and_more_are_several() {
        // Along the diagonal of a square both of its triangles count.
        assert_eq!(runs_of(127, 0.0, &NOON), 1);
        assert!(runs_of(256, 0.0, &NOON) > 1);
    }

    #[test]
    fn runs_are_cut_between_casters() {
        let block = |i: usize| block(Vec3::new(0.0, i as f32, 0.0), Vec3::new(1.0, i as f32 + 0.5, 1.0));
        let triangles: Vec<_> = (0..301).flat_map(block).collect();
        let stage = Stage::plain(SceneBuilder::new().soup(&triangles).build(), None);
        let casters = Casters::new(&stage);
        let runs = runs(&casters, &NOON.facings(&casters, false).of_triangle, &NOON, 500);
        let starts: Vec<usize> = casters.all.iter().map(|caster| caster.triangles.start).collect();
        assert!(runs.len() > 1 && starts.len() > 1, "{} runs, {} casters", runs.len(), starts.len());
        assert!(!starts.contains(&(casters.triangles.len() / 2)), "the middle lies between two of them anyway");
        assert!(runs.iter().all(|run| starts.contains(&run.start)), "{runs:?}");
    }

    #[test]
    fn close_edges_of_a_stack_do_not_hold_up_a_search() {
        // Diagonals a hundredth of a millimetre apart, where only two more may be counted: ten million cells tell them
        // apart. A second run is the price of not trying.
        let runs = runs_of(253, 1e-5, &NOON);
        assert!((1..=2).contains(&runs), "{runs} runs");
    }

    #[test]
    fn sheets_side_by_side_are_one_run() {
        assert_eq!(runs_of(2000, 1.1, &NOON), 1);
    }

    #[test]
    fn a_lamp_above_sees_them_alike() {
        let lamp = Light::Lamp { position_m: DVec3::new(0.0, 30.0, 0.0), range_m: None };
        assert_eq!(runs_of(100, 0.0, &lamp), 1);
        assert!(runs_of(300, 0.0, &lamp) > 1);
    }
}
