//! Common to the path files of suns and of lamps: a list of keys, and the path time of each key.

use crate::words::counted;

/// Most keys that a path may have: each pair costs a query of the scene for every texel.
pub const MAX_KEYS: usize = 1000;

/// Shortest time between neighbouring keys, as a share of the path.
const MIN_STEP_T: f64 = 1e-6;

/// Why the keys of a path file are refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum KeyError {
    /// Not JSON, or unknown or missing fields.
    #[error("the path file is not understood: {0}")]
    Json(String),
    /// Too few or too many keys.
    #[error("the path has {}: give 2 to {MAX_KEYS}", counted(*.0 as u64, "key"))]
    Count(usize),
    /// A key is invalid.
    #[error("key {index} of the path (counted from 0) {problem}")]
    Key {
        /// Index of the key, from 0.
        index: usize,
        /// What is wrong, and what to give.
        problem: String,
    },
    /// Two neighbouring keys contradict each other.
    #[error("keys {index} and {next} of the path (counted from 0) {problem}", next = .index + 1)]
    Pair {
        /// The first of the two.
        index: usize,
        /// What is wrong, and what to give.
        problem: String,
    },
}

/// Path times of the keys, from 0 to 1: those given, or evenly spaced if no key has one.
pub(crate) fn key_times(given: &[Option<f64>]) -> Result<Vec<f64>, KeyError> {
    if !(2..=MAX_KEYS).contains(&given.len()) {
        return Err(KeyError::Count(given.len()));
    }
    let last = given.len() - 1;
    if given.iter().all(Option::is_none) {
        return Ok((0..=last).map(|i| i as f64 / last as f64).collect());
    }
    let wrong = |index, problem: String| Err(KeyError::Key { index, problem });
    let mut times = Vec::with_capacity(given.len());
    for (index, t) in given.iter().enumerate() {
        let Some(t) = *t else {
            return wrong(index, "has no 't': give every key one, or none".to_owned());
        };
        let expected = if index == 0 { Some(0.0) } else { (index == last).then_some(1.0) };
        if expected.is_some_and(|expected| t != expected) {
            return wrong(index, format!("has t = {t}: the first is at 0 and the last at 1"));
        }
        times.push(t);
    }
    for (index, pair) in times.windows(2).enumerate() {
        if pair[1] - pair[0] < MIN_STEP_T {
            let problem =
                format!("are at t = {} and {}: times must ascend, by {MIN_STEP_T} at least", pair[0], pair[1]);
            return Err(KeyError::Pair { index, problem });
        }
    }
    Ok(times)
}
