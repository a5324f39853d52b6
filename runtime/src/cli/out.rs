//! What the command says.

use super::exit::Failure;
use sunbake::printing;

/// Prints on stdout.
pub fn print(text: &str) -> Result<(), Failure> {
    printing::print(text).map_err(|error| Failure::io(printing::cannot_print(&error)))
}
