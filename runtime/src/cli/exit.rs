//! Exit codes: 0 done, 1 usage, 2 input or output failed, 3 the input is bad, 4 internal, 5 not supported here, 6 a limit of
//! `compare --fail-above` was passed.

use std::error::Error;
use std::process::ExitCode;
use sunbake::BakeError;
use sunbake::disk::read::ReadError;
use sunbake::report::folder::FolderError;
use sunbake::scene::ErrorClass;
use sunbake_runtime::camera::CameraError;
use sunbake_runtime::compare::CompareError;
use sunbake_runtime::gpu::GpuError;
use sunbake_runtime::light::TimeError;
use sunbake_runtime::stage::StageError;

/// A failure with its exit code.
#[derive(Debug)]
pub struct Failure {
    /// What to exit with.
    pub code: u8,
    /// What to print.
    pub error: Box<dyn Error>,
}

impl Failure {
    /// The options do not fit together, or do not fit the set.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { code: 1, error: message.into().into() }
    }

    /// Reading or writing failed.
    pub fn io(message: impl Into<String>) -> Self {
        Self { code: 2, error: message.into().into() }
    }

    /// Something is above a limit that was set for it.
    pub fn limit(message: impl Into<String>) -> Self {
        Self { code: 6, error: message.into().into() }
    }

    /// This machine cannot do it.
    pub fn unsupported(message: impl Into<String>) -> Self {
        Self { code: 5, error: message.into().into() }
    }
}

impl From<StageError> for Failure {
    fn from(error: StageError) -> Self {
        let code = match &error {
            StageError::Set(ReadError::Io { .. } | ReadError::NotASet { .. }) => 2,
            StageError::NoScene { .. } => 2,
            StageError::Scene(error) if error.class() == ErrorClass::Io => 2,
            StageError::Set(_) | StageError::Scene(_) | StageError::Changed { .. } | StageError::Mismatch { .. } => 3,
        };
        Self { code, error: error.into() }
    }
}

impl From<BakeError> for Failure {
    fn from(error: BakeError) -> Self {
        let code = match &error {
            BakeError::Load(load) if load.class() == ErrorClass::Io => 2,
            BakeError::Write(_) => 2,
            BakeError::Threads { .. } => 5,
            _ => 3,
        };
        Self { code, error: error.into() }
    }
}

impl From<CompareError> for Failure {
    fn from(error: CompareError) -> Self {
        match error {
            CompareError::Stage(error) => error.into(),
            CompareError::Bake(error) => error.into(),
            CompareError::Camera(error) => error.into(),
            CompareError::Time(error) => error.into(),
            CompareError::Gpu(error) => error.into(),
            CompareError::WorkFolder(_) => Self { code: 2, error: error.into() },
            CompareError::OtherScene { .. } => Self { code: 3, error: error.into() },
            CompareError::TechniqueName(_) => Self { code: 1, error: error.into() },
            CompareError::ReferenceNotInSet(_) => Self::usage(format!("{error}: give another --against")),
            CompareError::NoSun => {
                Self::usage(format!("{error}: choose another --date, or a set that was baked with a sun"))
            }
            CompareError::TooManyPixels { .. } => {
                Self::usage(format!("{error}: give a smaller --size, or fewer --at or --camera"))
            }
            CompareError::Reference { .. } => Self { code: 5, error: error.into() },
            CompareError::Cancelled => Self { code: 130, error: error.into() },
        }
    }
}

impl From<CameraError> for Failure {
    fn from(error: CameraError) -> Self {
        let remedy = match &error {
            CameraError::NoSuchCamera { .. } => "leave --camera out, or give ex,ey,ez,tx,ty,tz[,fov]",
            CameraError::PointsTooClose => "give two points further apart",
        };
        Self::usage(format!("{error}; {remedy}"))
    }
}

impl From<TimeError> for Failure {
    fn from(error: TimeError) -> Self {
        let remedy = match &error {
            TimeError::NoSun => "give --at from 0 to 1, or leave it out",
            TimeError::NoClock => "give --at from 0 to 1",
            TimeError::OutsidePath { .. } => "give a time between",
        };
        Self::usage(format!("{error}: {remedy}"))
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        Self { code: 2, error: error.into() }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        Self { code: 5, error: error.into() }
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
            eprintln!("sunplay: {}", failure.error);
            ExitCode::from(failure.code)
        }
        Err(_) => {
            eprintln!("sunplay: this is a defect in sunplay: please report it with the message above and the set");
            ExitCode::from(4)
        }
    }
}
