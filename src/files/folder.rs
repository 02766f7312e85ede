//! Exclusive access to an output folder, and listing of a folder.

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

use crate::error::open::open_own;
use crate::error::{Error, Input, Result};

use super::unfinished::{make_folders, remove_empty};

/// Lock on an output folder, which is held until it is dropped or the process ends. A folder that was created for it
/// and is still empty is then removed.
#[derive(Debug)]
pub struct FolderLock {
    _folder: Option<File>,
    made: Vec<PathBuf>,
}

impl FolderLock {
    /// Creates the folder if necessary, and locks it.
    ///
    /// # Errors
    /// If it cannot be created, or another run has locked it.
    pub fn take(path: &Path) -> Result<Self> {
        Self::locked(path, File::try_lock)
    }

    /// Creates the folder if necessary, and locks it against those that [`FolderLock::take`] it, not against those that
    /// share it too: the shards of a sweep, whose files have names of their own.
    ///
    /// # Errors
    /// If it cannot be created, or another run has taken it.
    pub fn share(path: &Path) -> Result<Self> {
        Self::locked(path, File::try_lock_shared)
    }

    fn locked(
        path: &Path,
        lock: impl Fn(&File) -> std::result::Result<(), TryLockError>,
    ) -> Result<Self> {
        let made = make_folders(path).map_err(Error::io(path, "create"))?;
        // Where the system opens no folders, there is nothing to hold.
        let Ok(folder) = open_own(path) else { return Ok(FolderLock { _folder: None, made }) };
        match lock(&folder) {
            Ok(()) => Ok(FolderLock { _folder: Some(folder), made }),
            Err(TryLockError::WouldBlock) => {
                let expected = "another run is writing there, expected a folder of its own";
                Err(Input::new("--output", expected).value(path.display()).into())
            }
            Err(TryLockError::Error(error)) if error.kind() == std::io::ErrorKind::Unsupported => {
                Ok(FolderLock { _folder: None, made })
            }
            Err(TryLockError::Error(error)) => Err(Error::io(path, "lock")(error)),
        }
    }
}

/// Returns the sorted paths of all files in a folder and its subfolders.
///
/// # Errors
/// If a folder cannot be read.
pub fn files_below(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(Error::io(folder, "read"))? {
        let path = entry.map_err(Error::io(folder, "read"))?.path();
        if path.is_dir() { files.extend(files_below(&path)?) } else { files.push(path) }
    }
    files.sort();
    Ok(files)
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        remove_empty(&self.made);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_held_by_one_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let held = FolderLock::take(&path).unwrap();
        let error = FolderLock::take(&path).unwrap_err().to_string();
        assert!(error.contains("out: another run is writing there"), "{error}");
        assert!(FolderLock::share(&path).is_err());
        drop(held);
        assert!(!path.exists(), "what was made stays empty");
        let shards = [FolderLock::share(&path).unwrap(), FolderLock::share(&path).unwrap()];
        assert!(FolderLock::take(&path).is_err());
        drop(shards);
        let held = FolderLock::take(&path).unwrap();
        std::fs::write(path.join("file"), "whole").unwrap();
        drop(held);
        assert!(path.join("file").exists());
    }
}
