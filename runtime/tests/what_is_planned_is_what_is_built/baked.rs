//! Playback of a bake.

use crate::{ASIDE, CELL, bent_quad, cube, draw, plain_box, quad, shot, sun, turned_on};
use glam::{DMat4, DVec3, Mat3, Vec2, Vec4};
use sunbake::disk::manifest::InstanceEntry;
use sunbake::maps::{AmbientMaps, AmbientSide, Bits, LayerMaps};
use sunbake::scene::{Alpha, Material, Mesh, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, opaque};
use sunbake::tracks::PageTracks;
use sunbake_runtime::gpu::{Gpu, Output, baked_plan};
use sunbake_runtime::plan::Census;
use sunbake_runtime::technique::{BakedGpu, Technique};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, bake_lanes, with_lamp};
use sunbake_runtime::{DrawPlan, Filter, Stage};

/// What a picture of a baked stage builds, after checking that the plan said so before anything was built.
fn baked(gpu: &Gpu, stage: &Stage, output: Output) -> (Census, DrawPlan) {
    filtered(gpu, stage, Filter::Bilinear, output)
}

fn filtered(gpu: &Gpu, stage: &Stage, filter: Filter, output: Output) -> (Census, DrawPlan) {
    let plan = baked_plan(stage, filter, output);
    let shot = shot(stage, ASIDE);
    let mut technique = BakedGpu::new(gpu, stage, filter).unwrap();
    draw(&mut technique, &shot, output);
    let found = technique.census().unwrap();
    assert_eq!(plan.totals, found, "{output:?}");
    assert_eq!(technique.draw_plan(&shot, output), plan);
    (found, plan)
}

/// A stage's pictures of all kinds; what the lit one builds.
fn lit(gpu: &Gpu, stage: &Stage) -> (Census, DrawPlan) {
    baked(gpu, stage, Output::Visibility);
    baked(gpu, stage, Output::LampVisibility);
    baked(gpu, stage, Output::Lit)
}

/// The counts without bytes of textures, which change with a page's number of texels.
fn without_bytes(census: Census) -> Census {
    Census { map_bytes: 0, ..census }
}

fn texels(stage: &Stage) -> usize {
    stage.pages[0].width as usize * stage.pages[0].height as usize
}

#[test]
fn a_box_under_a_point_sun_builds_the_least() {
    let gpu = gpu();
    let stage = plain_box(0.0);
    let (found, plan) = lit(&gpu, &stage);
    let least = Census {
        passes: 2,
        pipelines: 3, // Depth, lit, sky.
        time_textures: 2,
        vertex_buffers: 2,
        bind_groups: 2, // The frame's and the page's.
        bindings: 4,    // The frame, materials; rise and fall.
        targets: 2,
        draws: 1,
        map_bytes: texels(&stage) as u64 * 16,
        ..Census::default()
    };
    assert_eq!(found, least);
    let on: Vec<&str> = plan.needs.iter().filter(|need| need.is_on).map(|need| need.effect.name()).collect();
    assert_eq!(on, ["depth-pass", "light-pass", "sky-background", "sun-times", "16-bit-times"]);
    // A picture of visibility draws no sky.
    assert_eq!(baked(&gpu, &stage, Output::Visibility).0, Census { pipelines: 2, ..least });
    // A sun with a width needs more shader code, but no more resources.
    let (wide, wide_plan) = lit(&gpu, &plain_box(0.0047));
    assert_eq!((wide, turned_on(&wide_plan, &plan)), (least, vec!["penumbra"]));
    assert_eq!(wide_plan.need("penumbra").unwrap().takes, Census::default());
}

