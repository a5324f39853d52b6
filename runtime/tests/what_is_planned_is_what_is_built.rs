//! Plans are compared with what is built, and what each effect adds with what it states. These tests need a GPU
//! adapter.

use glam::{DMat4, DVec3, Mat3, Vec2, Vec3, Vec4};
use sunbake::disk::manifest::InstanceEntry;
use sunbake::maps::{AmbientMaps, AmbientSide, Bits, LayerMaps};
use sunbake::scene::{Alpha, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::sun::SunPath;
use sunbake::testing::{SceneBuilder, block, floor, opaque};
use sunbake_runtime::gpu::{Gpu, Output, VolumeSettings, baked_plan, maps_plan, volumes_plan};
use sunbake_runtime::plan::Census;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, ShadowMaps, Technique, Truth, Volumes};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, bake_lanes, standing_sun, view, with_lamp};
use sunbake_runtime::volumes::Mode;
use sunbake_runtime::{DrawPlan, Filter, Shot, Stage};

/// Texels of a triangle's cell, each way.
const CELL: u32 = 6;
/// Where pictures are taken from.
const ASIDE: DVec3 = DVec3::new(4.0, 3.0, 5.0);
/// Pixels each way.
const EDGE: u32 = 16;

const OUTPUTS: [Output; 3] = [Output::Lit, Output::Visibility, Output::LampVisibility];

fn sun(radius_rad: f64) -> Option<SunPath> {
    Some(standing_sun(DVec3::new(0.3, 1.0, 0.2), radius_rad))
}

fn cube(x: f32) -> Vec<[Vec3; 3]> {
    block(Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 1.0, 1.0))
}

fn shot(stage: &Stage, eye: DVec3) -> Shot<'_> {
    Shot::new(stage, view(stage, eye, DVec3::new(0.4, 0.3, 0.2), [EDGE; 2]))
}

/// Draws a picture of a kind.
fn draw(technique: &mut dyn Technique, shot: &Shot, output: Output) {
    let moment = shot.stage.moment(0.5);
    match output {
        Output::Lit => drop(technique.color(shot, &moment).unwrap()),
        Output::Visibility => drop(technique.visibility(shot, &moment).unwrap()),
        Output::LampVisibility => drop(technique.lamp_visibility(shot, &moment).unwrap()),
    }
}

/// What a picture of a baked stage builds, after checking that the plan said so before anything was built.
fn baked(gpu: &Gpu, stage: &Stage, output: Output) -> (Census, DrawPlan) {
    let plan = baked_plan(stage, output);
    let shot = shot(stage, ASIDE);
    let mut technique = BakedGpu::new(gpu, stage, Filter::Bilinear).unwrap();
    draw(&mut technique, &shot, output);
    let found = technique.census().unwrap();
    assert_eq!(plan.totals, found, "{output:?}");
    assert_eq!(technique.effects(&shot, output), plan);
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

fn quad() -> Mesh {
    let triangles = floor(Vec2::ZERO, Vec2::ONE, 1.5);
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    Mesh { indices: (0..6).collect(), positions, ..Mesh::default() }
}

/// A box, and a sheet of a material above it.
fn box_and(builder: SceneBuilder, mesh: Mesh, material: Material) -> Stage {
    let scene = builder.soup(&cube(0.0)).mesh_of(mesh, material, &[DMat4::IDENTITY]).build();
    bake(scene, sun(0.0), CELL, Bits::Sixteen)
}

fn plain_box(radius_rad: f64) -> Stage {
    bake(SceneBuilder::new().soup(&cube(0.0)).build(), sun(radius_rad), CELL, Bits::Sixteen)
}

fn texels(stage: &Stage) -> usize {
    stage.pages[0].width as usize * stage.pages[0].height as usize
}

/// The names of the effects that are on in one plan and off in another.
fn turned_on<'a>(plan: &'a DrawPlan, other: &DrawPlan) -> Vec<&'a str> {
    plan.needs
        .iter()
        .filter(|need| need.is_on && !other.is_on(need.effect.name()))
        .map(|need| need.effect.name())
        .collect()
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
    let (builder, image) = SceneBuilder::new().image(4, 4, vec![[90, 120, 60, 255]; 16]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] };
    let textured = Material { base_color_texture: Some(texture), ..opaque() };
    let mesh = Mesh { texcoords: [Some(vec![Vec2::ZERO; 6]), None], ..quad() };
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
    let open = AmbientSide { open: vec![40_000; texels(&stage)], ..AmbientSide::default() };
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

