//! Exit codes: 0 done, 1 usage, 2 input or output failed, 3 the input is bad, 4 internal, 5 not supported here.

use std::error::Error;
use std::process::ExitCode;
use sunbake::BakeError;
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

impl From<BakeError> for Failure {
    fn from(error: BakeError) -> Self {
        let code = match &error {
            BakeError::Load(load) => match load.class() {
                ErrorClass::Io => 2,
                ErrorClass::BadInput | ErrorClass::Unsupported => 3,
            },
            BakeError::Write(_) | BakeError::TooLarge(_) => 2,
            BakeError::Day(_) => 1,
            BakeError::Keyed(_) | BakeError::Light(_) | BakeError::Atlas(_) | BakeError::Memory { .. } => 3,
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

/// Prints what clap has to say. Help and version are no failure.
pub fn usage(error: &clap::Error) -> ExitCode {
    // If even this cannot be printed there is nobody to tell.
    let _ = error.print();
    ExitCode::from(u8::from(error.use_stderr()))
}

/// Runs a command and turns its end into an exit code. A panic is a defect of ours, and says so.
pub fn report(command: impl FnOnce() -> Result<(), Failure> + std::panic::UnwindSafe) -> ExitCode {
    match std::panic::catch_unwind(command) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            eprintln!("sunbake: {}", chain(failure.error.as_ref()));
            ExitCode::from(failure.code)
        }
        Err(_) => {
            eprintln!("sunbake: this is a defect in sunbake: please report it with the message above and the scene");
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
    text
}
