//! The report as text: what the command prints, and the title of the sheet.

use super::super::sheet::BestPair;
use super::{LimitEntry, Report, TechniqueEntry};
use sunbake::report::{plain, with_unit};
use sunbake::words::counted;

impl Report {
    /// The report as lines of text.
    pub fn text(&self) -> String {
        let name = self.techniques.iter().map(|technique| technique.name.len()).max().unwrap_or(0).max(9);
        let mut text = format!(
            "{} against {}, {} of {}x{}, on {}\n\n\
             {:name$}  {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>11} {:>10} {:>10}\n",
            self.scene.name,
            self.reference.name,
            counted((self.cameras.len() * self.times.len()) as u64, "frame"),
            self.size[0],
            self.size[1],
            self.drawn_by(),
            "technique",
            "mean",
            "rms",
            "p99",
            "wrong",
            "leak",
            "shade",
            "ssim",
            "frame",
            "memory",
            "bake",
        );
        for technique in &self.techniques {
            let error = &technique.error;
            text += &format!(
                "{:name$}  {:>8.5} {:>8.5} {:>8.4} {:>6.2} % {:>8.5} {:>8.5} {:>8.5} {:>11} {:>10} {:>10}\n",
                technique.name,
                error.mean,
                error.rms,
                error.p99,
                error.wrong_share * 100.0,
                error.false_light.unwrap_or(0.0),
                error.false_shade.unwrap_or(0.0),
                error.ssim,
                with_unit(technique.times.frame_ms, "ms"),
                with_unit(technique.memory_bytes as f64, "bytes"),
                technique
                    .preparation
                    .bake_s
                    .map_or(if technique.family == "baked" { "-" } else { "none" }.into(), |seconds| with_unit(
                        seconds, "s"
                    )),
            );
        }
        for warning in &self.warnings {
            text += &format!("warning: {warning}\n");
        }
        for left in &self.left_out {
            text += &format!("left out: {}: {}\n", left.name, left.reason);
        }
        text += "\n";
        text
    }

    /// The result in a few sentences: error and cost of the best baked technique and of the best live one
    /// ([`BestPair`]).
    pub fn findings(&self) -> Vec<String> {
        let Some(BestPair { baked, live }) = BestPair::of(&self.techniques) else { return Vec::new() };
        let [baked, live] = [baked, live].map(|i| &self.techniques[i]);
        let cost = |one: &TechniqueEntry| {
            format!(
                "has a mean error of {}, with {:.2} % of pixels wrong by more than a half; it takes {} a frame and \
                 {} of memory",
                plain(one.error.mean, 2),
                one.error.wrong_share * 100.0,
                with_unit(one.times.frame_ms, "ms"),
                with_unit(one.memory_bytes as f64, "bytes"),
            )
        };
        let bake = baked.preparation.bake_s.map_or("an unknown time".into(), |seconds| with_unit(seconds, "s"));
        vec![
            format!("Best baked technique: {} {}, after {bake} of baking.", baked.name, cost(baked)),
            format!("Best live technique: {} {}, and no bake.", live.name, cost(live)),
            format!(
                "Live against baked: error {}, time a frame {}, memory {}.",
                ratio(live.error.mean, baked.error.mean),
                ratio(live.times.frame_ms, baked.times.frame_ms),
                ratio(live.memory_bytes as f64, baked.memory_bytes as f64),
            ),
        ]
    }

    /// What drew: the adapter, or the CPU.
    pub fn drawn_by(&self) -> String {
        let machine = &self.machine;
        match &machine.adapter {
            Some(adapter) if machine.is_software => format!("{adapter} (a software GPU)"),
            Some(adapter) => adapter.clone(),
            None => format!("the CPU, {}", machine.cpu),
        }
    }

    /// The title of a pair's sheet.
    pub fn title_lines(&self, pair: BestPair) -> Vec<String> {
        let [baked, live] = [pair.baked, pair.live].map(|i| &self.techniques[i]);
        let line = |technique: &TechniqueEntry| {
            let bake =
                technique.preparation.bake_s.map_or("no bake".into(), |seconds| with_unit(seconds, "s") + " to bake");
            format!(
                "{}: mean error {}, {:.2} % of pixels wrong, {} a frame, {}, {bake}",
                technique.name,
                plain(technique.error.mean, 3),
                technique.error.wrong_share * 100.0,
                with_unit(technique.times.frame_ms, "ms"),
                with_unit(technique.memory_bytes as f64, "bytes"),
            )
        };
        vec![format!("{}, against {}", self.scene.name, self.reference.name), line(baked), line(live), self.drawn_by()]
    }
}

/// A ratio as text. Against 0 both numbers are given.
fn ratio(a: f64, b: f64) -> String {
    if b > 0.0 && a.is_finite() {
        format!("{} times", plain(a / b, 2))
    } else {
        format!("{} against {}", plain(a, 2), plain(b, 2))
    }
}

impl LimitEntry {
    /// Whether every technique was checked, and none is above the limit.
    pub fn is_kept(&self) -> bool {
        self.above.is_empty() && self.unchecked.is_empty()
    }

    /// Which techniques are above it, and which could not be checked, as text.
    pub fn text(&self) -> String {
        let above = self.above.iter().map(|above| format!("{} {}", above.name, plain(above.value, 4)));
        let above: Vec<String> = above.collect();
        let limit = plain(self.limit, 4);
        let sentences = [
            (!above.is_empty()).then(|| format!("{} is above {limit}: {}", self.key, above.join(", "))),
            (!self.unchecked.is_empty())
                .then(|| format!("{} could not be checked of {}", self.key, self.unchecked.join(", "))),
        ];
        sentences.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}
