//! A file that can seek, whatever stands at its path.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use crate::error::{Error, Result};
use crate::files::output::OutputFile;

/// An [`OutputFile`] that can seek. Where the target is a pipe or a device, the bytes are kept in
/// a temporary file without a name until they are all there.
pub(super) struct Spool {
    file: OutputFile,
    kept: Option<BufWriter<File>>,
}

impl Spool {
    pub(super) fn create(path: &Path) -> Result<Self> {
        let file = OutputFile::create(path)?;
        let kept = match fs::metadata(path) {
            Ok(found) if !found.is_file() => {
                let kept = tempfile::tempfile().map_err(Error::io(path, "write"))?;
                Some(BufWriter::new(kept))
            }
            _ => None,
        };
        Ok(Spool { file, kept })
    }

    fn out(&mut self) -> &mut dyn WriteSeek {
        match &mut self.kept {
            Some(kept) => kept,
            None => &mut self.file,
        }
    }

    /// Puts the finished file in place.
    pub(super) fn commit(self) -> Result<()> {
        let Spool { mut file, kept } = self;
        if let Some(kept) = kept {
            let copied =
                kept.into_inner().map_err(|error| error.into_error()).and_then(|mut all| {
                    all.rewind()?;
                    io::copy(&mut all, &mut file)
                });
            copied.map_err(|error| file.fault(error))?;
        }
        file.commit()
    }
}

impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out().flush()
    }
}

impl Seek for Spool {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.out().seek(to)
    }
}

trait WriteSeek: Write + Seek {}

impl<W: Write + Seek> WriteSeek for W {}
