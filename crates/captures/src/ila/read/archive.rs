//! `.ila` archives: the data from the dump, names from the CSV's head or from the list of probes.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};

use zip::ZipArchive;

use tofsim::error::{Error, Input, Result};

use super::super::capture::Radix;
use super::dump::Dump;
use super::heads::Heads;
use super::opened::{CaptureForm, Column, Opened, damaged};
use super::table::first_lines;
use super::{csv, ltx};

/// Most bytes of an entry that is read in passing.
const LARGEST_ENTRY: u64 = 1 << 30;
/// Most bytes of a list of probes, which is read whole.
const LARGEST_LIST: u64 = 1 << 23;

/// Opens an archive.
pub(super) fn open(source: String, file: File, radix: Option<Radix>) -> Result<Opened> {
    let mut archive = Archive::new(source, file)?;
    let [csv, dump, list] = ["waveform.csv", "waveform.dmp", "probes.ltx"].map(|n| archive.find(n));
    let Some(dump) = dump else {
        let Some(csv) = csv else {
            let text = "expected an entry waveform.dmp or waveform.csv in the archive";
            return Err(Input::new(&archive.source, text).into());
        };
        return archive.table(csv, radix);
    };
    let dump = archive
        .entry(dump, LARGEST_ENTRY, |source, entry| Dump::read(source, BufReader::new(entry)))?;
    let (heads, source) = match (csv, list) {
        (Some(csv), _) => archive.entry(csv, LARGEST_ENTRY, |source, entry| {
            let lines = first_lines(entry).map_err(|error| damaged(source, error))?;
            Ok((Heads::read(source, &lines)?, source.to_owned()))
        })?,
        (None, Some(list)) => archive.entry(list, LARGEST_LIST, |source, entry| {
            let mut text = Vec::new();
            entry.read_to_end(&mut text).map_err(|error| damaged(source, error))?;
            let text =
                String::from_utf8(text).map_err(|_| Input::new(source, "expected UTF-8 text"))?;
            let columns = ltx::columns(source, &text, &dump.core, dump.width)?;
            Ok((Heads { columns, radix_row: false, gap: false }, source.to_owned()))
        })?,
        (None, None) => {
            let text = "expected an entry waveform.csv or probes.ltx in the archive, for the names";
            return Err(Input::new(&archive.source, text).into());
        }
    };
    let mut columns = heads.columns;
    let places = lay_out(&source, &mut columns, dump.width)?;
    for column in columns.iter_mut().filter(|column| !column.text && column.radix.is_none()) {
        column.radix = radix;
    }
    let words = columns.iter().map(Column::words).sum();
    let samples = Some(dump.samples);
    let rows = Box::new(dump.rows(columns.clone(), places));
    let radix_told = heads.radix_row;
    Ok(Opened { form: CaptureForm::Archive, columns, words, samples, radix_told, rows })
}

/// Places the columns in a row, and tells the lowest bit in the dump of each that is not text.
fn lay_out(source: &str, columns: &mut [Column], width: u32) -> Result<Vec<usize>> {
    let bits = |texts: bool| -> u64 {
        let counted = columns.iter().filter(|column| texts || !column.text);
        counted.map(|column| column.width as u64).sum()
    };
    // Nobody knows whether the words of a System ILA have bits in the dump.
    let texts = bits(true) == width as u64;
    if !texts && bits(false) != width as u64 {
        let text =
            format!("the columns have {} bits, the dump has {width} (data_width)", bits(false));
        return Err(Input::new(source, text).into());
    }
    let (mut low, mut word, mut places) = (0, 0, Vec::new());
    for column in columns {
        column.word = word;
        word += column.words();
        if !column.text {
            places.push(low);
        }
        if texts || !column.text {
            low += column.width as usize;
        }
    }
    Ok(places)
}

/// An archive being read.
struct Archive {
    source: String,
    zip: ZipArchive<File>,
}

impl Archive {
    fn new(source: String, file: File) -> Result<Self> {
        let zip = ZipArchive::new(file).map_err(|error| {
            Input::new(&source, format!("expected a whole ZIP archive: {error}"))
        })?;
        Ok(Archive { source, zip })
    }

    /// The entry of this name, in any directory.
    fn find(&self, name: &str) -> Option<usize> {
        let last = |path: &[u8]| path.rsplit(|&byte| byte == b'/').next() == Some(name.as_bytes());
        self.zip.file_names_raw().position(last)
    }

    /// Reads an entry, of which at most `limit` bytes are let through.
    fn entry<T>(
        &mut self,
        index: usize,
        limit: u64,
        read: impl FnOnce(&str, &mut dyn Read) -> Result<T>,
    ) -> Result<T> {
        let name = self.zip.file_names_raw().nth(index).unwrap_or_default();
        let source = format!("{}/{}", self.source, String::from_utf8_lossy(name));
        let entry = self.zip.by_index(index);
        let entry = entry.map_err(|error| Input::new(&source, format!("damaged: {error}")))?;
        read(&source, &mut Limited { source: &source, entry, limit, left: limit })
    }

    /// An archive that has a CSV only: it is unpacked into a temporary file and read from there.
    fn table(&mut self, csv: usize, radix: Option<Radix>) -> Result<Opened> {
        let opened = self.entry(csv, LARGEST_ENTRY, |source, entry| {
            let fault = |error| Error::io(&std::env::temp_dir(), "write")(error);
            let mut file = tempfile::tempfile().map_err(fault)?;
            let mut block = vec![0; 1 << 16];
            loop {
                let count = entry.read(&mut block).map_err(|error| damaged(source, error))?;
                if count == 0 {
                    break;
                }
                io::Write::write_all(&mut file, &block[..count]).map_err(fault)?;
            }
            file.rewind().map_err(fault)?;
            csv::open(source.to_owned(), file, radix)
        })?;
        Ok(Opened { form: CaptureForm::Archive, ..opened })
    }
}

/// An entry that may not be longer than a limit, whatever the archive says.
struct Limited<'a, R> {
    source: &'a str,
    entry: R,
    limit: u64,
    left: u64,
}

impl<R: Read> Read for Limited<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.entry.read(buffer)?;
        match self.left.checked_sub(count as u64) {
            Some(left) => self.left = left,
            None => {
                let text = format!("unpacks to more than {} bytes", self.limit);
                return Err(io::Error::other(Error::from(Input::new(self.source, text))));
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_ends_in_an_error_at_its_limit() {
        let limited = |limit| {
            let entry = &b"12345"[..];
            let mut text = String::new();
            let mut limited = Limited { source: "a.ila/x", entry, limit, left: limit };
            limited.read_to_string(&mut text).map_err(|error| damaged("a.ila/x", error).to_string())
        };
        assert_eq!(limited(5), Ok(5));
        assert_eq!(limited(4), Err("a.ila/x: unpacks to more than 4 bytes".into()));
    }
}
