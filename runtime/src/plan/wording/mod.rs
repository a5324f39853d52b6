//! Every text of the effect plan: names, reasons, costs, and what turns an effect on or off.

mod census;
mod texts;

use super::{DrawEffect, DrawNeed, Reason, Uncounted};
use sunbake::words::counted;
use texts::{EVERYTHING_SHADED, EffectText, ONE_PAGE_AND_EVERYTHING_SHADED, SUN_DOWN, TEXTS};

impl DrawEffect {
    /// Its name, in reports and manifests.
    pub fn name(self) -> &'static str {
        text(self).name
    }
}

fn text(effect: DrawEffect) -> &'static EffectText {
    // Entries are in the order of the enum, which a test checks.
    let text = &TEXTS[effect as usize];
    debug_assert_eq!(text.effect, effect);
    text
}

/// The flag or property that would turn an effect off or on.
pub fn toggled_by(need: &DrawNeed) -> &'static str {
    let text = text(need.effect);
    match need.reason {
        Reason::PagesAndOpenTexel(1) => EVERYTHING_SHADED,
        Reason::PagesAndOpenTexel(_) => ONE_PAGE_AND_EVERYTHING_SHADED,
        _ if need.is_on => text.off_by,
        _ => text.on_by,
    }
}

/// What an effect takes; where it is off, what it would take.
pub fn cost(need: &DrawNeed) -> String {
    let EffectText { would_take, also_takes, .. } = *text(need.effect);
    let besides = match need.uncounted {
        Uncounted::Nothing => also_takes.to_owned(),
        Uncounted::Prisms(1) => "a prism of the triangle, whichever way it faces".into(),
        Uncounted::Prisms(triangles) => format!("prisms of all {triangles} triangles, whichever way they face"),
        Uncounted::Comparisons(count) => format!("{} a pixel", counted(count.into(), "comparison")),
        Uncounted::Rays(count) => rays(need.effect, count),
    };
    if !need.is_on {
        let is_of_rays = matches!(need.uncounted, Uncounted::Rays(_));
        return if is_of_rays { besides } else { would_take.to_owned() };
    }
    let counted = need.takes.in_words();
    match (counted.is_empty(), besides.is_empty()) {
        (true, true) => "nothing of its own".into(),
        (true, false) => besides,
        (false, true) => counted,
        (false, false) => format!("{counted}; {besides}"),
    }
}

fn rays(effect: DrawEffect, count: Option<u32>) -> String {
    match (effect, count) {
        (DrawEffect::TruthOfDisc, None) => "N rays a pixel and light, not one".into(),
        (DrawEffect::TruthOfDisc, Some(n)) => format!("{} a pixel and light", counted(n.into(), "ray")),
        (_, None) => "a ray a pixel".into(),
        (_, Some(n)) => format!("{} a pixel", counted(n.into(), "ray")),
    }
}

/// Why an effect is on or off.
pub fn why(need: &DrawNeed) -> String {
    let text = text(need.effect);
    match need.reason {
        Reason::Count(count) => of_count(need.effect, count),
        Reason::PagesAndOpenTexel(pages) => {
            let hold = if pages == 1 { "holds" } else { "hold" };
            format!("{} {hold} what is shaded, and one texel what nothing shades", counted(pages as u64, "page"))
        }
        Reason::Slices(1) => "one slice of the view has a map".into(),
        Reason::Slices(maps) => format!("{maps} slices of the view have a map each"),
        Reason::CubeFaces(1) => "one face of a cube around the sun is seen".into(),
        Reason::CubeFaces(maps) => format!("{maps} faces of a cube around the sun are seen"),
        Reason::Gathered => "the shader compares what a sampler gathers, each texel with the receiver's plane".into(),
        Reason::SunDown => SUN_DOWN.into(),
        Reason::VisibilityPicture => "surfaces tell how much of the light they see".into(),
        Reason::Unread => unread(need.effect).into(),
        Reason::Possible => possible(need.effect).into(),
        Reason::Usual => if need.is_on { text.why_on } else { text.why_off }.into(),
    }
}

/// What it depends on is not read.
fn unread(effect: DrawEffect) -> &'static str {
    match effect {
        DrawEffect::Penumbra => "no times of a sun are read",
        DrawEffect::Lamp => "the set has a lamp, and its times are not read",
        _ => "no times are read",
    }
}

