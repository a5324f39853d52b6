//! The effect plan: which effects this scene and request call for, decided before anything runs.
//!
//! Each effect is on or off for a reason, the reason names what would turn it over, and what is off costs nothing: no
//! ray, no texture, no loop.

use crate::disk::manifest::EffectEntry;
use crate::lamp::LampPath;
use crate::scene::{Alpha, Scene};
use crate::settings::{AmbientRequest, BakeSettings};
use crate::sun::SunPath;

/// An effect that a bake may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Times at which texels see the sun.
    SunIntervals,
    /// Times at which texels see a lamp that moves through the scene.
    LampIntervals,
    /// A sun of some width: edges soften as it crosses them.
    Penumbra,
    /// Several paths across the sun's disc.
    DiscLanes,
    /// Rays look up alpha.
    AlphaCut,
    /// Surfaces that are lit from both sides.
    DoubleSided,
    /// Share of the sky that texels see.
    AmbientOcclusion,
    /// Nothing beyond a distance hides the sky.
    AmbientDistance,
    /// From where texels see the sky.
    BentNormals,
    /// How a sky of any brightness adds up at texels.
    SkyHarmonics,
    /// Openness of vertices.
    VertexAmbient,
}

impl Effect {
    /// Its name in the manifest.
    pub fn name(self) -> &'static str {
        match self {
            Self::SunIntervals => "sun-intervals",
            Self::LampIntervals => "lamp-intervals",
            Self::Penumbra => "penumbra",
            Self::DiscLanes => "disc-lanes",
            Self::AlphaCut => "alpha-cut",
            Self::DoubleSided => "double-sided",
            Self::AmbientOcclusion => "ambient-occlusion",
            Self::AmbientDistance => "ambient-distance",
            Self::BentNormals => "bent-normals",
            Self::SkyHarmonics => "sky-sh2",
            Self::VertexAmbient => "vertex-ambient",
        }
    }
}

/// One effect's verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// Which effect.
    pub effect: Effect,
    /// Whether it is part of the bake.
    pub is_on: bool,
    /// Why.
    pub why: String,
}

/// All verdicts, in the order of [`Effect`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EffectPlan {
    /// One per effect.
    pub decisions: Vec<Decision>,
}

impl EffectPlan {
    /// Decides from the scene, the paths and what is asked for; `no_sun` says why there is no sun's path.
    pub fn new(
        scene: &Scene,
        path: Option<&SunPath>,
        lamp: Option<&LampPath>,
        settings: &BakeSettings,
        no_sun: &str,
    ) -> Self {
        let decide = |effect, is_on, why: String| Decision { effect, is_on, why };
        let lane_count = settings.lane_count;
        let is_asked = settings.bakes_intervals;
        let path = path.filter(|_| is_asked);
        let no_sun = if is_asked { no_sun } else { "--only asks for no intervals" };
        let radius_deg = path.map_or(0.0, |p| p.angular_radius_rad.to_degrees());
        let cut = count(scene, |m| matches!(m.alpha, Alpha::Cut { .. }));
        let double_sided = count(scene, |m| m.is_double_sided && m.alpha != Alpha::Air);
        let sun = path.map_or(no_sun.to_owned(), |p| format!("the sun is up, along {} arc(s)", p.arcs().len()));
        Self {
            decisions: vec![
                decide(Effect::SunIntervals, path.is_some(), sun),
                decide(Effect::LampIntervals, lamp.is_some(), lamp_reason(lamp)),
                decide(Effect::Penumbra, radius_deg > 0.0, format!("the light's radius is {radius_deg:.3} degrees")),
                decide(Effect::DiscLanes, path.is_some() && has_lanes(radius_deg, lane_count), lanes(path, lane_count)),
                decide(Effect::AlphaCut, cut > 0, format!("{cut} drawn surfaces have holes cut by alpha")),
                decide(
                    Effect::DoubleSided,
                    double_sided > 0,
                    format!("{double_sided} drawn surfaces are double-sided"),
                ),
            ]
            .into_iter()
            .chain(ambient(settings))
            .collect(),
        }
    }

