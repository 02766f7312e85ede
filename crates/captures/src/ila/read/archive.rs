//! Reader of `.ila` archives. Names and radices come from the head of the CSV, values from the dump, and their
//! positions in it from the list of probes. Values that the dump lacks come from the CSV or the VCD; if the dump is
//! damaged, all values do.

mod entries;
mod merge;

use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::sync::atomic::AtomicBool;

use tofsim::error::{Error, Input, Result, poll_stop};

use super::super::capture::Radix;
use super::buffer::Buffer;
use super::csv;
use super::dump::Dump;
use super::header::Header;
use super::ltx::{self, List, Placed};
use super::opened::{CaptureForm, Column, Opened, lay_out};
use super::table::first_lines;
use super::vcd::Vcd;

use entries::{Entries, LARGEST_ENTRY, text, whole};
use merge::Merge;

/// Size limit of a list of probes [bytes].
const LARGEST_LIST: u64 = 1 << 23;
/// Size limit of a VCD [bytes].
const LARGEST_VCD: u64 = 1 << 28;

/// Opens an archive, until `stop` is set.
pub(super) fn open(
    source: String,
    file: File,
    radix: Option<Radix>,
    stop: Option<&AtomicBool>,
) -> Result<Opened> {
    let (entries, notes) = Entries::open(source, file)?;
    let mut parts = Parts { entries, faults: Vec::new(), notes };
    let dump = parts.read("waveform.dmp", |source, entry| {
        Dump::read(source, BufReader::new(entry.take(LARGEST_ENTRY)))
    });
    let list = parts.read("probes.ltx", |source, entry| {
        List::read(source, &text(source, entry, LARGEST_LIST)?)
    });
    let csv = parts.read("waveform.csv", |source, entry| {
        Ok((source.to_owned(), whole(source, entry, LARGEST_ENTRY)?))
    });
    let header = csv.as_ref().and_then(|(source, bytes)| {
        let lines = first_lines(&bytes[..]).unwrap_or_default();
        parts.keep("waveform.csv", Header::read(source, &lines))
    });
    let placed = match (&list, &dump) {
        (Some(list), Some(dump)) => list.placed(&dump.core, dump.width),
        _ => None,
    };
    let radix_stated = header.as_ref().is_some_and(|header| header.radix_row);
    let has_names = header.is_some();
    let columns = header.map(|header| header.columns).or_else(|| named(placed.as_deref()));
    let Some(columns) = columns else { return parts.vcd_alone(dump.is_some()) };
    let places = places(&columns, dump.as_ref(), placed.as_deref());
    let are_all = places.iter().all(Option::is_some);
    // Without radices the digits of a CSV say less than the dump's bits.
    let csv = csv.filter(|_| has_names && (radix_stated || !are_all));
    let table = csv.and_then(|(source, bytes)| parts.table(source, bytes, radix, stop));
    poll_stop(stop)?;
    if table.is_none() && dump.is_none() {
        return parts.vcd_alone(false);
    }
    let columns = match &table {
        Some((table, _)) => table.columns.clone(),
        None => columns,
    };
    let needs_vcd = |(column, place): (&Column, &Option<usize>)| {
        place.is_none() && (column.text || table.is_none())
    };
    let vcd = columns.iter().zip(&places).any(needs_vcd).then(|| parts.vcd()).flatten();
    let width = |column: &Column| column.width;
    let vcd = vcd.filter(|vcd| vcd.columns.iter().map(width).eq(columns.iter().map(width)));
    let has_dump = dump.is_some();
    let buffer = dump.map(|dump| dump.buffer);
    let mut merge =
        Merge::new(buffer, columns, places, vcd.as_ref(), table.is_some(), &mut parts.notes);
    if let Some((table, lines)) = table {
        merge.table(table, (!has_dump).then_some(lines))?;
    }
    let (buffer, mut columns, places) = merge.finish();
    parts.add_notes((!has_dump).then_some("waveform.csv"));
    if columns.is_empty() {
        return Err(parts.nothing());
    }
    for column in columns.iter_mut().filter(|column| !column.text && column.radix.is_none()) {
        column.radix = radix;
    }
    Ok(opened(buffer, columns, places, radix_stated, parts.notes))
}

