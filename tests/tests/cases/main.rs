//! The cases from the field, one row a case: what must hold, and what was found.
//!
//! Each row is a test of its own. With the option `--table`, as `tests/run cases` gives it, all rows are run and
//! printed as a table; the exit code is 1 if one does not hold. The files are in `tests/cases`.

mod darkness;
mod kept;
mod occluders;
mod read_right;
mod surfaces;
mod tools;

use libtest_mimic::{Arguments, Trial};
use rayon::prelude::*;
use std::panic::AssertUnwindSafe;
use std::process::ExitCode;

/// What was found, in a few words, if what must hold holds; else what does not.
type Found = Result<String, String>;

/// A case and one thing that must hold of it.
struct Row {
    /// The folder in `tests/cases`.
    case: &'static str,
    /// In a few words.
    must_hold: &'static str,
    check: fn() -> Found,
}

impl Row {
    const fn new(case: &'static str, must_hold: &'static str, check: fn() -> Found) -> Self {
        Self { case, must_hold, check }
    }

    /// A panic is something that does not hold.
    fn found(&self) -> Found {
        std::panic::catch_unwind(AssertUnwindSafe(self.check)).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            Err(text.or(panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default())
        })
    }

    fn name(&self) -> String {
        format!("case_{}: {}", self.case, self.must_hold)
    }
}

/// All rows, by case.
fn rows() -> Vec<&'static Row> {
    let files = [occluders::ROWS, darkness::ROWS, kept::ROWS, read_right::ROWS, surfaces::ROWS];
    let mut rows: Vec<&'static Row> = files.into_iter().flatten().collect();
    rows.sort_by_key(|row| row.case);
    rows
}

fn main() -> ExitCode {
    if std::env::args().any(|argument| argument == "--table") {
        return print_table(&rows());
    }
    let trial = |row: &'static Row| Trial::test(row.name(), move || row.found().map(|_| ()).map_err(Into::into));
    libtest_mimic::run(&Arguments::from_args(), rows().into_iter().map(trial).collect()).exit_code()
}

fn print_table(rows: &[&'static Row]) -> ExitCode {
    let found: Vec<Found> = rows.par_iter().map(|row| row.found()).collect();
    println!("| case | what must hold | holds | found |\n|---|---|---|---|");
    for (row, found) in rows.iter().zip(&found) {
        let (holds, text) = match found {
            Ok(text) => ("yes", text),
            Err(text) => ("NO", text),
        };
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        println!("| {} | {} | {holds} | {text} |", row.case, row.must_hold);
    }
    let failed = found.iter().filter(|found| found.is_err()).count();
    println!("\n{} of {} rows hold", rows.len() - failed, rows.len());
    ExitCode::from(u8::from(failed > 0))
}
