//! What is decided about times, and about the surfaces that they are found for.

use super::{Decision, Effect, LayersNeeded};
use crate::lamp::LampPath;
use crate::maps::Bits;
use crate::scene::{Alpha, Material, Scene};
use crate::settings::{BakeSettings, EngineChoice};
use crate::sun::SunPath;

/// Why there are no times.
pub(super) const NOT_ASKED: &str = "--only asks for no intervals";

/// What decides about times.
pub(super) struct Times<'a> {
    /// The sun's, if times of it are stored.
    pub path: Option<&'a SunPath>,
    pub lamp: Option<&'a LampPath>,
    pub settings: &'a BakeSettings,
    /// Why there is no sun.
    pub no_sun: &'a str,
}

impl Times<'_> {
    pub fn decisions(&self) -> Vec<Decision> {
        vec![
            self.sun(),
            self.lamp(),
            self.penumbra(),
            self.lanes(),
            self.layers(),
            self.sixteen_bits(),
            self.loss_map(),
        ]
    }

    fn has_times(&self) -> bool {
        self.path.is_some() || self.lamp.is_some()
    }

    fn sun(&self) -> Decision {
        let is_on = self.path.is_some();
        Decision {
            effect: Effect::SunIntervals,
            is_on,
            why: self
                .path
                .map_or(self.no_sun.to_owned(), |p| format!("the sun is up, along {} arc(s)", p.arcs().len())),
            cost: format!(
                "{}, layer and lane: a rise and a fall texture with four times each; {} and lane",
                bytes_of_times(self.settings.bits),
                engine_cost(self.settings.engine)
            ),
            toggled_by: match (is_on, self.settings.bakes_intervals, self.lamp.is_some()) {
                (true, _, _) => "--only ao",
                (false, false, _) => "intervals among what --only names",
                (false, true, true) => "a lamp given as --lamp FILE, not as --path FILE",
                (false, true, false) => "another --date or --place, on which the sun rises",
            }
            .into(),
        }
    }

    fn lamp(&self) -> Decision {
        let why = match self.lamp {
            Some(lamp) => format!("a lamp moves along {} straight segment(s)", lamp.segments().count()),
            None => "no lamp is asked for; --lamp bakes one beside the sun".into(),
        };
        Decision {
            effect: Effect::LampIntervals,
            is_on: self.lamp.is_some(),
            why,
            cost: format!(
                "as much as a lane of the sun: {} and layer; {}",
                bytes_of_times(self.settings.bits),
                engine_cost(self.settings.engine)
            ),
            toggled_by: if self.lamp.is_some() { "leaving the lamp's FILE out" } else { "--lamp FILE" }.into(),
        }
    }

    fn penumbra(&self) -> Decision {
        let radius_deg = self.path.map_or(0.0, |p| p.angular_radius_rad.to_degrees());
        let radius_m = self.lamp.map_or(0.0, LampPath::radius_m);
        let of_sun = self.path.map(|_| format!("the light's radius is {radius_deg:.3} degrees"));
        let of_lamp = self.lamp.map(|_| format!("the lamp's radius is {radius_m} m"));
        let why = match (of_sun, of_lamp) {
            (None, None) => "there is no light whose times are stored".into(),
            (sun, lamp) => sun.into_iter().chain(lamp).collect::<Vec<_>>().join(", "),
        };
        let is_on = radius_deg > 0.0 || radius_m > 0.0;
        Decision {
            effect: Effect::Penumbra,
            is_on,
            why,
            cost: "no texture and no ray; playback measures how much of the light's width each interval fills".into(),
            toggled_by: if is_on {
                "a radius of 0 in the light's FILE (\"angular_radius_deg\", or of a lamp \"radius_m\")"
            } else {
                "a radius above 0 in the light's FILE (\"angular_radius_deg\", or of a lamp \"radius_m\")"
            }
            .into(),
        }
    }

    fn lanes(&self) -> Decision {
        let count = self.settings.lane_count;
        let (is_on, why) = match self.path.map(|path| path.angular_radius_rad) {
            None => (false, "there is no sun".into()),
            Some(0.0) => (false, "a light without width has no disc to cut into lanes".into()),
            Some(_) if count < 2 => {
                (false, "the sun is taken as a line along its path; --lanes 3 or 5 cuts its disc".into())
            }
            Some(_) => (true, format!("--lanes {count}: edges along the path soften in {count} steps")),
        };
        let times = if is_on { count.to_string() } else { "3 or 5".into() };
        let by = match self.path.map(|path| path.angular_radius_rad) {
            _ if is_on => "--lanes 1",
            None => "a sun, and --lanes 3 or 5",
            Some(0.0) => "a light with a width, and --lanes 3 or 5",
            Some(_) => "--lanes 3 or 5",
        };
        Decision {
            effect: Effect::DiscLanes,
            is_on,
            why,
            cost: format!("{times} times the bytes of one lane's times, and {times} times the work of finding them"),
            toggled_by: by.into(),
        }
    }

    fn layers(&self) -> Decision {
        let cap = self.settings.layer_cap;
        let (is_on, why, by) = match cap {
            _ if !self.has_times() => (false, "no times are stored".into(), "times to store"),
            1 => (false, "--layers 1: what is beyond four intervals is merged".into(), "--layers 2 or more"),
            _ => (
                true,
                format!("as many layers of four intervals as texels need, {cap} at most (--layers)"),
                "--layers 1",
            ),
        };
        Decision {
            effect: Effect::SeveralLayers,
            is_on,
            why,
            cost: format!("{} and lane for each layer beyond the first", bytes_of_times(self.settings.bits)),
            toggled_by: by.into(),
        }
    }

    fn sixteen_bits(&self) -> Decision {
        let bits = self.settings.bits;
        let duration_min = self.path.map(|p| p.duration_min).or(self.lamp.map(LampPath::duration_min));
        let half_step_s = duration_min.map(|min| 0.5 * 60.0 * min / f64::from(bits.max_code()));
        let why = match half_step_s {
            None => "no times are stored".into(),
            Some(s) => format!("--bits {}, given or by preset: edges are stored to {s:.2} s", bits.count()),
        };
        let is_on = self.has_times() && bits == Bits::Sixteen;
        Decision {
            effect: Effect::SixteenBitTimes,
            is_on,
            why,
            cost: "twice the bytes of times: 16 a texel, layer and lane, where 8 bits take 8".into(),
            toggled_by: match (is_on, self.has_times()) {
                (true, _) => "--bits 8",
                (false, true) => "--bits 16",
                (false, false) => "times to store",
            }
            .into(),
        }
    }

    fn loss_map(&self) -> Decision {
        let (is_asked, has_times) = (self.settings.loss_map, self.has_times());
        let why = match (is_asked, has_times) {
            (false, _) => "not asked for",
            (true, true) => "--loss-map asks for it",
            (true, false) => "no times are stored, and none can be lost",
        };
        let by = match (is_asked, has_times) {
            (true, true) => "leaving --loss-map out",
            (false, true) => "--loss-map",
            (_, false) => "times to store, and --loss-map",
        };
        Decision {
            effect: Effect::LossMap,
            is_on: is_asked && has_times,
            why: why.into(),
            cost: "a PNG of 4 and an OpenEXR of 8 bytes a texel of each page; 24 bytes of memory a texel meanwhile"
                .into(),
            toggled_by: by.into(),
        }
    }
}

