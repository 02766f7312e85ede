//! Folders under construction: output folders whose files appear together, and scratch folders.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::output::{create_directory, write_file};
use super::unfinished::Unfinished;
use crate::error::open::open_own;
use crate::error::{Error, Result};

/// A scratch folder, which is removed when it is dropped; if the process was killed, a later run removes it.
#[derive(Debug)]
pub struct ScratchFolder {
    folder: Unfinished<TempDir>,
    _lock: Option<File>,
}

impl ScratchFolder {
    /// Creates a scratch folder in the system's temporary folder.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn new() -> Result<Self> {
        ScratchFolder::within(&std::env::temp_dir())
    }

    fn within(directory: &Path) -> Result<Self> {
        let (lock, folder) =
            Unfinished::folder(directory).map_err(Error::io(directory, "write"))?;
        Ok(ScratchFolder { folder, _lock: lock })
    }

    /// Returns the folder's path.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// An output folder whose files appear all together or not at all.
#[derive(Debug)]
pub struct StagedFolder {
    target: PathBuf,
    scratch: ScratchFolder,
}

impl StagedFolder {
    /// Begins the output folder `target`, which need not exist.
    ///
    /// # Errors
    /// If it is not writable.
    pub fn new(target: &Path) -> Result<Self> {
        let absolute = std::path::absolute(target).map_err(Error::io(target, "create"))?;
        let is_there = |path: &&Path| fs::symlink_metadata(path).is_ok();
        let above = absolute.ancestors().find(is_there).unwrap_or(&absolute);
        if !above.is_dir() {
            // What keeps it from being made says why.
            create_directory(target)?;
        }
        let (target, scratch) = (target.to_owned(), ScratchFolder::within(above));
        match scratch {
            Err(Error::Io { source, .. }) => {
                Err(Error::Io { path: target, action: "create", source })
            }
            scratch => Ok(StagedFolder { target, scratch: scratch? }),
        }
    }

    /// Returns the path of the temporary folder in which to write files.
    pub fn path(&self) -> &Path {
        self.scratch.path()
    }

    /// Moves all files to their final paths, and returns these, sorted.
    ///
    /// # Errors
    /// If a file cannot be moved.
    pub fn commit(self) -> Result<Vec<PathBuf>> {
        let mut placed = Vec::new();
        place_all(self.scratch.path(), &self.target, &mut placed)?;
        placed.sort();
        Ok(placed)
    }
}

fn place_all(from: &Path, to: &Path, placed: &mut Vec<PathBuf>) -> Result<()> {
    create_directory(to)?;
    for entry in fs::read_dir(from).map_err(Error::io(from, "read"))? {
        let entry = entry.map_err(Error::io(from, "read"))?;
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            place_all(&from, &to, placed)?;
        } else {
            place(&from, &to)?;
            placed.push(to);
        }
    }
    Ok(())
}

fn place(from: &Path, to: &Path) -> Result<()> {
    match fs::metadata(to) {
        // A device or a pipe is written in place.
        Ok(found) if !found.is_file() => {
            write_file(to, |file| io::copy(&mut open_own(from)?, file).map(drop))
        }
        _ => {
            let target = fs::canonicalize(to).unwrap_or_else(|_| to.to_owned());
            match fs::rename(from, &target) {
                Err(error) if error.kind() == io::ErrorKind::CrossesDevices => {
                    write_file(to, |file| io::copy(&mut open_own(from)?, file).map(drop))
                }
                renamed => renamed.map_err(Error::io(to, "write")),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("out/deep");
        let stage = StagedFolder::new(&target).unwrap();
        create_directory(&stage.path().join("tdc")).unwrap();
        fs::write(stage.path().join("tdc/a"), "new").unwrap();
        fs::write(stage.path().join("b"), "new").unwrap();
        assert!(!folder.path().join("out").exists());
        drop(stage);
        assert_eq!(names(folder.path()), [""; 0]);

        create_directory(&target).unwrap();
        fs::write(target.join("b"), "old").unwrap();
        let stage = StagedFolder::new(&target).unwrap();
        create_directory(&stage.path().join("tdc")).unwrap();
        fs::write(stage.path().join("tdc/a"), "new").unwrap();
        fs::write(stage.path().join("b"), "new").unwrap();
        assert_eq!(stage.commit().unwrap(), [target.join("b"), target.join("tdc/a")]);
        assert_eq!(fs::read_to_string(target.join("b")).unwrap(), "new");
        assert_eq!(names(&target), ["b", "tdc"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let error = StagedFolder::new(&file).unwrap_err().to_string();
        assert!(error.contains("file: cannot create"), "{error}");
        let error = StagedFolder::new(&file.join("below")).unwrap_err().to_string();
        assert!(error.contains("below: cannot create"), "{error}");
    }
}
