//! Files of odd kinds that are read right: the same light as their plain twins, and as brute force in `f64` finds.

use super::tools::{bake, must, scene, settings};
use super::{Found, Row};
use glam::DVec3;
use sunbake::scene::Scene;
use sunbake::sun::{DayOutcome, day};
use sunbake_tests::paths::Random;
use sunbake_tests::{Traced, engines, june_day};

pub const ROWS: &[Row] = &[
    Row::new("04_gpu_instancing", "instances are plain transforms", || {
        twins("04_gpu_instancing/scene.glb", "04_gpu_instancing/uninstanced.glb")
    }),
    Row::new("07_quantised", "quantised meshes are where floats are", quantised),
    Row::new("13_tree", "leaves of an alpha texture under a texture transform cast their cut-outs", || {
        agrees("13_tree/scene.glb", 12)
    }),
    Row::new("15_chips", "thousands of chips are lit as brute force says", || agrees("15_chips/scene.glb", 6)),
    Row::new("18_images", "PNG of every kind, as masks", || agrees("18_images/scene.glb", 12)),
    Row::new("19_names", "names and data URIs beyond ASCII", names),
    Row::new("22_units", "millimetres and kilometres bake the same map", units),
    Row::new("23_scenes", "the default scene is drawn, and no other", scenes),
    Row::new("26_column", "a thin column on a floor", || agrees("26_column/scene.glb", 12)),
    Row::new("32_wire", "wires", || agrees("32_wire/scene.glb", 12)),
    Row::new("33_scales", "one mesh at three sizes", || agrees("33_scales/scene.glb", 12)),
    Row::new("35_curtain", "an alpha gradient is cut at one half", || agrees("35_curtain/scene.glb", 12)),
    Row::new("36_basisu_fallback", "the PNG is read where KTX2 is not", || pictures("36_basisu_fallback/scene.glb")),
    Row::new("37_georef", "map coordinates below a turned node keep their digits", || {
        agrees("37_georef/scene.glb", 12)
    }),
    Row::new("41_sunlight", "the file's own sun, on a node or on its child", sunlight),
    Row::new("42_meshopt_fallback", "the fallback buffer is read", || agrees("42_meshopt_fallback/scene.glb", 6)),
];

/// Every engine against brute force at random points of surfaces.
fn agrees(name: &str, count: usize) -> Found {
    let here = Traced::new(scene(name));
    let Ok(DayOutcome::Path(path)) = day(&june_day()) else { return Err("no sun in June".into()) };
    let mut random = Random::new(17);
    let area = |triangle: usize| {
        let [a, b, c] = here.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
        (b - a).cross(c - a).length()
    };
    let instances = here.scene.instances.len();
    let points: Vec<_> = (0..count)
        .map(|k| {
            // Instance by instance, so that a large ground does not take all points.
            let instance = k % instances;
            let [first, end] = [instance, instance + 1].map(|i| here.geometry.first_triangle[i] as usize);
            let whole: f64 = (first..end).map(area).sum();
            let mut left = random.unit() * whole;
            let triangle = (first..end).find(|&triangle| {
                left -= area(triangle);
                left <= 0.0
            });
            let [u, v] = [random.unit(), random.unit()];
            here.point(triangle.unwrap_or(end - 1), if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] })
        })
        .collect();
    engines::all_must_agree(name, &here, &path, &points);
    Ok(format!("all engines agree with brute force at {count} points"))
}

/// The same maps, byte for byte.
fn twins(a: &str, b: &str) -> Found {
    let [a, b] = [a, b].map(|name| bake(&scene(name), &settings()).0);
    let maps = |bake: &sunbake::Bake| bake.pages.iter().map(|page| page.maps.clone()).collect::<Vec<_>>();
    must(maps(&a) == maps(&b), || "the maps differ".into())?;
    Ok(format!("{} pages are equal", a.pages.len()))
}