fn opened(
    buffer: Buffer,
    mut columns: Vec<Column>,
    places: Vec<usize>,
    radix_stated: bool,
    notes: Vec<String>,
) -> Opened {
    lay_out(&mut columns);
    let rows = Box::new(buffer.rows(columns.clone(), places));
    Opened { form: CaptureForm::Archive, columns, radix_stated, rows, notes }
}

/// Returns the columns of a list of probes, one for each name.
fn named(placed: Option<&[Placed]>) -> Option<Vec<Column>> {
    let mut columns: Vec<Column> = Vec::new();
    for (column, _) in placed? {
        if columns.iter().all(|other| other.head() != column.head()) {
            columns.push(column.clone());
        }
    }
    (!columns.is_empty()).then_some(columns)
}

/// Returns the lowest bit of each column in the dump: from the list of probes, or consecutively if that uses all bits
/// of the dump.
fn places(
    columns: &[Column],
    dump: Option<&Dump>,
    placed: Option<&[Placed]>,
) -> Vec<Option<usize>> {
    let Some(dump) = dump else { return vec![None; columns.len()] };
    if dump.buffer.samples == 0 {
        return vec![Some(0); columns.len()];
    }
    let bits: u64 = columns.iter().map(|column| u64::from(column.width)).sum();
    let in_order = bits == u64::from(dump.width);
    let mut next = 0;
    columns
        .iter()
        .map(|column| {
            let low = next;
            next += column.width as usize;
            let listed = placed.and_then(|placed| ltx::place(placed, column));
            listed.or(in_order.then_some(low))
        })
        .collect()
}

/// Parts of an archive, and the errors of some.
struct Parts {
    entries: Entries,
    /// Name and error of each unusable part.
    faults: Vec<(&'static str, Error)>,
    notes: Vec<String>,
}

impl Parts {
    /// Reads a part; returns `None` if it is missing or invalid.
    fn read<T>(
        &mut self,
        name: &'static str,
        read: impl FnOnce(&str, &mut dyn Read) -> Result<T>,
    ) -> Option<T> {
        let result = self.entries.part(name, read)?;
        self.keep(name, result)
    }

    /// Unwraps the result of a part, and records an error.
    fn keep<T>(&mut self, name: &'static str, result: Result<T>) -> Option<T> {
        result.map_err(|error| self.faults.push((name, error))).ok()
    }

    /// Opens the CSV, and returns it with its number of lines.
    fn table(
        &mut self,
        source: String,
        bytes: Vec<u8>,
        radix: Option<Radix>,
        stop: Option<&AtomicBool>,
    ) -> Option<(Opened, u64)> {
        let lines = bytes.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        let table = csv::open(source, Cursor::new(bytes), radix, stop);
        self.keep("waveform.csv", table).map(|table| (table, lines))
    }

    fn vcd(&mut self) -> Option<Vcd> {
        self.read("waveform.vcd", |source, entry| {
            Vcd::read(source, &text(source, entry, LARGEST_VCD)?)
        })
    }

    /// Adds notes on the parts that are not used, and on the part that replaces the dump.
    fn add_notes(&mut self, values: Option<&str>) {
        for (name, error) in self.faults.drain(..) {
            self.notes.push(format!("{name} is not used: {error}"));
        }
        if let Some(name) = values {
            self.notes.push(format!("the values are those of {name}, not of waveform.dmp"));
        }
    }

    /// Reads everything from the VCD. `nameless` states that there is a dump, but no names for its bits.
    fn vcd_alone(mut self, nameless: bool) -> Result<Opened> {
        let vcd = self.vcd();
        let Some((vcd, (buffer, places))) = vcd.and_then(|vcd| {
            let contents = vcd.buffer()?;
            (!vcd.columns.is_empty()).then_some((vcd, contents))
        }) else {
            if nameless && self.faults.is_empty() {
                let expected =
                    "expected an entry waveform.csv or probes.ltx in the archive, for the names";
                return Err(Input::new(&self.entries.source, expected).into());
            }
            return Err(self.nothing());
        };
        self.add_notes(Some("waveform.vcd"));
        self.notes.push("a VCD ends with the last change: samples after it are missing".to_owned());
        Ok(opened(buffer, vcd.columns, places, false, self.notes))
    }

    /// Returns the error for an archive without a usable part.
    fn nothing(&mut self) -> Error {
        if self.faults.is_empty() {
            let expected = "expected an entry waveform.dmp or waveform.csv in the archive";
            return Input::new(&self.entries.source, expected).into();
        }
        self.faults.swap_remove(0).1
    }
}
