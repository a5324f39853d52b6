//! Sorted, disjoint intervals of path time: the answer to "when does this point see the light?".
//!
//! Sun paths, visibility and maps all use them, so they are a module of their own below those.

/// Lit intervals of one point.
///
/// Guarantees: every interval lies in [0, 1] and has positive length; intervals ascend and do not touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Intervals(Vec<[f64; 2]>);

impl Intervals {
    /// Lit the whole path.
    pub fn always() -> Self {
        Self(vec![[0.0, 1.0]])
    }

    /// No interval: the light is never seen.
    pub fn never() -> Self {
        Self(Vec::new())
    }

    /// Sorts, clips to [0, 1], drops what is empty (or NaN) and joins what overlaps or touches.
    pub fn from_unsorted(mut raw: Vec<[f64; 2]>) -> Self {
        for interval in &mut raw {
            *interval = interval.map(|t| t.clamp(0.0, 1.0));
        }
        raw.retain(|[start, end]| start < end);
        raw.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut joined: Vec<[f64; 2]> = Vec::with_capacity(raw.len());
        for [start, end] in raw {
            match joined.last_mut() {
                Some(last) if start <= last[1] => last[1] = last[1].max(end),
                _ => joined.push([start, end]),
            }
        }
        Self(joined)
    }

    /// Start and end of each interval, ascending, in path time.
    pub fn as_slice(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Total lit length, in [0, 1].
    pub fn lit_length(&self) -> f64 {
        self.0.iter().map(|[start, end]| end - start).sum()
    }

    /// Whether the sun is seen at `t` (ends count as lit).
    pub fn contains(&self, t: f64) -> bool {
        self.0.iter().any(|&[start, end]| (start..=end).contains(&t))
    }

    /// The times that are in these and not in others.
    pub fn without(&self, others: &Self) -> Self {
        let mut left = Vec::with_capacity(self.0.len() + others.0.len());
        for &[start, end] in &self.0 {
            let mut from = start;
            for &[cut_start, cut_end] in others.0.iter().filter(|other| other[1] > start && other[0] < end) {
                left.push([from, cut_start]);
                from = cut_end;
            }
            left.push([from, end]);
        }
        left.retain(|[start, end]| start < end);
        Self(left)
    }

    /// Those that are longer.
    pub fn longer_than(&self, least: f64) -> Self {
        Self(self.0.iter().copied().filter(|[start, end]| end - start > least).collect())
    }

    /// The times that are in both.
    pub fn intersection(&self, other: &Self) -> Self {
        let pairs = self.0.iter().flat_map(|a| other.0.iter().map(move |b| [a[0].max(b[0]), a[1].min(b[1])]));
        Self::from_unsorted(pairs.collect())
    }
}

/// Intervals of many points, end to end in two arrays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct IntervalTable {
    ends: Vec<u32>,
    intervals: Vec<[f64; 2]>,
}

impl IntervalTable {
    /// Adds the next point's.
    pub fn push(&mut self, intervals: &Intervals) {
        self.intervals.extend_from_slice(intervals.as_slice());
        self.ends.push(self.intervals.len() as u32);
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Those of a point: start and end of each.
    pub fn get(&self, index: usize) -> &[[f64; 2]] {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.intervals[start..self.ends[index] as usize]
    }

    /// Each point's, in order.
    pub fn iter(&self) -> impl Iterator<Item = Intervals> + '_ {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| Intervals(self.intervals[start as usize..end as usize].to_vec()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlaps_touches_and_disorder_join() {
        let joined = Intervals::from_unsorted(vec![[0.5, 0.7], [0.1, 0.2], [0.2, 0.3], [0.6, 0.9]]);
        assert_eq!(joined.as_slice(), [[0.1, 0.3], [0.5, 0.9]]);
    }

    #[test]
    fn empty_backward_outside_and_nan_intervals_vanish() {
        let raw = vec![[0.3, 0.3], [0.5, 0.4], [f64::NAN, 0.5], [0.5, f64::NAN], [1.5, 2.0], [-1.0, -0.5]];
        assert_eq!(Intervals::from_unsorted(raw), Intervals::never());
        assert_eq!(Intervals::from_unsorted(vec![[-1.0, 2.0]]), Intervals::always());
    }

    #[test]
    fn what_is_taken_away_leaves_the_rest() {
        let of = |raw: &[[f64; 2]]| Intervals::from_unsorted(raw.to_vec());
        let day = of(&[[0.1, 0.5], [0.6, 0.9]]);
        assert_eq!(day.without(&of(&[[0.2, 0.3], [0.4, 0.7]])), of(&[[0.1, 0.2], [0.3, 0.4], [0.7, 0.9]]));
        assert_eq!(day.without(&of(&[[0.0, 0.5], [0.9, 1.0]])), of(&[[0.6, 0.9]]));
        assert_eq!((day.without(&Intervals::never()), day.without(&Intervals::always())), (day.clone(), of(&[])));
        assert_eq!(day.longer_than(0.35), of(&[[0.1, 0.5]]));
    }

    #[test]
    fn a_table_gives_back_what_was_pushed() {
        let rows = [Intervals::always(), Intervals::never(), Intervals::from_unsorted(vec![[0.1, 0.2], [0.4, 0.5]])];
        let mut table = IntervalTable::default();
        rows.iter().for_each(|row| table.push(row));
        assert_eq!(table.iter().collect::<Vec<_>>(), rows);
    }
}
