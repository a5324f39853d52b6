//! Verdicts on the effects that all techniques share: those of surfaces, of their maps and of their textures.

use super::batch::BatchKey;
use super::census::Census;
use super::needs::SceneNeeds;
use super::renderer::Output;
use super::scene::depth_key;
use crate::plan::Need;
use crate::stage::Stage;
use std::collections::BTreeSet;
use sunbake_shaders::{AmbientModel, PageVariant, SurfaceVariant};

/// What turns an effect off, and on.
pub type TurnedBy = [&'static str; 2];

/// A verdict on an effect that takes what is counted, and something in words.
pub fn need(effect: &'static str, on: Option<(Census, String)>, why: String, more: &str, by: TurnedBy) -> Need {
    let (is_on, takes, words) = match on {
        Some((takes, words)) => (true, takes, words),
        None => (false, Census::default(), String::new()),
    };
    let counted = takes.in_words();
    let cost = match (is_on, counted.is_empty(), words.is_empty()) {
        (false, ..) => more.to_owned(),
        (true, true, true) => "nothing of its own".into(),
        (true, true, false) => words,
        (true, false, true) => counted,
        (true, false, false) => format!("{counted}; {words}"),
    };
    Need { effect, is_on, why, takes, cost, toggled_by: by[usize::from(!is_on)].into() }
}

/// Verdicts on what a stage's scene calls for where nothing but its maps takes anything, and their bytes.
pub fn of_maps_alone(stage: &Stage) -> (Vec<Need>, u64) {
    let scene = SceneNeeds::new(stage, None);
    let totals = |scene: &SceneNeeds| Census { map_bytes: scene.census().map_bytes, ..Census::default() };
    (SceneEffects { scene: &scene, totals: &totals }.all(), totals(&scene).map_bytes)
}

/// Verdicts on what a scene calls for. Each takes what `totals` says less of a scene without it.
pub struct SceneEffects<'a> {
    /// The scene.
    pub scene: &'a SceneNeeds,
    /// What a technique builds for a scene.
    pub totals: &'a dyn Fn(&SceneNeeds) -> Census,
}

