//! The console that `sunbake` and `sunplay` share: how a command is started, what it prints, and how it ends.
//!
//! | exit code | when | [`ErrorClass`](crate::ErrorClass) |
//! |---|---|---|
//! | 0 | done, or help was asked for | |
//! | 1 | an option is unknown, its value makes no sense, options do not fit together or do not fit the scene or set (no such material, camera or lamp; a picture too large; no sun on that day) | `Usage` |
//! | 2 | a file or a folder is missing, cannot be read or written, or is in the way; stdout cannot be written | `Io` |
//! | 3 | a scene, a path or a set is damaged, asks for what is not supported, or needs more memory than allowed | `BadInput`, `UnsupportedInput` |
//! | 4 | a defect of ours | `Internal` |
//! | 5 | this machine or this build cannot do it: no GPU, a GPU that lacks something, threads that do not start, a feature that is off | `Unavailable` |
//! | 6 | a technique is above a limit of `sunplay compare --fail-above` | |
//! | 130, 143 | stopped by Ctrl-C or SIGTERM | `Cancelled` |
//!
//! A failure is one line on stderr, `name: what is wrong; what to do`, with each cause once and without control characters.
//! The class of an error is decided where the error is (`error.rs` of either crate), its code in `failure.rs`, and the words
//! of its [`Remedy`](crate::Remedy) in `remedies.rs`. Results go to stdout; warnings, progress and failures to stderr.

mod failure;
mod print;
mod progress;
mod remedies;
mod run;
mod signals;
mod sun_args;

pub use failure::Failure;
pub use print::{print, print_json, sentence, tell, warn, warn_all};
pub use progress::ProgressLine;
pub use run::{Command, set_threads};
pub use sun_args::SunArgs;
