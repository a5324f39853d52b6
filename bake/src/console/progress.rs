//! Progress: one line on stderr, if stderr is a terminal.

use super::Command;
use super::print::{sentence, warn};
use super::signals::Signals;
use crate::progress::{BakeStep, Progress};
use crate::warning::Warning;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// A line on stderr while there is something to wait for.
#[derive(Debug)]
pub struct ProgressLine {
    is_drawn: bool,
    is_quiet: bool,
    bar: Mutex<Option<ProgressBar>>,
    /// What steps are part of; empty if they are part of nothing.
    task: Mutex<String>,
    signals: Option<Signals>,
    /// Who tells warnings as they come; none: nobody.
    teller: Option<Command>,
    told: Mutex<Vec<Warning>>,
}

impl ProgressLine {
    /// Draws if stderr is a terminal and `quiet` is not asked for.
    pub fn new(quiet: bool) -> Self {
        let is_drawn = !quiet && std::io::stderr().is_terminal();
        let told = Mutex::default();
        Self {
            is_drawn,
            is_quiet: quiet,
            bar: Mutex::default(),
            task: Mutex::default(),
            signals: None,
            teller: None,
            told,
        }
    }

    /// The same, and prints warnings as they come, with what to do in the options of `command`.
    pub fn telling(mut self, command: Command) -> Self {
        self.teller = (!self.is_quiet).then_some(command);
        self
    }

    /// Those warnings that were not printed as they came.
    pub fn not_told(&self, warnings: &[Warning]) -> Vec<Warning> {
        let told = self.told.lock().map(|told| told.clone()).unwrap_or_default();
        warnings.iter().filter(|warning| !told.contains(warning)).cloned().collect()
    }

    /// The same, and hears Ctrl-C: whatever reports to it is then asked to stop.
    pub fn listening(mut self) -> Self {
        self.signals = Some(Signals::listen());
        self
    }

    /// What to exit with if a signal came.
    pub fn signal_code(&self) -> Option<u8> {
        self.signals.as_ref().and_then(Signals::exit_code)
    }

    /// Starts on something of `total` parts; 0 if parts are not counted.
    pub fn begin(&self, what: impl Into<String>, total: u64) {
        self.clear();
        if !self.is_drawn {
            return;
        }
        let (bar, template) = match total {
            0 => (ProgressBar::new_spinner(), "{spinner} {msg} {elapsed}"),
            total => (ProgressBar::new(total), "{msg} {bar:32} {percent:>3} %  {elapsed}, {eta} to go"),
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what.into());
        bar.enable_steady_tick(Duration::from_millis(200));
        if let Ok(mut current) = self.bar.lock() {
            *current = Some(bar);
        }
    }

    /// Counts more parts as done.
    pub fn step(&self, by: u64) {
        if let Ok(bar) = self.bar.lock()
            && let Some(bar) = bar.as_ref()
        {
            bar.inc(by);
        }
    }

    /// Clears the line.
    pub fn clear(&self) {
        if let Ok(mut bar) = self.bar.lock()
            && let Some(bar) = bar.take()
        {
            bar.finish_and_clear();
        }
    }

    fn message(&self, step: BakeStep) -> String {
        match self.task.lock() {
            Ok(task) if !task.is_empty() => format!("{task}: {}", step.verb()),
            _ => step.verb().into(),
        }
    }
}

impl Progress for ProgressLine {
    fn task(&self, name: &str) {
        if let Ok(mut task) = self.task.lock() {
            *task = name.into();
        }
    }

    fn start(&self, step: BakeStep, total: u64) {
        self.begin(self.message(step), total);
    }

    fn advance(&self, by: u64) {
        self.step(by);
    }

    fn warn(&self, warning: &Warning) {
        let Some(command) = self.teller else { return };
        let print = || warn(&sentence(warning, command));
        match self.bar.lock().as_deref() {
            Ok(Some(bar)) => bar.suspend(print),
            _ => print(),
        }
        if let Ok(mut told) = self.told.lock() {
            told.push(warning.clone());
        }
    }

    fn is_cancelled(&self) -> bool {
        self.signal_code().is_some()
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.clear();
    }
}
