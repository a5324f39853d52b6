//! Lamps that move through the scene: a lamp's position at every path time `t` in [0, 1].
//!
//! A path is a chain of straight segments, each passed at constant speed. A point and a segment span a triangle, so
//! visibility along the segment has closed-form solutions, and surfaces beyond the lamp do not hide it
//! (`visibility/lamp`). Paths are read from path files (`parse.rs`).
//!
//! The lamp is a sphere. Playback treats it as a line along its own path, as it treats the sun (GPU Gems, chapter 13,
//! "linear light"). At `t` the line is the part of the path within one radius ahead of and behind the centre. The
//! lamp's visibility is the lit share of the time in which the centre passes that part ([`LampPath::window_t`]).

mod parse;

pub use parse::{LampFileError, is_lamp, parse_lamp};

use crate::words::counted;
use glam::DVec3;

/// Largest coordinate of a key, in metres.
const MOST_M: f64 = 1e9;
/// Smallest distance between neighbouring keys, in metres.
const LEAST_STEP_M: f64 = 1e-6;
/// Largest distance, in `t`, of the path's ends from 0 and 1; also the least time between keys.
const END_TOLERANCE_T: f64 = 1e-9;

/// A position of the lamp at a path time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampKey {
    /// Path time, 0 to 1.
    pub t: f64,
    /// Position of the lamp's centre, in metres.
    pub position_m: DVec3,
}

/// The straight line from one key to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampSegment {
    /// Start and end, in metres.
    pub ends_m: [DVec3; 2],
    /// Path times at the start and the end, 0 to 1.
    pub t: [f64; 2],
}

/// The path of a lamp over `t` in [0, 1]. Path files give world space; engines need bake space
/// ([`LampPath::relative_to`]).
///
/// Guarantees, made by [`LampPath::new`]: at least two keys, the first at exactly t = 0 and the last at exactly t = 1;
/// times ascend; neighbouring keys differ in position; every number is finite, the radius not negative, the duration
/// positive.
#[derive(Debug, Clone, PartialEq)]
pub struct LampPath {
    keys: Vec<LampKey>,
    radius_m: f64,
    duration_min: f64,
}

/// Why keys are not a valid lamp path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LampError {
    /// Fewer than two keys.
    #[error("the lamp's path has {}: give at least two positions", counted(*.0 as u64, "key"))]
    Count(usize),
    /// A position is not finite or too large.
    #[error("key {index} of the lamp's path (counted from 0) is at {position_m}: give metres from -1e9 to 1e9")]
    Position {
        /// Index of the key, from 0.
        index: usize,
        /// The position given, in metres.
        position_m: DVec3,
    },
    /// Two neighbouring keys have the same position.
    #[error(
        "keys {index} and {next} of the lamp's path (counted from 0) are in the same place: a lamp that does not move \
         has no path; remove one of them",
        next = .index + 1
    )]
    NoMotion {
        /// The first of the two.
        index: usize,
    },
    /// Times do not ascend from 0 to 1.
    #[error(
        "the times of the lamp's keys must ascend from 0 to 1, and the one of key {index} (counted from 0) does not"
    )]
    Times {
        /// Index of the key, from 0.
        index: usize,
    },
    /// A size out of range.
    #[error("the lamp's {name} is {value}: give a number {bound}")]
    Size {
        /// The file's name for it.
        name: &'static str,
        /// The value given, in the unit of its name.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
}

impl LampPath {
    /// Checks the keys and makes a path of them.
    pub fn new(mut keys: Vec<LampKey>, radius_m: f64, duration_min: f64) -> Result<Self, LampError> {
        if keys.len() < 2 {
            return Err(LampError::Count(keys.len()));
        }
        check_positions(&keys)?;
        check_times(&keys)?;
        if !(0.0..=MOST_M).contains(&radius_m) {
            return Err(LampError::Size { name: "radius_m", value: radius_m, bound: "from 0 to 1e9" });
        }
        if !(duration_min > 0.0 && duration_min.is_finite()) {
            return Err(LampError::Size { name: "duration_min", value: duration_min, bound: "above 0" });
        }
        let last = keys.len() - 1;
        (keys[0].t, keys[last].t) = (0.0, 1.0);
        Ok(Self { keys, radius_m, duration_min })
    }