    /// How many lanes the bake has, of as many as were asked for.
    pub fn lane_count(&self, asked: usize) -> usize {
        if self.is_on(Effect::DiscLanes) { asked } else { 1 }
    }

    /// Whether an effect is part of the bake.
    pub fn is_on(&self, effect: Effect) -> bool {
        self.decisions.iter().any(|d| d.effect == effect && d.is_on)
    }

    /// For the manifest.
    pub fn entries(&self) -> Vec<EffectEntry> {
        let entry = |d: &Decision| EffectEntry { effect: d.effect.name().into(), on: d.is_on, why: d.why.clone() };
        self.decisions.iter().map(entry).collect()
    }
}

/// What of ambient light is baked, and why.
fn ambient(settings: &BakeSettings) -> Vec<Decision> {
    let request = settings.ambient.as_ref();
    let decide = |effect, is_on: bool, on: &dyn Fn(&AmbientRequest) -> String, off: &str| {
        let why = request.filter(|_| is_on).map_or_else(|| off.to_owned(), on);
        Decision { effect, is_on, why }
    };
    let is = |has: fn(&AmbientRequest) -> bool| request.is_some_and(has);
    vec![
        decide(
            Effect::AmbientOcclusion,
            request.is_some(),
            &|r| match r.estimate.error {
                Some(error) => format!("to {error} with 95 % confidence, by {} rays a texel at most", r.estimate.rays),
                None => format!("{} rays a texel", r.estimate.rays),
            },
            "--only asks for no ao",
        ),
        decide(
            Effect::AmbientDistance,
            is(|r| r.estimate.distance_m.is_some()),
            &|r| format!("nothing hides from beyond {} m", r.estimate.distance_m.unwrap_or_default()),
            "everything hides, however far; --ao-distance sets a limit, which closed rooms need",
        ),
        decide(
            Effect::BentNormals,
            is(|r| r.estimate.wants_bent),
            &|_| "--bent asks for them".into(),
            "not asked for; --bent bakes them",
        ),
        decide(
            Effect::SkyHarmonics,
            is(|r| r.estimate.wants_sky),
            &|_| "--sky sh2: nine coefficients a texel".into(),
            "not asked for; --sky sh2 bakes them",
        ),
        decide(
            Effect::VertexAmbient,
            is(|r| r.vertices.is_some()),
            &|r| format!("--ao-vertices asks for {}", r.vertices.map_or("", |v| v.name())),
            "not asked for; --ao-vertices stores it for engines without a second set of coordinates",
        ),
    ]
}

/// Why there is a lamp, or is none.
fn lamp_reason(lamp: Option<&LampPath>) -> String {
    lamp.map_or("no lamp is asked for; --lamp bakes one beside the sun".into(), |lamp| {
        format!("a lamp moves along {} straight segment(s)", lamp.segments().count())
    })
}

fn has_lanes(radius_deg: f64, lane_count: usize) -> bool {
    radius_deg > 0.0 && lane_count > 1
}

/// Why there are several lanes, or are not.
fn lanes(path: Option<&SunPath>, lane_count: usize) -> String {
    match path.map(|path| path.angular_radius_rad) {
        None => "there is no sun".into(),
        Some(0.0) => "a light without width has no disc to cut into lanes".into(),
        Some(_) if lane_count < 2 => "the sun is taken as a line along its path; --lanes 3 or 5 cuts its disc".into(),
        Some(_) => format!(
            "--lanes {lane_count}: edges along the path soften in {lane_count} steps, for {lane_count} times the maps"
        ),
    }
}

fn count(scene: &Scene, is: impl Fn(&crate::scene::Material) -> bool) -> usize {
    (0..scene.instances.len()).filter(|&i| is(scene.material(i))).count()
}
