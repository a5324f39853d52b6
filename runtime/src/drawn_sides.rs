//! Which sides of each triangle are drawn.
//!
//! The front is drawn, and so is the back of a double-sided material. But where triangles share all three corners
//! (blades of grass modelled from both sides, a part that was pasted twice), depths tie and a picture would speckle: on
//! a GPU by rounding, on a CPU by the order in which the BVH is walked. So on each side of such a stack one triangle is
//! drawn: the first whose front is there or, failing that, the first that is double-sided.

use glam::Vec3;
use sunbake::scene::{Alpha, Geometry, Material, Scene};

/// The sides of a triangle that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DrawnSides {
    /// The side to which the normal points.
    pub front: bool,
    /// The side to which the reversed normal points.
    pub back: bool,
}

impl DrawnSides {
    /// Whether neither side is drawn.
    pub fn is_none(self) -> bool {
        self == Self::default()
    }
}

/// The sides drawn of each triangle. `is_drawn` tells which instances are drawn at all.
pub fn drawn_sides(scene: &Scene, geometry: &Geometry, is_drawn: impl Fn(usize) -> bool) -> Vec<DrawnSides> {
    let material = |triangle: usize| scene.material(geometry.instance[triangle] as usize);
    let mut sides: Vec<DrawnSides> = (0..geometry.triangles.len())
        .map(|triangle| match is_drawn(geometry.instance[triangle] as usize) {
            true => DrawnSides { front: true, back: material(triangle).is_double_sided },
            false => DrawnSides::default(),
        })
        .collect();
    for stack in stacks(geometry, &sides) {
        share(&stack, &mut sides, geometry, material);
    }
    sides
}

/// Corners as bits, sorted, so that triangles with the same corners have the same key.
fn key(corners: &[Vec3; 3]) -> [[u32; 3]; 3] {
    // Adding zero turns -0.0 into 0.0.
    let mut key = corners.map(|corner| (corner + 0.0).to_array().map(f32::to_bits));
    key.sort_unstable();
    key
}

/// Drawn triangles that share all corners, in ascending order, two or more to a stack.
fn stacks(geometry: &Geometry, sides: &[DrawnSides]) -> Vec<Vec<u32>> {
    let drawn = (0..geometry.triangles.len()).filter(|&i| !sides[i].is_none());
    let mut keyed: Vec<([[u32; 3]; 3], u32)> = drawn.map(|i| (key(&geometry.triangles[i]), i as u32)).collect();
    keyed.sort_unstable();
    let runs = keyed.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() > 1);
    runs.map(|run| run.iter().map(|(_, triangle)| *triangle).collect()).collect()
}

/// Leaves each side of a stack to one of its triangles.
fn share<'a>(stack: &[u32], sides: &mut [DrawnSides], geometry: &Geometry, material: impl Fn(usize) -> &'a Material) {
    // An alpha mask may show the triangle behind, so stacks with different masks stay as they are.
    let first = material(stack[0] as usize);
    let is_alike = |m: &Material| m.alpha == Alpha::Opaque || std::ptr::eq(m, first);
    if !stack.iter().all(|&triangle| is_alike(material(triangle as usize))) {
        return;
    }
    let up = geometry.normal(stack[0] as usize);
    let faces_up: Vec<bool> = stack.iter().map(|&t| geometry.normal(t as usize).dot(up) > 0.0).collect();
    let asked: Vec<DrawnSides> = stack.iter().map(|&t| std::mem::take(&mut sides[t as usize])).collect();
    for is_up in [true, false] {
        let by_front = (0..stack.len()).find(|&i| faces_up[i] == is_up && asked[i].front);
        let by_back = || (0..stack.len()).find(|&i| faces_up[i] != is_up && asked[i].back);
        let Some(shown) = by_front.or_else(by_back) else { continue };
        let side = &mut sides[stack[shown] as usize];
        match faces_up[shown] == is_up {
            true => side.front = true,
            false => side.back = true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use sunbake::testing::{SceneBuilder, floor, opaque};

    const FRONT: DrawnSides = DrawnSides { front: true, back: false };
    const BACK: DrawnSides = DrawnSides { front: false, back: true };
    const BOTH: DrawnSides = DrawnSides { front: true, back: true };
    const NEITHER: DrawnSides = DrawnSides { front: false, back: false };

    /// The sides drawn of a stack of squares; each is flipped or not, and double-sided or not.
    fn stack(squares: &[(bool, bool)]) -> Vec<DrawnSides> {
        let mut builder = SceneBuilder::new();
        for &(is_flipped, is_double_sided) in squares {
            let mut triangles = floor(Vec2::ZERO, Vec2::ONE, 0.0);
            if is_flipped {
                triangles = triangles.into_iter().map(|[a, b, c]| [b, a, c]).collect();
            }
            builder = builder.soup_of(&triangles, Material { is_double_sided, ..opaque() });
        }
        let scene = builder.build();
        let all = drawn_sides(&scene, &Geometry::new(&scene), |_| true);
        all.chunks(2).inspect(|pair| assert_eq!(pair[0], pair[1])).map(|pair| pair[0]).collect()
    }

    #[test]
    fn each_side_of_a_stack_shows_one_triangle() {
        assert_eq!(stack(&[(false, false)]), [FRONT]);
        assert_eq!(stack(&[(false, true)]), [BOTH]);
        assert_eq!(stack(&[(false, false), (true, false)]), [FRONT, FRONT]);
        assert_eq!(stack(&[(false, true), (true, true)]), [FRONT, FRONT]);
        assert_eq!(stack(&[(false, true), (false, true)]), [BOTH, NEITHER]);
        assert_eq!(stack(&[(false, false), (false, true)]), [FRONT, BACK]);
    }
}
