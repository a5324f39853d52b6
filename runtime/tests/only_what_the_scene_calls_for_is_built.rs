//! Counts of pipelines, textures, bindings and targets that scenes need. These tests need a GPU adapter.

use glam::{DMat4, DVec3, Mat3, Vec2, Vec3, Vec4};
use sunbake::maps::{AmbientMaps, AmbientSide, Bits};
use sunbake::scene::{Alpha, Material, Mesh, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, block, floor, opaque};
use sunbake_runtime::gpu::VolumeSettings;
use sunbake_runtime::plan::Census;
use sunbake_runtime::shadow_maps::{MapSettings, Variant};
use sunbake_runtime::technique::{BakedGpu, ShadowMaps, Technique, Volumes};
use sunbake_runtime::testing::masks::gpu;
use sunbake_runtime::testing::{bake, bake_lanes, equinox, standing_sun, view};
use sunbake_runtime::{Filter, Moment, Shot, Stage};

fn census(stage: &Stage, draw_visibility: bool) -> Census {
    let gpu = gpu();
    let shot = Shot::new(stage, view(stage, DVec3::new(4.0, 3.0, 5.0), DVec3::ZERO, [16, 16]));
    let moment = Moment::new(stage.path.as_ref(), 0.5);
    let mut technique = BakedGpu::new(&gpu, stage, Filter::Bilinear).unwrap();
    match draw_visibility {
        true => drop(technique.visibility(&shot, &moment).unwrap()),
        false => drop(technique.color(&shot, &moment).unwrap()),
    }
    technique.census().unwrap()
}

fn cube() -> Vec<[Vec3; 3]> {
    block(Vec3::ZERO, Vec3::ONE)
}

#[test]
fn a_plain_scene_needs_three_pipelines_and_one_pair_of_textures() {
    let stage = bake(SceneBuilder::new().soup(&cube()).build(), Some(equinox(35.0)), 8, Bits::Sixteen);
    let layers: usize = stage.pages[0].lanes.iter().map(|lane| lane.layers.len()).sum();
    let [width, height] = [stage.pages[0].width, stage.pages[0].height].map(u64::from);
    let expected = Census {
        passes: 2,
        pipelines: 3, // Depth, lit, sky.
        time_textures: 2,
        vertex_buffers: 2,
        bind_groups: 2,
        bindings: 4, // The frame, materials; rise and fall.
        targets: 2,
        draws: 1,
        map_bytes: width * height * layers as u64 * 16,
        ..Census::default()
    };
    assert_eq!(census(&stage, false), expected);
    // Visibility alone needs no sky.
    assert_eq!(census(&stage, true), Census { pipelines: 2, ..expected });
}

#[test]
fn lanes_cost_layers_and_nothing_else() {
    let stage = |lane_count| {
        let cube = SceneBuilder::new().soup(&cube()).build();
        bake_lanes(cube, Some(equinox(35.0)), 8, Bits::Sixteen, lane_count)
    };
    let one = census(&stage(1), false);
    for lane_count in [3, 5] {
        let stage = stage(lane_count);
        let layers: u64 = stage.pages[0].lanes.iter().map(|lane| lane.layers.len() as u64).sum();
        assert!(layers >= lane_count as u64);
        let texels = u64::from(stage.pages[0].width) * u64::from(stage.pages[0].height);
        assert_eq!(census(&stage, false), Census { map_bytes: texels * layers * 16, ..one });
    }
}

#[test]
fn a_set_without_a_sun_has_no_textures_of_times_and_no_binding_for_them() {
    let stage = bake(SceneBuilder::new().soup(&cube()).build(), None, 8, Bits::Sixteen);
    let found = census(&stage, false);
    assert_eq!((found.time_textures, found.bind_groups, found.map_bytes), (0, 1, 0));
}

#[test]
fn an_empty_scene_needs_the_sky_alone() {
    let stage = bake(SceneBuilder::new().build(), Some(equinox(35.0)), 8, Bits::Sixteen);
    let found = census(&stage, false);
    assert_eq!((found.pipelines, found.vertex_buffers, found.draws), (1, 0, 0));
}

