//! Printing. Nobody has to read what is printed, so a reader that went away is no failure; a full disk is.

use std::io::{ErrorKind, Write};

/// Prints on stdout.
pub fn print(text: &str) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// What to tell a user whose result could not be printed.
pub fn cannot_print(error: &std::io::Error) -> String {
    format!("cannot print the result: {error}; check where stdout leads to")
}
