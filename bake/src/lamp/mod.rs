//! Lamps that move through the scene: where a lamp stands at every moment `t` in [0, 1].
//!
//! A path is a chain of straight segments, each passed at constant speed. From one point, all places of the lamp on one
//! segment lie in a triangle with the point, so visibility along it has closed-form answers, and what stands beyond the
//! lamp hides nothing (`visibility/lamp`). A file of keys makes a path (`parse.rs`).
//!
//! The lamp is a ball. Playback takes it as a line along its own path, as it takes the sun (GPU Gems, chapter 13, "linear
//! light"): at `t` it is the stretch of path within one radius of the centre, before and behind, and what is seen of it
//! is the lit share of the time in which the centre passes that stretch ([`LampPath::window_t`]).

mod parse;

pub use parse::{LampFileError, is_lamp, parse_lamp};

use glam::DVec3;

/// Largest coordinate of a key, in metres: beyond it a metre is lost in rounding.
const MOST_M: f64 = 1e9;
/// Smallest distance between neighbouring keys, in metres.
const LEAST_STEP_M: f64 = 1e-6;
/// How far apart, in `t`, the path's ends may be from 0 and 1 and still be taken for them.
const END_TOLERANCE_T: f64 = 1e-9;

/// A place and when the lamp is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampKey {
    /// When.
    pub t: f64,
    /// Where.
    pub position_m: DVec3,
}

/// From one key to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampSegment {
    /// Where it starts and ends.
    pub ends_m: [DVec3; 2],
    /// When.
    pub t: [f64; 2],
}

/// The path of a lamp over `t` in [0, 1], in a space that its owner knows: world, as made; bake space for engines.
///
/// Guarantees, made by [`LampPath::new`]: two keys at least, the first at exactly t = 0 and the last at exactly t = 1;
/// times ascend; neighbouring keys lie apart; every number is finite, the radius not negative and the duration positive.
#[derive(Debug, Clone, PartialEq)]
pub struct LampPath {
    keys: Vec<LampKey>,
    radius_m: f64,
    duration_min: f64,
}

/// Why keys make no path of a lamp.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LampError {
    /// One key or none.
    #[error("the lamp's path has {0} keys: give at least two places")]
    Count(usize),
    /// Not finite, or too far away.
    #[error("key {index} of the lamp's path (counted from 0) is at {position_m}: give metres from -1e9 to 1e9")]
    Position {
        /// Which key.
        index: usize,
        /// Where it is said to be.
        position_m: DVec3,
    },
    /// Two keys in one place.
    #[error(
        "keys {index} and {next} of the lamp's path (counted from 0) are in the same place: a lamp that stands still has \
         no path; drop one of them",
        next = .index + 1
    )]
    StandsStill {
        /// The first of the two.
        index: usize,
    },
    /// Not ascending from 0 to 1.
    #[error(
        "the times of the lamp's keys must ascend from 0 to 1, and the one of key {index} (counted from 0) does not"
    )]
    Times {
        /// Which key.
        index: usize,
    },
    /// A size out of range.
    #[error("the lamp's {name} is {value}: give a number {bound}")]
    Size {
        /// The file's name for it.
        name: &'static str,
        /// What it is.
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

    /// Radius of the lamp.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Minutes that the path takes.
    pub fn duration_min(&self) -> f64 {
        self.duration_min
    }

    /// The same places at the same `t`, over another time.
    pub fn lasting(&self, duration_min: f64) -> Result<Self, LampError> {
        Self::new(self.keys.clone(), self.radius_m, duration_min)
    }

    /// The same path in a space whose origin is at `origin_m` of this one.
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

    /// Where the lamp's centre is at `t` (clamped to [0, 1]).
    pub fn position_m(&self, t: f64) -> DVec3 {
        let [from, to] = self.around(t);
        from.position_m.lerp(to.position_m, ((t - from.t) / (to.t - from.t)).clamp(0.0, 1.0))
    }

    /// When the centre is within one radius of where it is at `t`, along the path: one diameter over the speed, less what
    /// lies before the path's start and after its end. Empty for a lamp without radius.
    pub fn window_t(&self, t: f64) -> [f64; 2] {
        let passed_m = self.passed_m(t.clamp(0.0, 1.0));
        if self.radius_m == 0.0 {
            return [t; 2];
        }
        [self.t_passed(passed_m - self.radius_m), self.t_passed(passed_m + self.radius_m)]
    }

    /// The keys before and after `t`.
    fn around(&self, t: f64) -> [LampKey; 2] {
        let next = self.keys.iter().position(|key| t < key.t).unwrap_or(self.keys.len() - 1).max(1);
        [self.keys[next - 1], self.keys[next]]
    }

    /// Length of the path until `t`.
    fn passed_m(&self, t: f64) -> f64 {
        let share = |s: &LampSegment| ((t - s.t[0]) / (s.t[1] - s.t[0])).clamp(0.0, 1.0);
        self.segments().map(|s| share(&s) * s.length_m()).sum()
    }

    /// When so much of the path's length is passed, within [0, 1].
    fn t_passed(&self, mut length_m: f64) -> f64 {
        for segment in self.segments() {
            let all_m = segment.length_m();
            if length_m < all_m {
                return segment.t[0] + (length_m / all_m).max(0.0) * (segment.t[1] - segment.t[0]);
            }
            length_m -= all_m;
        }
        1.0
    }
}

impl LampSegment {
    /// How long it is.
    pub fn length_m(&self) -> f64 {
        self.ends_m[0].distance(self.ends_m[1])
    }
}

fn check_positions(keys: &[LampKey]) -> Result<(), LampError> {
    for (index, LampKey { position_m, .. }) in keys.iter().enumerate() {
        // Not `> MOST_M`: a NaN is to be refused.
        if !(position_m.is_finite() && position_m.abs().max_element() <= MOST_M) {
            return Err(LampError::Position { index, position_m: *position_m });
        }
    }
    let still = |pair: &[LampKey]| pair[0].position_m.distance(pair[1].position_m) < LEAST_STEP_M;
    keys.windows(2).position(still).map_or(Ok(()), |index| Err(LampError::StandsStill { index }))
}

fn check_times(keys: &[LampKey]) -> Result<(), LampError> {
    let last = keys.len() - 1;
    // Ranges, so that a NaN lies outside of them.
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
    fn the_window_is_a_diameter_of_path_and_bends_with_it() {
        let window = |t| bent().window_t(t);
        assert_eq!(window(0.25), [0.1875, 0.3125]);
        assert_eq!(window(0.5), [0.4375, 0.75]);
        assert_eq!((window(0.0), window(1.0)), ([0.0, 0.0625], [0.75, 1.0]));
        assert_eq!(path(&[(0.0, [0.0; 3]), (1.0, [1.0; 3])], 0.0).unwrap().window_t(0.3), [0.3, 0.3]);
    }

    #[test]
    fn what_is_no_path_is_refused() {
        let (near, far) = ((0.0, [0.0; 3]), (1.0, [1.0, 0.0, 0.0]));
        assert_eq!(path(&[near], 0.1), Err(LampError::Count(1)));
        assert_eq!(path(&[near, (1.0, [0.0; 3])], 0.1), Err(LampError::StandsStill { index: 0 }));
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