    /// The keys, in order.
    pub fn keys(&self) -> &[LampKey] {
        &self.keys
    }

    /// Radius of the lamp, in metres.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Clock time from t = 0 to t = 1, in minutes.
    pub fn duration_min(&self) -> f64 {
        self.duration_min
    }

    /// The same path with another duration.
    pub fn lasting(&self, duration_min: f64) -> Result<Self, LampError> {
        Self::new(self.keys.clone(), self.radius_m, duration_min)
    }

    /// The same path in a space with its origin at `origin_m` of this one.
    pub fn relative_to(&self, origin_m: DVec3) -> Self {
        let moved = |key: &LampKey| LampKey { position_m: key.position_m - origin_m, ..*key };
        Self { keys: self.keys.iter().map(moved).collect(), ..self.clone() }
    }

    /// The segments, in order.
    pub fn segments(&self) -> impl Iterator<Item = LampSegment> + '_ {
        self.keys
            .windows(2)
            .map(|pair| LampSegment { ends_m: [pair[0].position_m, pair[1].position_m], t: [pair[0].t, pair[1].t] })
    }

    /// Position of the lamp's centre at `t` (clamped to [0, 1]).
    pub fn position_m(&self, t: f64) -> DVec3 {
        let [from, to] = self.around(t);
        from.position_m.lerp(to.position_m, ((t - from.t) / (to.t - from.t)).clamp(0.0, 1.0))
    }

    /// The path times in which the centre is within one radius, along the path, of its position at `t`: as long as the
    /// centre takes for one diameter, cut off at the path's start and end. Empty for a lamp with radius 0.
    pub fn window_t(&self, t: f64) -> [f64; 2] {
        let length_until_m = self.length_until_m(t.clamp(0.0, 1.0));
        if self.radius_m == 0.0 {
            return [t; 2];
        }
        [self.t_at_length(length_until_m - self.radius_m), self.t_at_length(length_until_m + self.radius_m)]
    }

    /// The keys before and after `t`.
    fn around(&self, t: f64) -> [LampKey; 2] {
        let next = self.keys.iter().position(|key| t < key.t).unwrap_or(self.keys.len() - 1).max(1);
        [self.keys[next - 1], self.keys[next]]
    }

    /// Length of the path from its start to `t`, in metres.
    fn length_until_m(&self, t: f64) -> f64 {
        let share = |s: &LampSegment| ((t - s.t[0]) / (s.t[1] - s.t[0])).clamp(0.0, 1.0);
        self.segments().map(|s| share(&s) * s.length_m()).sum()
    }

    /// Path time, in [0, 1], at a length from the path's start.
    fn t_at_length(&self, mut length_m: f64) -> f64 {
        for segment in self.segments() {
            let segment_m = segment.length_m();
            if length_m < segment_m {
                return segment.t[0] + (length_m / segment_m).max(0.0) * (segment.t[1] - segment.t[0]);
            }
            length_m -= segment_m;
        }
        1.0
    }
}

impl LampSegment {
    /// Distance between its ends, in metres.
    pub fn length_m(&self) -> f64 {
        self.ends_m[0].distance(self.ends_m[1])
    }
}

fn check_positions(keys: &[LampKey]) -> Result<(), LampError> {
    for (index, LampKey { position_m, .. }) in keys.iter().enumerate() {
        // Written so that NaN is an error too.
        if !(position_m.is_finite() && position_m.abs().max_element() <= MOST_M) {
            return Err(LampError::Position { index, position_m: *position_m });
        }
    }
    let is_same = |pair: &[LampKey]| pair[0].position_m.distance(pair[1].position_m) < LEAST_STEP_M;
    keys.windows(2).position(is_same).map_or(Ok(()), |index| Err(LampError::NoMotion { index }))
}

