//! The effect plan of a picture: which effects a stage, a technique and a kind of picture call for, why, what each
//! takes, and how to turn it on or off.
//!
//! A plan is decided before anything is built on the GPU, by the code that builds: batches, page layouts and pipeline
//! keys come from the same functions. A plan counts them, [`Census`] counts what was built, and a test compares the
//! two. Some counts depend on the view and the light: how casters are counted, how many maps there are. There a plan
//! states an upper bound before the picture, and the true counts after it.
//!
//! What an effect takes is what leaving it out would save. Two effects that need the same pipeline each save nothing
//! alone.
//!
//! Decisions are values ([`DrawEffect`], [`Reason`], [`Census`]); `wording.rs` holds every text.

mod census;
mod effect;
mod wording;

pub use census::Census;
pub use effect::{DrawEffect, Reason, Uncounted};

use sunbake::disk::manifest::EffectEntry;
use sunbake::plan::{in_words, labelled};

/// The decision about one effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DrawNeed {
    /// Which effect.
    pub effect: DrawEffect,
    /// Whether it is part of the picture.
    pub is_on: bool,
    /// Why it is on or off.
    pub reason: Reason,
    /// What leaving it out would save. Zero where it is off.
    pub takes: Census,
    /// What it takes besides, if that depends on the scene.
    pub uncounted: Uncounted,
}

impl DrawNeed {
    /// An effect that is on and saves this much when left out, or one that is off.
    pub fn new(effect: DrawEffect, saved: Option<Census>, reason: Reason) -> Self {
        let takes = saved.unwrap_or_default();
        Self { effect, is_on: saved.is_some(), reason, takes, uncounted: Uncounted::Nothing }
    }

    /// The same, with what it takes besides.
    pub fn with(self, uncounted: Uncounted) -> Self {
        Self { uncounted, ..self }
    }

    /// Why it is on or off.
    pub fn why(&self) -> String {
        wording::why(self)
    }

    /// What it takes; where it is off, what it would take.
    pub fn cost(&self) -> String {
        wording::cost(self)
    }

    /// The flag, or the property of the set or the scene, that would turn it off or on.
    pub fn toggled_by(&self) -> &'static str {
        wording::toggled_by(self)
    }
}

/// All decisions, and the sum of what is built for them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DrawPlan {
    /// One entry per effect.
    pub needs: Vec<DrawNeed>,
    /// What is built for all of them.
    pub totals: Census,
    /// Whether `totals` is what a picture takes; else it is an upper bound.
    pub is_exact: bool,
}

impl DrawPlan {
    /// The decision about an effect, by its name, if the plan has it.
    pub fn need(&self, effect: &str) -> Option<&DrawNeed> {
        self.needs.iter().find(|need| need.effect.name() == effect)
    }

    /// Whether an effect is part of the picture, by its name.
    pub fn is_on(&self, effect: &str) -> bool {
        self.need(effect).is_some_and(|need| need.is_on)
    }

    /// For machines: the entries that a manifest has for a bake.
    pub fn entries(&self) -> Vec<EffectEntry> {
        let entry = |need: &DrawNeed| EffectEntry {
            effect: need.effect.name().into(),
            on: need.is_on,
            why: need.why(),
            cost: need.cost(),
            toggled_by: need.toggled_by().into(),
        };
        self.needs.iter().map(entry).collect()
    }

    /// For people: a block of lines per effect, and the totals.
    pub fn in_words(&self) -> String {
        let text = in_words(&self.entries());
        let all = self.totals.in_words();
        let heading = if self.is_exact { "  in all" } else { "  in all, at most" };
        if all.is_empty() { text } else { text + &labelled(heading, &all) }
    }
}
