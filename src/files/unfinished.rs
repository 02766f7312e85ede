//! Files and folders under construction: their names, and the removal of those that a killed run left.
//!
//! Their names are `.tofsim-PROCESS-RANDOM.part`, and their creator keeps them locked. This distinguishes a killed
//! run from a live one: the first time that a run writes into a folder, it removes the leftovers of dead runs.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile, TempDir, TempPath};

use crate::error::open::open_own;

const PREFIX: &str = ".tofsim-";
const SUFFIX: &str = ".part";
/// Age from which an unlocked leftover belongs to a dead run, even if a process has its number.
const OLD: Duration = Duration::from_secs(60);

/// Paths that this process has under construction.
static OURS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Folders that this process has searched for leftovers.
static SWEPT: LazyLock<Mutex<BTreeSet<PathBuf>>> = LazyLock::new(Mutex::default);

/// Folders that this process created for its outputs, outer ones first.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A path under construction, which is removed when dropped unless it was persisted.
#[derive(Debug)]
pub(super) struct Unfinished<T> {
    path: PathBuf,
    /// Temporary path, which is removed when dropped; `None` once it was renamed.
    own: Option<T>,
}

impl Unfinished<TempPath> {
    /// Creates a temporary file in `directory`.
    pub(super) fn file(directory: &Path) -> io::Result<(File, Self)> {
        sweep(directory);
        let make = |builder: &mut Builder| {
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                builder.permissions(fs::Permissions::from_mode(0o666));
            }
            builder.tempfile_in(directory).map(NamedTempFile::into_parts)
        };
        let ((file, own), path) = registered(make, |(_, own)| own)?;
        lock(&file);
        Ok((file, Unfinished { path, own: Some(own) }))
    }

    /// Renames the file to its final path.
    pub(super) fn persist(mut self, target: &Path) -> io::Result<()> {
        match self.own.take() {
            Some(path) => path.persist(target).map_err(|error| error.error),
            None => Ok(()),
        }
    }
}

