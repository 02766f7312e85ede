//! Checksum of a whole Parquet file, in the file's own metadata.
//!
//! Checksums of pages do not cover what says where the pages are and what their columns mean. The value of [`KEY`] is
//! the CRC-32 of all bytes of the file, computed with zeros in its own place. Files without it are read unchecked:
//! those of other programs and of earlier versions have none.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};

use crc32fast::Hasher;
use parquet::file::metadata::KeyValue;

use tofsim::files::output::OutputFile;

/// Key of the checksum in the file's metadata.
const KEY: &str = "tofsim.crc32";
/// Value while the checksum is computed, of the same length.
const BLANK: &str = "00000000";
/// Bytes between key and value: type of the field and length of the value.
const BETWEEN: [u8; 2] = [0x18, BLANK.len() as u8];
/// Bytes after the footer: its length and the magic number.
const END: u64 = 8;

/// Output of a Parquet writer, whose checksum is computed on the way.
pub struct Checksummed {
    file: OutputFile,
    sum: Hasher,
    /// Bytes that are kept back, because the checksum goes among them.
    tail: Option<Vec<u8>>,
}

impl Checksummed {
    /// Begins a file.
    pub fn new(file: OutputFile) -> Self {
        Checksummed { file, sum: Hasher::new(), tail: None }
    }

    /// Returns the file.
    pub fn file(&self) -> &OutputFile {
        &self.file
    }

    /// Keeps the following bytes, which end the file, back until [`Checksummed::finish`]. The metadata among them must
    /// have the returned entry.
    pub fn begin_footer(&mut self) -> KeyValue {
        self.tail = Some(Vec::new());
        KeyValue::new(KEY.to_owned(), BLANK.to_owned())
    }

    /// Writes the bytes that were kept back, with the checksum.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn finish(mut self) -> io::Result<OutputFile> {
        let mut tail = self.tail.take().unwrap_or_default();
        self.sum.update(&tail);
        if let Some(place) = place(&tail) {
            let sum = format!("{:08x}", self.sum.finalize());
            tail[place..][..BLANK.len()].copy_from_slice(sum.as_bytes());
        }
        self.file.write_all(&tail)?;
        Ok(self.file)
    }
}

impl Write for Checksummed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(tail) = &mut self.tail {
            return tail.write(bytes);
        }
        let written = self.file.write(bytes)?;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Returns whether the file has no checksum, or the right one.
///
/// # Errors
/// If the file cannot be read.
pub(super) fn is_intact(file: &mut File) -> io::Result<bool> {
    let length = file.metadata()?.len();
    let Some(end) = length.checked_sub(END) else { return Ok(true) };
    let mut footer = [0; 4];
    file.seek(SeekFrom::Start(end))?;
    file.read_exact(&mut footer)?;
    let begin = end.saturating_sub(u32::from_le_bytes(footer).into());
    let mut tail = Vec::new();
    file.seek(SeekFrom::Start(begin))?;
    file.read_to_end(&mut tail)?;
    file.rewind()?;
    let Some(place) = place(&tail) else { return Ok(true) };
    let value = &mut tail[place..][..BLANK.len()];
    let stated = String::from_utf8_lossy(value).into_owned();
    value.copy_from_slice(BLANK.as_bytes());
    let mut sum = Summed(Hasher::new());
    io::copy(&mut BufReader::with_capacity(1 << 16, &mut *file).take(begin), &mut sum)?;
    sum.0.update(&tail);
    file.rewind()?;
    Ok(stated == format!("{:08x}", sum.0.finalize()))
}

/// Returns the place of the checksum among the last bytes of a file.
fn place(tail: &[u8]) -> Option<usize> {
    let before = [KEY.as_bytes(), &BETWEEN].concat();
    let found =
        tail.windows(before.len() + BLANK.len()).rposition(|part| part.starts_with(&before));
    found.map(|begin| begin + before.len())
}

/// Output that only computes the checksum.
struct Summed(Hasher);

impl Write for Summed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
