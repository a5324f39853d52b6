//! How well an engine's intervals agree with brute force, sun by sun and edge by edge.

use sunbake::visibility::Intervals;

/// The result of comparing. Distances are in `t`, from the middle between two neighbouring suns that brute force
/// answers differently.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Agreement {
    /// Points compared.
    pub points: u64,
    /// Suns compared.
    pub suns: u64,
    /// Times that brute force changes from a sun to the next.
    pub edges: u64,
    /// Suns about which they disagree, within a step of an edge of either.
    pub beside_an_edge: u64,
    /// Suns about which they disagree, anywhere else.
    pub elsewhere: u64,
    /// Lit or dark intervals of two suns or more, of which the engine has none.
    pub missed: u64,
    /// How far from brute force's nearest edge they disagree, at most.
    pub furthest_t: f64,
    /// How far an edge of the engine is from brute force's nearest, at most. Intervals too short for brute force to
    /// resolve do not count.
    pub edge_error_t: f64,
}

impl Agreement {
    /// Compares the intervals of one point with what brute force says of evenly spaced suns.
    pub fn of(found: &Intervals, truth: &[bool]) -> Self {
        let step_t = 1.0 / truth.len() as f64;
        let said = labels(found, truth.len());
        let edges_t: Vec<f64> =
            (1..truth.len()).filter(|&i| truth[i] != truth[i - 1]).map(|i| i as f64 * step_t).collect();
        let ends_t: Vec<f64> =
            found.as_slice().as_flattened().iter().copied().filter(|t| (f64::MIN_POSITIVE..1.0).contains(t)).collect();
        let mut all = Self { points: 1, suns: truth.len() as u64, edges: edges_t.len() as u64, ..Self::default() };
        for sun in (0..truth.len()).filter(|&sun| said[sun] != truth[sun]) {
            let t = (sun as f64 + 0.5) * step_t;
            let from_edge_t = nearest(&edges_t, t);
            let is_beside = from_edge_t.min(nearest(&ends_t, t)) <= step_t;
            all.beside_an_edge += u64::from(is_beside);
            all.elsewhere += u64::from(!is_beside);
            all.furthest_t = all.furthest_t.max(from_edge_t);
        }
        all.missed = missed(&said, truth);
        all.edge_error_t =
            lasting_edges(&ends_t, step_t).map(|end_t| nearest(&edges_t, end_t)).fold(all.edge_error_t, f64::max);
        all
    }

    /// Sums counts, and keeps the larger distances.
    pub fn add(&mut self, other: &Self) {
        self.points += other.points;
        self.suns += other.suns;
        self.edges += other.edges;
        self.beside_an_edge += other.beside_an_edge;
        self.elsewhere += other.elsewhere;
        self.missed += other.missed;
        self.furthest_t = self.furthest_t.max(other.furthest_t);
        self.edge_error_t = self.edge_error_t.max(other.edge_error_t);
    }
}

/// What intervals say of each of `count` suns.
fn labels(found: &Intervals, count: usize) -> Vec<bool> {
    let mut said = vec![false; count];
    for &[start, end] in found.as_slice() {
        let first = (start * count as f64 - 0.5).ceil().max(0.0) as usize;
        let last = (end * count as f64 - 0.5).floor() + 1.0;
        let last = (last.max(0.0) as usize).min(count);
        said[first.min(last)..last].fill(true);
    }
    said
}

/// Distance to the nearest of ascending numbers; infinite if there is none.
fn nearest(ascending: &[f64], t: f64) -> f64 {
    let after = ascending.partition_point(|&x| x < t);
    let beside = ascending[after.saturating_sub(1)..ascending.len().min(after + 1)].iter();
    beside.map(|x| (x - t).abs()).fold(f64::INFINITY, f64::min)
}

/// Lit or dark intervals of two suns or more about all of which the engine is wrong.
fn missed(said: &[bool], truth: &[bool]) -> u64 {
    let mut first = 0;
    let mut count = 0;
    for run in truth.chunk_by(|a, b| a == b) {
        let range = first..first + run.len();
        count += u64::from(run.len() >= 2 && said[range.clone()].iter().all(|s| *s != run[0]));
        first = range.end;
    }
    count
}

/// Ends of intervals with light and shade of at least a step on either side.
fn lasting_edges(ends_t: &[f64], step_t: f64) -> impl Iterator<Item = f64> {
    let all: Vec<f64> = [&[0.0], ends_t, &[1.0]].concat();
    let lasts =
        move |three: &[f64]| (three[1] - three[0] >= step_t && three[2] - three[1] >= step_t).then_some(three[1]);
    all.windows(3).filter_map(lasts).collect::<Vec<_>>().into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen suns, lit from the fifth to the twelfth.
    fn truth() -> Vec<bool> {
        (0..16).map(|i| (4..12).contains(&i)).collect()
    }

    fn compare(raw: &[[f64; 2]]) -> Agreement {
        Agreement::of(&Intervals::from_unsorted(raw.to_vec()), &truth())
    }

    #[test]
    fn the_same_agrees() {
        let same = compare(&[[0.25, 0.75]]);
        assert_eq!((same.suns, same.edges), (16, 2));
        assert_eq!((same.beside_an_edge, same.elsewhere, same.missed), (0, 0, 0));
        assert_eq!((same.furthest_t, same.edge_error_t), (0.0, 0.0));
    }

    #[test]
    fn an_edge_off_by_a_step_is_beside_it_and_by_three_is_not() {
        let near = compare(&[[0.25 - 1.0 / 16.0, 0.75]]);
        assert_eq!((near.beside_an_edge, near.elsewhere), (1, 0));
        assert_eq!((near.furthest_t, near.edge_error_t), (0.5 / 16.0, 1.0 / 16.0));
        let far = compare(&[[0.25 + 3.0 / 16.0, 0.75]]);
        assert_eq!((far.beside_an_edge, far.elsewhere), (2, 1), "one in the middle is a step away from both");
    }

    #[test]
    fn an_interval_that_is_not_found_is_missed() {
        assert_eq!(compare(&[[0.0, 1.0]]).missed, 2);
        let none = compare(&[]);
        assert_eq!((none.missed, none.elsewhere, none.beside_an_edge), (1, 6, 2));
        // Light that brute force does not know.
        let invented = compare(&[[0.0, 0.125], [0.25, 0.75]]);
        assert_eq!((invented.missed, invented.beside_an_edge, invented.edge_error_t), (0, 1, 0.125));
    }

    #[test]
    fn an_interval_between_two_suns_is_no_error() {
        let brief = compare(&[[0.25, 0.5], [0.51, 0.75]]);
        assert_eq!((brief.elsewhere + brief.beside_an_edge, brief.edge_error_t), (0, 0.0));
    }
}
