//! Streaming reader of CSV files.

use std::io::{Read, Seek};
use std::sync::atomic::AtomicBool;

use tofsim::error::{Error, Result};

use super::super::capture::Radix;
use super::digits;
use super::header::{FIXED, Header};
use super::opened::{CaptureForm, CaptureRow, CaptureRows, LONGEST_WORD, Opened, put_word};
use super::order::Order;
use super::survey::survey;
use super::table::{Table, first_lines};

/// Opens a CSV, until `stop` is set. It is read twice, because only the whole file shows which columns are numbers.
pub(super) fn open<R: Read + Seek + Send + 'static>(
    source: String,
    mut file: R,
    hint: Option<Radix>,
    stop: Option<&AtomicBool>,
) -> Result<Opened> {
    let fault = |error| Error::io(source.as_ref(), "read")(error);
    let lines = first_lines(&mut file).map_err(fault)?;
    file.rewind().map_err(fault)?;
    let mut header = Header::read(&source, &lines)?;
    let mut table = below(&source, file, &header)?;
    survey(&mut table, &mut header, hint, stop)?;
    file = table.into_inner();
    file.rewind().map_err(fault)?;
    let table = below(&source, file, &header)?;
    let form = if header.radix_row { CaptureForm::Csv } else { CaptureForm::LegacyCsv };
    let columns = header.columns.clone();
    let (radix_stated, notes) = (header.radix_row, std::mem::take(&mut header.notes));
    let rows = Box::new(CsvRows { table, header, order: Order::default() });
    Ok(Opened { form, columns, radix_stated, rows, notes })
}

/// Returns the table from the first row below the header on.
fn below<R: Read>(source: &str, file: R, header: &Header) -> Result<Table<R>> {
    let mut table = Table::new(source, file, header.delimiter);
    for _ in 0..1 + usize::from(header.radix_row) {
        table.advance()?;
    }
    Ok(table)
}

/// Rows below the header.
struct CsvRows<R> {
    table: Table<R>,
    header: Header,
    order: Order,
}

impl<R: Read + Send> CaptureRows for CsvRows<R> {
    fn next(&mut self, row: &mut CaptureRow) -> Result<bool> {
        let CsvRows { table, header, order } = self;
        let first = FIXED.len() + header.gap as usize;
        if !table.advance_to(first + header.columns.len())? {
            return Ok(false);
        }
        let cells = &table.row;
        let number = |index, most, expected: &str| match cells.number(index) {
            Some(number) if number <= most => Ok(number),
            _ => Err(cells.fault(index, expected).field(FIXED.get(index).unwrap_or(&"GAP"))),
        };
        row.sample = number(0, u64::MAX, "expected a whole number")?;
        row.in_window = number(1, u64::MAX, "expected a whole number")?;
        row.trigger = number(2, 1, "expected 0 or 1")? == 1;
        row.gap = header.gap && number(3, 1, "expected 0 or 1")? == 1;
        row.window_start = order
            .check(row.sample, row.in_window, row.trigger)
            .map_err(|(index, expected)| cells.fault(index, expected).field(FIXED[index]))?;
        row.clear(&header.columns);
        for (index, column) in header.columns.iter().enumerate() {
            let index = first + index;
            let place = column.place();
            let Some(radix) = column.radix.filter(|_| !column.text) else {
                let cell = cells.text(index)?;
                if cell.len() > LONGEST_WORD {
                    let expected = format!("expected {LONGEST_WORD} bytes at most");
                    return Err(cells.fault(index, expected).field(column.head()).into());
                }
                put_word(cell.as_bytes(), &mut row.value[place]);
                continue;
            };
            let read = digits::read(&cells.field(index), radix, column.width);
            let bits = read.map_err(|fault| {
                let expected = fault.message(radix, column.width);
                cells.fault(index, expected).field(column.head())
            })?;
            row.value[place.clone()].copy_from_slice(&bits.value);
            row.unknown[place].copy_from_slice(&bits.unknown);
        }
        Ok(true)
    }
}
