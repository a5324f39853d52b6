//! Printing: results on stdout, everything else on stderr.

use super::Failure;
use super::remedies::with_remedy;
use super::{Command, failure::one_line};
use crate::warning::Warning;
use serde::Serialize;
use std::io::{ErrorKind, Write};

/// Prints on stdout. A reader that went away is no failure; a full disk is.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::io(format!("cannot print the result: {error}; check where stdout leads to")))
        }
        _ => Ok(()),
    }
}

/// Prints JSON on stdout, indented.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure::io(error.to_string()))?;
    print(&(text + "\n"))
}

/// Prints a line on stderr, without control characters. If stderr is closed, there is nobody to tell.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", one_line(line));
}

/// Prints a sentence on stderr as a warning.
pub fn warn(sentence: &str) {
    tell(&format!("warning: {sentence}"));
}

/// A warning with what to do about it, in the options of `command`.
pub fn sentence(warning: &Warning, command: Command) -> String {
    with_remedy(warning.to_string(), warning.remedy().as_ref(), command)
}

/// Prints warnings on stderr, one a line.
pub fn warn_all(warnings: &[Warning], command: Command) {
    warnings.iter().for_each(|warning| warn(&sentence(warning, command)));
}
