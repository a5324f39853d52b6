//! What every error of this crate says beside its text: which class it is of, and what to do next.
//!
//! All of it stands here, so that the same error has the same class whoever meets it. `sunbake-runtime` has the same
//! table for its own errors. The commands exit by the class (see `console`).

use crate::BakeError;
use crate::atlas::AtlasError;
use crate::disk::folder::FolderError;
use crate::disk::read::ReadError;
use crate::glb::GlbTooLarge;
use crate::lamp::{LampError, LampFileError};
use crate::remedy::{Remedy, Setting};
use crate::scene::{LoadError, ObjectError, Wish};
use crate::sun::{ClockError, DateError, DayError, KeyedError, LightError};

/// Which kind of failure an error is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorClass {
    /// What was asked for makes no sense, or does not fit the scene or set.
    Usage,
    /// A file or a folder could not be read or written.
    Io,
    /// A scene, a path or a set is bad, or needs more memory than allowed.
    BadInput,
    /// A scene asks for what is not supported.
    UnsupportedInput,
    /// A defect of these libraries.
    Internal,
    /// This machine, or this build, cannot do it.
    Unavailable,
    /// The listener asked to stop.
    Cancelled,
}

/// An error that knows its class and, if a setting can help, its remedy.
pub trait Explain: std::error::Error {
    /// What kind of mistake it is, which decides the exit code.
    fn class(&self) -> ErrorClass;

    /// What to do next, where its text does not already say so.
    fn remedy(&self) -> Option<Remedy> {
        None
    }
}

impl Explain for BakeError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Load(error) => error.class(),
            Self::Day(error) => error.class(),
            Self::Keyed(error) => error.class(),
            Self::LampFile(error) => error.class(),
            Self::Lamp(error) => error.class(),
            Self::Light(error) => error.class(),
            Self::Atlas(error) => error.class(),
            Self::TooLarge(error) => error.class(),
            Self::Write(error) => error.class(),
            Self::TwoLamps | Self::LampEngine(_) | Self::Objects(_) => ErrorClass::Usage,
            Self::Memory { .. } | Self::PageTooSmall { .. } => ErrorClass::BadInput,
            Self::Threads { .. } | Self::NoExr => ErrorClass::Unavailable,
            Self::Cancelled => ErrorClass::Cancelled,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Load(error) => error.remedy(),
            Self::Light(error) => error.remedy(),
            Self::Atlas(error) => error.remedy(),
            Self::Write(error) => error.remedy(),
            Self::Day(_) | Self::Keyed(_) | Self::LampFile(_) | Self::Lamp(_) | Self::TooLarge(_) | Self::Cancelled => {
                None
            }
            Self::TwoLamps => Some(Remedy::any([Remedy::Omit(Setting::Lamp), Remedy::Omit(Setting::Path)])),
            Self::LampEngine(_) => Some(Remedy::any([
                Remedy::Set(Setting::Engine, "exact".into()),
                Remedy::Set(Setting::Engine, "rays:N".into()),
            ])),
            Self::Objects(
                ObjectError::NothingNamed { wish, .. }
                | ObjectError::NoIndex { wish, .. }
                | ObjectError::DrawsNothing { wish, .. },
            ) => Some(Remedy::any([Remedy::Change(setting_of(*wish)), Remedy::ListNames])),
            Self::Objects(_) => None,
            Self::Memory { smaller, .. } => {
                let smaller = smaller.iter().map(|&setting| Remedy::Lower(setting));
                Some(Remedy::AnyOf(smaller.chain([Remedy::Raise(Setting::MaxMemory)]).collect()))
            }
            Self::PageTooSmall { remedy, .. } => Some(remedy.clone()),
            Self::Threads { .. } => Some(Remedy::Lower(Setting::Threads)),
            Self::NoExr => Some(Remedy::any([Remedy::Omit(Setting::Exr), Remedy::Omit(Setting::LossMap)])),
        }
    }
}

/// The setting that holds a wish.
fn setting_of(wish: Wish) -> Setting {
    match wish {
        Wish::LeaveOut => Setting::LeaveOut,
        Wish::NoCast => Setting::NoCast,
        Wish::NoReceive => Setting::NoReceive,
        Wish::Density => Setting::ObjectDensity,
    }
}

