//! A report in words: what is printed, and what stands over its sheet.

use super::super::sheet::Pair;
use super::{LimitEntry, Report, TechniqueEntry};
use sunbake::report::{plain, with_unit};

impl Report {
    /// The report as lines of text.
    pub fn text(&self) -> String {
        let name = self.techniques.iter().map(|technique| technique.name.len()).max().unwrap_or(0).max(9);
        let mut text = format!(
            "{} against {}, {} frames of {}x{}, on {}\n\n{:name$}  {:>8} {:>8} {:>8} {:>8} {:>11} {:>10} {:>10}\n",
            self.scene.name,
            self.reference.name,
            self.cameras.len() * self.times.len(),
            self.size[0],
            self.size[1],
            self.drawn_by(),
            "technique",
            "mean",
            "p99",
            "wrong",
            "ssim",
            "frame",
            "memory",
            "bake",
        );
        for technique in &self.techniques {
            let error = &technique.error;
            text += &format!(
                "{:name$}  {:>8.5} {:>8.4} {:>6.2} % {:>8.5} {:>11} {:>10} {:>10}\n",
                technique.name,
                error.mean,
                error.p99,
                error.wrong_share * 100.0,
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

    /// What came of it, in a few sentences: what the best baked technique and the best live one lose and cost. Best is whose lit
    /// pictures are most like the reference's.
    pub fn findings(&self) -> Vec<String> {
        let Some(Pair { ours, theirs }) = Pair::best(&self.techniques) else { return Vec::new() };
        let [ours, theirs] = [ours, theirs].map(|i| &self.techniques[i]);
        let lost = |one: &TechniqueEntry| {
            format!(
                "is off by {} of the sun in the mean, with {:.2} % of pixels wrong by more than a half; it takes {} a frame, {} of \
                 memory",
                plain(one.error.mean, 2),
                one.error.wrong_share * 100.0,
                with_unit(one.times.frame_ms, "ms"),
                with_unit(one.memory_bytes as f64, "bytes"),
            )
        };
        let bake = ours.preparation.bake_s.map_or("an unknown time".into(), |seconds| with_unit(seconds, "s"));
        vec![
            format!("Baked: {}, the most lifelike, {}, and {bake} of baking before.", ours.name, lost(ours)),
            format!("Live: {}, the most lifelike, {}, and no bake.", theirs.name, lost(theirs)),
            format!(
                "So the live one errs {} as much as the baked one, takes {} its time a frame, and {} its memory.",
                times(theirs.error.mean, ours.error.mean),
                times(theirs.times.frame_ms, ours.times.frame_ms),
                times(theirs.memory_bytes as f64, ours.memory_bytes as f64),
            ),
        ]
    }

    /// What drew: the adapter, or the CPU.
    pub fn drawn_by(&self) -> String {
        let machine = &self.machine;
        match &machine.adapter {
            Some(adapter) if machine.is_software => format!("{adapter} (a software adapter)"),
            Some(adapter) => adapter.clone(),
            None => format!("the CPU, {}", machine.cpu),
        }
    }

    /// What stands over the sheet of a pair.
    pub fn title_lines(&self, pair: Pair) -> Vec<String> {
        let [ours, theirs] = [pair.ours, pair.theirs].map(|i| &self.techniques[i]);
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
        vec![format!("{}, against {}", self.scene.name, self.reference.name), line(ours), line(theirs), self.drawn_by()]
    }
}

/// A ratio in words; of nothing there is none.
fn times(a: f64, b: f64) -> String {
    if b > 0.0 && a.is_finite() {
        format!("{} times", plain(a / b, 2))
    } else {
        format!("{} against {}", plain(a, 2), plain(b, 2))
    }
}

impl LimitEntry {
    /// Whether everybody was held to it, and kept it.
    pub fn is_kept(&self) -> bool {
        self.above.is_empty() && self.unchecked.is_empty()
    }

    /// Who did not keep it, in words.
    pub fn text(&self) -> String {
        let above = self.above.iter().map(|above| format!("{} {}", above.name, plain(above.value, 4)));
        let above: Vec<String> = above.collect();
        let limit = plain(self.limit, 4);
        let told = [
            (!above.is_empty()).then(|| format!("{} is above {limit}: {}", self.key, above.join(", "))),
            (!self.unchecked.is_empty())
                .then(|| format!("{} could not be checked of {}", self.key, self.unchecked.join(", "))),
        ];
        told.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}
