//! Opening of input files and pipes. A pipe must have a writer soon.
//!
//! A pipe, such as `<(command)` in a shell, is accepted wherever a file is. Opening one blocks until a writer opens
//! it, and reading blocks until the next byte arrives; both have a time limit here.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use super::fault::{Error, Input, Result, line_and_column};

/// Time limit for a writer to open a pipe.
const WRITER: Duration = Duration::from_secs(5);
/// Time limit between two writes to a pipe.
const SILENCE: Duration = Duration::from_secs(60);
/// Size of a read from a pipe [bytes].
const CHUNK: usize = 1 << 16;

/// An opened file or pipe.
#[derive(Debug)]
pub enum Opened {
    /// A file, or a device.
    File(File),
    /// A pipe with a writer.
    Pipe(Pipe),
}

/// A pipe, which another thread reads.
#[derive(Debug)]
pub struct Pipe {
    chunks: Receiver<io::Result<Vec<u8>>>,
    rest: io::Cursor<Vec<u8>>,
    silence: Duration,
}

/// Opens a file or folder of the program's own, which is never a pipe.
///
/// # Errors
/// If it cannot be opened.
#[expect(clippy::disallowed_methods, reason = "the callers have looked, or wait elsewhere")]
pub(crate) fn open_own(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Opens a file or a pipe.
///
/// # Errors
/// If it cannot be opened, or no writer opens the pipe in time.
pub fn open(path: &Path) -> Result<Opened> {
    if is_pipe(path) {
        Pipe::open(path, WRITER, SILENCE).map(Opened::Pipe)
    } else {
        open_own(path).map(Opened::File).map_err(Error::io(path, "read"))
    }
}

/// Opens a regular file, for input that is read more than once or must have an end.
///
/// # Errors
/// If it cannot be opened, or is a pipe or a device.
pub fn open_file(path: &Path) -> Result<File> {
    let found = fs::metadata(path).map_err(Error::io(path, "read"))?;
    if !found.is_file() && !found.is_dir() {
        return Err(Input::new(path.display(), "expected a file, not a pipe or device").into());
    }
    open_own(path).map_err(Error::io(path, "read"))
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    fs::metadata(path).is_ok_and(|found| found.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}

impl Pipe {
    fn open(path: &Path, writer: Duration, silence: Duration) -> Result<Pipe> {
        let (send, chunks) = sync_channel(1);
        let to_open = path.to_owned();
        // If nobody ever writes, the thread waits until the program ends.
        thread::spawn(move || pump(to_open, &send));
        match chunks.recv_timeout(writer) {
            Ok(Ok(_)) => Ok(Pipe { chunks, rest: io::Cursor::default(), silence }),
            Ok(Err(error)) => Err(Error::io(path, "read")(error)),
            Err(_) => {
                let seconds = writer.as_secs_f64();
                let expected =
                    format!("is a pipe; expected somebody to write into it within {seconds} s");
                Err(Input::new(path.display(), expected).into())
            }
        }
    }
}

/// Reports that the pipe is open, and then sends its contents.
fn pump(path: PathBuf, send: &SyncSender<io::Result<Vec<u8>>>) {
    let mut file = match open_own(&path) {
        Ok(file) => file,
        Err(error) => return drop(send.send(Err(error))),
    };
    let mut sent = send.send(Ok(Vec::new()));
    while sent.is_ok() {
        let mut chunk = vec![0; CHUNK];
        sent = match file.read(&mut chunk) {
            Ok(0) => return,
            Ok(length) => {
                chunk.truncate(length);
                send.send(Ok(chunk))
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(()),
            Err(error) => return drop(send.send(Err(error))),
        };
    }
}

impl Read for Pipe {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.rest.position() == self.rest.get_ref().len() as u64 {
            let chunk = match self.chunks.recv_timeout(self.silence) {
                Ok(chunk) => chunk?,
                Err(RecvTimeoutError::Disconnected) => return Ok(0),
                Err(RecvTimeoutError::Timeout) => {
                    let seconds = self.silence.as_secs_f64();
                    let silent = format!("nothing was written into the pipe for {seconds} s");
                    return Err(io::Error::new(io::ErrorKind::TimedOut, silent));
                }
            };
            self.rest = io::Cursor::new(chunk);
        }
        self.rest.read(bytes)
    }
}

impl Read for Opened {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        match self {
            Opened::File(file) => file.read(bytes),
            Opened::Pipe(pipe) => pipe.read(bytes),
        }
    }
}

/// Byte order mark, which some editors write before a text.
const MARK: char = '\u{feff}';
/// Size limit of an input [bytes].
const LONGEST: u64 = 1 << 28;
/// Size limit of what is read of a device, which need not have an end [bytes].
const LONGEST_OF_DEVICE: u64 = 1 << 20;

/// Reads a file or a pipe of at most 256 MiB.
///
/// # Errors
/// If it cannot be read or is too long.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let file = open(path)?;
    let found = match &file {
        Opened::File(file) => Some(file.metadata().map_err(Error::io(path, "read"))?),
        Opened::Pipe(_) => None,
    };
    let is_device = found.as_ref().is_some_and(|found| !found.is_file() && !found.is_dir());
    let (longest, expected) = if is_device {
        (LONGEST_OF_DEVICE, "expected a file or a pipe; of a device at most 1 MiB is read")
    } else {
        (LONGEST, "expected 256 MiB at most")
    };
    let mut bytes = Vec::new();
    let is_longer = found.is_some_and(|found| found.len() > longest);
    if !is_longer {
        file.take(longest + 1).read_to_end(&mut bytes).map_err(Error::io(path, "read"))?;
    }
    if is_longer || bytes.len() as u64 > longest {
        return Err(Input::new(path.display(), expected).into());
    }
    Ok(bytes)
}

