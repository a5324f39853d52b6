//! Every shader that the runtime can compose is parsed and validated without a GPU, and every struct that Rust and WGSL
//! share has the same layout on both sides.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::mem::offset_of;
use sunbake_shaders::*;

fn validated(text: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}\n{text}", e.emit_to_string(text)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    module
}

fn surfaces() -> Vec<SurfaceVariant> {
    // What is smooth changes other files than the rest does: one of each kind will do.
    let smooth = |has_lift| SurfaceVariant { is_smooth: true, has_lift, has_alpha_mask: true, ..Default::default() };
    (0..8)
        .map(|bits| SurfaceVariant {
            is_textured: bits & 1 != 0,
            has_vertex_color: bits & 2 != 0,
            has_alpha_mask: bits & 4 != 0,
            ..SurfaceVariant::default()
        })
        .chain([false, true].map(smooth))
        .collect()
}

/// Surfaces with every combination of what only lit pictures show.
fn looks() -> Vec<SurfaceVariant> {
    let of_bits = |bits: u32| LookVariant {
        is_specular: bits & 3 != 0,
        has_metallic_roughness_map: bits & 2 != 0,
        has_normal_map: bits & 4 != 0,
        has_emissive_map: bits & 8 != 0,
        is_blended: bits & 16 != 0,
    };
    let surface = |bits: u32| SurfaceVariant {
        is_textured: bits & 5 != 0,
        has_vertex_color: bits & 6 == 6,
        has_alpha_mask: bits & 17 == 1,
        is_smooth: bits & 4 != 0,
        has_lift: bits & 12 == 12,
        look: of_bits(bits),
    };
    (0..32).filter(|bits| bits & 3 != 3).map(surface).collect()
}

fn pages() -> Vec<PageVariant> {
    let lane = |layer_count, weight| LaneVariant { layer_count, weight, chord: 0.75 };
    let lanes = [vec![], vec![lane(0, 1.0)], vec![lane(1, 1.0)], vec![lane(2, 0.25), lane(4, 0.5), lane(0, 0.25)]];
    let with = |lanes: &Vec<LaneVariant>, max_code, ambient, lamp_layer_count| PageVariant {
        max_code,
        lanes: lanes.clone(),
        is_point_sun: max_code == 255,
        lamp_layer_count,
        ambient,
        has_backs: lamp_layer_count > 0,
        has_walls: false,
        has_tracks: false,
    };
    let of_lanes = |l| {
        let ambient = [AmbientModel::Occlusion, AmbientModel::Bent, AmbientModel::Sky];
        let plain = with(l, 255, AmbientModel::Hemisphere, 0);
        std::iter::once(plain)
            .chain(ambient.into_iter().flat_map(move |a| [with(l, 65_535, a, 0), with(l, 65_535, a, 3)]))
    };
    let open: Vec<PageVariant> = lanes.iter().flat_map(of_lanes).collect();
    let variants = [(false, false), (true, false), (false, true), (true, true)];
    let of_page = |page: &PageVariant| {
        variants.map(|(has_walls, has_tracks)| PageVariant { has_walls, has_tracks, ..page.clone() })
    };
    open.iter().flat_map(of_page).collect()
}

fn shadow_sources() -> Vec<ShadowSource> {
    let mut all = vec![ShadowSource::Down, ShadowSource::Open, ShadowSource::Mask, ShadowSource::Flat];
    for filter in [ShadowFilter::One, ShadowFilter::Sixteen, ShadowFilter::Four, ShadowFilter::Penumbra] {
        for tap in [ShadowTap::Manual, ShadowTap::Nearest, ShadowTap::Filtered, ShadowTap::Gathered] {
            for choice in [ShadowMapChoice::One, ShadowMapChoice::First, ShadowMapChoice::Blended] {
                let bias = ShadowBias {
                    constant_m: 0.01,
                    constant_texels: 0.5,
                    slope: 0.0,
                    normal: 1.0,
                    reach: 1.0,
                    reach_off_plane: 2.0,
                    has_plane: choice == ShadowMapChoice::One,
                };
                all.push(ShadowSource::Maps { filter, tap, choice, bias, margin_texels: 4.0 });
            }
        }
    }
    all
}

