//! Plans of techniques that the CPU draws: nothing is built, and maps and rays are what they take.

use crate::gpu::{Census, of_maps_alone};
use crate::plan::{DrawPlan, Need};
use crate::stage::Stage;

/// Of the maps. The CPU builds nothing for what surfaces are like, but looks up what they have.
pub fn baked(stage: &Stage) -> DrawPlan {
    let (needs, map_bytes) = of_maps_alone(stage);
    DrawPlan { needs, totals: Census { map_bytes, ..Census::default() }, is_exact: true }
}

/// Of rays, so many a pixel.
pub fn truth(stage: &Stage, rays: Option<u32>) -> DrawPlan {
    let need = |effect, is_on: bool, why: &str, cost: String, by: [&str; 2]| Need {
        effect,
        is_on,
        why: why.into(),
        takes: Census::default(),
        cost,
        toggled_by: by[usize::from(!is_on)].into(),
    };
    let is_soft = rays.is_some();
    let why = if is_soft { "truth:soft sees the light's disc" } else { "truth:hard sees the light's middle" };
    let cost = rays.map_or("N rays a pixel and light, not one".into(), |n| format!("{n} rays a pixel and light"));
    let (has_lamp, has_alpha_mask) = (stage.lamp.is_some(), stage.scene.has_alpha_mask());
    let needs = vec![
        need("truth-of-disc", is_soft, why, cost, ["--technique truth:hard", "--technique truth:soft:N"]),
        need(
            "lamp",
            has_lamp,
            if has_lamp { "the set has a lamp" } else { "there is no lamp, or it is off" },
            format!("{} a pixel", rays.map_or("a ray".into(), |n| format!("{n} rays"))),
            ["--light sun", "a set baked with --lamp FILE"],
        ),
        need(
            "alpha-test",
            has_alpha_mask,
            if has_alpha_mask { "surfaces have holes cut by alpha" } else { "no surface has holes" },
            "alpha looked up wherever a ray meets such a surface".into(),
            ["materials of alphaMode OPAQUE", "a material of alphaMode MASK or BLEND"],
        ),
    ];
    DrawPlan { needs, totals: Census::default(), is_exact: true }
}
