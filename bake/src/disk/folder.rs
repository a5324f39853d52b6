//! A folder that is written whole or not at all: a set, or a report.
//!
//! Everything goes into a folder beside the target, under a name that nothing reads; [`FolderWriter::finish`] renames it
//! into place. What stops before that, for whatever reason, leaves the old folder or none.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// How the folder of something unfinished is called, after a dot and the target's name.
const PARTIAL_SUFFIX: &str = ".sunbake-partial";

/// What kind of folder is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FolderKind {
    /// Name of the file that tells an older folder of this kind, which `--force` may replace.
    pub marker: &'static str,
    /// What to call it, as `a baked set`.
    pub what: &'static str,
    /// The same in one word, as `set`.
    pub noun: &'static str,
}

/// Why a folder could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The target is there already.
    #[error("{} exists", target.display())]
    Exists {
        /// The target.
        target: PathBuf,
    },
    /// The target is there and is something else, so it is not replaced even by force.
    #[error("{} exists and is not {what}, so it is never replaced", target.display())]
    NotOurs {
        /// The target.
        target: PathBuf,
        /// What it would have to be.
        what: &'static str,
    },
    /// The target's parent folder is missing, or cannot be written.
    #[error("cannot write in {}: {source}", folder.display())]
    Folder {
        /// The parent.
        folder: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {name}: {source}; nothing was left behind")]
    File {
        /// Its name within the folder.
        name: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The finished folder could not be moved into place.
    #[error("cannot move the finished {noun} to {}: {source}", target.display())]
    Rename {
        /// The target.
        target: PathBuf,
        /// What was finished.
        noun: &'static str,
        /// What the system says.
        source: std::io::Error,
    },
}

/// A folder being written. Dropped before it is finished, it takes back whatever it made.
#[derive(Debug)]
pub struct FolderWriter {
    kind: FolderKind,
    target: PathBuf,
    partial: TempDir,
    /// After `partial`, which lies in it and has to go first.
    _parent: MadeFolders,
}

/// Folders that were made on the way to the target, outermost first. Those that stay empty are removed again.
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
            // Only empty folders can be removed so: one that holds what was made stays.
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
    if !force {
        return Err(FolderError::Exists { target: target.to_owned() });
    }
    match metadata.is_dir() && target.join(kind.marker).is_file() {
        true => Ok(()),
        false => Err(FolderError::NotOurs { target: target.to_owned(), what: kind.what }),
    }
}

impl FolderWriter {
    /// Opens a folder beside `target` to write in. `force` allows an older one of this kind to be replaced.
    pub fn begin(target: &Path, force: bool, kind: FolderKind) -> Result<Self, FolderError> {
        check_target(target, force, kind)?;
        // What is there already is replaced where it really is, be it named `.` or by a link.
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
            // The kind alone: the whole error names our hidden folder, which means nothing to anyone.
            .map_err(|error| wrong(error.kind().into()))?;
        Ok(Self { kind, target: target.to_owned(), partial, _parent: made })
    }

    /// Where files are written until they are moved into place. What else is put there has to be gone by then.
    pub fn path(&self) -> &Path {
        self.partial.path()
    }

    /// Writes a file, and gives back how many bytes it has. Files of different names may be written at once.
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
                    // The old one goes back to where it was; if even that fails, the error below names the cause.
                    let _ = std::fs::rename(old.path().join("old"), &self.target);
                }
                Err(wrong(source))
            }
        }
    }

    /// Moves what the target holds into a folder that is removed when the new one is in place.
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

/// A temporary folder is its owner's alone; what is finished is as open as any folder the user makes.
#[cfg(unix)]
fn make_readable(folder: &Path) {
    use std::os::unix::fs::PermissionsExt;
    // What only its owner can read is still what was asked for.
    let _ = std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755));
}

#[cfg(not(unix))]
fn make_readable(_folder: &Path) {}