impl SceneEffects<'_> {
    /// All of them.
    pub fn all(&self) -> Vec<Need> {
        let surfaces = [self.textures(), self.vertex_colors(), self.alpha_test(), self.two_sided()];
        surfaces.into_iter().chain(self.of_times()).chain(self.of_ambient()).chain([self.pages()]).collect()
    }

    /// What a change to the scene would save.
    pub fn saved_by(&self, change: impl Fn(&mut SceneNeeds)) -> Census {
        let mut without = self.scene.clone();
        change(&mut without);
        (self.totals)(self.scene).beyond(&(self.totals)(&without))
    }

    fn textures(&self) -> Need {
        let count = self.scene.census().base_color_textures;
        let strip = |key: &BatchKey| BatchKey {
            surface: SurfaceVariant { is_textured: false, ..key.surface },
            texture: None,
            ..*key
        };
        let saved = (count > 0).then(|| (self.saved_by(|scene| change_keys(scene, strip)), String::new()));
        let why = of_count(count, "image is drawn as a base colour", "images are drawn as base colours");
        let more = "a texture an image, a group of two bindings, a vertex buffer, and a pipeline a kind of surface";
        need("base-colour-textures", saved, why, more, ["materials without baseColorTexture", "a baseColorTexture"])
    }

    fn vertex_colors(&self) -> Need {
        let count = self.scene.surfaces().filter(|key| key.surface.has_vertex_color).count();
        let strip =
            |key: &BatchKey| BatchKey { surface: SurfaceVariant { has_vertex_color: false, ..key.surface }, ..*key };
        let saved = (count > 0).then(|| (self.saved_by(|scene| change_keys(scene, strip)), String::new()));
        let why = of_count(count, "batch has vertex colours", "batches have vertex colours");
        let more = "a vertex buffer, and a pipeline a kind of surface";
        need("vertex-colours", saved, why, more, ["meshes without COLOR_0", "a mesh with COLOR_0"])
    }

    fn alpha_test(&self) -> Need {
        let count = self.scene.surfaces().filter(|key| key.surface.is_cut).count();
        let strip = |key: &BatchKey| BatchKey { surface: SurfaceVariant { is_cut: false, ..key.surface }, ..*key };
        let saved = (count > 0).then(|| {
            let words = "alpha looked up at each of their pixels in every pass";
            (self.saved_by(|scene| change_keys(scene, strip)), words.into())
        });
        let why = of_count(count, "batch has holes cut by alpha", "batches have holes cut by alpha");
        let more = "a pipeline for depths and one a kind of surface";
        need("alpha-test", saved, why, more, ["materials of alphaMode OPAQUE", "a material of alphaMode MASK or BLEND"])
    }

    fn two_sided(&self) -> Need {
        let count = self.scene.surfaces().filter(|key| key.is_two_sided).count();
        let strip = |key: &BatchKey| BatchKey { is_two_sided: false, ..*key };
        let saved = (count > 0).then(|| (self.saved_by(|scene| change_keys(scene, strip)), String::new()));
        let why = of_count(count, "batch shows both sides", "batches show both sides");
        let more = "a pipeline for depths and one a kind of surface, without culling";
        let by = ["materials without \"doubleSided\"", "a material with \"doubleSided\": true"];
        need("two-sided-faces", saved, why, more, by)
    }

    fn of_times(&self) -> Vec<Need> {
        let pages = || self.scene.pages.iter().map(|page| &page.variant);
        let has_sun = pages().any(|page| page.layer_count() > 0);
        let lamp_layers = pages().map(|page| page.lamp_layer_count).max().unwrap_or(0);
        let layers = pages().flat_map(|page| &page.lanes).map(|lane| lane.layer_count).max().unwrap_or(0);
        let lanes = pages().map(|page| page.lanes.len()).max().unwrap_or(0);
        let has_times = has_sun || lamp_layers > 0;
        let is_soft = has_sun && pages().any(|page| page.layer_count() > 0 && !page.is_point_sun);
        let on_pages = |change: fn(&mut PageVariant)| {
            self.saved_by(|scene| scene.pages.iter_mut().for_each(|page| change(&mut page.variant)))
        };
        let plainly = |saved| (saved, String::new());
        vec![
            need(
                "sun-times",
                has_sun.then(|| (on_pages(|page| page.lanes.clear()), "four texels of each a pixel".into())),
                if has_sun { "the set tells when texels see the sun, and this reads it" } else { "none is read" }
                    .into(),
                "two textures and two bindings a page",
                ["--light sky", "--technique baked, of a set with a sun"],
            ),
            need(
                "penumbra",
                is_soft.then(|| {
                    (Census::default(), "the sun's width measured against each interval, at each texel".into())
                }),
                match (has_sun, is_soft) {
                    (_, true) => "the sun has a width",
                    (true, false) => "the sun has no width: it is seen or not",
                    (false, false) => "no times of a sun are read",
                }
                .into(),
                "the sun's width measured against each interval, at each texel",
                ["a set whose sun has no width", "a set whose sun has a width"],
            ),
            need(
                "disc-lanes",
                (lanes > 1).then(|| plainly(on_pages(|page| one_lane(&mut page.lanes)))),
                of_count(lanes, "lane is in the set", "lanes are in the set"),
                "as many layers for each lane more",
                ["a set baked with --lanes 1", "a set baked with --lanes 3 or 5"],
            ),
            need(
                "several-layers",
                (layers.max(lamp_layers) > 1).then(|| plainly(on_pages(one_layer))),
                of_count(layers.max(lamp_layers) as usize, "layer holds all that is read", "layers hold what is read"),
                "a layer more of each texture of times",
                ["a set baked with --layers 1", "a set with texels of more than four intervals"],
            ),
            need(
                "16-bit-times",
                (has_times && self.scene.bits > 8).then(|| plainly(self.saved_by(|scene| scene.bits = 8))),
                if has_times { format!("times have {} bits", self.scene.bits) } else { "no times are read".into() },
                "twice the bytes of times",
                ["a set baked with --bits 8", "a set baked with --bits 16"],
            ),
            self.lamp(lamp_layers),
        ]
    }

    fn lamp(&self, layers: u32) -> Need {
        let strip = |scene: &mut SceneNeeds| {
            scene.has_lamp = false;
            scene.pages.iter_mut().for_each(|page| page.variant.lamp_layer_count = 0);
        };
        let saved = self.scene.has_lamp.then(|| (self.saved_by(strip), String::new()));
        let why = match (self.scene.has_lamp, layers) {
            (true, 0) => "the set has a lamp, and its times are not read",
            (true, _) => "the set has a lamp, and tells when texels see it",
            (false, _) => "there is no lamp, or it is off",
        };
        let more = "a binding of the frame, and two textures and two bindings a page";
        need("lamp", saved, why.into(), more, ["--light sun", "a set baked with --lamp FILE"])
    }

    fn of_ambient(&self) -> [Need; 4] {
        use AmbientModel::{Bent, Hemisphere, Occlusion, Sky};
        let models: BTreeSet<AmbientModel> = self.scene.pages.iter().map(|page| page.variant.ambient).collect();
        let has = |model| models.contains(&model);
        let has_occlusion = has(Occlusion) || has(Bent);
        let instead = |of: &'static [AmbientModel], by: AmbientModel| {
            let saved = self.saved_by(|scene| {
                let variants = scene.pages.iter_mut().map(|page| &mut page.variant);
                variants.filter(|page| of.contains(&page.ambient)).for_each(|page| page.ambient = by);
            });
            (saved, String::new())
        };
        let has_backs =
            self.scene.pages.iter().any(|page| page.variant.has_backs && page.variant.ambient != Hemisphere);
        let read = |is_on: bool, what: &str| format!("{what} {}", if is_on { "is read" } else { "is not read" });
        [
            need(
                "ambient-occlusion",
                has_occlusion.then(|| instead(&[Occlusion, Bent], Hemisphere)),
                read(has_occlusion, "the share of sky that texels see"),
                "a texture and a binding a page, 2 bytes a texel and side",
                ["--ambient hemisphere", "--ambient ao, of a set baked with ao"],
            ),
            need(
                "bent-normals",
                has(Bent).then(|| instead(&[Bent], Occlusion)),
                read(has(Bent), "from where texels see the sky"),
                "a texture and a binding a page, 8 bytes a texel and side",
                ["--ambient ao", "--ambient bent, of a set baked with --bent"],
            ),
            need(
                "sky-sh2",
                has(Sky).then(|| instead(&[Sky], Hemisphere)),
                read(has(Sky), "how any sky adds up at texels"),
                "a texture and a binding a page, 24 bytes a texel and side, and a binding of the frame",
                ["--ambient hemisphere, ao or bent", "--ambient sh2, of a set baked with --sky sh2"],
            ),
            need(
                "ambient-of-backs",
                has_backs.then(|| {
                    let strip = |scene: &mut SceneNeeds| {
                        scene.pages.iter_mut().for_each(|page| page.variant.has_backs = false);
                    };
                    (self.saved_by(strip), String::new())
                }),
                read(has_backs, "what the backs of surfaces see of the sky"),
                "twice the bytes of ambient light",
                ["--ambient hemisphere", "ambient light of a set with double-sided surfaces"],
            ),
        ]
    }

    fn pages(&self) -> Need {
        let count = self.scene.pages.len();
        let saved = (count > 1).then(|| (self.saved_by(one_page), String::new()));
        let why = of_count(count, "page holds all surfaces", "pages hold the surfaces");
        let more = "the textures and bindings of one page more, and a draw";
        let by = ["a set baked with a larger --size", "a set baked with a smaller --size, or --texels-per-metre"];
        need("several-pages", saved, why, more, by)
    }
}

