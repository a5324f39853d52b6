//! Printing. Nobody has to read what is printed, so a reader that went away is no failure; a full disk is.

use super::exit::Failure;
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
