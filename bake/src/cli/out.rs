//! Printing. Nobody has to read what is printed, so a reader that went away is no failure; a full disk is.

use super::exit::Failure;
use serde::Serialize;
use std::io::{ErrorKind, Write};

/// Prints on stdout.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::io(format!("cannot print the result: {error}; check where stdout leads to")))
        }
        _ => Ok(()),
    }
}

/// Prints JSON on stdout, as people read it.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|e| Failure::io(e.to_string()))?;
    print(&(text + "\n"))
}

/// Prints a line on stderr. If even that fails there is nobody to tell.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Prints warnings on stderr, one a line.
pub fn warn(warnings: &[String]) {
    warnings.iter().for_each(|warning| tell(&format!("warning: {warning}")));
}