#[test]
fn ambient_occlusion_is_bound_only_where_a_set_has_it() {
    let mut stage = bake(SceneBuilder::new().soup(&cube()).build(), None, 8, Bits::Sixteen);
    assert_eq!(census(&stage, false).ambient_textures, 0);
    let texels = stage.pages[0].width as usize * stage.pages[0].height as usize;
    let mut with = |front: AmbientSide, back: Option<AmbientSide>| {
        stage.pages[0].ambient = Some(AmbientMaps { front, back });
        let found = census(&stage, false);
        assert_eq!(found.time_textures, 0);
        (found.ambient_textures, found.sky_bindings, found.map_bytes / texels as u64)
    };
    let open = AmbientSide { visibility: vec![40_000; texels], ..AmbientSide::default() };
    let bent = AmbientSide { bent: Some(vec![[40_000; 3]; texels]), ..open.clone() };
    let sky = AmbientSide { sky: Some(vec![[40_000; 9]; texels]), ..bent.clone() };
    assert_eq!(with(open.clone(), None), (1, 0, 2));
    assert_eq!(with(open.clone(), Some(open)), (1, 0, 4));
    assert_eq!(with(bent, None), (2, 0, 10));
    assert_eq!(with(sky.clone(), None), (1, 1, 24));
    assert_eq!(with(sky.clone(), Some(sky)), (1, 1, 48));
}

#[test]
fn textures_alpha_masks_colours_and_second_sides_cost_only_the_scenes_that_have_them() {
    let (builder, image) = SceneBuilder::new().image(4, 4, vec![[90, 120, 60, 255]; 16]);
    let texture = TextureRef { image, texcoord: 0, image_from_texcoord: Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] };
    let mesh = |has_colors: bool| {
        let positions: Vec<Vec3> = cube().iter().flatten().copied().collect();
        let uvs = positions.iter().map(|p| Vec2::new(p.x, p.y + p.z)).collect();
        let colors = has_colors.then(|| vec![Vec4::ONE; positions.len()]);
        Mesh { indices: (0..36).collect(), positions, texcoords: vec![Some(uvs)], colors, ..Mesh::default() }
    };
    let textured = Material { base_color_texture: Some(texture), ..opaque() };
    let leaf = Material { alpha: Alpha::Mask { cutoff: 0.5 }, is_double_sided: true, ..textured.clone() };
    let at = |x: f64| [DMat4::from_translation(DVec3::new(x, 0.0, 0.0))];
    let builder = builder.mesh_of(mesh(false), textured.clone(), &at(0.0)).mesh_of(mesh(false), textured, &at(2.0));
    let plain = bake(builder.clone().build(), Some(equinox(35.0)), 6, Bits::Eight);
    let found = census(&plain, false);
    assert_eq!((found.pipelines, found.draws, found.base_color_textures, found.vertex_buffers), (3, 1, 1, 3));
    assert_eq!((found.alpha_test_pipelines, found.two_sided_pipelines), (0, 0));
    let leafy = builder.mesh_of(mesh(false), leaf, &at(4.0)).mesh_of(mesh(true), opaque(), &at(6.0));
    let found = census(&bake(leafy.build(), Some(equinox(35.0)), 6, Bits::Eight), false);
    // Lit: textured, leaf, coloured. Depth: solid, leaf. Sky.
    assert_eq!((found.pipelines, found.draws, found.base_color_textures, found.vertex_buffers), (6, 3, 1, 4));
    assert_eq!((found.alpha_test_pipelines, found.two_sided_pipelines), (2, 2));
}

/// What volumes build for a plain scene seen from the side, and where its casters are counted.
fn volume_census(scene: sunbake::scene::Scene, settings: VolumeSettings, eye: DVec3) -> (Census, [usize; 2]) {
    let gpu = gpu();
    let stage = Stage::plain(scene, Some(standing_sun(DVec3::new(0.3, 1.0, 0.2), 0.0)));
    let shot = Shot::new(&stage, view(&stage, eye, DVec3::new(0.4, 0.3, 0.2), [16, 16]));
    let mut volumes = Volumes::new(&gpu, &stage, settings).unwrap();
    volumes.visibility(&shot, &stage.moment(0.5)).unwrap();
    let counted = volumes.report().lights.first().map_or([0; 2], |light| [light.plan.z_pass, light.plan.z_fail]);
    (volumes.census().unwrap(), counted)
}