fn check_times(keys: &[LampKey]) -> Result<(), LampError> {
    let last = keys.len() - 1;
    // Ranges, so that NaN is outside.
    let is_at = |index: usize, t: f64| (t - END_TOLERANCE_T..=t + END_TOLERANCE_T).contains(&keys[index].t);
    let ascends = |pair: &[LampKey]| (END_TOLERANCE_T..=2.0).contains(&(pair[1].t - pair[0].t));
    let wrong = if !is_at(0, 0.0) {
        Some(0)
    } else if !is_at(last, 1.0) {
        Some(last)
    } else {
        keys.windows(2).position(|pair| !ascends(pair)).map(|index| index + 1)
    };
    wrong.map_or(Ok(()), |index| Err(LampError::Times { index }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(places: &[(f64, [f64; 3])], radius_m: f64) -> Result<LampPath, LampError> {
        let key = |&(t, position): &(f64, [f64; 3])| LampKey { t, position_m: DVec3::from_array(position) };
        LampPath::new(places.iter().map(key).collect(), radius_m, 10.0)
    }

    /// Four metres in the first half, one metre in the second.
    fn bent() -> LampPath {
        path(&[(0.0, [0.0; 3]), (0.5, [4.0, 0.0, 0.0]), (1.0, [4.0, 1.0, 0.0])], 0.5).unwrap()
    }

    #[test]
    fn the_lamp_moves_at_constant_speed_from_key_to_key() {
        for (t, expected) in
            [(0.0, [0.0, 0.0]), (0.25, [2.0, 0.0]), (0.5, [4.0, 0.0]), (0.75, [4.0, 0.5]), (1.0, [4.0, 1.0])]
        {
            assert_eq!(bent().position_m(t).to_array()[..2], expected, "{t}");
        }
        assert_eq!(bent().position_m(-3.0), DVec3::ZERO);
        assert_eq!(bent().relative_to(DVec3::X).position_m(0.5), DVec3::new(3.0, 0.0, 0.0));
    }

    #[test]
    fn the_window_is_one_diameter_of_the_path_around_corners_too() {
        let window = |t| bent().window_t(t);
        assert_eq!(window(0.25), [0.1875, 0.3125]);
        assert_eq!(window(0.5), [0.4375, 0.75]);
        assert_eq!((window(0.0), window(1.0)), ([0.0, 0.0625], [0.75, 1.0]));
        assert_eq!(path(&[(0.0, [0.0; 3]), (1.0, [1.0; 3])], 0.0).unwrap().window_t(0.3), [0.3, 0.3]);
    }

    #[test]
    fn invalid_keys_are_refused() {
        let (near, far) = ((0.0, [0.0; 3]), (1.0, [1.0, 0.0, 0.0]));
        assert_eq!(path(&[near], 0.1), Err(LampError::Count(1)));
        assert_eq!(path(&[near, (1.0, [0.0; 3])], 0.1), Err(LampError::NoMotion { index: 0 }));
        for bad in [f64::NAN, f64::INFINITY, 2e9] {
            assert!(matches!(path(&[near, (1.0, [bad, 0.0, 0.0])], 0.1), Err(LampError::Position { index: 1, .. })));
        }
        for (t, index) in [(0.0, 1), (0.9, 1), (f64::NAN, 1)] {
            assert_eq!(path(&[near, (t, far.1)], 0.1), Err(LampError::Times { index }), "{t}");
        }
        let loops = [near, (0.6, [1.0; 3]), (0.6, [2.0; 3]), far];
        assert_eq!(path(&loops, 0.1), Err(LampError::Times { index: 2 }));
        for radius in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(path(&[near, far], radius), Err(LampError::Size { name: "radius_m", .. })));
        }
        for duration in [0.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(bent().lasting(duration), Err(LampError::Size { name: "duration_min", .. })));
        }
    }
}