fn world_corners(scene: &Scene) -> Vec<DVec3> {
    let corners = |instance: &sunbake::scene::Instance| {
        let mesh = &scene.meshes[instance.mesh];
        let matrix = instance.bake_from_object;
        let at =
            move |index: &u32| matrix.transform_point3(mesh.positions[*index as usize].as_dvec3()) + scene.centre_m;
        mesh.indices.iter().map(at).collect::<Vec<_>>()
    };
    scene.instances.iter().flat_map(corners).collect()
}

fn quantised() -> Found {
    let [float, short] = ["07_quantised/f.glb", "07_quantised/q.glb"].map(|name| world_corners(&scene(name)));
    must(float.len() == short.len() && !float.is_empty(), || "other corners".into())?;
    let worst_m = float.iter().zip(&short).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    must(worst_m < 1e-3, || format!("a corner is {worst_m} m off"))?;
    let agrees = agrees("07_quantised/q.glb", 9)?;
    Ok(format!("corners within {:.2} mm; {agrees}", worst_m * 1e3))
}

fn pictures(name: &str) -> Found {
    let scene = scene(name);
    must(scene.images.len() == 1 && scene.warnings.is_empty(), || format!("{:?}", scene.warnings))?;
    let image = &scene.images[0];
    Ok(format!("a picture of {} x {}", image.width, image.height))
}

fn names() -> Found {
    for name in ["19_names/datauri.gltf", "19_names/häuschen α.gltf"] {
        pictures(name)?;
        let scene = scene(name);
        let named: Vec<_> = scene.nodes.iter().filter_map(|node| node.name.as_deref()).collect();
        must(named.starts_with(&["块", "地面"]), || format!("{named:?}"))?;
    }
    Ok("two files, their pictures and 块, 地面".into())
}

fn units() -> Found {
    let maps = ["k0.001", "k1", "k1000"].map(|name| {
        let (baked, _) = bake(&scene(&format!("22_units/{name}.glb")), &settings());
        baked.pages.into_iter().map(|page| page.maps.lanes).collect::<Vec<_>>()
    });
    let differing = |a: &[Vec<sunbake::maps::LaneMaps>], b: &[Vec<sunbake::maps::LaneMaps>]| {
        let codes = |pages: &[Vec<sunbake::maps::LaneMaps>]| -> Vec<[u16; 4]> {
            pages.iter().flatten().flat_map(|lane| &lane.layers).flat_map(|layer| layer.rise.clone()).collect()
        };
        let (a, b) = (codes(a), codes(b));
        let near = |(a, b): (&[u16; 4], &[u16; 4])| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 16);
        if a.len() != b.len() { usize::MAX } else { a.iter().zip(&b).filter(|&pair| !near(pair)).count() }
    };
    let [small, large] = [differing(&maps[0], &maps[1]), differing(&maps[2], &maps[1])];
    let text = format!("{small} and {large} texels differ by more than 16 of 65535");
    must(small < 60 && large < 60, || text.clone())?;
    Ok(text)
}

fn scenes() -> Found {
    let scene = scene("23_scenes/second_default.glb");
    let drawn: Vec<_> = scene.instances.iter().filter_map(|one| scene.nodes[one.node].name.as_deref()).collect();
    must(drawn.contains(&"crateB") && !drawn.contains(&"crateA"), || format!("{drawn:?}"))?;
    Ok(format!("{drawn:?}"))
}

fn sunlight() -> Found {
    let directions = ["41_sunlight/node.glb", "41_sunlight/child.glb"].map(|name| scene(name).sun_direction);
    let [Some(a), Some(b)] = directions else { return Err(format!("{directions:?}")) };
    // The file's matrix: the light shines along the node's own -Z.
    let expected = DVec3::new(-0.541_954_560_984_997_7, 0.642_316_516_722_960_2, 0.541_954_560_984_997_7).normalize();
    must(a.distance(expected) < 1e-6 && b.distance(expected) < 1e-6, || format!("{a} {b}, not {expected}"))?;
    Ok(format!("towards {a:.3}"))
}
