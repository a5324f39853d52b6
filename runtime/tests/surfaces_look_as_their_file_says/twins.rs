//! A scene with every effect of looks, on the GPU and on the CPU.

use super::{square, with_clear_panes};
use glam::{DMat4, DQuat, DVec3, Mat3, Vec2, Vec3, Vec4};
use sunbake::maps::Bits;
use sunbake::scene::looks::Look;
use sunbake::scene::{Image, Material, Mesh, Scene, TextureRef, Wrap};
use sunbake::testing::{SceneBuilder, floor, icosphere, pseudo_random};
use sunbake_runtime::compare::{Agreement, color_difference, edges};
use sunbake_runtime::technique::{BakedCpu, BakedGpu, Technique};
use sunbake_runtime::testing::looks::{named, texture, with_looks};
use sunbake_runtime::testing::masks::{gpu, lamp_at};
use sunbake_runtime::testing::{bake, equinox, table_line, view, with_lamp};
use sunbake_runtime::{Filter, Raster, Shot, Stage};

/// A ball with smooth normals and coordinates by longitude and latitude.
fn ball() -> Mesh {
    let positions: Vec<Vec3> = icosphere(2).iter().flatten().copied().collect();
    let uv = |p: &Vec3| Vec2::new(p.z.atan2(p.x) / std::f32::consts::PI, 0.5 - p.y * 0.5);
    Mesh {
        normals: Some(positions.iter().map(|p| p.normalize()).collect()),
        texcoords: vec![Some(positions.iter().map(uv).collect())],
        colors: Some(positions.iter().map(|p| Vec4::new(1.0, 0.8 + 0.2 * p.y, 0.9, 0.8)).collect()),
        indices: (0..positions.len() as u32).collect(),
        positions,
        ..Mesh::default()
    }
}

fn noise(seed: u64, low: [u8; 3], high: [u8; 3]) -> Image {
    let mut state = seed;
    let texel = |_| {
        let mut mixed = |k: usize| {
            let share = pseudo_random(&mut state);
            (f64::from(low[k]) * (1.0 - share) + f64::from(high[k]) * share) as u8
        };
        [mixed(0), mixed(1), mixed(2), 255]
    };
    Image { name: "noise".into(), width: 16, height: 8, rgba: (0..128).map(texel).collect() }
}

fn place(x: f64, y: f64, z: f64) -> DMat4 {
    DMat4::from_scale_rotation_translation(DVec3::splat(0.7), DQuat::from_rotation_y(x), DVec3::new(x, y, z))
}

fn scene() -> Scene {
    let both = |name| Material { is_double_sided: true, ..named(name) };
    let color = |name, color: Vec3, alpha: f32| Material { base_color: color.extend(alpha), ..both(name) };
    let upright = |x: f64, z: f64| place(x, 0.9, z) * DMat4::from_rotation_x(1.3);
    let mirrored = upright(2.6, -0.4) * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let faint = color("pane", Vec3::new(0.9, 0.5, 0.1), 0.3);
    let glass = color("glass", Vec3::new(0.8, 0.9, 1.0), 1.0);
    SceneBuilder::new()
        .soup(&floor(Vec2::splat(-4.0), Vec2::splat(4.0), 0.0))
        .mesh_of(ball(), color("metal", Vec3::new(0.9, 0.7, 0.3), 1.0), &[place(-2.0, 0.8, 0.0)])
        .mesh_of(ball(), color("gloss", Vec3::new(0.1, 0.3, 0.6), 1.0), &[place(0.0, 0.8, -1.0)])
        .mesh_of(square(), both("bumps"), &[upright(1.3, -1.2), mirrored])
        .mesh_of(square(), Material { emissive: Vec3::new(2.0, 1.0, 0.2), ..both("sign") }, &[upright(-1.2, -1.7)])
        .mesh_of(square(), faint, &[upright(0.4, 1.2), upright(0.6, 1.9)])
        // One side, and beside the panes: sorted by triangle, what it blends is in order at every pixel.
        .mesh_of(ball(), Material { is_double_sided: false, ..glass }, &[place(2.3, 0.7, 1.6)])
        .build()
}

