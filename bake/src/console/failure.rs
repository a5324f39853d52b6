//! A failure of a command: exit code, text, remedy.

use crate::error::{ErrorClass, Explain};
use crate::remedy::Remedy;
use std::error::Error;

/// Why a command failed.
#[derive(Debug)]
pub struct Failure {
    /// What to exit with.
    pub code: u8,
    /// What went wrong, with each cause once.
    pub message: String,
    /// What to do next, where the message does not say so.
    pub remedy: Option<Remedy>,
}

/// Exit code of work that was asked to stop, unless a signal has its own: 128 + SIGINT.
const CANCELLED: u8 = 130;

/// The exit code of a class of errors.
fn code_of(class: ErrorClass) -> u8 {
    match class {
        ErrorClass::Usage => 1,
        ErrorClass::Io => 2,
        ErrorClass::BadInput | ErrorClass::UnsupportedInput => 3,
        ErrorClass::Internal => 4,
        ErrorClass::Unavailable => 5,
        ErrorClass::Cancelled => CANCELLED,
    }
}

impl<E: Explain> From<E> for Failure {
    fn from(error: E) -> Self {
        Self { code: code_of(error.class()), message: chain(&error), remedy: error.remedy() }
    }
}

impl Failure {
    fn new(class: ErrorClass, message: impl Into<String>) -> Self {
        Self { code: code_of(class), message: message.into(), remedy: None }
    }

    /// The options do not fit together, or do not fit the scene or set.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::new(ErrorClass::Usage, message)
    }

    /// Reading or writing failed.
    pub fn io(message: impl Into<String>) -> Self {
        Self::new(ErrorClass::Io, message)
    }

    /// What was given is bad.
    pub fn bad_input(message: impl Into<String>) -> Self {
        Self::new(ErrorClass::BadInput, message)
    }

    /// This machine or this build cannot do it.
    pub fn unavailable(message: impl Into<String>) -> Self {
        Self::new(ErrorClass::Unavailable, message)
    }

    /// Something exceeds a limit that was set for it.
    pub fn limit(message: impl Into<String>) -> Self {
        Self { code: 6, message: message.into(), remedy: None }
    }

    /// The same; work that a signal stopped exits by the signal.
    pub fn after_signal(self, signal_code: Option<u8>) -> Self {
        match signal_code {
            Some(code) if self.code == CANCELLED => Self { code, ..self },
            _ => self,
        }
    }
}

/// An error and its causes, each once: messages that already hold their cause do not repeat it.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let cause_text = cause.to_string();
        if !text.contains(&cause_text) {
            text = format!("{text}: {cause_text}");
        }
        source = cause.source();
    }
    text
}

/// Text for a terminal: control characters, which may come from a file, become spaces.
pub(super) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BakeError;

    #[test]
    fn a_message_is_one_line_with_every_cause_once() {
        let disk = crate::disk::write::WriteError::Folder { folder: "x".into(), source: std::io::Error::other("a\nb") };
        let failure = Failure::from(disk);
        let line = one_line(&failure.message);
        assert!(failure.code == 2 && line.matches("a b").count() == 1 && !line.contains('\n'), "{line}");
    }

    #[test]
    fn what_was_stopped_exits_by_its_signal() {
        let stopped = || Failure::from(BakeError::Cancelled);
        assert_eq!([None, Some(143)].map(|signal| stopped().after_signal(signal).code), [130, 143]);
        assert_eq!(Failure::io("no").after_signal(Some(143)).code, 2);
    }
}
