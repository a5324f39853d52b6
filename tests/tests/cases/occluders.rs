//! What hides the sun by mistake, and what is too small for its texels.

use super::tools::{bake, file, mean_light_on, must, scene, settings, stage};
use super::{Found, Row};
use sunbake::progress::Silent;
use sunbake::scene::{LoadLimits, ObjectWishes, Scene, parse};
use sunbake::settings::{BakeSettings, SunRequest};
use sunbake::sun::DayRequest;
use sunbake_tests::june_day;

pub const ROWS: &[Row] = &[
    Row::new("02_window", "the sun comes in as if the pane were not there", panes_let_light_in),
    Row::new("02_window", "the pane is drawn, and a line names its material", panes_are_drawn_and_named),
    Row::new("08_dome", "the dome is named with what helps, which helps", domes_are_named),
    Row::new("08_dome", "a dome without any name is named by its index", nameless_domes_are_named),
    Row::new("09_collision", "the shell is named, and its node leaves it out", shells_are_named),
    Row::new("09_collision", "a hidden node is not there", hidden_nodes_are_not_there),
    Row::new("14_terrain", "what is narrower than two texels is listed", small_things_are_listed),
    Row::new("14_terrain", "a bench can have texels of its own size", a_bench_has_its_own_density),
    Row::new("14_terrain", "the bench's shadow on the ground has its size", a_bench_casts_its_shadow),
];

/// B21.
fn panes_let_light_in() -> Found {
    // The low sun of winter reaches deep into the room.
    let december = DayRequest { date: "2026-12-21".parse().expect("a date"), ..june_day() };
    let winter = BakeSettings { sun: SunRequest::Day(december), ..settings() };
    let light = |name: &str| mean_light_on(&stage(&scene(name), &winter), "floor");
    let [none, blend, transmission] =
        ["none", "blend", "transmission"].map(|kind| light(&format!("02_window/{kind}.glb")));
    let text =
        format!("mean light on the floor {none:.4} without a pane, {blend:.4} BLEND, {transmission:.4} transmitting");
    must(none > 0.02 && (blend - none).abs() < 5e-3 && (transmission - none).abs() < 5e-3, || text.clone())?;
    Ok(text)
}

fn panes_are_drawn_and_named() -> Found {
    for kind in ["blend", "transmission"] {
        let (baked, warnings) = bake(&scene(&format!("02_window/{kind}.glb")), &settings());
        let line = warnings.iter().find(|line| line.contains("\"glass\"") && line.contains("sunbake_no_cast"));
        must(line.is_some(), || format!("{kind}: {warnings:?}"))?;
        let stage = sunbake_runtime::stage::Stage::of_bake(baked).map_err(|error| error.to_string())?;
        let is_drawn = |&triangle: &usize| !stage.sides(triangle).is_none();
        let pane = |&triangle: &usize| stage.material(triangle).name.as_deref() == Some("glass");
        let drawn = (0..stage.geometry.triangles.len()).filter(pane).filter(is_drawn).count();
        must(drawn == 12, || format!("{kind}: {drawn} of 12 triangles of the pane are drawn"))?;
    }
    Ok("12 of 12 triangles drawn, \"glass\" and its key named".into())
}

fn left_out(name: &str) -> BakeSettings {
    BakeSettings { objects: ObjectWishes { leave_out: vec![name.into()], ..ObjectWishes::default() }, ..settings() }
}

/// B21.
fn domes_are_named() -> Found {
    let dome = scene("08_dome/sky.glb");
    let (_, warnings) = bake(&dome, &settings());
    let line = warnings.iter().find(|line| line.contains("SkySphere") && line.contains("--leave-out SkySphere"));
    must(line.is_some(), || format!("{warnings:?}"))?;
    let dark = mean_light_on(&stage(&dome, &settings()), "floor");
    let lit = mean_light_on(&stage(&dome, &left_out("SkySphere")), "floor");
    // Nor does it take texels from the rest then.
    let sky = || vec!["sky".to_owned()];
    let passed = ObjectWishes { no_cast: sky(), no_receive: sky(), ..ObjectWishes::default() };
    let no_cast = mean_light_on(&stage(&dome, &BakeSettings { objects: passed, ..settings() }), "floor");
    let text = format!("mean light on the floor {dark:.3}, left out {lit:.3}, not casting {no_cast:.3}");
    must(dark == 0.0 && lit > 0.5 && (lit - no_cast).abs() < 0.02, || text.clone())?;
    Ok(text)
}