fn stage() -> Stage {
    let tiled = |image, wrap| TextureRef {
        image_from_texcoord: Mat3::from_scale(Vec2::new(3.0, 2.0)),
        wrap: [wrap, Wrap::Repeat],
        ..texture(image)
    };
    let images = vec![
        noise(3, [0, 60, 0], [255, 250, 255]),
        noise(5, [70, 70, 160], [186, 186, 255]),
        noise(7, [0, 0, 0], [255, 255, 255]),
    ];
    let mapped = Some(tiled(0, Wrap::Repeat));
    let look = |name: &str| match name {
        "metal" => Look { metallic: 1.0, roughness: 0.4, ..Look::PLAIN },
        "gloss" => Look { metallic: 0.7, roughness: 0.9, metallic_roughness_texture: mapped, ..Look::PLAIN },
        "bumps" => Look { roughness: 0.5, normal_texture: Some(tiled(1, Wrap::Mirror)), ..Look::PLAIN },
        "sign" => Look { emissive_texture: Some(tiled(2, Wrap::Clamp)), ..Look::PLAIN },
        "pane" => Look { says_blend: true, ..Look::PLAIN },
        _ => {
            let normal_texture = Some(tiled(1, Wrap::Repeat));
            Look { transmission: 0.6, roughness: 0.3, normal_texture, normal_scale: 0.3, ..Look::PLAIN }
        }
    };
    let stage = bake(with_clear_panes(scene()), Some(equinox(35.0)), 12, Bits::Sixteen);
    let stage = with_lamp(stage, &lamp_at(DVec3::new(0.5, 3.0, 1.5)), 12);
    with_looks(stage, images, look)
}

/// Pixels at the border of a surface, solid or blended, or of a shadow.
fn borders(shot: &Shot, seen: &Raster<f32>) -> Vec<bool> {
    let (solid, blended) = shot.layers().expect("panes");
    let instance =
        |layer: &Shot, pixel: usize| layer.hits()[pixel].map(|hit| shot.stage.geometry.instance[hit.triangle as usize]);
    let shown = |pixel: usize| {
        let panes = blended.iter().map(|layer| instance(layer, pixel));
        std::iter::once(instance(&solid, pixel)).chain(panes).collect::<Vec<_>>()
    };
    let [width, height] = shot.view.size.map(|edge| edge as usize);
    let of_surface = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let beside = [(x.max(1) - 1, y), ((x + 1).min(width - 1), y), (x, y.max(1) - 1), (x, (y + 1).min(height - 1))];
        beside.into_iter().any(|(x, y)| shown(y * width + x) != shown(pixel))
    };
    edges(shot, seen).into_iter().enumerate().map(|(pixel, is_edge)| is_edge || of_surface(pixel)).collect()
}

#[test]
fn every_look_is_the_same_on_the_gpu_and_on_the_cpu() {
    let gpu = gpu();
    let stage = stage();
    for (name, eye) in [("from the south", DVec3::new(0.6, 2.6, 5.0)), ("from the north", DVec3::new(1.0, 2.2, -4.5))] {
        let shot = Shot::new(&stage, view(&stage, eye, DVec3::new(0.2, 0.7, 0.0), [160, 112]));
        let mut on_gpu = BakedGpu::new(&gpu, &stage, Filter::Bilinear).unwrap();
        let mut on_cpu = BakedCpu::new(&stage, Filter::Bilinear);
        for t in [0.2, 0.5, 0.85] {
            let moment = stage.moment(t);
            let borders = borders(&shot, &on_cpu.visibility(&shot, &moment).unwrap());
            let pictures = [on_gpu.color(&shot, &moment).unwrap(), on_cpu.color(&shot, &moment).unwrap()];
            let difference = color_difference(&pictures[0], &pictures[1]);
            let found = Agreement::new(&difference, &borders, 1.0 / 255.0 + 1e-6);
            println!("{}", table_line(name, t, "picture", &found));
            assert!(found.share_within() >= 0.999 && found.unexplained == 0, "{found:?}");
            assert!(!found.worst.is_nan());
        }
    }
}
