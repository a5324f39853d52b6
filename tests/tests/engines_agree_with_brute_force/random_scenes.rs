//! Random triangles, points and paths, as many as `SUNBAKE_CASES` says. The first are for every engine, the rest for
//! the exact one alone: it claims the most.

use glam::{DVec3, Vec3};
use sunbake::testing::SceneBuilder;
use sunbake_tests::engines::{ALL, EXACT, must_agree};
use sunbake_tests::paths::Random;
use sunbake_tests::{Traced, asked_for};

/// Cases that every engine is asked about.
const FOR_ALL: u64 = 2_000;

/// A triangle near or far, large or small, fat or thin.
fn triangle(random: &mut Random) -> [Vec3; 3] {
    let middle = random.direction() * 10f64.powf(random.range(-1.5, 1.0));
    let size = middle.length() * 10f64.powf(random.range(-1.0, 0.5));
    let corners = [0; 3].map(|_| middle + random.cube() * size);
    let thin = 10f64.powf(random.range(-2.0, 0.0));
    let [a, b, c] =
        if random.index(4) == 0 { [corners[0], corners[1], corners[0].lerp(corners[2], thin)] } else { corners };
    [a, b, c].map(|v| v.as_vec3())
}

/// One case: up to a dozen triangles, and points on them and in the air.
fn case(seed: u64) {
    let mut random = Random::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let count = 1 + random.index(12);
    let triangles: Vec<[Vec3; 3]> = (0..count).map(|_| triangle(&mut random)).collect();
    let here = Traced::new(SceneBuilder::new().soup(&triangles).build());
    let on = here.point(random.index(count), [0.3, 0.4]);
    let mut air = here.observer(random.cube() * 0.1, (random.direction() + DVec3::Y).normalize(), random.index(count));
    air.is_double_sided = random.index(2) == 0;
    let engines = if seed < FOR_ALL { &ALL[..] } else { &[EXACT] };
    must_agree(engines, &format!("case {seed}"), &here, &random.path(), &[on, air]);
}

#[test]
fn random_triangles_agree_with_brute_force() {
    use rayon::prelude::*;
    (0..asked_for("SUNBAKE_CASES", 20_000) as u64).into_par_iter().for_each(case);
}