/// A scene whose JSON is changed before it is read.
fn changed(name: &str, change: impl Fn(&mut serde_json::Value)) -> Scene {
    let bytes = std::fs::read(file(name)).expect("a file");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("a word")) as usize;
    let mut json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    change(&mut json);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let rest = &bytes[20 + length..];
    let word = |number: usize| (number as u32).to_le_bytes();
    let head = [&bytes[..8], &word(20 + text.len() + rest.len()), &word(text.len()), &bytes[16..20]].concat();
    let whole = [head, text, rest.to_vec()].concat();
    parse(&file(name), &whole, &LoadLimits::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// B21.
fn nameless_domes_are_named() -> Found {
    let nameless = changed("08_dome/sky.glb", |json| {
        for list in ["nodes", "meshes", "materials"] {
            for item in json[list].as_array_mut().expect("a list") {
                item.as_object_mut().expect("an object").remove("name");
            }
        }
    });
    let (_, warnings) = bake(&nameless, &settings());
    let line = warnings.iter().find(|line| line.contains("--leave-out node:0"));
    must(line.is_some(), || format!("{warnings:?}"))?;
    Ok("node:0 is named".into())
}

/// B21.
fn shells_are_named() -> Found {
    let mut found = Vec::new();
    for kind in ["nomat", "samemat"] {
        let scene = scene(&format!("09_collision/{kind}.glb"));
        let (_, warnings) = bake(&scene, &settings());
        let line = warnings.iter().find(|line| line.contains("--leave-out crate-colonly"));
        must(line.is_some(), || format!("{kind}: {warnings:?}"))?;
        let dark = mean_light_on(&stage(&scene, &settings()), "crate");
        let [by_name, by_index] =
            ["crate-colonly", "node:2"].map(|name| mean_light_on(&stage(&scene, &left_out(name)), "crate"));
        let text = format!("{kind}: light on the crate {dark:.3}, without the shell {by_name:.3} and {by_index:.3}");
        must(dark == 0.0 && by_name > 0.9 && by_name == by_index, || text.clone())?;
        found.push(text);
    }
    Ok(found.join("; "))
}

fn hidden_nodes_are_not_there() -> Found {
    let light = mean_light_on(&stage(&scene("09_collision/hidden.glb"), &settings()), "crate");
    must(light > 0.9, || format!("light on the crate {light:.3}"))?;
    Ok(format!("light on the crate {light:.3}"))
}

/// B21.
fn small_things_are_listed() -> Found {
    let (_, warnings) = bake(&scene("14_terrain/scene.glb"), &settings());
    let line = warnings.iter().find(|line| line.contains("narrower than two texels") && line.contains("--density"));
    let named = line.is_some_and(|line| ["leg1", "leg2"].iter().all(|name| line.contains(name)));
    must(named, || format!("{warnings:?}"))?;
    Ok(line.cloned().unwrap_or_default())
}

fn a_bench_has_its_own_density() -> Found {
    let terrain = scene("14_terrain/scene.glb");
    let density = ["seat", "back", "leg1", "leg2"].map(|name| (name.to_owned(), 40.0)).into();
    let objects = ObjectWishes { density, ..ObjectWishes::default() };
    let baked = sunbake::bake_scene(&terrain, &BakeSettings { objects, ..settings() }, &Silent);
    let stage = sunbake_runtime::stage::Stage::of_bake(baked.map_err(|error| error.to_string())?);
    let stage = stage.map_err(|error| error.to_string())?;
    let density_of = |name: &str| {
        let triangles = (0..stage.geometry.triangles.len())
            .filter(|&triangle| super::tools::node(&stage, stage.geometry.instance[triangle] as usize) == name);
        let (texels, square_m) = triangles.fold((0.0, 0.0), |(texels, square_m), triangle| {
            let chart = stage.chart(stage.geometry.instance[triangle] as usize).expect("it is drawn");
            let page = &stage.pages[chart.page as usize];
            let size = glam::DVec2::new(f64::from(page.width), f64::from(page.height));
            let [a, b, c] = stage.corners(triangle).page_uv.map(|uv| uv.as_dvec2() * size);
            let [p, q, r] = stage.geometry.triangles[triangle].map(|corner| corner.as_dvec3());
            (texels + (b - a).perp_dot(c - a).abs(), square_m + (q - p).cross(r - p).length())
        });
        (texels / square_m).sqrt()
    };
    let [seat, ground] = ["seat", "terrain"].map(density_of);
    let text = format!("{seat:.1} texels a metre on the seat, {ground:.3} on the terrain");
    must((38.0..42.0).contains(&seat) && ground > 0.1, || text.clone())?;
    Ok(text)
}

/// B21: filtered playback against truth at points of the ground around the bench.
fn a_bench_casts_its_shadow() -> Found {
    let terrain = scene("14_terrain/scene.glb");
    let around = ["seat", "back", "leg1", "leg2"].map(|name| (name.to_owned(), 12.0)).into();
    let dense = ObjectWishes { density_around: around, ..ObjectWishes::default() };
    let errors = [(ObjectWishes::default(), 256), (dense, 512)].map(|(objects, page_size_texels)| {
        ground_error(&stage(&terrain, &BakeSettings { objects, page_size_texels, ..settings() }))
    });
    let [[plain, shade], [dense, _]] = errors;
    let text =
        format!("mean error {dense:.4} with 12 texels a metre around it, {plain:.4} without; {shade:.3} in shade");
    must(shade > 0.02 && dense < 0.25 * shade && plain > 0.5 * shade, || text.clone())?;
    Ok(text)
}

/// Mean error of the sun's visibility at ten times of day on ground within 1.5 m of the middle, and the share of it
/// that truth finds dark.
fn ground_error(stage: &sunbake_runtime::stage::Stage) -> [f64; 2] {
    use sunbake::trace::Direction;
    let path = stage.path.clone().expect("a sun");
    let pages: Vec<_> = (stage.pages.iter())
        .map(|page| sunbake_runtime::playback::Page::new(page, stage.bits, path.angular_radius_rad))
        .collect();
    let (mut error, mut shade, mut count) = (0.0, 0.0, 0.0);
    for (i, j) in (0..60).flat_map(|i| (0..60).map(move |j| (i, j))) {
        let [x, z] = [i, j].map(|k| (f64::from(k) + 0.5) * 0.05 - 1.5);
        let from = glam::DVec3::new(x, 40.0, z) - stage.scene.centre_m;
        let is_ground =
            |triangle: u32| super::tools::node(stage, stage.geometry.instance[triangle as usize] as usize) == "terrain";
        let down = Direction::new(-glam::DVec3::Y);
        let Some(hit) = stage.tracer().closest_hit_where(from, &down, is_ground) else { continue };
        let (page, page_uv) = stage.page_uv(&hit).expect("the ground has texels");
        let normal = stage.geometry.normal(hit.triangle as usize);
        let origin =
            stage.tracer().lift(stage.geometry.point(hit.triangle as usize, hit.barycentric), normal, hit.triangle);
        for k in 0..10 {
            let t = (f64::from(k) + 1.5) / 12.0;
            let sun = path.direction(t);
            let is_lit = normal.dot(sun) > 0.0 && !stage.tracer().is_occluded(origin, &Direction::new(sun));
            let lit = f64::from(u8::from(is_lit));
            let moment = stage.moment(t);
            let filter = sunbake_runtime::Filter::Bilinear;
            let seen = pages[page as usize].sun_visibility(page_uv, normal.as_vec3(), filter, &moment);
            error += (f64::from(seen) - lit).abs();
            shade += 1.0 - lit;
            count += 1.0;
        }
    }
    [error / count, shade / count]
}
