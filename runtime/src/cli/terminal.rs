//! Progress on a terminal, and nowhere else.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;
use sunbake::progress::{BakeStage, Progress};
use sunbake::signals::Signals;

/// One line on stderr, while there is something to wait for.
#[derive(Default)]
pub struct Terminal {
    is_quiet: bool,
    bar: Mutex<Option<ProgressBar>>,
    signals: Option<Signals>,
}

impl Terminal {
    /// One that draws if stderr is a terminal and `quiet` is not asked for.
    pub fn new(quiet: bool) -> Self {
        Self { is_quiet: quiet || !std::io::stderr().is_terminal(), bar: Mutex::default(), signals: None }
    }

    /// The same, which hears Ctrl-C: what it draws for is asked to stop, and takes back what it made.
    pub fn listening(mut self) -> Self {
        self.signals = Some(Signals::listen());
        self
    }

    /// What to exit with, if a signal came.
    pub fn signal_code(&self) -> Option<u8> {
        self.signals.as_ref().and_then(Signals::exit_code)
    }

    /// Starts on something that has `total` parts; 0 if it does not count.
    pub fn begin(&self, what: &'static str, total: u64) {
        self.clear();
        if self.is_quiet {
            return;
        }
        let (bar, template) = match total {
            0 => (ProgressBar::new_spinner(), "{spinner} {msg} {elapsed}"),
            total => (ProgressBar::new(total), "{msg} {bar:32} {percent:>3} %  {elapsed}, {eta} to go"),
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        if let Ok(mut current) = self.bar.lock() {
            *current = Some(bar);
        }
    }

    /// Gets on by so many parts.
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
}

impl Progress for Terminal {
    fn start(&self, stage: BakeStage, total: u64) {
        self.begin(stage.verb(), total);
    }

    fn advance(&self, by: u64) {
        self.step(by);
    }

    fn is_cancelled(&self) -> bool {
        self.signal_code().is_some()
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.clear();
    }
}