/// What is decided about surfaces.
pub(super) fn of_surfaces(scene: &Scene) -> [Decision; 2] {
    [alpha_cut(scene), double_sided(scene)]
}

fn alpha_cut(scene: &Scene) -> Decision {
    let is_cut = |m: &Material| matches!(m.alpha, Alpha::Mask { .. });
    let [surfaces, triangles] = count(scene, is_cut);
    Decision {
        effect: Effect::AlphaCut,
        is_on: surfaces > 0,
        why: format!("{surfaces} drawn surfaces have holes cut by alpha"),
        cost: match triangles {
            0 => "alpha looked up wherever a triangle with holes is met".into(),
            n => format!("alpha looked up wherever one of {n} triangles with holes is met"),
        },
        toggled_by: match surfaces {
            0 => "a material with alphaMode MASK or BLEND",
            _ => "--leave-out MATERIAL, or alphaMode OPAQUE",
        }
        .into(),
    }
}

fn double_sided(scene: &Scene) -> Decision {
    let [surfaces, triangles] = count(scene, |m| m.is_double_sided && m.alpha != Alpha::Invisible);
    Decision {
        effect: Effect::DoubleSided,
        is_on: surfaces > 0,
        why: format!("{surfaces} drawn surfaces are double-sided"),
        cost: format!(
            "times serve both sides; ambient light takes rays and bytes for a second side{}",
            if triangles > 0 { format!(" of {triangles} triangles") } else { String::new() }
        ),
        toggled_by: match surfaces {
            0 => "a material with \"doubleSided\": true",
            _ => "--leave-out MATERIAL, or \"doubleSided\": false",
        }
        .into(),
    }
}

/// Drawn surfaces of some materials, and their triangles.
fn count(scene: &Scene, is: impl Fn(&Material) -> bool) -> [usize; 2] {
    let all = scene.instances.iter().enumerate().filter(|(i, _)| is(scene.material(*i)));
    all.fold([0, 0], |[surfaces, triangles], (_, instance)| {
        [surfaces + 1, triangles + scene.meshes[instance.mesh].triangle_count()]
    })
}

/// What a pair of textures of four times each takes, uncompressed.
fn bytes_of_times(bits: Bits) -> String {
    format!("{} bytes a texel", bits.count())
}

fn engine_cost(engine: EngineChoice) -> String {
    match engine {
        EngineChoice::Exact => "one walk of the hierarchy a texel".into(),
        EngineChoice::Rays(count) => format!("{count} rays a texel"),
        EngineChoice::Bisect(count) => format!("{count} rays and some for each edge a texel"),
    }
}

/// How many layers there came to be, and why.
pub(super) fn settle(decision: &mut Decision, needed: LayersNeeded) {
    let LayersNeeded { layers, crowded_texels, texels } = needed;
    let was_allowed = decision.is_on;
    decision.is_on = layers > 1;
    let crowded = format!("{crowded_texels} of {texels} texels have more than four intervals");
    decision.why = match (layers, crowded_texels) {
        (2.., _) => format!("{crowded}: {layers} layers"),
        (_, 0) => format!("none of {texels} texels has more than four intervals: one layer holds them all"),
        _ if was_allowed => format!("{crowded}, but rounding leaves no more than four"),
        _ => format!("{crowded}, and --layers 1 merged them"),
    };
    if was_allowed && layers < 2 {
        decision.toggled_by = "a scene that is lit in more pieces: through fences, wires or leaves".into();
    }
}
