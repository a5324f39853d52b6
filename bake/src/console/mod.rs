//! The console that `sunbake` and `sunplay` share: how a command is started, what it prints, and how it ends.
//!
//! Exit codes, with the [`ErrorClass`](crate::ErrorClass) of an error that leads to each:
//!
//! - **0**: done, or help was asked for.
//! - **1**, `Usage`: an option is unknown, its value makes no sense, options do not fit together, or do not fit the
//!   scene or set: there is no such material, camera or lamp, a picture is too large, there is no sun on that day.
//! - **2**, `Io`: a file or a folder is missing, cannot be read or written, or is in the way; stdout cannot be written.
//! - **3**, `BadInput` and `UnsupportedInput`: a scene, a path or a set is damaged, asks for what is not supported, or
//!   needs more memory than allowed.
//! - **4**, `Internal`: a defect of ours.
//! - **5**, `Unavailable`: this machine or this build cannot do it: there is no GPU, the GPU lacks something, threads
//!   do not start, a feature is off.
//! - **6**: a technique exceeds a limit of `sunplay compare --fail-above`.
//! - **130** and **143**, `Cancelled`: stopped by Ctrl-C or SIGTERM.
//!
//! A failure is one line on stderr, `name: what is wrong; what to do`, with each cause once and without control
//! characters. The class of an error is decided where the error is (`error.rs` of either crate), its code in
//! `failure.rs`, and the words of its [`Remedy`](crate::Remedy) in `remedies.rs`. Results go to stdout; warnings,
//! progress and failures to stderr.

mod clock_offset;
mod failure;
mod object_args;
mod print;
mod progress;
mod remedies;
mod run;
mod signals;
mod sun_args;

pub use failure::Failure;
pub use object_args::{DensityArgs, ObjectArgs};
pub use print::{print, print_json, sentence, tell, warn, warn_all};
pub use progress::ProgressLine;
pub use run::{Command, set_threads};
pub use sun_args::SunArgs;
