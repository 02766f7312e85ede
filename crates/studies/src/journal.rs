//! Journal of a sweep: one line per finished point, from which a killed sweep resumes.
//!
//! A line is a checksum and a JSON object; the first one identifies the sweep. The checksum is that of all objects so
//! far, so that a changed, missing or repeated line is noticed. An incomplete last line is discarded. The file is
//! locked while a sweep writes to it.

use std::fs::{File, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use tofsim::error::{Error, Input, Result};
use tofsim::files::digest::digest;
use tofsim::note::Note;

use crate::table::{Cell, Row};

/// A journal that is open for appending.
pub struct Journal {
    path: PathBuf,
    written: Mutex<Written>,
}

/// The file, and the checksum of its last line.
struct Written {
    file: File,
    sum: u64,
}

/// A finished point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Cells of its row; the first one is the number of the point.
    pub cells: Vec<Cell>,
    /// Notes on its values.
    pub notes: Vec<Note>,
}

impl Entry {
    /// Returns the number of the point.
    pub fn point(&self) -> Option<u64> {
        match self.cells.first() {
            Some(Cell::Whole(point)) => Some(*point),
            _ => None,
        }
    }

    /// Converts the entry to a row.
    pub fn into_row(self) -> Option<Row> {
        Some(Row { point: self.point()?, cells: self.cells })
    }
}

/// First line of a journal.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    schema: String,
    about: String,
}

const SCHEMA: &str = "tofsim.sweep-journal/2";
/// Digits of a checksum, and the space after them.
const SUM: usize = 17;

impl Journal {
    /// Opens the journal of the sweep that `about` identifies, or creates it, and passes the number of every finished
    /// point to `take`.
    ///
    /// # Errors
    /// If it cannot be written, is locked by another process, is damaged, or belongs to another sweep.
    pub fn open(path: &Path, about: &str, mut take: impl FnMut(u64)) -> Result<Self> {
        let options = File::options().read(true).append(true).create(true).open(path);
        let file = options.map_err(Error::io(path, "write"))?;
        if !file.metadata().is_ok_and(|found| found.is_file()) {
            let expected = "expected a regular file: a sweep goes on from what it reads there";
            return Err(Input::new(path.display(), expected).into());
        }
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let expected =
                    "another sweep is writing there, expected a folder or a shard of its own";
                return Err(Input::new(path.display(), expected).into());
            }
            // A file system without locks has to do.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let head = Head { schema: SCHEMA.to_owned(), about: about.to_owned() };
        let (whole, sum) = scan(path, &file, |line, _, entry| match entry {
            Line::Head(found) if found == head => Ok(()),
            Line::Head(_) => {
                let expected = "the sweep that was begun there is another: expected the same plan, seed and version, \
                    another folder, or --restart";
                Err(Input::new(path.display(), expected).into())
            }
            Line::Entry(entry) => {
                take(entry.point().ok_or_else(|| damaged(path, line))?);
                Ok(())
            }
        })?;
        file.set_len(whole).map_err(Error::io(path, "write"))?;
        let mut written = Written { file, sum };
        if whole == 0 {
            written.add(&serde_json::json!(head)).map_err(Error::io(path, "write"))?;
        }
        Ok(Journal { path: path.to_owned(), written: Mutex::new(written) })
    }

    /// Appends a finished point.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&self, entry: &Entry) -> Result<()> {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        written.add(&serde_json::json!(entry)).map_err(Error::io(&self.path, "write"))
    }

    /// Passes all points to `take`, in order of their numbers.
    ///
    /// # Errors
    /// If the journal cannot be read, or `take` fails.
    pub fn in_order(&self, mut take: impl FnMut(Entry) -> Result<()>) -> Result<()> {
        let written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let file = &written.file;
        let mut places = Vec::new();
        scan(&self.path, file, |line, begin, entry| {
            if let Line::Entry(entry) = entry {
                places.push((entry.point().ok_or_else(|| damaged(&self.path, line))?, begin));
            }
            Ok(())
        })?;
        places.sort_unstable();
        let mut reader = BufReader::new(file);
        let mut text = String::new();
        let mut here = u64::MAX;
        for (_, begin) in places {
            let read = Error::io(&self.path, "read");
            let line = (|| {
                if here != begin {
                    reader.seek(SeekFrom::Start(begin))?;
                }
                text.clear();
                reader.read_line(&mut text)
            })();
            here = begin + line.map_err(read)? as u64;
            let entry = text.get(SUM..).and_then(|text| serde_json::from_str(text).ok());
            take(entry.ok_or_else(|| damaged(&self.path, 0))?)?;
        }
        Ok(())
    }

    /// Deletes the journal.
    pub fn remove(self) -> Result<()> {
        std::fs::remove_file(&self.path).map_err(Error::io(&self.path, "remove"))
    }
}

impl Written {
    /// Appends a line.
    fn add(&mut self, object: &serde_json::Value) -> std::io::Result<()> {
        let text = object.to_string();
        let sum = digest(self.sum, text.as_bytes());
        self.file.write_all(format!("{sum:016x} {text}\n").as_bytes())?;
        self.sum = sum;
        Ok(())
    }
}

/// A line of a journal.
enum Line {
    Head(Head),
    Entry(Entry),
}

/// Passes every complete line to `take`, with its number and offset, and returns the end and the checksum of the last
/// one.
fn scan(
    path: &Path,
    mut file: &File,
    mut take: impl FnMut(usize, u64, Line) -> Result<()>,
) -> Result<(u64, u64)> {
    file.rewind().map_err(Error::io(path, "read"))?;
    let mut reader = BufReader::new(file);
    let (mut begin, mut number, mut sum) = (0, 0, 0);
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = reader.by_ref().read_until(b'\n', &mut line).map_err(Error::io(path, "read"))?;
        if line.last() != Some(&b'\n') {
            return Ok((begin, sum));
        }
        number += 1;
        if number == 1 && line.starts_with(b"{") {
            let expected = "a journal of an earlier version, which has no checksums: expected --restart, or that version";
            return Err(Input::new(path.display(), expected).into());
        }
        let text = line.get(SUM..line.len() - 1).ok_or_else(|| damaged(path, number))?;
        sum = digest(sum, text);
        if line[..SUM] != *format!("{sum:016x} ").as_bytes() {
            return Err(damaged(path, number));
        }
        let parsed = match number {
            1 => serde_json::from_slice(text).map(Line::Head),
            _ => serde_json::from_slice(text).map(Line::Entry),
        };
        take(number, begin, parsed.map_err(|_| damaged(path, number))?)?;
        begin += read as u64;
    }
}

fn damaged(path: &Path, line: usize) -> Error {
    let expected = "damaged: the line does not match its checksum; expected the journal as the sweep left it, or \
        --restart";
    Input::new(path.display(), expected).at(line.max(1), 1).into()
}

#[cfg(test)]
mod tests;
