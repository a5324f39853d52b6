//! The effect plan of a picture: which effects a stage, a technique and a kind of picture call for, why, what each takes, and what
//! turns it over.
//!
//! It is decided before anything is built on the GPU, and by what builds: batches, what pages need of their programs, and the keys
//! of pipelines come from the same functions. A plan counts them, [`crate::gpu::Census`] counts what was built, and a test
//! holds one against the other. Where counts depend on the view and the light (how casters are counted, how many maps there are)
//! a plan states the most that a picture may take, and after the picture what it took.
//!
//! What an effect takes is what leaving it out would save. Effects share: two that need the same pipeline each save nothing alone.

use crate::gpu::Census;
use sunbake::disk::manifest::EffectEntry;
use sunbake::plan::{in_words, said};

/// One effect's verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Need {
    /// Its name.
    pub effect: &'static str,
    /// Whether it is part of the picture.
    pub is_on: bool,
    /// Why.
    pub why: String,
    /// What leaving it out would save; nothing of what is off.
    pub takes: Census,
    /// The same in words, and what is not counted; of what is off, what it would take.
    pub cost: String,
    /// The flag, or the property of the set or the scene, that would turn it over.
    pub toggled_by: String,
}

/// All verdicts, and what they come to.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DrawPlan {
    /// One per effect.
    pub needs: Vec<Need>,
    /// What is built for all of them.
    pub totals: Census,
    /// Whether that is what a picture takes; else it is the most that one may take.
    pub is_exact: bool,
}

impl DrawPlan {
    /// The verdict on an effect, if it is in the plan.
    pub fn need(&self, effect: &str) -> Option<&Need> {
        self.needs.iter().find(|need| need.effect == effect)
    }

    /// Whether an effect is part of the picture.
    pub fn is_on(&self, effect: &str) -> bool {
        self.need(effect).is_some_and(|need| need.is_on)
    }

    /// For machines: as the manifest has them of a bake.
    pub fn entries(&self) -> Vec<EffectEntry> {
        let entry = |need: &Need| EffectEntry {
            effect: need.effect.into(),
            on: need.is_on,
            why: need.why.clone(),
            cost: need.cost.clone(),
            toggled_by: need.toggled_by.clone(),
        };
        self.needs.iter().map(entry).collect()
    }

    /// For people: a block an effect, and what they come to.
    pub fn in_words(&self) -> String {
        let text = in_words(&self.entries());
        let all = self.totals.in_words();
        let heading = if self.is_exact { "  in all" } else { "  in all, at most" };
        if all.is_empty() { text } else { text + &said(heading, &all) }
    }
}