/// The passes that every technique of the GPU has: depths, and what lights.
pub fn of_passes(scene: &SceneNeeds, output: Output, lit_pipelines: usize) -> [Need; 3] {
    let depth_keys: BTreeSet<BatchKey> = scene.batches.iter().map(depth_key).collect();
    let pass = |pipelines| Census { passes: 1, pipelines, targets: 1, ..Census::default() };
    let never = ["nothing: it is what a picture is made of"; 2];
    let background = Census { pipelines: 1, ..Census::default() };
    let is_lit = output == Output::Lit;
    [
        need(
            "depth-pass",
            Some((pass(depth_keys.len()), String::new())),
            "what is nearest is found first, so that each pixel is lit once".into(),
            "",
            never,
        ),
        need(
            "light-pass",
            Some((pass(lit_pipelines), String::new())),
            if is_lit { "surfaces are lit" } else { "surfaces tell how much of the light they see" }.into(),
            "",
            never,
        ),
        need(
            "sky-background",
            is_lit.then_some((background, String::new())),
            if is_lit { "what is behind the scene is drawn" } else { "a picture of visibility has no sky" }.into(),
            "a pipeline",
            ["--output visibility", "--output color"],
        ),
    ]
}

/// `no image is drawn`, `1 image is drawn`, `2 images are drawn`.
pub fn of_count(count: usize, one: &str, several: &str) -> String {
    match count {
        0 => format!("no {one}"),
        1 => format!("1 {one}"),
        n => format!("{n} {several}"),
    }
}

/// Batches that a change makes alike are one.
pub fn change_keys(scene: &mut SceneNeeds, change: impl Fn(&BatchKey) -> BatchKey) {
    for keys in [&mut scene.batches, &mut scene.hidden] {
        *keys = keys.iter().map(&change).collect();
    }
}

/// The lane in the middle.
fn one_lane(lanes: &mut Vec<sunbake_shaders::LaneVariant>) {
    if lanes.len() > 1 {
        let middle = lanes.len() / 2;
        lanes.swap(0, middle);
        lanes.truncate(1);
    }
}

fn one_layer(page: &mut PageVariant) {
    page.lanes.iter_mut().for_each(|lane| lane.layer_count = lane.layer_count.min(1));
    page.lamp_layer_count = page.lamp_layer_count.min(1);
}

/// All pages as one that is as large as they, and read like the first.
fn one_page(scene: &mut SceneNeeds) {
    let texels = scene.pages.iter().map(|page| page.texels).sum();
    scene.pages.truncate(1);
    scene.pages.iter_mut().for_each(|page| page.texels = texels);
    change_keys(scene, |key| BatchKey { page: 0, ..*key });
}
