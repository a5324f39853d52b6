//! What the command says, and where.

use super::exit::Failure;
use serde::Serialize;
use std::io::Write;
use sunbake::printing;

/// Prints on stdout.
pub fn print(text: &str) -> Result<(), Failure> {
    printing::print(text).map_err(|error| Failure::io(printing::cannot_print(&error)))
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
