//! Lists of times: codes from a start to an end, ascending and disjoint.

use crate::maps::Bits;

/// All that lies in any of these times.
pub(super) fn union(times: impl Iterator<Item = [u16; 2]>) -> Vec<[u16; 2]> {
    let mut sorted: Vec<[u16; 2]> = times.collect();
    sorted.sort_unstable();
    let mut joined: Vec<[u16; 2]> = Vec::new();
    for span in sorted {
        match joined.last_mut().filter(|last| span[0] <= last[1]) {
            Some(last) => last[1] = last[1].max(span[1]),
            None => joined.push(span),
        }
    }
    joined
}

/// What lies between the times of a list, from the path's start to its end. Empty times part nothing.
pub(super) fn between(times: impl IntoIterator<Item = [u16; 2]>) -> Vec<[u16; 2]> {
    let mut from = 0;
    let mut found = Vec::new();
    for [start, end] in times.into_iter().filter(|[start, end]| start < end) {
        if from < start {
            found.push([from, start]);
        }
        from = end;
    }
    let last = Bits::Sixteen.max_code();
    if from < last {
        found.push([from, last]);
    }
    found
}

/// What lies in both lists.
pub(super) fn both(some: &[[u16; 2]], others: &[[u16; 2]]) -> Vec<[u16; 2]> {
    let (mut a, mut b) = (0, 0);
    let mut found = Vec::new();
    while let (Some(one), Some(other)) = (some.get(a), others.get(b)) {
        let [start, end] = [one[0].max(other[0]), one[1].min(other[1])];
        if start < end {
            found.push([start, end]);
        }
        if one[1] < other[1] {
            a += 1;
        } else {
            b += 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_what_their_codes_say() {
        let spans = [[30, 40], [5, 10], [10, 20], [35, 50]];
        let all = union(spans.into_iter());
        assert_eq!(all, [[5, 20], [30, 50]]);
        assert_eq!(between(all.iter().copied()), [[0, 5], [20, 30], [50, 65535]]);
        assert_eq!(between([[0, 20], [30, 65535]]), [[20, 30]]);
        assert_eq!(between([]), [[0, 65535]]);
        assert_eq!(between([[7, 7], [9, 65535]]), [[0, 9]]);
        assert_eq!(both(&all, &[[0, 7], [15, 35], [49, 60]]), [[5, 7], [15, 20], [30, 35], [49, 50]]);
        assert_eq!(both(&all, &[[20, 30]]), [[0u16; 2]; 0]);
    }
}