/// It depends on the view and the light.
fn possible(effect: DrawEffect) -> &'static str {
    match effect {
        DrawEffect::SunVolumes => "the sun may be up",
        DrawEffect::ZPass => "the eye may be outside of volumes whose caps are hidden",
        DrawEffect::ZFail => "the eye may come into some volume, or a cap show",
        DrawEffect::SmoothSolids => "some solids are smooth-shaded, and their facets may turn away from the light",
        DrawEffect::SeveralRuns => "there are more than 255 triangles, which may overlap",
        _ => "something may be in shadow",
    }
}

/// Reasons that are counts.
fn of_count(effect: DrawEffect, count: usize) -> String {
    let [one, several] = match effect {
        DrawEffect::BaseColorTextures => ["image is drawn as a base colour", "images are drawn as base colours"],
        DrawEffect::VertexColors => ["batch has vertex colours", "batches have vertex colours"],
        DrawEffect::AlphaTest => ["batch has an alpha mask", "batches have alpha masks"],
        DrawEffect::TwoSidedFaces => ["batch shows both sides", "batches show both sides"],
        DrawEffect::Highlights => ["batch is metallic or has highlights", "batches are metallic or have highlights"],
        DrawEffect::MetallicRoughnessTextures => {
            ["batch has a metallic-roughness texture", "batches have metallic-roughness textures"]
        }
        DrawEffect::NormalMaps => ["batch has a normal map", "batches have normal maps"],
        DrawEffect::EmissiveTextures => ["batch has an emissive texture", "batches have emissive textures"],
        DrawEffect::BlendedSurfaces => ["batch is blended", "batches are blended"],
        DrawEffect::SmoothTerminator => ["batch is smooth-shaded", "batches are smooth-shaded"],
        DrawEffect::DiscLanes => ["lane is in the set", "lanes are in the set"],
        DrawEffect::SeveralLayers => ["layer holds all that is read", "layers hold what is read"],
        DrawEffect::SixteenBitTimes => return format!("times have {count} bits"),
        DrawEffect::SeveralPages => ["page holds all surfaces", "pages hold the surfaces"],
        DrawEffect::SoftSun => ["sun: its centre, with hard edges", "suns share its disc"],
        DrawEffect::OpenMeshes => ["mesh that casts is open", "meshes that cast are open"],
        DrawEffect::SeveralMaps => ["map holds all that may be in shadow", "maps hold what may be in shadow"],
        _ => ["", ""],
    };
    match count {
        0 => format!("no {one}"),
        1 => format!("1 {one}"),
        n => format!("{n} {several}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_in_the_order_of_the_effects() {
        for (i, text) in TEXTS.iter().enumerate() {
            assert_eq!(text.effect as usize, i, "{}", text.name);
            assert!(!text.name.is_empty() && !text.off_by.is_empty() && !text.on_by.is_empty(), "{:?}", text.effect);
        }
    }

    #[test]
    fn a_texel_of_what_nothing_shades_is_not_taken_for_a_page_that_a_larger_size_saves() {
        let pages = |reason| DrawNeed::new(DrawEffect::SeveralPages, Some(Default::default()), reason);
        let open = pages(Reason::PagesAndOpenTexel(1));
        assert_eq!(why(&open), "1 page holds what is shaded, and one texel what nothing shades");
        assert!(toggled_by(&open).contains("--no-receive") && !toggled_by(&open).contains("--size"));
        let both = pages(Reason::PagesAndOpenTexel(2));
        assert!(why(&both).starts_with("2 pages hold"), "{}", why(&both));
        assert!(["--no-receive", "--size"].iter().all(|flag| toggled_by(&both).contains(flag)));
        assert!(!toggled_by(&pages(Reason::Count(2))).contains("--no-receive"));
    }

    #[test]
    fn one_of_a_kind_is_singular() {
        let rays = |n| {
            let need = DrawNeed::new(DrawEffect::TruthOfDisc, Some(Default::default()), Reason::Usual);
            cost(&need.with(Uncounted::Rays(Some(n))))
        };
        assert_eq!([1, 2].map(rays), ["1 ray a pixel and light", "2 rays a pixel and light"]);
    }
}
