//! A stage's tracer is built on first use, and must be built before threads start: a rayon thread that waits while
//! building one takes other work, which may need the same tracer, and would deadlock.

use glam::DVec3;
use sunbake::testing::{SceneBuilder, icosphere};
use sunbake_runtime::testing::view;
use sunbake_runtime::{Camera, Shot, Stage};

fn stage() -> Stage {
    Stage::plain(SceneBuilder::new().soup(&icosphere(5)).build(), None)
}

#[test]
fn pictures_of_a_new_stage_are_found_by_sixteen_threads() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(16).build().unwrap();
    for _ in 0..40 {
        let (seen, camera) = pool.install(|| {
            let stages = [stage(), stage()];
            let view = view(&stages[0], DVec3::new(3.0, 1.0, 2.0), DVec3::ZERO, [64, 64]);
            let seen = Shot::new(&stages[0], view).hits().iter().flatten().count();
            (seen, Camera::default_of(&stages[1], 1.0))
        });
        assert!(seen > 100 && camera.eye_m.is_finite());
    }
}
