//! Which sides of each triangle are drawn.
//!
//! The front is, and the back of a double-sided material is. But where triangles share all three corners (blades of grass
//! modelled from both sides, a part that was pasted twice), depths tie and a picture would speckle, on a GPU by its
//! rounding and on a CPU by the order of its walk. So each side of such a stack shows one triangle: the first whose front
//! it is or, failing that, the first that is double-sided.

use glam::Vec3;
use sunbake::scene::{Alpha, Geometry, Material, Scene};

/// The sides of a triangle that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sides {
    /// Where its front normal points.
    pub front: bool,
    /// The other one.
    pub back: bool,
}

impl Sides {
    /// Whether neither is.
    pub fn is_none(self) -> bool {
        self == Self::default()
    }
}

/// The sides drawn of each triangle. `is_drawn` tells which instances are drawn at all.
pub fn sides(scene: &Scene, geometry: &Geometry, is_drawn: impl Fn(usize) -> bool) -> Vec<Sides> {
    let material = |triangle: usize| scene.material(geometry.instance[triangle] as usize);
    let mut sides: Vec<Sides> = (0..geometry.triangles.len())
        .map(|triangle| match is_drawn(geometry.instance[triangle] as usize) {
            true => Sides { front: true, back: material(triangle).is_double_sided },
            false => Sides::default(),
        })
        .collect();
    for stack in stacks(geometry, &sides) {
        share(&stack, &mut sides, geometry, material);
    }
    sides
}

/// Corners as bits, in an order that does not depend on which comes first.
fn key(corners: &[Vec3; 3]) -> [[u32; 3]; 3] {
    // Adding zero makes one of the two zeros.
    let mut key = corners.map(|corner| (corner + 0.0).to_array().map(f32::to_bits));
    key.sort_unstable();
    key
}

/// Drawn triangles that share all corners, in ascending order, two or more to a stack.
fn stacks(geometry: &Geometry, sides: &[Sides]) -> Vec<Vec<u32>> {
    let drawn = (0..geometry.triangles.len()).filter(|&i| !sides[i].is_none());
    let mut keyed: Vec<([[u32; 3]; 3], u32)> = drawn.map(|i| (key(&geometry.triangles[i]), i as u32)).collect();
    keyed.sort_unstable();
    let runs = keyed.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() > 1);
    runs.map(|run| run.iter().map(|(_, triangle)| *triangle).collect()).collect()
}

/// Leaves each side of a stack to one triangle.
fn share<'a>(stack: &[u32], sides: &mut [Sides], geometry: &Geometry, material: impl Fn(usize) -> &'a Material) {
    // What shows through a hole is not this rule's to say, unless all have the same holes.
    let first = material(stack[0] as usize);
    let is_alike = |m: &Material| m.alpha == Alpha::Opaque || std::ptr::eq(m, first);
    if !stack.iter().all(|&triangle| is_alike(material(triangle as usize))) {
        return;
    }
    let up = geometry.normal(stack[0] as usize);
    let faces_up: Vec<bool> = stack.iter().map(|&t| geometry.normal(t as usize).dot(up) > 0.0).collect();
    let asked: Vec<Sides> = stack.iter().map(|&t| std::mem::take(&mut sides[t as usize])).collect();
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

    const FRONT: Sides = Sides { front: true, back: false };
    const BACK: Sides = Sides { front: false, back: true };
    const BOTH: Sides = Sides { front: true, back: true };
    const NEITHER: Sides = Sides { front: false, back: false };

    /// The sides drawn of a stack of squares; each is flipped or not, and double-sided or not.
    fn stack(squares: &[(bool, bool)]) -> Vec<Sides> {
        let mut builder = SceneBuilder::new();
        for &(is_flipped, is_double_sided) in squares {
            let mut triangles = floor(Vec2::ZERO, Vec2::ONE, 0.0);
            if is_flipped {
                triangles = triangles.into_iter().map(|[a, b, c]| [b, a, c]).collect();
            }
            builder = builder.soup_of(&triangles, Material { is_double_sided, ..opaque() });
        }
        let scene = builder.build();
        let all = sides(&scene, &Geometry::new(&scene), |_| true);
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
