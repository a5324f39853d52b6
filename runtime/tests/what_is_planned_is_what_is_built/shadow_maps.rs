//! Shadow maps.

use crate::{ASIDE, CELL, EDGE, OUTPUTS, draw, on_ground, quad, shot, sun, with_ball, with_box};
use glam::DMat4;
use sunbake::maps::Bits;
use sunbake::scene::{Alpha, Material};
use sunbake::testing::{SceneBuilder, opaque};
use sunbake_runtime::gpu::{Gpu, Output, maps_plan};
use sunbake_runtime::plan::Census;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{ShadowMaps, Technique};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, with_lamp};
use sunbake_runtime::{DrawPlan, Stage};

/// What a picture with shadow maps builds: at most what its plan says before, exactly what it says after.
fn under_maps(gpu: &Gpu, stage: &Stage, variant: Variant, output: Output) -> (Census, DrawPlan) {
    let settings = MapSettings { size_texels: 64, ..MapSettings::new(variant) };
    let most = maps_plan(stage, &settings, output, u64::from(EDGE * EDGE));
    let shot = shot(stage, ASIDE);
    let mut technique = ShadowMaps::new(gpu, stage, settings).unwrap();
    let before = technique.draw_plan(&shot, output);
    draw(&mut technique, &shot, output);
    let (found, plan) = (technique.census().unwrap(), technique.draw_plan(&shot, output));
    assert_eq!(before.totals, most.totals, "{variant} {output:?}");
    assert!(found.is_within(&most.totals), "{variant} {output:?}: {:?}", found.beyond(&most.totals));
    assert_eq!((plan.totals, plan.is_exact, most.is_exact), (found, true, false), "{variant} {output:?}");
    // Maps kept from the last picture need no pass.
    draw(&mut technique, &shot, output);
    let again = technique.draw_plan(&shot, output).totals;
    assert_eq!(again, technique.census().unwrap(), "{variant} {output:?}");
    (found, plan)
}

#[test]
fn every_variant_of_maps_builds_what_is_planned_and_adds_its_own() {
    let gpu = gpu();
    let boxed = Stage::plain(on_ground(with_box), sun(0.0047));
    let bare = Stage::plain(on_ground(|builder| builder), sun(0.0047));
    let leaf = |builder: SceneBuilder| {
        let material = Material { alpha: Alpha::Mask { cutoff: 0.5 }, is_double_sided: true, ..opaque() };
        with_box(builder).mesh_of(quad(), material, &[DMat4::IDENTITY])
    };
    let leafy = Stage::plain(on_ground(leaf), sun(0.0047));
    let round = Stage::plain(on_ground(with_ball), sun(0.0047));
    let lit_by_both = with_lamp(bake(on_ground(with_box), sun(0.0047), CELL, Bits::Eight), &lamp_at(ASIDE), CELL);
    for variant in Variant::ALL {
        for stage in [&boxed, &bare, &leafy, &round, &lit_by_both] {
            OUTPUTS.iter().for_each(|&output| drop(under_maps(&gpu, stage, variant, output)));
        }
        let [(open, open_plan), (found, plan)] = [&bare, &boxed].map(|s| under_maps(&gpu, s, variant, Output::Lit));
        assert!(plan.is_on("sun-shadows") && !open_plan.is_on("sun-shadows"), "{variant}");
        // Objects on the ground are another batch, and both may need their own pipelines; the rest is due to shadows.
        let takes = plan.need("sun-shadows").unwrap().takes;
        let of_both = |census: Census| Census { pipelines: 0, two_sided_pipelines: 0, draws: 0, ..census };
        assert_eq!(of_both(found.beyond(&open)), of_both(takes), "{variant}");
        for (effect, of) in [
            ("several-maps", &[Variant::Cascades, Variant::Cube][..]),
            ("blurred-mask", &[Variant::Ground]),
            ("flat-mask", &[Variant::Planar]),
            ("map-penumbra", &[Variant::Pcss]),
            ("wide-filter", &[Variant::Pcf16, Variant::Pcf4, Variant::Cascades]),
        ] {
            assert!(!plan.is_on(effect) || of.contains(&variant), "{variant}: {effect}");
            assert!(plan.is_on(effect) || effect == "several-maps" || !of.contains(&variant), "{variant}: {effect}");
        }
        // What rises above facets is read from a buffer of its own, where anything is compared with maps.
        let (_, plan) = under_maps(&gpu, &round, variant, Output::Lit);
        let buffers = usize::from(variant != Variant::Planar);
        let takes = plan.need("smooth-terminator").unwrap().takes;
        assert_eq!((takes.vertex_buffers, takes.pipelines, takes.draws), (buffers, 1, 1), "{variant}");
        let (_, plan) = under_maps(&gpu, &leafy, variant, Output::Lit);
        assert!(plan.is_on("alpha-test") && plan.need("alpha-test").unwrap().takes.shadow_pipelines > 0, "{variant}");
    }
}
