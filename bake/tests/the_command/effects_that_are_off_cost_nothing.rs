//! The effect plan is obeyed: what is off leaves no file, no ray and no second, and what is switched on adds its own.

use super::tools::{Desk, names};
use serde_json::Value;
use std::collections::BTreeSet;

/// The least bake of a floor: a sun without width, and nothing else.
const LEAST: [&str; 4] = ["--path=sun.json", "--only=intervals", "--layers=1", "--engine=exact"];

/// A floor, a sun without width, and a lamp.
fn desk() -> Desk {
    let desk = Desk::new();
    let sun =
        r#"{"keys": [{"azimuth_deg": 90, "elevation_deg": 5}, {"direction": [0, 1, 0]}], "angular_radius_deg": 0}"#;
    desk.write("sun.json", sun.as_bytes());
    desk.write("wide.json", sun.replace("\"angular_radius_deg\": 0", "\"angular_radius_deg\": 0.3").as_bytes());
    desk.write("lamp.json", br#"{"keys": [{"position": [0, 1, 0]}, {"position": [1, 2, 0]}], "radius_m": 0}"#);
    desk
}

/// What a bake left: its manifest, and the files of its set.
struct Baked {
    manifest: Value,
    files: BTreeSet<String>,
}

impl Baked {
    fn of(desk: &Desk, arguments: &[&str]) -> Self {
        let usual = ["bake", "floor.glb", "-o", "out/set", "--preset=draft", "--size=64", "--threads=1"];
        let manifest = desk.run(&[&usual[..], arguments, &["--json", "--force"]].concat()).ok().json();
        let files = names(&desk.path("out/set")).into_iter().collect();
        Self { manifest, files }
    }

    /// Names of the effects that are on.
    fn effects(&self) -> BTreeSet<String> {
        let all = self.manifest["effects"].as_array().expect("a list");
        let on = all.iter().filter(|effect| effect["on"] == true);
        on.map(|effect| effect["effect"].as_str().expect("a name").to_owned()).collect()
    }
}

fn set<const N: usize>(names: [&str; N]) -> BTreeSet<String> {
    names.map(str::to_owned).into()
}

/// [`LEAST`] with one argument replaced or added, and further ones.
fn with<'a>(argument: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let key = |argument: &'a str| argument.split('=').next();
    let others = LEAST.into_iter().filter(|least| key(least) != key(argument));
    others.chain([argument]).chain(more.iter().copied()).collect()
}

#[test]
fn a_floor_under_a_point_sun_bakes_one_pair_of_textures_and_traces_no_ray() {
    let found = Baked::of(&desk(), &LEAST);
    assert_eq!(found.effects(), set(["sun-intervals"]));
    let files = ["page0_lane0_layer0_fall.png", "page0_lane0_layer0_rise.png", "scene.glb", "sunbake.json"];
    assert_eq!(found.files, set(files));
    let stats = &found.manifest["stats"];
    assert_eq!((&stats["rays"], &stats["seconds"]["ambient"]), (&0.into(), &0.0.into()));
    for of_others in ["lamp", "ambient"] {
        assert!(found.manifest.get(of_others).is_none(), "{of_others}");
    }
    let page = found.manifest["atlases"][0].as_object().expect("a page");
    let said: Vec<&str> = page.iter().filter(|(_, value)| !value.is_null()).map(|(key, _)| key.as_str()).collect();
    assert_eq!(said, ["height", "lanes", "width"]);
}