/// Reads a file or a pipe of at most 256 MiB as UTF-8, without the byte order mark that it may begin with.
///
/// # Errors
/// If it cannot be read, is too long, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    let mut text = String::from_utf8(read_bytes(path)?).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
        let (line, column) = line_and_column(&text, valid);
        Input::new(path.display(), "expected UTF-8 text").at(line, column)
    })?;
    if text.starts_with(MARK) {
        text.drain(..MARK.len_utf8());
    }
    Ok(text)
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    const SHORT: Duration = Duration::from_millis(200);

    fn pipe(folder: &Path) -> PathBuf {
        let path = folder.join("pipe");
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    }

    #[test]
    fn a_device_without_an_end_and_a_file_that_is_too_long_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let long = folder.path().join("long");
        fs::File::create(&long).unwrap().set_len(LONGEST + 1).unwrap();
        for (path, expected) in
            [(Path::new("/dev/zero"), "of a device at most"), (&long, "256 MiB")]
        {
            let error = read_bytes(path).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        assert_eq!(read_bytes(Path::new("/dev/null")).unwrap(), b"");
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_a_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "\u{feff}a\u{feff}").unwrap();
        assert_eq!(read_text(&path).unwrap(), "a\u{feff}");
    }

    #[test]
    fn a_pipe_that_nobody_writes_into_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = pipe(folder.path());
        let error = Pipe::open(&path, SHORT, SHORT).unwrap_err().to_string();
        assert!(error.contains("expected somebody to write into it within 0.2 s"), "{error}");
        let error = open_file(&path).unwrap_err().to_string();
        assert!(error.contains("expected a file, not a pipe"), "{error}");
    }

    #[test]
    fn a_pipe_is_read_to_its_end_and_not_waited_for_without_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = pipe(folder.path());
        let write = |script: &str| {
            let script = format!("exec > {}; {script}", path.display());
            Command::new("sh").args(["-c", &script]).spawn().unwrap()
        };
        let mut writer = write("echo one; sleep 0.05; seq 100000");
        let mut text = String::new();
        let mut opened = open(&path).unwrap();
        opened.read_to_string(&mut text).unwrap();
        assert!(text.starts_with("one\n1\n") && text.ends_with("\n100000\n"));
        assert!(writer.wait().unwrap().success());

        let mut writer = write("echo one; exec sleep 60");
        let mut opened = Pipe::open(&path, WRITER, SHORT).unwrap();
        let error = opened.read_to_string(&mut text).unwrap_err();
        assert!(error.to_string().contains("nothing was written into the pipe for 0.2 s"));
        writer.kill().unwrap();
        writer.wait().unwrap();
    }
}
