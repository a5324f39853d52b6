//! Progress: one line on stderr, if stderr is a terminal.

use super::signals::Signals;
use crate::progress::{BakeStep, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// A line on stderr while there is something to wait for.
#[derive(Debug)]
pub struct ProgressLine {
    is_drawn: bool,
    bar: Mutex<Option<ProgressBar>>,
    /// What steps are part of; empty if they are part of nothing.
    task: Mutex<String>,
    signals: Option<Signals>,
}

impl ProgressLine {
    /// Draws if stderr is a terminal and `quiet` is not asked for.
    pub fn new(quiet: bool) -> Self {
        let is_drawn = !quiet && std::io::stderr().is_terminal();
        Self { is_drawn, bar: Mutex::default(), task: Mutex::default(), signals: None }
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

    fn is_cancelled(&self) -> bool {
        self.signal_code().is_some()
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.clear();
    }
}