#[test]
fn shadow_tracks_take_the_place_of_times_where_they_are_asked_for() {
    let gpu = gpu();
    let mut stage = plain_box(0.0047);
    let (times, plan_of_times) = lit(&gpu, &stage);
    let of_tracks = |stage: &Stage| filtered(&gpu, stage, Filter::Tracks, Output::Lit);
    assert_eq!(of_tracks(&stage).0, times, "there are none");
    stage.pages[0].tracks = Some(PageTracks { ranges: vec![[0, 0]; texels(&stage)], spans: Vec::new() });
    assert_eq!(lit(&gpu, &stage).0, times, "nobody asks for them");
    let (found, plan) = of_tracks(&stage);
    let map_bytes = 4 * texels(&stage) as u64 + 6 * 2048;
    assert_eq!(found, Census { time_textures: 3, bindings: times.bindings + 1, map_bytes, ..times });
    assert_eq!(turned_on(&plan, &plan_of_times), ["shadow-tracks"]);
    // A sun without width is seen or not, which is read from the times.
    let mut point = plain_box(0.0);
    let (times, _) = lit(&gpu, &point);
    point.pages[0].tracks = stage.pages[0].tracks.clone();
    assert_eq!(of_tracks(&point).0, times);
}

#[test]
fn each_property_of_surfaces_adds_its_own_resources() {
    let gpu = gpu();
    let (least, least_plan) = lit(&gpu, &plain_box(0.0));
    let holds = |stage: &Stage, effect: &str, adds: Census| {
        let (found, plan) = lit(&gpu, stage);
        assert_eq!(turned_on(&plan, &least_plan), [effect]);
        assert_eq!(without_bytes(found.beyond(&least)), adds, "{effect}");
        assert!(without_bytes(least).is_within(&found), "{effect}");
        assert_eq!(plan.need(effect).unwrap().takes, adds, "{effect}");
    };
    let one = Census { draws: 1, ..Census::default() };
    let leaf = Material { alpha: Alpha::Mask { cutoff: 0.5 }, ..opaque() };
    let adds = Census { pipelines: 2, alpha_test_pipelines: 2, ..one };
    holds(&box_and(SceneBuilder::new(), quad(), leaf), "alpha-test", adds);
    let both = Material { is_double_sided: true, ..opaque() };
    let adds = Census { pipelines: 2, two_sided_pipelines: 2, ..one };
    holds(&box_and(SceneBuilder::new(), quad(), both), "two-sided-faces", adds);
    let colors = Mesh { colors: Some(vec![Vec4::ONE; 6]), ..quad() };
    let adds = Census { pipelines: 1, vertex_buffers: 1, ..one };
    holds(&box_and(SceneBuilder::new(), colors, opaque()), "vertex-colours", adds);
    let adds = Census { pipelines: 1, ..one };
    holds(&box_and(SceneBuilder::new(), bent_quad(), opaque()), "smooth-terminator", adds);
    let (builder, image) = SceneBuilder::new().image(4, 4, vec![[90, 120, 60, 255]; 16]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] };
    let textured = Material { base_color_texture: Some(texture), ..opaque() };
    let mesh = Mesh { texcoords: vec![Some(vec![Vec2::ZERO; 6])], ..quad() };
    let adds = Census { pipelines: 1, base_color_textures: 1, vertex_buffers: 1, bind_groups: 1, bindings: 2, ..one };
    holds(&box_and(builder, mesh, textured), "base-colour-textures", adds);
}

