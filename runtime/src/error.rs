//! What every error of this crate says beside its text: which class it is of, and what to do next.

use crate::camera::CameraError;
use crate::gpu::GpuError;
use crate::light::TimeError;
use crate::stage::StageError;
use sunbake::{ErrorClass, Explain, Remedy, Setting};

/// Draw on the CPU.
fn on_the_cpu() -> Remedy {
    Remedy::Set(Setting::Renderer, "cpu".into())
}

impl Explain for StageError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Set(error) => error.class(),
            Self::Scene(error) => error.class(),
            Self::NoScene { .. } => ErrorClass::Io,
            Self::Changed { .. } | Self::Mismatch { .. } => ErrorClass::BadInput,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Set(error) => error.remedy(),
            Self::Scene(error) => error.remedy(),
            Self::NoScene { .. } | Self::Changed { .. } | Self::Mismatch { .. } => None,
        }
    }
}

impl Explain for GpuError {
    fn class(&self) -> ErrorClass {
        ErrorClass::Unavailable
    }

    fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::NoAdapter { .. } => {
                Remedy::AnyOf(vec![Remedy::Do("install a Vulkan driver (Mesa's lavapipe will do)"), on_the_cpu()])
            }
            Self::NoDevice { .. } | Self::Failed { .. } => on_the_cpu(),
            Self::Limit { .. } => {
                Remedy::AnyOf(vec![on_the_cpu(), Remedy::Rebake(Box::new(Remedy::Lower(Setting::PageSize)))])
            }
            Self::Picture { .. } => Remedy::AnyOf(vec![Remedy::Lower(Setting::PictureSize), on_the_cpu()]),
            Self::MapMemory { .. } => {
                Remedy::AnyOf(vec![Remedy::Lower(Setting::MapSize), Remedy::Lower(Setting::Cascades)])
            }
            Self::Lacks { .. } => Remedy::Change(Setting::Technique),
        })
    }
}

impl Explain for CameraError {
    fn class(&self) -> ErrorClass {
        ErrorClass::Usage
    }

    fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::NoSuchCamera { .. } => Remedy::AnyOf(vec![
                Remedy::Omit(Setting::Camera),
                Remedy::Set(Setting::Camera, "ex,ey,ez,tx,ty,tz[,fov]".into()),
            ]),
            Self::PointsTooClose => Remedy::Do("give two points further apart"),
        })
    }
}

impl Explain for TimeError {
    fn class(&self) -> ErrorClass {
        ErrorClass::Usage
    }

    fn remedy(&self) -> Option<Remedy> {
        let fraction = Remedy::Set(Setting::Time, "T from 0 to 1".into());
        Some(match self {
            Self::NoSun => Remedy::AnyOf(vec![fraction, Remedy::Omit(Setting::Time)]),
            Self::NoClock => fraction,
            Self::OutsidePath { .. } => Remedy::Do("give a time between"),
        })
    }
}

#[cfg(feature = "report")]
impl Explain for crate::compare::CompareError {
    fn class(&self) -> ErrorClass {
        match self {
            Self::Stage(error) => error.class(),
            Self::Bake(error) => error.class(),
            Self::Camera(error) => error.class(),
            Self::Time(error) => error.class(),
            Self::Gpu(error) => error.class(),
            Self::WorkFolder(_) => ErrorClass::Io,
            Self::OtherScene { .. } => ErrorClass::BadInput,
            Self::TechniqueName(_) | Self::ReferenceNotInSet(_) | Self::NoSun | Self::TooManyPixels { .. } => {
                ErrorClass::Usage
            }
            Self::Reference { .. } => ErrorClass::Unavailable,
            Self::Cancelled => ErrorClass::Cancelled,
        }
    }

    fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Stage(error) => error.remedy(),
            Self::Bake(error) => error.remedy(),
            Self::Camera(error) => error.remedy(),
            Self::Time(error) => error.remedy(),
            Self::Gpu(error) => error.remedy(),
            Self::ReferenceNotInSet(_) => Some(Remedy::Change(Setting::Reference)),
            Self::NoSun => Some(Remedy::AnyOf(vec![
                Remedy::Change(Setting::Date),
                Remedy::Do("compare a set that was baked with a sun"),
            ])),
            Self::TooManyPixels { .. } => Some(Remedy::AnyOf(vec![
                Remedy::Lower(Setting::PictureSize),
                Remedy::Fewer(Setting::Time),
                Remedy::Fewer(Setting::Camera),
            ])),
            Self::WorkFolder(_)
            | Self::OtherScene { .. }
            | Self::TechniqueName(_)
            | Self::Reference { .. }
            | Self::Cancelled => None,
        }
    }
}
