//! Buried texels beside visible ones: they take the times that their visible neighbours agree on.
//!
//! Theory: a texel whose point lies inside a solid, or under something that lies on its surface, never sees the sun.
//! Nobody sees it either, but a filter does, and would draw a dark line round what lies there. Its visible neighbours
//! say what to show in its place; what only some of them see is left out. Neighbours behind walls say nothing: no
//! filter blends across ([`crate::atlas::find_walls`]), and what looks like a solid may be a room without inner faces.
//!
//! Practice: only texels with a neighbour that sees more are tested.
//!
//! * Those that are hardly ever lit, by rays over the hemisphere: all of them meet the backs of single-sided surfaces,
//!   or, within the size of a texel, backs of double-sided ones. (At a distance the backs of double-sided surfaces are
//!   walls of a room.)
//! * All, by one ray: straight above them, within a quarter of a texel, lies something. So the sun that grazes comes in
//!   under the border of a decal, yet a filter sees none of it.

use crate::ambient::{back_comes_first, hemisphere_directions};
use crate::atlas::{self, Around, PageSamples, PageSize, SurfacePoint};
use crate::intervals::{IntervalTable, Intervals};
use crate::scene::{Geometry, Scene};
use crate::trace::{Direction, Tracer};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// Rays of a test.
const RAYS: u32 = 16;
/// Share of the path below which a texel may be buried.
const DARK: f64 = 0.05;
/// Height below which what is above a texel lies on it, in texels.
const ON_TEXELS: f64 = 0.25;

/// Finds buried points.
pub(crate) struct BuriedPoints<'a> {
    pub scene: &'a Scene,
    pub geometry: &'a Geometry,
    pub tracer: &'a Tracer,
    /// For each instance, the width of a texel.
    pub texel_m: Vec<f64>,
}

impl BuriedPoints<'_> {
    /// Whether nobody sees a point that sees this share of the path: it lies inside a solid, or right under something.
    pub fn is_buried(&self, point: &SurfacePoint, lit_share: f64) -> bool {
        let texel_m = self.texel_m[self.geometry.instance[point.triangle as usize] as usize];
        let sides: &[f64] = if point.is_double_sided { &[1.0, -1.0] } else { &[1.0] };
        sides.iter().all(|side| {
            let normal = point.normal * *side;
            let from = self.tracer.lift(point.position_m, normal, point.triangle);
            let is_inside =
                || hemisphere_directions(normal, RAYS).all(|direction| self.meets_back(from, direction, texel_m));
            self.is_covered(from, normal, texel_m) || (lit_share < DARK && is_inside())
        })
    }

    /// Whether something lies on a point.
    fn is_covered(&self, from: DVec3, normal: DVec3, texel_m: f64) -> bool {
        self.tracer.nearest_within(from, &Direction::new(normal), ON_TEXELS * texel_m).is_some()
    }

    fn meets_back(&self, from: DVec3, direction: DVec3, texel_m: f64) -> bool {
        let along = Direction::new(direction);
        let is_back = |triangle: u32| self.geometry.normal(triangle as usize).dot(direction) > 0.0;
        let Some(hit) = self.tracer.closest_hit(from, &along) else { return false };
        let instance = self.geometry.instance[hit.triangle as usize] as usize;
        if !is_back(hit.triangle) || (self.scene.material(instance).is_double_sided && hit.distance_m > texel_m) {
            return false;
        }
        back_comes_first(self.tracer, from, &along, hit.distance_m, is_back)
    }
}

/// Answers of a page's texels, in their order: for each as many lists as there are lanes.
#[derive(Clone, Copy)]
pub(crate) struct Answers<'a> {
    pub tables: &'a [IntervalTable],
    pub lane_count: usize,
}

impl Answers<'_> {
    fn get(&self, place: usize, lane: usize) -> &[[f64; 2]] {
        let index = place * self.lane_count + lane;
        // All tables but the last have the same length.
        let length = self.tables[0].len();
        self.tables[index / length].get(index % length)
    }

    /// Share of the path that a texel sees, in the lane where that is most.
    fn lit_share(&self, place: usize) -> f64 {
        let length = |lane: usize| self.get(place, lane).iter().map(|[start, end]| end - start).sum::<f64>();
        (0..self.lane_count).map(length).fold(0.0, f64::max)
    }
}

/// The lists that buried texels of a page get instead of their own, by their place in `order`, which says what sample
/// each answer is of. `walls` are the page's.
pub(crate) fn fill_buried(
    buried: &BuriedPoints,
    size: PageSize,
    PageSamples { samples }: &PageSamples,
    order: &[u32],
    walls: Option<&[[u8; 2]]>,
    answers: Answers,
) -> HashMap<usize, Vec<Intervals>> {
    let mut place_of = vec![NONE; size.texel_count()];
    for (place, &sample) in (0..).zip(order) {
        place_of[samples[sample as usize].texel as usize] = place;
    }
    let around = Around::new(size, walls);
    let neighbours = |place: usize| {
        let places = around.texels(samples[order[place] as usize].texel as usize).map(|texel| place_of[texel]);
        places.filter(|&other| other != NONE).map(|other| other as usize).collect::<Vec<_>>()
    };
    let is_buried = |place: usize| {
        let point = atlas::surface_point(buried.scene, buried.geometry, &samples[order[place] as usize]);
        buried.is_buried(&point, answers.lit_share(place))
    };
    let has_brighter_neighbour = |place: usize| {
        let own_share = answers.lit_share(place).max(DARK);
        neighbours(place).iter().any(|&other| answers.lit_share(other) > own_share)
    };
    // Rays are sent once for each of these; their other neighbours are few.
    let tested = |place: usize| has_brighter_neighbour(place).then(|| is_buried(place));
    let known: Vec<Option<bool>> = (0..order.len()).into_par_iter().map(tested).collect();
    let fill = |place: usize| {
        if known[place] != Some(true) {
            return None;
        }
        let is_visible = |other: &usize| !known[*other].unwrap_or_else(|| is_buried(*other));
        let visible: Vec<usize> = neighbours(place).into_iter().filter(is_visible).collect();
        if visible.is_empty() {
            return None;
        }
        let of_lane = |lane: usize| {
            let lists = visible.iter().map(|&other| Intervals::from_unsorted(answers.get(other, lane).to_vec()));
            lists.reduce(|a, b| a.intersection(&b)).unwrap_or_default()
        };
        Some((place, (0..answers.lane_count).map(of_lane).collect()))
    };
    (0..order.len()).into_par_iter().filter_map(fill).collect()
}

const NONE: u32 = u32::MAX;