#[test]
fn each_kind_of_map_adds_its_own_resources() {
    let gpu = gpu();
    let stage = plain_box(0.0047);
    let of_texels = |bytes: u64| texels(&stage) as u64 * bytes;
    let (least, least_plan) = lit(&gpu, &stage);
    let holds = |stage: &Stage, effects: &[&str], adds: Census| {
        let (found, plan) = lit(&gpu, stage);
        assert_eq!(turned_on(&plan, &least_plan), effects);
        assert_eq!(found.beyond(&least), adds, "{effects:?}");
        assert!(least.is_within(&found), "{effects:?}");
        if let [effect] = effects {
            assert_eq!(plan.need(effect).unwrap().takes, adds, "{effect}");
        }
        (found, plan)
    };
    let nothing = Census::default();
    let mut two_layers = plain_box(0.0047);
    two_layers.pages[0].lanes[0].layers.push(LayerMaps::unlit(texels(&stage), Bits::Sixteen));
    holds(&two_layers, &["several-layers"], Census { map_bytes: of_texels(16), ..nothing });
    let lanes = bake_lanes(SceneBuilder::new().soup(&cube(0.0)).build(), sun(0.0047), CELL, Bits::Sixteen, 3);
    assert!(lanes.pages[0].lanes.iter().all(|lane| lane.layers.len() == 1));
    holds(&lanes, &["disc-lanes"], Census { map_bytes: of_texels(32), ..nothing });
    let lamp = with_lamp(plain_box(0.0047), &lamp_at(DVec3::new(0.5, 3.0, 0.5)), CELL);
    let lamp_layers = lamp.pages[0].lamp.as_ref().map_or(0, Vec::len) as u64;
    assert_eq!(lamp_layers, 1);
    let adds = Census { time_textures: 2, lamp_bindings: 1, bindings: 3, map_bytes: of_texels(16), ..nothing };
    holds(&lamp, &["lamp"], adds);
    let open = AmbientSide { visibility: vec![40_000; texels(&stage)], ..AmbientSide::default() };
    let bent = AmbientSide { bent: Some(vec![[40_000; 3]; texels(&stage)]), ..open.clone() };
    let sky = AmbientSide { sky: Some(vec![[40_000; 9]; texels(&stage)]), ..bent.clone() };
    let with = |front: &AmbientSide, back: Option<AmbientSide>| {
        let mut stage = plain_box(0.0047);
        stage.pages[0].ambient = Some(AmbientMaps { front: front.clone(), back });
        stage
    };
    let adds = |map_bytes| Census { ambient_textures: 1, bindings: 1, map_bytes: of_texels(map_bytes), ..nothing };
    let (with_ao, _) = holds(&with(&open, None), &["ambient-occlusion"], adds(2));
    let of_bent = Census { ambient_textures: 2, bindings: 2, map_bytes: of_texels(10), ..nothing };
    let (with_bent, plan) = holds(&with(&bent, None), &["ambient-occlusion", "bent-normals"], of_bent);
    assert_eq!(plan.need("bent-normals").unwrap().takes, with_bent.beyond(&with_ao));
    holds(&with(&sky, None), &["sky-sh2"], Census { sky_bindings: 1, bindings: 2, ..adds(24) });
    let backs = with(&open, Some(open.clone()));
    let (found, plan) = holds(&backs, &["ambient-occlusion", "ambient-of-backs"], adds(4));
    assert_eq!(plan.need("ambient-of-backs").unwrap().takes, found.beyond(&with_ao));
}

#[test]
fn a_second_page_adds_its_textures_and_a_draw() {
    let gpu = gpu();
    let one = bake(SceneBuilder::new().soup(&cube(0.0)).soup(&cube(2.0)).build(), sun(0.0), CELL, Bits::Sixteen);
    let entry = |(index, instance): (usize, &sunbake::scene::Instance)| InstanceEntry {
        node: instance.node,
        primitive: one.scene.meshes[instance.mesh].gltf.1,
        atlas: Some(index as u32),
        casts: true,
        receives: true,
        uv_set: 1,
        uv_scale: [1.0; 2],
        uv_offset: [0.0; 2],
        double_sided: false,
    };
    let entries: Vec<InstanceEntry> = one.scene.instances.iter().enumerate().map(entry).collect();
    let pages = vec![one.pages[0].clone(), one.pages[0].clone()];
    let two = Stage::new(one.scene.clone(), &entries, pages, Bits::Sixteen, one.path.clone()).unwrap();
    let [(before, _), (found, plan)] = [&one, &two].map(|stage| lit(&gpu, stage));
    // Pages that are read alike share their pipelines.
    let adds = Census { draws: 1, time_textures: 2, bind_groups: 1, bindings: 2, ..Census::default() };
    assert_eq!(found.beyond(&before), Census { map_bytes: before.map_bytes, ..adds });
    assert_eq!(plan.need("several-pages").unwrap().takes, adds);
}

/// A box, and a sheet of a material above it.
fn box_and(builder: SceneBuilder, mesh: Mesh, material: Material) -> Stage {
    let scene = builder.soup(&cube(0.0)).mesh_of(mesh, material, &[DMat4::IDENTITY]).build();
    bake(scene, sun(0.0), CELL, Bits::Sixteen)
}
