//! A report's folder: `report.json` for programs, `report.html` for people, and pictures.

use crate::disk::folder::{FolderKind, FolderWriter};
use std::io::Write;
use std::path::Path;

pub use crate::disk::folder::FolderError;

/// Name of a report for programs. A folder that holds it may be replaced by force.
pub const REPORT_JSON: &str = "report.json";
/// Name of a report for people.
pub const REPORT_HTML: &str = "report.html";

/// Opens a report's folder beside `target`, before anything is measured: nobody should wait for a report that cannot be
/// written. With `force` an older report there is replaced, which is recognised by its file `marker`; anything else is
/// never replaced.
pub fn begin(target: &Path, force: bool, marker: &'static str) -> Result<FolderWriter, FolderError> {
    FolderWriter::begin(target, force, FolderKind { marker, what: "a report", noun: "report" })
}

/// Writes files (name and bytes) into a folder that was begun, and moves it into place.
pub fn finish(folder: FolderWriter, files: &[(&str, Vec<u8>)]) -> Result<(), FolderError> {
    for (name, bytes) in files {
        folder.write_file(name, |file| file.write_all(bytes))?;
    }
    folder.finish()
}

/// Writes a report at once: [`begin`] and [`finish`].
pub fn write(target: &Path, force: bool, marker: &'static str, files: &[(&str, Vec<u8>)]) -> Result<(), FolderError> {
    finish(begin(target, force, marker)?, files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_replaces_a_report_and_nothing_else() {
        let temporary = tempfile::tempdir().unwrap();
        let target = temporary.path().join("made/on the way");
        let files = |text: &str| [(REPORT_JSON, text.as_bytes().to_vec()), (REPORT_HTML, Vec::new())];
        let read = || std::fs::read_to_string(target.join(REPORT_JSON)).unwrap();
        write(&target, false, REPORT_JSON, &files("old")).unwrap();
        assert!(matches!(write(&target, false, REPORT_JSON, &files("new")), Err(FolderError::Exists { .. })));
        assert_eq!(read(), "old");
        write(&target, true, REPORT_JSON, &files("new")).unwrap();
        assert_eq!(read(), "new");
        std::fs::remove_file(target.join(REPORT_JSON)).unwrap();
        let message = write(&target, true, REPORT_JSON, &files("new")).unwrap_err().to_string();
        assert!(message.contains("not a report") && target.join(REPORT_HTML).exists(), "{message}");
    }

    #[test]
    fn a_report_that_is_dropped_leaves_nothing() {
        let temporary = tempfile::tempdir().unwrap();
        let folder = begin(&temporary.path().join("a/b"), false, REPORT_JSON).unwrap();
        folder.write_file(REPORT_JSON, |file| file.write_all(b"half")).unwrap();
        drop(folder);
        assert_eq!(std::fs::read_dir(temporary.path()).unwrap().count(), 0);
    }
}