#[test]
fn volumes_of_a_box_take_one_pipeline_and_two_buffers_and_each_need_adds_its_own() {
    let settings = VolumeSettings::default();
    let aside = DVec3::new(4.0, 3.0, 5.0);
    let floor = floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0);
    let ground = || SceneBuilder::new().soup(&floor);
    let (base, counted) = volume_census(ground().soup(&cube()).build(), settings, aside);
    let expected = Census {
        passes: 3,    // Depth, volumes, light.
        pipelines: 4, // Depth, the sun's mask, the background, faces in front of the surface.
        vertex_buffers: 2,
        bind_groups: 2, // The frame's, and the casters'.
        bindings: 3,    // The frame, materials; points.
        targets: 2,
        draws: 1,
        stencil_pipelines: 1,
        volume_buffers: 2, // Points, corners.
        volume_bytes: base.volume_bytes,
        ..Census::default()
    };
    // The ground shades nothing, so it casts no volume.
    assert_eq!((base, counted), (expected, [1, 0]));
    // An eye in the box's shadow needs faces behind the surface, and no longer those in front of it.
    let in_shadow = DVec3::new(0.3, -0.5, 0.3);
    let (found, counted) = volume_census(SceneBuilder::new().soup(&cube()).build(), settings, in_shadow);
    assert_eq!((found.stencil_pipelines, counted), (1, [0, 1]));
    // An open mesh beside the box asks for both.
    let lid: Vec<_> = cube()[2..].iter().map(|t| t.map(|v| v + Vec3::new(1.5, 0.2, 0.0))).collect();
    let (found, counted) = volume_census(ground().soup(&cube()).soup(&lid).build(), settings, aside);
    assert_eq!((found.pipelines, found.stencil_pipelines, counted), (5, 2, [1, 1]));
    // Two suns: the same pipelines, and a pass of volumes and one of light more.
    let two = VolumeSettings { sun_samples: 2, ..settings };
    let (found, _) = volume_census(ground().soup(&cube()).build(), two, aside);
    assert_eq!((found.pipelines, found.passes), (4, 5));
    // Nothing casts: no volumes, no pass of them, no pipeline. The sun is down: no light either.
    let (found, _) = volume_census(ground().build(), settings, aside);
    assert_eq!((found.passes, found.stencil_pipelines, found.pipelines), (2, 0, 3));
    let gpu = gpu();
    let stage = Stage::plain(ground().soup(&cube()).build(), Some(standing_sun(DVec3::new(1.0, -0.3, 0.0), 0.0)));
    let shot = Shot::new(&stage, view(&stage, aside, DVec3::ZERO, [16, 16]));
    let mut volumes = Volumes::new(&gpu, &stage, settings).unwrap();
    volumes.visibility(&shot, &stage.moment(0.5)).unwrap();
    let found = volumes.census().unwrap();
    assert_eq!((found.passes, found.pipelines, found.stencil_pipelines), (2, 2, 0));
}

/// What shadow maps of a block on the ground build, with something below the ground or not.
fn of_maps(variant: Variant, edit: impl Fn(SceneBuilder) -> SceneBuilder) -> Census {
    let gpu = gpu();
    let scene = edit(SceneBuilder::new().soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0))).build();
    let stage = Stage::plain(scene, Some(standing_sun(DVec3::new(0.3, 1.0, 0.2), 0.0047)));
    let shot = Shot::new(&stage, view(&stage, DVec3::new(4.0, 3.0, 5.0), DVec3::ZERO, [16, 16]));
    let mut maps = ShadowMaps::new(&gpu, &stage, MapSettings { size_texels: 64, ..MapSettings::new(variant) }).unwrap();
    maps.visibility(&shot, &stage.moment(0.5)).unwrap();
    maps.census().unwrap()
}