impl Unfinished<TempDir> {
    /// Creates a temporary folder in `directory`.
    pub(super) fn folder(directory: &Path) -> io::Result<(Option<File>, Self)> {
        sweep(directory);
        let (own, path) = registered(|builder| builder.tempdir_in(directory), TempDir::path)?;
        // Where a folder cannot be opened, its age has to do.
        let lock_file = open_own(own.path()).ok();
        lock_file.iter().for_each(lock);
        Ok((lock_file, Unfinished { path, own: Some(own) }))
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

impl<T> Drop for Unfinished<T> {
    fn drop(&mut self) {
        let mut ours = OURS.lock().unwrap_or_else(PoisonError::into_inner);
        drop(self.own.take());
        ours.remove(&self.path);
    }
}

/// Creates a path that follows the naming scheme, and returns it as absolute; [`discard_all`] finds it in any case.
fn registered<T>(
    make: impl FnOnce(&mut Builder) -> io::Result<T>,
    path: impl FnOnce(&T) -> &Path,
) -> io::Result<(T, PathBuf)> {
    let prefix = format!("{PREFIX}{}-", std::process::id());
    let mut ours = OURS.lock().unwrap_or_else(PoisonError::into_inner);
    let made = make(Builder::new().prefix(&prefix).suffix(SUFFIX));
    let made = made.map_err(|error| without_path(&error))?;
    // Whoever ends the process may do so in another folder than where it began.
    let path = path(&made);
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    ours.insert(path.clone());
    Ok((made, path))
}

/// Returns an error of the temporary file without its name, which says nothing to a user, but with the system's words.
fn without_path(error: &io::Error) -> io::Error {
    let text = error.to_string();
    let words = text.rsplit_once(" at path ").map_or(text.as_str(), |(words, _)| words);
    io::Error::new(error.kind(), words)
}

/// Locks a file to show that this process is alive. Where the file system has no locks, the file's age decides
/// instead.
fn lock(file: &File) {
    drop(file.try_lock());
}

/// Removes everything that this process has under construction, and blocks any further output, just before the
/// process ends.
pub fn discard_all() {
    let ours = OURS.lock().unwrap_or_else(PoisonError::into_inner);
    ours.iter().for_each(|path| remove(path));
    std::mem::forget(ours);
    remove_empty(&MADE.lock().unwrap_or_else(PoisonError::into_inner));
}

/// Creates the missing folders on the path to `directory`, and returns them, outer ones first. [`discard_all`] removes
/// those that are empty.
pub(super) fn make_folders(directory: &Path) -> io::Result<Vec<PathBuf>> {
    // Nothing is created once the process ends.
    let _ours = OURS.lock().unwrap_or_else(PoisonError::into_inner);
    let is_missing = |path: &&Path| fs::symlink_metadata(path).is_err();
    // That of a bare name is empty, and there.
    let absolute = std::path::absolute(directory).unwrap_or_default();
    let missing = absolute.ancestors().take_while(is_missing).filter(|path| *path != Path::new(""));
    let mut missing: Vec<_> = missing.map(Path::to_owned).collect();
    missing.reverse();
    MADE.lock().unwrap_or_else(PoisonError::into_inner).extend(missing.iter().cloned());
    fs::create_dir_all(directory)?;
    Ok(missing)
}

/// Removes those of the folders that are empty; the list has outer ones first.
pub(super) fn remove_empty(made: &[PathBuf]) {
    made.iter().rev().for_each(|path| drop(fs::remove_dir(path)));
}

/// Removes the leftovers of dead runs from a folder, once per process.
fn sweep(directory: &Path) {
    let known = fs::canonicalize(directory).unwrap_or_else(|_| directory.to_owned());
    if !SWEPT.lock().unwrap_or_else(PoisonError::into_inner).insert(known) {
        return;
    }
    // What cannot be read or removed does not keep the run from its work.
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| is_left(path)).for_each(|path| remove(&path));
}

fn remove(path: &Path) {
    let is_folder = fs::symlink_metadata(path).is_ok_and(|found| found.is_dir());
    let _ = if is_folder { fs::remove_dir_all(path) } else { fs::remove_file(path) };
}

/// Parses the process number from the name of a path under construction. The inner value is `None` for the names of
/// an older tofsim.
pub fn process(name: &OsStr) -> Option<Option<u32>> {
    let middle = name.to_str()?.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?;
    Some(middle.split_once('-').and_then(|(process, _)| process.parse().ok()))
}

/// Returns whether a path was left by a dead run.
fn is_left(path: &Path) -> bool {
    let Some(process) = path.file_name().and_then(process) else { return false };
    let Ok(found) = fs::symlink_metadata(path) else { return false };
    let age = found.modified().ok().and_then(|then| then.elapsed().ok()).unwrap_or_default();
    let is_plain = found.is_file() || found.is_dir();
    let may_be = age > OLD || process.is_some_and(is_gone);
    is_plain && may_be && open_own(path).is_ok_and(|file| file.try_lock().is_ok())
}

/// Returns whether the process has ended, as far as the system can tell.
pub fn is_gone(process: u32) -> bool {
    let tells = Path::new("/proc/self/stat").exists();
    let stat = fs::read_to_string(format!("/proc/{process}/stat"));
    tells && stat.map_or(true, |stat| stat.contains(") Z") || stat.contains(") X"))
}

#[cfg(target_os = "linux")]
#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of a process that has ended.
    fn dead() -> u32 {
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        child.id()
    }

    #[test]
    fn the_error_of_a_temporary_file_is_the_system_s() {
        let error = Unfinished::file(Path::new("/nowhere")).unwrap_err().to_string();
        assert_eq!(error, io::Error::from_raw_os_error(2).to_string());
    }

    #[test]
    fn what_a_dead_run_left_is_removed_and_what_lives_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (left, folder_left) =
            (format!(".tofsim-{}-abc.part", dead()), format!(".tofsim-{}-d.part", dead()));
        fs::write(at(&left), "half").unwrap();
        fs::create_dir(at(&folder_left)).unwrap();
        fs::write(at(&folder_left).join("within"), "half").unwrap();
        let other = format!(".tofsim-{}-abc.part", std::process::id());
        let kept = [other.as_str(), ".tofsim-new.part", ".tofsim-1", "mine.part"];
        kept.iter().for_each(|name| fs::write(at(name), "whole").unwrap());
        let locked = at(&format!(".tofsim-{}-locked.part", dead()));
        let file = File::create(&locked).unwrap();
        file.lock().unwrap();

        let (_, unfinished) = Unfinished::file(folder.path()).unwrap();
        assert!(!at(&left).exists() && !at(&folder_left).exists());
        assert!(kept.iter().all(|name| at(name).exists()) && locked.exists());
        let own = unfinished.path.clone();
        assert!(own.exists() && OURS.lock().unwrap().contains(&own));
        drop(unfinished);
        assert!(!own.exists() && !OURS.lock().unwrap().contains(&own));
    }

    #[test]
    fn a_file_in_place_is_no_longer_under_construction() {
        let folder = tempfile::tempdir().unwrap();
        let (_, unfinished) = Unfinished::file(folder.path()).unwrap();
        let own = unfinished.path.clone();
        unfinished.persist(&folder.path().join("whole")).unwrap();
        assert!(folder.path().join("whole").exists() && !own.exists());
        assert!(!OURS.lock().unwrap().contains(&own));
    }
}
