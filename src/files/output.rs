//! Output files that are complete or absent: they are written beside the target and then renamed.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::unfinished::Unfinished;
use crate::error::{Error, Result};

/// An output file under construction. If it is dropped without [`OutputFile::commit`], the target does not change.
///
/// A target that exists and is not a regular file (a device, a pipe) is written in place.
#[derive(Debug)]
pub struct OutputFile {
    target: PathBuf,
    file: BufWriter<File>,
    place: Place,
}

/// Destination of the bytes while the file is under construction.
#[derive(Debug)]
enum Place {
    /// Temporary file beside the target, which is renamed in the end.
    Beside(Unfinished<TempPath>),
    /// The target itself.
    Target,
    /// Anonymous temporary file, which is copied to this target in the end.
    Nameless(BufWriter<File>),
}

/// Size of the write buffer [bytes].
const BUFFER: usize = 1 << 16;

impl OutputFile {
    /// Creates an output file. A symbolic link is followed, so that its target is replaced.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(target: &Path) -> Result<Self> {
        let (file, place) = match fs::metadata(target) {
            Ok(found) if found.is_dir() => {
                let source = io::Error::from(io::ErrorKind::IsADirectory);
                return Err(Error::Io { path: target.to_owned(), action: "write", source });
            }
            Ok(found) if !found.is_file() => {
                let file = File::options().write(true).open(target);
                (file.map_err(Error::io(target, "write"))?, Place::Target)
            }
            _ => {
                let (file, path) = beside(target)?;
                (file, Place::Beside(path))
            }
        };
        let file = BufWriter::with_capacity(BUFFER, file);
        Ok(OutputFile { target: target.to_owned(), file, place })
    }

    /// Creates a seekable output file, even if the target is a pipe or a device.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub(crate) fn create_seekable(target: &Path) -> Result<Self> {
        let mut output = OutputFile::create(target)?;
        if let Place::Target = output.place {
            let nameless = tempfile::tempfile().map_err(Error::io(target, "write"))?;
            let device = std::mem::replace(&mut output.file, BufWriter::new(nameless));
            output.place = Place::Nameless(device);
        }
        Ok(output)
    }

    /// Returns the final path.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Converts an I/O error to one that names the file.
    pub fn fault(&self, source: io::Error) -> Error {
        Error::Io { path: self.target.clone(), action: "write", source }
    }

    /// Moves the complete file to its final path.
    ///
    /// # Errors
    /// If the bytes cannot be written, or the file cannot be renamed.
    pub fn commit(self) -> Result<()> {
        let OutputFile { target, file, place } = self;
        let finish = || {
            let mut file = file.into_inner().map_err(|error| error.into_error())?;
            match place {
                Place::Target => Ok(()),
                Place::Beside(path) => {
                    let target = fs::canonicalize(&target).unwrap_or(target.clone());
                    path.persist(&target)
                }
                Place::Nameless(mut device) => {
                    file.rewind()?;
                    io::copy(&mut file, &mut device)?;
                    device.flush()
                }
            }
        };
        finish().map_err(Error::io(&target, "write"))
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for OutputFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

fn beside(target: &Path) -> Result<(File, Unfinished<TempPath>)> {
    let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    Unfinished::file(directory).map_err(Error::io(&target, "write"))
}

/// Writes a complete file with the output of `fill`.
///
/// # Errors
/// If `fill` fails, or the file cannot be written.
pub fn write_file(
    target: &Path,
    fill: impl FnOnce(&mut OutputFile) -> io::Result<()>,
) -> Result<()> {
    let mut file = OutputFile::create(target)?;
    fill(&mut file).map_err(|source| file.fault(source))?;
    file.commit()
}

/// Writes a complete file.
///
/// # Errors
/// If the file cannot be written.
pub fn write_bytes(target: &Path, bytes: impl AsRef<[u8]>) -> Result<()> {
    write_file(target, |file| file.write_all(bytes.as_ref()))
}

/// Creates a directory and its parents.
///
/// # Errors
/// If a directory cannot be created.
pub fn create_directory(path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(Error::io(path, "create"))
}

/// Creates a directory and its parents, and checks that the file `name` can be created in it.
///
/// # Errors
/// If the directory or the file cannot be created.
pub fn create_directory_for(path: &Path, name: &str) -> Result<()> {
    create_directory(path)?;
    OutputFile::create(&path.join(name)).map(drop)
}

#[cfg(all(test, unix))]
/// Returns the path of a device equivalent to `/dev/{name}`: a new one in `folder` where the system allows it, so
/// that a faulty test cannot replace the machine's own.
pub(crate) fn device(folder: &Path, name: &str) -> PathBuf {
    let own = folder.join(name);
    if own.exists() {
        return own;
    }
    let minor = if name == "full" { "7" } else { "3" };
    let made = std::process::Command::new("mknod")
        .args([own.as_os_str(), "c".as_ref(), "1".as_ref(), minor.as_ref()])
        .stderr(std::process::Stdio::null())
        .status();
    let usable = made.is_ok_and(|status| status.success())
        && fs::File::options().write(true).open(&own).is_ok();
    if usable { own } else { Path::new("/dev").join(name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_finished_leaves_the_old_one() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("depths.csv");
        fs::write(&path, "old").unwrap();
        let failed = write_file(&path, |file| {
            file.write_all(b"half")?;
            Err(io::Error::other("stop"))
        });
        assert!(failed.unwrap_err().to_string().contains("depths.csv"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
        write_file(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_in_place() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let (full, null) = (device(folder.path(), "full"), device(folder.path(), "null"));
        assert!(write_file(&full, |file| file.write_all(b"x")).is_err());
        assert!(fs::metadata(&full).unwrap().file_type().is_char_device());
        write_file(&null, |file| file.write_all(b"x")).unwrap();
        assert!(fs::metadata(&null).unwrap().file_type().is_char_device());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_keeps_pointing_at_what_was_written() {
        let directory = tempfile::tempdir().unwrap();
        let (real, link) = (directory.path().join("real"), directory.path().join("link"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_file(&link, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
}
