//! Progress on a terminal, and nowhere else; and the ear that hears Ctrl-C.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;
use sunbake::progress::{BakeStage, Progress};
use sunbake::signals::Signals;

/// Draws one line on stderr while a bake runs, and stops the bake at a signal.
#[derive(Debug)]
pub struct TerminalProgress {
    draws: bool,
    bar: Mutex<Option<ProgressBar>>,
    /// What stages are part of, if they are part of something.
    task: Mutex<String>,
    signals: Signals,
}

impl TerminalProgress {
    /// One that draws if stderr is a terminal and `quiet` is not asked for.
    pub fn new(quiet: bool) -> Self {
        let draws = !quiet && std::io::stderr().is_terminal();
        Self { draws, bar: Mutex::default(), task: Mutex::default(), signals: Signals::listen() }
    }

    /// What to exit with, if a signal stopped the bake.
    pub fn signal_code(&self) -> Option<u8> {
        self.signals.exit_code()
    }

    /// Clears the line.
    pub fn clear(&self) {
        if let Ok(mut bar) = self.bar.lock()
            && let Some(bar) = bar.take()
        {
            bar.finish_and_clear();
        }
    }
}

impl TerminalProgress {
    /// What to say of a stage.
    fn message(&self, stage: BakeStage) -> String {
        match self.task.lock() {
            Ok(task) if !task.is_empty() => format!("{task}: {}", stage.verb()),
            _ => stage.verb().into(),
        }
    }
}

impl Progress for TerminalProgress {
    fn task(&self, name: &str) {
        if let Ok(mut task) = self.task.lock() {
            *task = name.into();
        }
    }

    fn start(&self, stage: BakeStage, total: u64) {
        self.clear();
        if !self.draws {
            return;
        }
        let (bar, template) = match total {
            0 => (ProgressBar::new_spinner(), "{spinner} {msg} {elapsed}"),
            total => (ProgressBar::new(total), "{msg} {bar:32} {percent:>3} %  {elapsed}, {eta} to go"),
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(self.message(stage));
        bar.enable_steady_tick(Duration::from_millis(200));
        if let Ok(mut current) = self.bar.lock() {
            *current = Some(bar);
        }
    }

    fn advance(&self, by: u64) {
        if let Ok(bar) = self.bar.lock()
            && let Some(bar) = bar.as_ref()
        {
            bar.inc(by);
        }
    }

    fn is_cancelled(&self) -> bool {
        self.signal_code().is_some()
    }
}

impl Drop for TerminalProgress {
    fn drop(&mut self) {
        self.clear();
    }
}
