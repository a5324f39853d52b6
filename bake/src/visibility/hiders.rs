//! Which parts of a scene hide the sun from points.

/// For each of some points, parts of a scene: those whose triangles closed gaps in its query, ascending, each once.
/// There may be more than are needed. Empty where an engine does not note them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Hiders {
    parts: Vec<u32>,
    /// For each point, where its parts end.
    ends: Vec<u32>,
}

impl Hiders {
    /// Adds the next point with its parts, which may come in any order and more than once.
    pub fn push(&mut self, parts: &mut Vec<u32>) {
        parts.sort_unstable();
        parts.dedup();
        self.parts.append(parts);
        self.ends.push(self.parts.len() as u32);
    }

    /// The parts of a point.
    pub fn of_point(&self, point: usize) -> &[u32] {
        let start = point.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.parts[start..self.ends[point] as usize]
    }

    /// Whether nothing was noted.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The points of several lists, one list after the other.
    pub fn joined(lists: Vec<Self>) -> Self {
        let count = |of: fn(&Self) -> usize| lists.iter().map(of).sum();
        let mut all = Self {
            parts: Vec::with_capacity(count(|list| list.parts.len())),
            ends: Vec::with_capacity(count(|list| list.ends.len())),
        };
        for list in lists {
            let before = all.parts.len() as u32;
            all.parts.extend(list.parts);
            all.ends.extend(list.ends.iter().map(|end| before + end));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_lists_have_the_points_of_all() {
        let list = |points: &[&[u32]]| {
            let mut list = Hiders::default();
            points.iter().for_each(|parts| list.push(&mut parts.to_vec()));
            list
        };
        let all = Hiders::joined(vec![list(&[&[3, 1, 3], &[]]), Hiders::default(), list(&[&[2]])]);
        assert_eq!([0, 1, 2].map(|point| all.of_point(point).to_vec()), [vec![1, 3], vec![], vec![2]]);
        assert!(!all.is_empty() && Hiders::joined(Vec::new()).is_empty());
    }
}
