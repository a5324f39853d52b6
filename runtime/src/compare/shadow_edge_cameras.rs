//! Cameras that see many edges of shadows, since that is where techniques differ.
//!
//! Candidates are the file's own cameras, views of the whole scene from all around, and close views of the place with
//! the most edges. Each candidate is drawn small by hard truth, at every time that is compared. An edge is where two
//! neighbouring pixels show surfaces that meet, one in the sun and one not; silhouettes do not count. The camera with
//! the most edges is taken first, and then, again and again, the one that sees most edges that no earlier camera has
//! seen.

use crate::camera::framing::{FOV_Y_DEG, detail, middle, standing_back, towards};
use crate::camera::{Camera, View};
use crate::gpu::GpuError;
use crate::light::Moment;
use crate::shot::Shot;
use crate::stage::Stage;
use crate::technique::{Technique, Truth};
use glam::DVec3;
use std::collections::HashSet;
use sunbake::trace::Hit;

/// Size of the pictures in which a candidate's edges are counted.
const TRIAL_PX: [u32; 2] = [96, 54];
/// Bearings of candidates, in degrees from north over east: a sixteenth of a turn off the walls of most houses.
const BEARINGS_DEG: [f64; 8] = [22.5, 67.5, 112.5, 157.5, 202.5, 247.5, 292.5, 337.5];
/// Elevations of candidates that show the whole scene, in degrees.
const WIDE_DEG: [f64; 2] = [18.0, 35.0];
/// Elevations of candidates that show a part, in degrees.
const CLOSE_DEG: [f64; 2] = [12.0, 30.0];
/// Distance of a camera that shows a part, as a share of that of the farthest other candidate.
const CLOSE: f64 = 0.32;
/// Largest difference of the distances of two surfaces that meet, as a share.
const MEETING: f64 = 0.04;
/// Size of the cells in which edges are told apart, as a share of the distance of the farthest candidate.
const CELL: f64 = 0.03;

/// A camera with a name for reports.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    /// The camera's name in the scene or, without one, where it looks from.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// A candidate and the edges that it sees.
struct Trial {
    named: NamedCamera,
    /// Index of the time, and the edge's position in bake space.
    edges: Vec<(usize, DVec3)>,
}

/// As many cameras as asked for, or fewer if there are fewer candidates. `aspect` is the picture's width over its
/// height.
pub fn shadow_edge_cameras(
    stage: &Stage,
    moments: &[Moment],
    count: usize,
    aspect: f64,
) -> Result<Vec<NamedCamera>, GpuError> {
    let points = detail(stage);
    let centre_m = middle(&points);
    let around = |heights_deg: [f64; 2]| {
        BEARINGS_DEG.into_iter().flat_map(move |bearing| heights_deg.map(|height| (bearing, height)))
    };
    let wide = around(WIDE_DEG).filter_map(|(bearing_deg, height_deg)| {
        let camera = standing_back(&points, centre_m, towards(bearing_deg, height_deg), aspect)?;
        Some(NamedCamera { name: format!("from the {}", compass(stage, bearing_deg)), camera })
    });
    let of_file =
        stage.scene.cameras.iter().enumerate().map(|(i, camera)| NamedCamera {
            name: Camera::label(&stage.scene, i),
            camera: Camera::from_scene(camera),
        });
    let default = NamedCamera { name: "default".into(), camera: Camera::default_of(stage, aspect) };
    let is_framed = stage.scene.cameras.is_empty();
    let all = of_file.chain(is_framed.then_some(default)).chain(wide);
    let mut trials: Vec<Trial> = all.map(|named| Trial::new(stage, moments, named)).collect::<Result<_, _>>()?;
    let reach_m = trials.iter().map(|trial| trial.named.camera.eye_m.distance(centre_m)).fold(0.0, f64::max);
    let cell_m = (CELL * reach_m).max(f64::MIN_POSITIVE);
    if let Some(target_m) = most_edges_near(&trials, cell_m) {
        for (bearing_deg, height_deg) in around(CLOSE_DEG) {
            let eye_m = target_m + towards(bearing_deg, height_deg) * (CLOSE * reach_m);
            let name = format!("close, from the {}", compass(stage, bearing_deg));
            if let Some(camera) = Camera::look_at(eye_m, target_m, FOV_Y_DEG.to_radians()) {
                trials.push(Trial::new(stage, moments, NamedCamera { name, camera })?);
            }
        }
    }
    Ok(pick(trials, count, cell_m))
}

impl Trial {
    fn new(stage: &Stage, moments: &[Moment], named: NamedCamera) -> Result<Self, GpuError> {
        let shot = Shot::new(stage, View::new(&named.camera, TRIAL_PX, &stage.scene));
        let mut edges = Vec::new();
        for (time, moment) in moments.iter().enumerate() {
            let seen = Truth::Hard.visibility(&shot, moment)?;
            let hits = edge_pixels(&shot, &seen.pixels).into_iter();
            edges.extend(hits.map(|hit| (time, stage.geometry.point(hit.triangle as usize, hit.barycentric))));
        }
        Ok(Self { named, edges })
    }
}

