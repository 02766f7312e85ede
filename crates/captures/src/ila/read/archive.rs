//! `.ila` archives: the data from the dump, names from the CSV's head or from the list of probes.

use std::fs::File;
use std::io::{BufReader, Cursor, Read};

use zip::ZipArchive;
use zip::read::ZipFile;

use tofsim::error::{Input, Result};

use super::super::capture::Radix;
use super::dump::Dump;
use super::heads::Heads;
use super::opened::{CaptureForm, Column, Opened, damaged};
use super::table::first_lines;
use super::{csv, ltx};

/// Most bytes of an entry that are read.
const LARGEST_ENTRY: u64 = 1 << 30;
/// Most bytes of a list of probes.
const LARGEST_LIST: u64 = 1 << 23;

/// Opens an archive.
pub(super) fn open(source: String, file: File, radix: Option<Radix>) -> Result<Opened> {
    let zip = ZipArchive::new(file)
        .map_err(|error| Input::new(&source, format!("expected a whole ZIP archive: {error}")))?;
    let mut archive = Archive { source, zip };
    let [csv, dump, list] = ["waveform.csv", "waveform.dmp", "probes.ltx"].map(|n| archive.find(n));
    let Some(dump) = dump else {
        let Some(csv) = csv else {
            let text = "expected an entry waveform.dmp or waveform.csv in the archive";
            return Err(Input::new(&archive.source, text).into());
        };
        let (source, entry) = archive.entry(csv)?;
        let bytes = whole(&source, entry, LARGEST_ENTRY)?;
        let opened = csv::open(source, Cursor::new(bytes), radix)?;
        return Ok(Opened { form: CaptureForm::Archive, ..opened });
    };
    let (source, entry) = archive.entry(dump)?;
    let dump = Dump::read(&source, BufReader::new(entry.take(LARGEST_ENTRY)))?;
    let (heads, source) = if let Some(csv) = csv {
        let (source, entry) = archive.entry(csv)?;
        let lines = first_lines(entry).map_err(|error| damaged(&source, error))?;
        (Heads::read(&source, &lines)?, source)
    } else if let Some(list) = list {
        let (source, entry) = archive.entry(list)?;
        let text = String::from_utf8(whole(&source, entry, LARGEST_LIST)?)
            .map_err(|_| Input::new(&source, "expected UTF-8 text"))?;
        let columns = ltx::columns(&source, &text, &dump.core, dump.width)?;
        (Heads { columns, radix_row: false, gap: false }, source)
    } else {
        let text = "expected an entry waveform.csv or probes.ltx in the archive, for the names";
        return Err(Input::new(&archive.source, text).into());
    };
    let mut columns = heads.columns;
    let places = lay_out(&source, &mut columns, dump.width)?;
    for column in columns.iter_mut().filter(|column| !column.text && column.radix.is_none()) {
        column.radix = radix;
    }
    let rows = Box::new(dump.rows(columns.clone(), places));
    let radix_told = heads.radix_row;
    Ok(Opened { form: CaptureForm::Archive, columns, radix_told, rows })
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
    /// The entry of this name, in any directory.
    fn find(&self, name: &str) -> Option<usize> {
        let last = |path: &[u8]| path.rsplit(|&byte| byte == b'/').next() == Some(name.as_bytes());
        self.zip.file_names_raw().position(last)
    }

    /// An entry, and what it is called.
    fn entry(&mut self, index: usize) -> Result<(String, ZipFile<'_, File>)> {
        let name = self.zip.file_names_raw().nth(index).unwrap_or_default();
        let source = format!("{}/{}", self.source, String::from_utf8_lossy(name));
        match self.zip.by_index(index) {
            Ok(entry) => Ok((source, entry)),
            Err(error) => Err(Input::new(source, format!("damaged: {error}")).into()),
        }
    }
}

/// All of an entry, which may not be longer than a limit, whatever the archive says.
fn whole(source: &str, entry: impl Read, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut entry = entry.take(limit + 1);
    entry.read_to_end(&mut bytes).map_err(|error| damaged(source, error))?;
    match bytes.len() as u64 > limit {
        true => Err(Input::new(source, format!("unpacks to more than {limit} bytes")).into()),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_ends_in_an_error_at_its_limit() {
        let limited =
            |limit| whole("a.ila/x", &b"12345"[..], limit).map_err(|error| error.to_string());
        assert_eq!(limited(5), Ok(b"12345".to_vec()));
        assert_eq!(limited(4), Err("a.ila/x: unpacks to more than 4 bytes".into()));
    }
}