#[test]
fn every_composed_shader_is_valid() {
    validated(&sky_shader());
    validated(&background_shader());
    validated(&screen_shader());
    for light in [VolumeLight::Sun, VolumeLight::Lamp, VolumeLight::LampWithRange] {
        for corners in [VolumeCorners::Indexed, VolumeCorners::FromEdges] {
            for of in [VolumeUse::Stencil, VolumeUse::Count, VolumeUse::Fill, VolumeUse::Visualize] {
                validated(&volume_shader(light, corners, of));
            }
        }
    }
    validated(&blur_shader());
    validated(&shadow_probe_shader());
    for surface in surfaces() {
        validated(&depth_shader(surface));
        validated(&shadow_depth_shader(surface));
        validated(&shadow_mask_shader(surface, true));
        validated(&shadow_mask_shader(surface, false));
        for sun in shadow_sources() {
            validated(&mapped_visibility_shader(surface, &sun));
        }
        for light in [HardLight::SunMask, HardLight::Sun, HardLight::LampMask, HardLight::Lamp] {
            validated(&hard_light_shader(surface, light));
        }
        for page in pages() {
            for filter in [Filter::Nearest, Filter::Bilinear, Filter::Sharp, Filter::Tracks] {
                validated(&lit_shader(surface, &page, filter));
                validated(&visibility_shader(surface, &page, filter));
                validated(&lamp_visibility_shader(surface, &page, filter));
            }
        }
        let lamp_page = PageVariant { max_code: 255, lamp_layer_count: 1, ..PageVariant::default() };
        for page in [PageVariant::default(), lamp_page] {
            for sun in shadow_sources() {
                validated(&mapped_lit_shader(surface, &page, Filter::Bilinear, &sun));
            }
        }
    }
}

#[test]
fn every_look_is_valid() {
    let lane = LaneVariant { layer_count: 2, weight: 1.0, chord: 1.0 };
    let baked = PageVariant { max_code: 255, lanes: vec![lane], lamp_layer_count: 1, ..PageVariant::default() };
    let sky = PageVariant { ambient: AmbientModel::Sky, has_backs: true, ..baked.clone() };
    for surface in looks() {
        for page in [&PageVariant::default(), &baked, &sky] {
            validated(&lit_shader(surface, page, Filter::Bilinear));
        }
        validated(&mapped_lit_shader(surface, &baked, Filter::Bilinear, &ShadowSource::Open));
        for light in [HardLight::Sun, HardLight::Lamp] {
            validated(&hard_light_shader(surface, light));
        }
        for has_lamp in [false, true] {
            validated(&open_lit_shader(surface, &sky, has_lamp));
            validated(&open_lit_shader(surface, &PageVariant::default(), has_lamp));
        }
        assert!(attributes(surface).len() <= 16, "a GPU has 16 attributes: {surface:?}");
    }
}

#[test]
fn looks_are_in_no_program_of_a_plain_surface() {
    let named =
        ["reflect(", "metal_texture", "normal_texture", "emissive_texture", "tangent", "air_color", "1.0 - mat"];
    let of =
        |look| lit_shader(SurfaceVariant { look, ..Default::default() }, &PageVariant::default(), Filter::Bilinear);
    let all = LookVariant {
        is_specular: true,
        has_metallic_roughness_map: true,
        has_normal_map: true,
        has_emissive_map: true,
        is_blended: true,
    };
    let (plain, full) = (of(LookVariant::default()), of(all));
    assert!(named.iter().all(|name| !plain.contains(name) && full.contains(name)));
}

#[test]
fn the_snippet_for_engines_is_valid() {
    validated(ENGINE_WGSL);
}

#[test]
fn a_sun_without_width_has_no_code_that_measures_widths() {
    let page = |is_point_sun| PageVariant {
        max_code: 255,
        lanes: vec![LaneVariant { layer_count: 2, weight: 1.0, chord: 1.0 }],
        is_point_sun,
        ..PageVariant::default()
    };
    let surface = SurfaceVariant::default();
    for filter in [Filter::Nearest, Filter::Bilinear] {
        let texts = |page: &PageVariant| [lit_shader(surface, page, filter), visibility_shader(surface, page, filter)];
        // Looked for in what has them as well, so that the words are those that would be there.
        for words in
            ["soft_visibility", "frame.width_t", "frame.inverse_angular_diameter", "window_start", "disc_share"]
        {
            assert!(texts(&page(false)).iter().all(|text| text.contains(words)), "{words}");
            assert!(!texts(&page(true)).iter().any(|text| text.contains(words)), "{words}");
        }
    }
}