/// What a picture with shadow volumes builds: at most what its plan says before, exactly what it says after.
fn under_volumes(gpu: &Gpu, stage: &Stage, settings: VolumeSettings, eye: DVec3, output: Output) -> (Census, DrawPlan) {
    let most = volumes_plan(stage, &settings, output);
    let shot = shot(stage, eye);
    let mut technique = Volumes::new(gpu, stage, settings).unwrap();
    let before = technique.effects(&shot, output);
    draw(&mut technique, &shot, output);
    let (found, plan) = (technique.census().unwrap(), technique.effects(&shot, output));
    let name = format!("{} {output:?}", technique.name());
    assert!(found.is_within(&most.totals), "{name}: {:?}", found.beyond(&most.totals));
    assert!(found.is_within(&before.totals) && before.totals.is_within(&most.totals), "{name}");
    assert_eq!((plan.totals, plan.is_exact, most.is_exact), (found, true, false), "{name}");
    (found, plan)
}

fn on_ground(edit: impl Fn(SceneBuilder) -> SceneBuilder) -> Scene {
    edit(SceneBuilder::new().soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))).build()
}

fn with_box(builder: SceneBuilder) -> SceneBuilder {
    builder.soup(&cube(0.0))
}

/// Five sides of a box beside the other.
fn with_lid(builder: SceneBuilder) -> SceneBuilder {
    let lid: Vec<_> = cube(1.5)[2..].iter().map(|t| t.map(|v| v + Vec3::new(0.0, 0.2, 0.0))).collect();
    with_box(builder).soup(&lid)
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
        pipelines: 5, // Depth, all around, sky, the sun's light, faces before the surface.
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
    // An eye in the shadow: behind, and no longer before.
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
    let edits: [fn(SceneBuilder) -> SceneBuilder; 4] = [with_box, with_lid, with_sheets, |builder| builder];
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
    volumes.shown(&shot, &stage.moment(0.5)).unwrap();
    let plan = volumes.effects(&shot, Output::Lit);
    assert_eq!(plan.totals, volumes.census().unwrap());
    assert_eq!(plan.need("shown-volumes").map(|need| need.takes.pipelines), Some(1));
}

/// What a picture with shadow maps builds: at most what its plan says before, exactly what it says after.
fn under_maps(gpu: &Gpu, stage: &Stage, variant: Variant, output: Output) -> (Census, DrawPlan) {
    let settings = MapSettings { size_texels: 64, ..MapSettings::new(variant) };
    let most = maps_plan(stage, &settings, output, u64::from(EDGE * EDGE));
    let shot = shot(stage, ASIDE);
    let mut technique = ShadowMaps::new(gpu, stage, settings).unwrap();
    let before = technique.effects(&shot, output);
    draw(&mut technique, &shot, output);
    let (found, plan) = (technique.census().unwrap(), technique.effects(&shot, output));
    assert_eq!(before.totals, most.totals, "{variant} {output:?}");
    assert!(found.is_within(&most.totals), "{variant} {output:?}: {:?}", found.beyond(&most.totals));
    assert_eq!((plan.totals, plan.is_exact, most.is_exact), (found, true, false), "{variant} {output:?}");
    // Maps kept from the last picture need no pass.
    draw(&mut technique, &shot, output);
    let again = technique.effects(&shot, output).totals;
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
    let lit_by_both = with_lamp(bake(on_ground(with_box), sun(0.0047), CELL, Bits::Eight), &lamp_at(ASIDE), CELL);
    for variant in Variant::ALL {
        for stage in [&boxed, &bare, &leafy, &lit_by_both] {
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
        let (_, plan) = under_maps(&gpu, &leafy, variant, Output::Lit);
        assert!(plan.is_on("alpha-test") && plan.need("alpha-test").unwrap().takes.shadow_pipelines > 0, "{variant}");
    }
}

#[test]
fn every_effect_states_why_its_cost_and_what_toggles_it() {
    let gpu = gpu();
    let stage = with_lamp(bake(on_ground(with_lid), sun(0.0047), CELL, Bits::Eight), &lamp_at(ASIDE), CELL);
    let shot = shot(&stage, ASIDE);
    let maps = MapSettings { size_texels: 64, ..MapSettings::new(Variant::Ground) };
    let mut all: Vec<Box<dyn Technique + '_>> = vec![
        Box::new(BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap()),
        Box::new(BakedCpu::new(&stage, Filter::Bilinear)),
        Box::new(Volumes::new(&gpu, &stage, VolumeSettings::default()).unwrap()),
        Box::new(ShadowMaps::new(&gpu, &stage, maps).unwrap()),
        Box::new(Truth::Hard),
        Box::new(Truth::Soft { rays: 4 }),
    ];
    for technique in &mut all {
        for drawn in [false, true] {
            if drawn {
                draw(technique.as_mut(), &shot, Output::Lit);
            }
            let plan = technique.effects(&shot, Output::Lit);
            assert!(plan.is_on("lamp") && plan.needs.len() > 2, "{}", technique.name());
            for need in &plan.needs {
                let is_said = |text: &str| text.len() > 2;
                let is_whole = is_said(&need.why()) && is_said(&need.cost()) && is_said(need.toggled_by());
                assert!(is_whole, "{}: {need:?}", technique.name());
            }
            let text = plan.in_words();
            assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
        }
    }
}