impl Explain for LoadError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Read { .. } => ErrorClass::Io,
            Self::Extension { .. } | Self::Version { .. } => ErrorClass::UnsupportedInput,
            _ => ErrorClass::BadInput,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        let more = || Remedy::any([Remedy::Raise(Setting::MaxMemory), Remedy::Do("simplify the scene")]);
        matches!(self, Self::TooLarge { .. }).then(more)
    }
}

impl Explain for AtlasError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::BadSetting { .. } => ErrorClass::Usage,
            Self::TooDense { .. } | Self::PageTooSmall { .. } => ErrorClass::BadInput,
            Self::Cancelled => ErrorClass::Cancelled,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        let settings = [Setting::PageSize, Setting::Padding, Setting::TexelsPerMetre];
        match self {
            Self::BadSetting { .. } | Self::PageTooSmall { .. } => {
                Some(Remedy::AnyOf(settings.map(Remedy::Change).into()))
            }
            Self::TooDense { .. } => Some(Remedy::Lower(Setting::TexelsPerMetre)),
            Self::Cancelled => None,
        }
    }
}

impl Explain for FolderError {
    fn class(&self) -> ErrorClass {
        ErrorClass::Io
    }

    fn remedy(&self) -> Option<Remedy> {
        let elsewhere = Remedy::Change(Setting::Output);
        Some(match self {
            Self::Exists { .. } => Remedy::any([elsewhere, Remedy::Set(Setting::Force, String::new())]),
            Self::NotOurs { .. } => Remedy::any([elsewhere, Remedy::Do("remove it yourself")]),
            Self::Folder { .. } | Self::Rename { .. } => elsewhere,
            Self::File { .. } => Remedy::any([Remedy::Do("make room"), elsewhere]),
        })
    }
}

impl Explain for ReadError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Io { .. } | Self::Missing { .. } | Self::File { .. } | Self::NotASet { .. } => ErrorClass::Io,
            Self::Manifest { .. } | Self::Texture { .. } => ErrorClass::BadInput,
        }
    }
}

impl Explain for LightError {
    fn class(&self) -> ErrorClass {
        ErrorClass::BadInput
    }

    fn remedy(&self) -> Option<Remedy> {
        let instead = [Remedy::Set(Setting::Place, "LAT,LON".into()), Remedy::Set(Setting::Path, "FILE".into())];
        matches!(self, Self::Direction(_) | Self::BelowHorizon { .. }).then(|| Remedy::any(instead))
    }
}

impl Explain for KeyedError {
    fn class(&self) -> ErrorClass {
        match self {
            // The rest is in the path file.
            Self::North(_) => ErrorClass::Usage,
            _ => ErrorClass::BadInput,
        }
    }
}

/// Errors of one class that say themselves what to do.
macro_rules! explain {
    ($($error:ty => $class:ident),* $(,)?) => {
        $(impl Explain for $error {
            fn class(&self) -> ErrorClass {
                ErrorClass::$class
            }
        })*
    };
}

explain! {
    ClockError => Usage,
    DateError => Usage,
    DayError => Usage,
    GlbTooLarge => BadInput,
    LampError => BadInput,
    LampFileError => BadInput,
}

#[cfg(feature = "report")]
impl Explain for crate::cost::CostError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Bake(error) => error.class(),
            Self::Read(error) => error.class(),
            Self::Load(error) => error.class(),
            Self::Folder(error) => error.class(),
            Self::NoSun(_) => ErrorClass::Usage,
            Self::NoSurface => ErrorClass::BadInput,
            Self::Moved { .. } => ErrorClass::Internal,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Bake(error) => error.remedy(),
            Self::Read(error) => error.remedy(),
            Self::Load(error) => error.remedy(),
            Self::Folder(error) => error.remedy(),
            Self::NoSun(_) => {
                Some(Remedy::AnyOf([Setting::Date, Setting::Place, Setting::Path].map(Remedy::Change).into()))
            }
            Self::NoSurface | Self::Moved { .. } => None,
        }
    }
}
