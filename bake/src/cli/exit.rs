//! Exit codes: 0 done, 1 usage, 2 input or output failed, 3 the input is bad, 4 internal, 5 not supported here.

use super::out::tell;
use clap::error::ErrorKind;
use std::error::Error;
use std::process::ExitCode;
use sunbake::BakeError;
use sunbake::atlas::AtlasError;
use sunbake::disk::read::ReadError;
use sunbake::scene::ErrorClass;

/// A failure with its exit code.
#[derive(Debug)]
pub struct Failure {
    /// What to exit with.
    pub code: u8,
    /// What to print.
    pub error: Box<dyn Error>,
}

impl Failure {
    /// The options do not fit together, or their values do not make sense.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { code: 1, error: message.into().into() }
    }

    /// Reading or writing failed.
    pub fn io(message: impl Into<String>) -> Self {
        Self { code: 2, error: message.into().into() }
    }
}

impl Failure {
    /// A bake that failed. One that a signal stopped exits as shells expect it.
    pub fn of_bake(error: BakeError, signal_code: Option<u8>) -> Self {
        let code = signal_code.filter(|_| matches!(error, BakeError::Cancelled));
        let failure = Self::from(error);
        Self { code: code.unwrap_or(failure.code), ..failure }
    }
}

impl From<BakeError> for Failure {
    fn from(error: BakeError) -> Self {
        let code = match &error {
            BakeError::Load(load) => match load.class() {
                ErrorClass::Io => 2,
                ErrorClass::BadInput | ErrorClass::Unsupported => 3,
            },
            BakeError::Write(_) | BakeError::TooLarge(_) => 2,
            BakeError::Day(_)
            | BakeError::TwoLamps
            | BakeError::LampEngine(_)
            | BakeError::NoSuchMaterial { .. }
            | BakeError::Atlas(AtlasError::BadSetting { .. }) => 1,
            BakeError::Cancelled => 130,
            BakeError::Keyed(_)
            | BakeError::LampFile(_)
            | BakeError::Lamp(_)
            | BakeError::Light(_)
            | BakeError::Atlas(_)
            | BakeError::Memory { .. } => 3,
            BakeError::Threads { .. } => 5,
        };
        Self { code, error: error.into() }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let code = match &error {
            ReadError::Io { .. } | ReadError::NotASet { .. } => 2,
            ReadError::Manifest { .. } | ReadError::Texture { .. } => 3,
        };
        Self { code, error: error.into() }
    }
}

/// Prints what clap has to say. Help and version are no failure. A value that makes no sense is told in one line, like
/// any other failure; only a command line that cannot be understood gets the usage with it.
pub fn usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::ValueValidation | ErrorKind::InvalidValue => {
            let text = error.to_string();
            let first = text.split("\n\n").next().unwrap_or_default().trim_start_matches("error: ");
            let line: Vec<&str> = first.split_whitespace().collect();
            tell(&format!("sunbake: {}; `sunbake {} --help` tells more", line.join(" "), command()));
        }
        // If even this cannot be printed there is nobody to tell.
        _ => drop(error.print()),
    }
    ExitCode::from(u8::from(error.use_stderr()))
}

/// The command that was given, or the one that most people want.
fn command() -> String {
    let given = std::env::args().nth(1).filter(|name| ["inspect", "texels", "cost"].contains(&name.as_str()));
    given.unwrap_or_else(|| "bake".into())
}

/// Runs a command and turns its end into an exit code. A panic is a defect of ours, and says so.
pub fn report(command: impl FnOnce() -> Result<(), Failure> + std::panic::UnwindSafe) -> ExitCode {
    match std::panic::catch_unwind(command) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            tell(&format!("sunbake: {}", chain(failure.error.as_ref())));
            ExitCode::from(failure.code)
        }
        Err(_) => {
            tell("sunbake: this is a defect in sunbake: please report it with the message above and the scene");
            ExitCode::from(4)
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
    one_line(&text)
}

/// What comes from a file may hold line breaks and worse; a terminal gets neither.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_has_its_exit_code() {
        let text = |code: ExitCode| format!("{code:?}");
        assert_eq!(text(report(|| Ok(()))), text(ExitCode::SUCCESS));
        assert_eq!(text(report(|| Err(Failure::usage("no")))), text(ExitCode::from(1)));
        assert_eq!(text(report(|| Err(Failure::io("no")))), text(ExitCode::from(2)));
        assert_eq!(text(report(|| panic!("a defect"))), text(ExitCode::from(4)));
    }

    #[test]
    fn a_message_is_one_line_with_every_cause_once() {
        let disk =
            sunbake::disk::write::WriteError::Folder { folder: "x".into(), source: std::io::Error::other("a\nb") };
        assert_eq!(chain(&disk).matches("a b").count(), 1);
        assert!(!chain(&disk).contains('\n'));
    }
}