#[test]
fn each_effect_adds_its_own_files_and_nothing_else() {
    let desk = desk();
    let least = Baked::of(&desk, &LEAST);
    let adds = |argument: &str, more: &[&str], effects: &[&str], files: &[&str]| {
        let found = Baked::of(&desk, &with(argument, more));
        let names = |of: &[&str]| of.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<_>>();
        assert_eq!(&found.effects() - &least.effects(), names(effects), "{argument}");
        assert_eq!(&found.files - &least.files, names(files), "{argument}");
        assert!(least.files.is_subset(&found.files) && least.effects().is_subset(&found.effects()), "{argument}");
    };
    let ao = "page0_ao.png";
    let bent = "page0_bent.png";
    let sky = ["page0_sky0.png", "page0_sky1.png", "page0_sky2.png"];
    let lamp = ["page0_lamp_layer0_fall.png", "page0_lamp_layer0_rise.png"];
    let lanes = [0, 1, 2].map(|k| ["fall", "rise"].map(|what| format!("page0_lane{k}_layer0_{what}.png"))).concat();
    let lanes: Vec<&str> = lanes.iter().map(String::as_str).filter(|name| !name.contains("lane0")).collect();
    let both = "--only=intervals,ao";
    adds("--path=wide.json", &[], &["penumbra"], &[]);
    adds("--path=wide.json", &["--lanes=3"], &["penumbra", "disc-lanes"], &lanes);
    adds("--lamp=lamp.json", &[], &["lamp-intervals"], &lamp);
    adds("--bits=16", &[], &["16-bit-times"], &[]);
    adds("--loss-map", &[], &["loss-map"], &["lost_minutes.0.exr", "lost_minutes.0.png"]);
    // A higher cap adds no layers where no texel needs them.
    adds("--layers=4", &[], &[], &[]);
    adds(both, &[], &["ambient-occlusion"], &[ao]);
    adds(both, &["--ao-distance=1"], &["ambient-occlusion", "ambient-distance"], &[ao]);
    adds(both, &["--bent"], &["ambient-occlusion", "bent-normals"], &[ao, bent]);
    adds(both, &["--sky=sh2"], &["ambient-occlusion", "sky-sh2"], &[&[ao], &sky[..]].concat());
    adds(both, &["--exr"], &["ambient-occlusion", "ambient-exr"], &[ao, "page0_ambient.exr"]);
    adds(both, &["--ao-vertices=_AO"], &["ambient-occlusion", "vertex-ambient"], &[ao, "vertices.glb"]);
}

#[test]
fn every_effect_states_its_cost_and_what_toggles_it() {
    let desk = desk();
    for arguments in [&LEAST[..], &["--only=ao"], &["--place=40,0", "--lanes=5", "--lamp=lamp.json", "--bent"]] {
        let plan = desk.run(&[&["bake", "floor.glb", "--explain", "--json"][..], arguments].concat()).ok().json();
        let plan = plan.as_array().expect("a list");
        assert_eq!(plan.len(), 18);
        for effect in plan {
            let is_said = |key: &str| effect[key].as_str().is_some_and(|text| text.len() > 3);
            assert!(is_said("why") && is_said("cost") && is_said("toggled_by"), "{effect}");
        }
    }
    let told = desk.run(&["bake", "floor.glb", "--explain"]).ok().stdout;
    for words in
        ["  on  sun-intervals", "      costs", "16 bytes a texel", "off by", "--only ao", "would cost", "--bent"]
    {
        assert!(told.contains(words), "{words}: {told}");
    }
    assert!(told.lines().all(|line| line.chars().count() <= 110), "{told}");
}

#[test]
fn a_set_without_costs_of_effects_is_still_read() {
    let desk = desk();
    let mut manifest = Baked::of(&desk, &LEAST).manifest;
    for effect in manifest["effects"].as_array_mut().expect("a list") {
        let effect = effect.as_object_mut().expect("an effect");
        assert!(effect.remove("cost").is_some() && effect.remove("toggled_by").is_some());
    }
    desk.write("out/set/sunbake.json", manifest.to_string().as_bytes());
    let told = desk.run(&["inspect", "out/set"]).ok().stdout;
    assert!(told.contains("sun-intervals") && !told.contains("would cost"), "{told}");
    assert_eq!(desk.run(&["inspect", "out/set", "--json"]).ok().json(), manifest);
}
