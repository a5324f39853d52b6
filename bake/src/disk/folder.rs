//! Writes a folder completely or not at all: a set, or a report.
//!
//! Files are written into a temporary folder beside the target; [`FolderWriter::finish`] renames it into place. A
//! program that stops earlier, for whatever reason, leaves the old folder or none.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Suffix of the temporary folder's name, after a dot and the target's name.
const PARTIAL_SUFFIX: &str = ".sunbake-partial";

/// What kind of folder is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FolderKind {
    /// Name of a file that identifies an older folder of this kind. Only such a folder may be replaced.
    pub marker: &'static str,
    /// For messages, with an article: `a baked set`.
    pub what: &'static str,
    /// For messages, in one word: `set`.
    pub noun: &'static str,
}

/// Why a folder could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The target is an older folder of this kind, which only force replaces.
    #[error("{} exists", target.display())]
    Exists {
        /// The target.
        target: PathBuf,
    },
    /// The target exists and is something else, so it is never replaced, forced or not.
    #[error("{} exists and is not {what}, so it is never replaced", target.display())]
    NotOurs {
        /// The target.
        target: PathBuf,
        /// What it must be to be replaced.
        what: &'static str,
    },
    /// The target's parent folder is missing, or cannot be written.
    #[error("cannot write in {}: {source}", folder.display())]
    Folder {
        /// The parent.
        folder: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {name}: {source}; nothing was left behind")]
    File {
        /// Its name within the folder.
        name: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// The finished folder could not be moved into place.
    #[error("cannot move the finished {noun} to {}: {source}", target.display())]
    Rename {
        /// The target.
        target: PathBuf,
        /// The folder's kind in one word.
        noun: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
}

/// A folder being written. If it is dropped before [`FolderWriter::finish`], everything it wrote is removed.
#[derive(Debug)]
pub struct FolderWriter {
    kind: FolderKind,
    target: PathBuf,
    partial: TempDir,
    /// Declared after `partial`, which lies in it and must be dropped first.
    _parent: MadeFolders,
}

/// Parent folders of the target that were made, outermost first. On drop, those that are empty are removed.
#[derive(Debug)]
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    fn make(folder: &Path) -> std::io::Result<Self> {
        let missing = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists());
        let mut made = Self(Vec::new());
        let missing: Vec<&Path> = missing.collect();
        for folder in missing.into_iter().rev() {
            match std::fs::create_dir(folder) {
                Ok(()) => made.0.push(folder.to_owned()),
                // Another process was faster.
                Err(_) if folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(made)
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // This fails for folders that are not empty, which must stay.
            let _ = std::fs::remove_dir(folder);
        }
    }
}

/// Whether a folder of this kind may be written at `target`.
fn check_target(target: &Path, force: bool, kind: FolderKind) -> Result<(), FolderError> {
    let Ok(metadata) = std::fs::metadata(target).or_else(|_| std::fs::symlink_metadata(target)) else { return Ok(()) };
    let is_empty = || std::fs::read_dir(target).is_ok_and(|mut entries| entries.next().is_none());
    if metadata.is_dir() && is_empty() {
        return Ok(());
    }
    let is_ours = metadata.is_dir() && target.join(kind.marker).is_file();
    match (is_ours, force) {
        (true, true) => Ok(()),
        (true, false) => Err(FolderError::Exists { target: target.to_owned() }),
        (false, _) => Err(FolderError::NotOurs { target: target.to_owned(), what: kind.what }),
    }
}

impl FolderWriter {
    /// Makes a temporary folder beside `target`. `force` allows an older folder of this kind to be replaced.
    pub fn begin(target: &Path, force: bool, kind: FolderKind) -> Result<Self, FolderError> {
        check_target(target, force, kind)?;
        // An existing target may be named `.` or by a link: replace the real folder.
        let target = &target.canonicalize().unwrap_or_else(|_| target.to_owned());
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let wrong = |source| FolderError::Folder { folder: folder.clone(), source };
        let made = MadeFolders::make(&folder).map_err(wrong)?;
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let partial = tempfile::Builder::new()
            .prefix(&format!(".{name}."))
            .suffix(PARTIAL_SUFFIX)
            .tempdir_in(&folder)
            // Only the kind, since the full error names the temporary folder, which would confuse users.
            .map_err(|error| wrong(error.kind().into()))?;
        Ok(Self { kind, target: target.to_owned(), partial, _parent: made })
    }

    /// The temporary folder. Files that do not belong to the result must be removed before [`FolderWriter::finish`].
    pub fn path(&self) -> &Path {
        self.partial.path()
    }

    /// Writes a file and returns its length in bytes. Files of different names may be written in parallel.
    pub fn write_file(
        &self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<u64, FolderError> {
        let wrong = |source| FolderError::File { name: name.to_owned(), source };
        let mut file = BufWriter::new(File::create(self.path().join(name)).map_err(wrong)?);
        write(&mut file).and_then(|()| file.flush()).map_err(wrong)?;
        let length = file.get_ref().metadata().map_err(wrong)?.len();
        Ok(length)
    }

    /// Moves the folder into place.
    pub fn finish(self) -> Result<(), FolderError> {
        make_readable(self.path());
        let wrong = |source| FolderError::Rename { target: self.target.clone(), noun: self.kind.noun, source };
        let replaced = self.set_old_aside().map_err(wrong)?;
        match std::fs::rename(self.path(), &self.target) {
            Ok(()) => Ok(()),
            Err(source) => {
                if let Some(old) = &replaced {
                    // Restore the old folder; if that fails too, the error below names the cause.
                    let _ = std::fs::rename(old.path().join("old"), &self.target);
                }
                Err(wrong(source))
            }
        }
    }

    /// Moves an existing target into a temporary folder that is removed when the new one is in place.
    fn set_old_aside(&self) -> std::io::Result<Option<TempDir>> {
        if !self.target.exists() {
            return Ok(None);
        }
        let parent = self.path().parent().unwrap_or(Path::new("."));
        let aside = tempfile::Builder::new().prefix(".old.").suffix(PARTIAL_SUFFIX).tempdir_in(parent)?;
        std::fs::rename(&self.target, aside.path().join("old"))?;
        Ok(Some(aside))
    }
}

/// Temporary folders are private to their owner; a finished folder gets ordinary permissions.
#[cfg(unix)]
fn make_readable(folder: &Path) {
    use std::os::unix::fs::PermissionsExt;
    // If this fails, the folder is still complete, but readable only by its owner.
    let _ = std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755));
}

#[cfg(not(unix))]
fn make_readable(_folder: &Path) {}
