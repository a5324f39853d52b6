//! How surfaces look: each look adds its own resources to a lit picture, and a plain surface has none of them.

use crate::{ASIDE, CELL, OUTPUTS, cube, draw, plain_box, quad, shot, sun, turned_on};
use glam::{DMat4, Vec2, Vec4};
use sunbake::maps::Bits;
use sunbake::scene::looks::Look;
use sunbake::scene::{Alpha, Material, Mesh};
use sunbake::testing::SceneBuilder;
use sunbake_runtime::gpu::{Gpu, Output, VolumeSettings, baked_plan, maps_plan, volumes_plan};
use sunbake_runtime::plan::Census;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedGpu, ShadowMaps, Technique, Volumes};
use sunbake_runtime::testing::bake;
use sunbake_runtime::testing::looks::{flat_image, named, texture, with_looks};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::{DrawPlan, Filter, Stage};

/// A plain box, and a sheet of a material above it.
fn with_sheet(material: Material, look: Look) -> Stage {
    let mesh = Mesh { texcoords: vec![Some(vec![Vec2::ZERO; 6])], ..quad() };
    let builder = SceneBuilder::new().soup(&cube(0.0)).mesh_of(mesh, material, &[DMat4::IDENTITY]);
    let images = vec![flat_image([128, 128, 255]), flat_image([0, 90, 200])];
    with_looks(bake(builder.build(), sun(0.0), CELL, Bits::Sixteen), images, |_| look)
}

/// What a picture of a kind builds, after checking that the plan said so before anything was built.
fn built(gpu: &Gpu, stage: &Stage, output: Output) -> (Census, DrawPlan) {
    let plan = baked_plan(stage, Filter::Bilinear, output);
    let shot = shot(stage, ASIDE);
    let mut technique = BakedGpu::new(gpu, stage, Filter::Bilinear).unwrap();
    draw(&mut technique, &shot, output);
    let found = technique.census().unwrap();
    assert_eq!(plan.totals, found, "{output:?}");
    (found, plan)
}

fn looks() -> Vec<(&'static [&'static str], Material, Look, Census)> {
    let metal = Look { metallic: 1.0, roughness: 0.5, ..Look::PLAIN };
    let pane =
        |alpha: f32, solid| Material { base_color: Vec4::new(1.0, 1.0, 1.0, alpha), alpha: solid, ..named("it") };
    let glowing = Material { emissive: glam::Vec3::ONE, ..named("it") };
    let one = Census { draws: 1, pipelines: 1, ..Census::default() };
    let of_texture = Census { look_textures: 1, vertex_buffers: 1, bind_groups: 1, bindings: 2, ..one };
    let blended = Look { says_blend: true, ..Look::PLAIN };
    let transmitting = Look { transmission: 0.5, ..Look::PLAIN };
    let mask = Alpha::Mask { cutoff: 0.5 };
    vec![
        (&["metal-and-highlights"], named("it"), metal, Census { specular_pipelines: 1, ..one }),
        (
            &["metal-and-highlights", "metallic-roughness-textures"],
            named("it"),
            Look { metallic_roughness_texture: Some(texture(1)), ..metal },
            Census { specular_pipelines: 1, ..of_texture },
        ),
        (&["normal-maps"], named("it"), Look { normal_texture: Some(texture(0)), ..Look::PLAIN }, of_texture),
        (&["emissive-textures"], glowing, Look { emissive_texture: Some(texture(1)), ..Look::PLAIN }, of_texture),
        (&["blended-surfaces"], pane(0.7, Alpha::Opaque), blended, Census { blended_pipelines: 1, ..one }),
        (&["blended-surfaces"], pane(1.0, Alpha::Opaque), transmitting, Census { blended_pipelines: 1, ..one }),
        // It is a mask where depths and visibility are found, and blended where it is lit.
        (&["alpha-test", "blended-surfaces"], pane(0.7, mask), blended, Census { blended_pipelines: 1, ..one }),
    ]
}

#[test]
fn each_look_adds_its_own_resources_to_a_lit_picture() {
    let gpu = gpu();
    let (least, least_plan) = built(&gpu, &plain_box(0.0), Output::Lit);
    for (effects, material, look, adds) in looks() {
        let stage = with_sheet(material, look);
        let (found, plan) = built(&gpu, &stage, Output::Lit);
        assert_eq!(turned_on(&plan, &least_plan), effects);
        assert_eq!(Census { map_bytes: 0, ..found.beyond(&least) }, adds, "{effects:?}");
        if let [effect] = effects {
            let draws = plan.need(effect).unwrap().takes.draws;
            assert_eq!(plan.need(effect).unwrap().takes, Census { draws, ..adds }, "{effect}");
        }
        // Programs of visibility know of no look.
        for output in [Output::Visibility, Output::LampVisibility] {
            let (found, _) = built(&gpu, &stage, output);
            assert_eq!((found.specular_pipelines, found.blended_pipelines), (0, 0), "{effects:?}");
        }
        // Without looks nothing is left of them.
        let (found, plan) = built(&gpu, &stage.without_looks(), Output::Lit);
        let left = Census { draws: found.draws, alpha_test_pipelines: 0, pipelines: 0, map_bytes: 0, ..found };
        let bound = Census { draws: found.draws, pipelines: 0, map_bytes: 0, ..least };
        assert_eq!(left, bound, "{effects:?}");
        assert!(effects.iter().all(|effect| !plan.is_on(effect) || *effect == "alpha-test"), "{effects:?}");
    }
}

#[test]
fn live_techniques_build_what_their_plans_say_of_looks() {
    let gpu = gpu();
    let maps = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Pcf16) };
    for (effects, material, look, _) in looks() {
        let stage = with_sheet(material, look).without_times();
        let shot = shot(&stage, ASIDE);
        for output in OUTPUTS {
            let mut volumes = Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap();
            let most = volumes_plan(&stage, &VolumeSettings::default(), output);
            draw(&mut volumes, &shot, output);
            let (found, plan) = (volumes.census().unwrap(), volumes.draw_plan(&shot, output));
            assert_eq!(plan.totals, found, "volumes, {output:?}, {effects:?}");
            assert!(found.is_within(&most.totals), "volumes, {output:?}, {effects:?}");
            assert!(effects.iter().all(|effect| plan.is_on(effect)), "{effects:?}");
            let mut mapped = ShadowMaps::new(&gpu, &stage, maps).unwrap();
            let most = maps_plan(&stage, &maps, output, 256);
            draw(&mut mapped, &shot, output);
            let (found, plan) = (mapped.census().unwrap(), mapped.draw_plan(&shot, output));
            assert_eq!(plan.totals, found, "maps, {output:?}, {effects:?}");
            assert!(found.is_within(&most.totals), "maps, {output:?}, {effects:?}");
        }
    }
}