#[test]
fn a_variant_builds_its_own_maps_and_pipelines_and_no_others() {
    let block = |builder: SceneBuilder| builder.soup(&cube());
    for variant in Variant::ALL {
        let found = of_maps(variant, block);
        let maps = match variant {
            Variant::Planar => 0,
            // From this camera the whole scene is at about one distance, so there is one cascade.
            Variant::Cascades => found.shadow_maps.clamp(1, 4),
            Variant::Cube => found.shadow_maps.clamp(1, 6),
            _ => 1,
        };
        let (masks, mask_bytes) = match variant {
            Variant::Ground => (2, 2 * 64 * 64),
            Variant::Planar => (1, 16 * 16),
            _ => (0, 0),
        };
        let read = match variant {
            Variant::Planar => 1, // A mask.
            Variant::Plain => 2,  // Matrices, maps.
            Variant::Ground => 5, // A sampler as well; a mask, and its sampler.
            _ => 3,
        };
        // The ground and what stands on it share their pipelines, but for those that light the ground apart.
        let (shadow_pipelines, surface_pipelines) = match variant {
            Variant::Ground => (4, 2), // Depths, what casts, and its blur across and down.
            Variant::Planar => (1, 2),
            _ => (1, 1),
        };
        let expected = Census {
            passes: 2 + maps + if variant == Variant::Ground { 3 } else { masks },
            pipelines: 1 + surface_pipelines + shadow_pipelines,
            // Both sides cast.
            two_sided_pipelines: shadow_pipelines.min(2),
            vertex_buffers: 2,
            // The frame's, what is read, and a matrix for each map or what is laid flat.
            bind_groups: 2 + maps.max(1),
            bindings: 2 + read + maps.max(1),
            targets: 2,
            draws: 2,
            shadow_pipelines,
            shadow_maps: maps,
            shadow_masks: masks,
            shadow_bytes: maps as u64 * 64 * 64 * 4 + mask_bytes,
            ..Census::default()
        };
        assert_eq!(found, expected, "{variant}");
    }
}

#[test]
fn where_nothing_can_be_in_shadow_there_is_no_map() {
    for variant in Variant::ALL {
        // The ground alone shades nothing: nothing lies below it.
        let found = of_maps(variant, |builder| builder);
        assert_eq!((found.passes, found.shadow_pipelines, found.shadow_maps), (2, 0, 0), "{variant}");
        assert_eq!((found.shadow_masks, found.shadow_bytes), (0, 0), "{variant}");
    }
}

#[test]
fn a_map_tests_alpha_only_where_something_has_an_alpha_mask() {
    let leaf = |builder: SceneBuilder| {
        let triangles = floor(Vec2::splat(-1.0), Vec2::splat(1.0), 1.0);
        let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
        let colors = Some(vec![Vec4::new(1.0, 1.0, 1.0, 0.4); 6]);
        let mesh = Mesh { positions, indices: (0..6).collect(), colors, ..Mesh::default() };
        let material = Material { alpha: Alpha::Mask { cutoff: 0.5 }, ..opaque() };
        builder.mesh_of(mesh, material, &[DMat4::IDENTITY])
    };
    let plain = of_maps(Variant::Compare, |builder| builder.soup(&cube()));
    let cut = of_maps(Variant::Compare, leaf);
    // A depth pass of the camera, one of the sun, and the lit pass.
    assert_eq!((plain.alpha_test_pipelines, cut.alpha_test_pipelines), (0, 3));
}

#[test]
fn a_map_is_kept_while_neither_the_sun_nor_what_it_follows_moves() {
    let gpu = gpu();
    let scene = SceneBuilder::new().soup(&floor(Vec2::splat(-3.0), Vec2::splat(3.0), 0.0)).soup(&cube()).build();
    let stage = Stage::plain(scene, Some(equinox(35.0)));
    let shots = [DVec3::new(4.0, 3.0, 5.0), DVec3::new(1.5, 1.0, 2.0)]
        .map(|eye| Shot::new(&stage, view(&stage, eye, DVec3::ZERO, [16, 16])));
    for variant in Variant::ALL.into_iter().filter(|&variant| variant != Variant::Planar) {
        let mut maps =
            ShadowMaps::new(&gpu, &stage, MapSettings { size_texels: 64, ..MapSettings::new(variant) }).unwrap();
        let mut drawn = |shot: &Shot, t: f64| {
            maps.visibility(shot, &stage.moment(t)).unwrap();
            (maps.report().drawn, maps.report().maps)
        };
        let first = drawn(&shots[0], 0.4);
        assert!(first.0 == first.1 && first.0 > 0, "{variant}");
        assert_eq!(drawn(&shots[0], 0.4), (0, first.1), "{variant}");
        let moved = drawn(&shots[1], 0.4);
        // A single cascade holds the whole scene.
        let follows = variant.follows_view() && (variant, moved.1) != (Variant::Cascades, 1);
        assert_eq!(moved.0, if follows { moved.1 } else { 0 }, "{variant}");
        let later = drawn(&shots[1], 0.5);
        assert!(later.0 == later.1 && later.0 > 0, "{variant}");
    }
}
