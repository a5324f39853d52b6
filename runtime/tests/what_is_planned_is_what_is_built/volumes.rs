//! Shadow volumes.

use crate::{ASIDE, OUTPUTS, cube, draw, on_ground, shot, sun, turned_on, with_ball, with_box, with_lid};
use glam::{DVec3, Vec2, Vec3};
use sunbake::testing::{SceneBuilder, block, floor};
use sunbake_runtime::gpu::{Gpu, Output, VolumeSettings, volumes_plan};
use sunbake_runtime::plan::Census;
use sunbake_runtime::technique::{Technique, Volumes};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::volumes::Mode;
use sunbake_runtime::{DrawPlan, Stage};

/// What a picture with shadow volumes builds: at most what its plan says before, exactly what it says after.
fn under_volumes(gpu: &Gpu, stage: &Stage, settings: VolumeSettings, eye: DVec3, output: Output) -> (Census, DrawPlan) {
    let most = volumes_plan(stage, &settings, output);
    let shot = shot(stage, eye);
    let mut technique = Volumes::new(gpu, stage, settings).unwrap();
    let before = technique.draw_plan(&shot, output);
    draw(&mut technique, &shot, output);
    let (found, plan) = (technique.census().unwrap(), technique.draw_plan(&shot, output));
    let name = format!("{} {output:?}", technique.name());
    assert!(found.is_within(&most.totals), "{name}: {:?}", found.beyond(&most.totals));
    assert!(found.is_within(&before.totals) && before.totals.is_within(&most.totals), "{name}");
    assert_eq!((plan.totals, plan.is_exact, most.is_exact), (found, true, false), "{name}");
    (found, plan)
}

/// More sheets over each other than a stencil counts.
fn with_sheets(builder: SceneBuilder) -> SceneBuilder {
    let sheets = (0..260).flat_map(|i| floor(Vec2::ZERO, Vec2::ONE, 0.2 + 0.005 * i as f32));
    builder.soup(&sheets.collect::<Vec<_>>())
}

fn with_lamp_above(stage: Stage) -> Stage {
    stage.with_lamp(Some(&lamp_at(DVec3::new(0.4, 3.0, 0.3))))
}

#[test]
fn volumes_build_what_is_planned_and_each_need_adds_its_own() {
    let gpu = gpu();
    let settings = VolumeSettings::default();
    // A slab, because a floor without a back is an open mesh.
    let slab = || SceneBuilder::new().soup(&block(Vec3::new(-3.0, -0.2, -3.0), Vec3::new(3.0, 0.0, 3.0)));
    let stage = |edit: fn(SceneBuilder) -> SceneBuilder| Stage::plain(edit(slab()).build(), sun(0.0));
    let (base, base_plan) = under_volumes(&gpu, &stage(with_box), settings, ASIDE, Output::Lit);
    let expected = Census {
        passes: 4,    // Depth, all around, volumes, light.
        pipelines: 5, // Depth, all around, sky, the sun's light, faces in front of the surface.
        vertex_buffers: 2,
        bind_groups: 2, // The frame's, and the casters'.
        bindings: 3,
        targets: 2,
        draws: 1,
        stencil_pipelines: 1,
        volume_buffers: 2,
        volume_bytes: base.volume_bytes,
        ..Census::default()
    };
    assert_eq!(base, expected);
    assert!(base_plan.is_on("z-pass") && !base_plan.is_on("z-fail") && !base_plan.is_on("open-meshes"));
    // An open mesh: faces behind the surface as well.
    let (found, plan) = under_volumes(&gpu, &stage(with_lid), settings, ASIDE, Output::Lit);
    assert_eq!(turned_on(&plan, &base_plan), ["z-fail", "open-meshes"]);
    let bytes = found.volume_bytes - base.volume_bytes;
    let adds = Census { pipelines: 1, stencil_pipelines: 1, ..Census::default() };
    assert_eq!(found.beyond(&base), Census { volume_bytes: bytes, ..adds });
    assert_eq!(plan.need("z-fail").unwrap().takes, adds);
    // A smooth solid: its own volume spares some of its facets, and surfaces of two kinds are drawn.
    let (found, plan) = under_volumes(&gpu, &stage(with_ball), settings, ASIDE, Output::Lit);
    assert_eq!(turned_on(&plan, &base_plan), ["smooth-solids", "smooth-terminator"]);
    let adds = Census { pipelines: 1, stencil_pipelines: 1, ..Census::default() };
    assert_eq!(plan.need("smooth-solids").unwrap().takes, adds);
    assert_eq!(found.beyond(&base).stencil_pipelines, 1);
    // An eye in the shadow: behind, and no longer in front.
    let alone = Stage::plain(SceneBuilder::new().soup(&cube(0.0)).build(), sun(0.0));
    let (found, plan) = under_volumes(&gpu, &alone, settings, DVec3::new(0.3, -0.5, 0.3), Output::Lit);
    assert!(plan.is_on("z-fail") && !plan.is_on("z-pass"));
    assert_eq!((found.pipelines, found.stencil_pipelines), (5, 1));
    // A lamp: its own volumes and its own light.
    let (found, plan) = under_volumes(&gpu, &with_lamp_above(stage(with_box)), settings, ASIDE, Output::Lit);
    assert_eq!(turned_on(&plan, &base_plan), ["lamp"]);
    let adds = Census {
        passes: 2,
        pipelines: 2,
        lamp_bindings: 1,
        bind_groups: 1,
        bindings: 2,
        stencil_pipelines: 1,
        volume_buffers: 1,
        volume_bytes: found.volume_bytes - base.volume_bytes,
        ..Census::default()
    };
    assert_eq!(found.beyond(&base), adds);
    assert_eq!(plan.need("lamp").unwrap().takes, adds);
    // More prisms than are counted at once: one pipeline that keeps, and a group and a buffer a run.
    let (found, plan) = under_volumes(&gpu, &stage(with_sheets), settings, ASIDE, Output::Lit);
    let takes = plan.need("several-runs").unwrap().takes;
    assert!(plan.is_on("several-runs") && takes.pipelines == 1 && takes.stencil_pipelines == 1, "{takes:?}");
    assert_eq!((takes.bind_groups, takes.volume_buffers), (found.bind_groups - 2, found.volume_buffers - 2));
}

#[test]
fn volumes_of_every_mode_and_kind_build_what_is_planned() {
    let gpu = gpu();
    let edits: [fn(SceneBuilder) -> SceneBuilder; 5] = [with_box, with_lid, with_sheets, with_ball, |builder| builder];
    for (edit, mode) in edits.into_iter().flat_map(|edit| Mode::ALL.map(|mode| (edit, mode))) {
        for (sun_samples, output) in [1, 2].into_iter().flat_map(|n| OUTPUTS.map(|output| (n, output))) {
            let settings = VolumeSettings { mode, sun_samples, ..VolumeSettings::default() };
            let stage = with_lamp_above(Stage::plain(on_ground(edit), sun(0.0047)));
            under_volumes(&gpu, &stage, settings, ASIDE, output);
        }
    }
}

#[test]
fn volumes_that_are_shown_are_planned_too() {
    let gpu = gpu();
    let stage = Stage::plain(on_ground(with_lid), sun(0.0));
    let shot = shot(&stage, ASIDE);
    let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
    volumes.debug_picture(&shot, &stage.moment(0.5)).unwrap();
    let plan = volumes.draw_plan(&shot, Output::Lit);
    assert_eq!(plan.totals, volumes.census().unwrap());
    assert_eq!(plan.need("shown-volumes").map(|need| need.takes.pipelines), Some(1));
}