#[test]
fn what_a_page_has_not_is_not_in_its_program() {
    let names = |page: &PageVariant, surface| {
        let module = validated(&lit_shader(surface, page, Filter::Bilinear));
        module.global_variables.iter().filter_map(|(_, v)| v.name.clone()).collect::<Vec<_>>()
    };
    let plain = SurfaceVariant::default();
    assert_eq!(names(&PageVariant::default(), plain), ["frame", "materials"]);
    let textured = SurfaceVariant { is_textured: true, ..plain };
    assert_eq!(names(&PageVariant::default(), textured), ["frame", "materials", "base_texture", "base_sampler"]);
    let all = PageVariant {
        max_code: 255,
        lanes: vec![LaneVariant { layer_count: 1, weight: 1.0, chord: 1.0 }],
        ambient: AmbientModel::Occlusion,
        ..PageVariant::default()
    };
    assert_eq!(names(&all, plain), ["frame", "materials", "rise_map", "fall_map", "ao_map"]);
    let bent = PageVariant { ambient: AmbientModel::Bent, ..PageVariant::default() };
    assert_eq!(names(&bent, plain), ["frame", "materials", "ao_map", "bent_map"]);
    let sky = PageVariant { ambient: AmbientModel::Sky, ..PageVariant::default() };
    assert_eq!(names(&sky, plain), ["frame", "materials", "sky", "sky_map"]);
    let lamp = PageVariant { max_code: 255, lamp_layer_count: 1, ..PageVariant::default() };
    assert_eq!(names(&lamp, plain), ["frame", "materials", "lamp", "lamp_rise_map", "lamp_fall_map"]);
}

fn members(module: &naga::Module, name: &str) -> (Vec<(String, u32)>, u32) {
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).expect("the struct exists");
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is not a struct") };
    (members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset)).collect(), *span)
}

macro_rules! offsets {
    ($type:ty: $($field:ident),*) => {
        vec![$((stringify!($field).to_owned(), offset_of!($type, $field) as u32)),*]
    };
}

#[test]
fn uniforms_have_one_layout_in_rust_and_wgsl() {
    let module = validated(&sky_shader());
    let rust = offsets!(FrameUniform: clip_from_eye, eye_m, pixel_angle_rad, ray_first, t, ray_per_column, width_t,
        ray_per_row, sun_cos_radius, sun_direction, inverse_angular_diameter, sun_light, sky_light, ground_light,
        zenith, horizon, glow, haze);
    assert_eq!(members(&module, "Frame"), (rust, size_of::<FrameUniform>() as u32));
    let page = PageVariant { max_code: 255, lamp_layer_count: 1, ..PageVariant::default() };
    let lit = validated(&lamp_visibility_shader(SurfaceVariant::default(), &page, Filter::Bilinear));
    let rust = offsets!(LampUniform: position_m, t, light, width_t, radius_m, inverse_diameter_per_m, range_m);
    assert_eq!(members(&lit, "Lamp"), (rust, size_of::<LampUniform>() as u32));
    let page = PageVariant { ambient: AmbientModel::Sky, ..PageVariant::default() };
    let lit = validated(&lit_shader(SurfaceVariant::default(), &page, Filter::Bilinear));
    assert_eq!(members(&lit, "Sky"), (offsets!(SkyUniform: coefficients), size_of::<SkyUniform>() as u32));
    let [_, _, mask, _] = shadow_sources()[..4] else { panic!("there are sources without maps") };
    let mapped = validated(&mapped_visibility_shader(SurfaceVariant::default(), &mask));
    let rust = offsets!(ShadowMapUniform: clip_from_point, origin_m, z_per_metre, eye_from_origin_m, ground_height_m);
    assert_eq!(members(&mapped, "ShadowMap"), (rust, size_of::<ShadowMapUniform>() as u32));
    let rust = offsets!(ShadowMapsUniform: maps, count);
    assert_eq!(members(&mapped, "ShadowMaps"), (rust, size_of::<ShadowMapsUniform>() as u32));
    let rust = offsets!(
        MaterialUniform: base_color, emissive, is_unlit, cutoff, wrap_u, wrap_v, metallic, roughness, normal_scale,
        transmission
    );
    assert_eq!(members(&module, "Material"), (rust, size_of::<MaterialUniform>() as u32));
}