/// Sunlit surfaces beside which the surface that they meet is not sunlit.
fn edge_pixels(shot: &Shot, seen: &[f32]) -> Vec<Hit> {
    let (hits, width) = (shot.hits(), shot.view.size[0] as usize);
    let is_edge = |a: usize, b: usize| match (hits[a], hits[b]) {
        (Some(here), Some(there)) => {
            seen[a] != seen[b] && (here.distance_m - there.distance_m).abs() < MEETING * here.distance_m
        }
        _ => false,
    };
    let beside = |i: usize| {
        let right = (!(i + 1).is_multiple_of(width)).then_some(i + 1);
        let below = (i + width < hits.len()).then_some(i + width);
        right.into_iter().chain(below)
    };
    (0..hits.len()).filter(|&i| beside(i).any(|j| is_edge(i, j))).filter_map(|i| hits[i]).collect()
}

/// A cell of space at a time.
fn cell(&(time, position_m): &(usize, DVec3), cell_m: f64) -> (usize, [i64; 3]) {
    (time, (position_m / cell_m).floor().to_array().map(|x| x as i64))
}

/// The position around which the most edges lie.
fn most_edges_near(trials: &[Trial], cell_m: f64) -> Option<DVec3> {
    // Edges that many cameras see count once.
    let mut positions: Vec<(usize, DVec3)> = Vec::new();
    let mut known = HashSet::new();
    for edge in trials.iter().flat_map(|trial| &trial.edges) {
        if known.insert(cell(edge, cell_m)) {
            positions.push(*edge);
        }
    }
    let step = positions.len().div_ceil(600).max(1);
    let some: Vec<DVec3> = positions.iter().step_by(step).map(|(_, position_m)| *position_m).collect();
    let near_m = 6.0 * cell_m;
    let neighbour_count = |position_m: &DVec3| some.iter().filter(|other| other.distance(*position_m) < near_m).count();
    some.iter()
        .map(|position_m| (neighbour_count(position_m), *position_m))
        .reduce(|a, b| if b.0 > a.0 { b } else { a })
        .map(|(_, m)| m)
}

/// The camera with the most edges, then those that add most to the edges seen already.
fn pick(mut trials: Vec<Trial>, count: usize, cell_m: f64) -> Vec<NamedCamera> {
    let mut seen = HashSet::new();
    let mut picked: Vec<NamedCamera> = Vec::new();
    while picked.len() < count && !trials.is_empty() {
        let unseen = |trial: &Trial| trial.edges.iter().filter(|edge| !seen.contains(&cell(edge, cell_m))).count();
        let scored = trials.iter().enumerate().map(|(i, trial)| (unseen(trial), i));
        // The first of equals: the file's own cameras come first.
        let Some((_, best)) = scored.reduce(|a, b| if b.0 > a.0 { b } else { a }) else { break };
        let Trial { named, edges } = trials.remove(best);
        seen.extend(edges.iter().map(|edge| cell(edge, cell_m)));
        let same = picked.iter().filter(|other| other.name == named.name).count();
        let name = if same > 0 { format!("{} ({})", named.name, same + 1) } else { named.name };
        picked.push(NamedCamera { name, ..named });
    }
    picked
}

/// A bearing in words. Bearings run from -Z over +X; the stage's north may be turned.
fn compass(stage: &Stage, bearing_deg: f64) -> &'static str {
    const NAMES: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
    let north_deg = stage.path.as_ref().and_then(|path| path.day.as_ref()).map_or(0.0, |day| day.north_deg);
    // Half way between two directions, the one further clockwise.
    NAMES[((bearing_deg - north_deg + 22.5).rem_euclid(360.0) / 45.0) as usize % 8]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::standing_sun;
    use glam::{Vec2, Vec3};
    use sunbake::testing::{SceneBuilder, floor};

    /// A block on wide ground, far from the middle: the only edges are around it.
    fn stage() -> Stage {
        let scene = SceneBuilder::new()
            .soup(&floor(Vec2::splat(-20.0), Vec2::splat(20.0), 0.0))
            .block(Vec3::new(5.0, 0.0, -6.0), Vec3::new(7.0, 2.0, -4.0))
            .build();
        Stage::plain(scene, Some(standing_sun(DVec3::new(0.5, 1.0, 0.3), 0.0047)))
    }

    #[test]
    fn cameras_see_the_edges_there_are_and_differ() {
        let stage = stage();
        let moments = [stage.moment(0.5)];
        let found = shadow_edge_cameras(&stage, &moments, 3, 16.0 / 9.0).unwrap();
        assert_eq!(found.len(), 3);
        for named in &found {
            let trial = Trial::new(&stage, &moments, named.clone()).unwrap();
            assert!(trial.edges.len() > 10, "{} sees {} edges", named.name, trial.edges.len());
            let is_near = |(_, position_m): &&(usize, DVec3)| (*position_m - DVec3::new(6.0, 1.0, -5.0)).length() < 4.0;
            assert_eq!(trial.edges.iter().filter(is_near).count(), trial.edges.len(), "{}", named.name);
        }
        let [a, b, c] = [0, 1, 2].map(|i| found[i].camera.eye_m);
        assert!(a.distance(b) > 1.0 && b.distance(c) > 1.0 && c.distance(a) > 1.0);
    }

    #[test]
    fn a_scene_without_shadows_still_has_cameras() {
        let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-2.0), Vec2::splat(2.0), 0.0)).build();
        let stage = Stage::plain(scene, Some(standing_sun(DVec3::Y, 0.0)));
        assert_eq!(shadow_edge_cameras(&stage, &[stage.moment(0.5)], 3, 1.5).unwrap().len(), 3);
        let empty = Stage::plain(SceneBuilder::new().build(), None);
        assert_eq!(shadow_edge_cameras(&empty, &[], 3, 1.5).unwrap().len(), 1);
    }
}
