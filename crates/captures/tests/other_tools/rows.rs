//! Values of all columns at each instant, from a text dump and from a waveform.

use tofsim_captures::source::{Signal, SignalKind, Source};

use super::cells;
use super::files::Waveform;
use super::table::{Kind, Table};

/// Femtoseconds of a picosecond.
const PICOSECOND: u128 = 1000;
/// Position of a character that GHDL writes into an FST as a byte of Latin-1.
const LATIN: &str = "233";
/// Position of the replacement character: `wellen` reads words of an FST as UTF-8.
const LOST: &str = "65533";

/// Values of the columns after each instant that changes one of them, with its time [fs].
pub(super) type Rows = Vec<(u128, Vec<String>)>;

/// Adds a row, unless it changes nothing; the last one of an instant counts.
fn push(rows: &mut Rows, time: u128, cells: Vec<String>) {
    if rows.last().is_some_and(|(last, _)| *last == time) {
        rows.pop();
    }
    if rows.last().is_none_or(|(_, last)| *last != cells) {
        rows.push((time, cells));
    }
}

/// Returns the rows of a text dump.
pub(super) fn printed(file: &Waveform, table: &Table, held: &[(usize, &Signal)]) -> Rows {
    let mut rows = Rows::new();
    let (mut events, mut last) = (vec![0; held.len()], vec!["0"; held.len()]);
    for (time, row) in &table.rows {
        let cells = held.iter().enumerate().map(|(k, &(column, signal))| {
            let (kind, cell) = (table.columns[column].kind, row[column].as_str());
            if kind == Kind::Event {
                events[k] += usize::from(cell != std::mem::replace(&mut last[k], cell));
                return events[k].to_string();
            }
            if file.valueless == table.columns[column].title() {
                return cells::VALUELESS.to_owned();
            }
            match (kind, cell) {
                (Kind::Character, LATIN) if signal.kind == SignalKind::Text => LOST.to_owned(),
                _ => cells::printed(kind, cell, signal.width, file.digits),
            }
        });
        let cells = cells.collect();
        push(&mut rows, u128::from(*time) * PICOSECOND, cells);
    }
    rows
}

/// Returns the rows of a waveform.
pub(super) fn read(
    file: &Waveform,
    source: &Source,
    table: &Table,
    held: &[(usize, &Signal)],
) -> Rows {
    let ids: Vec<usize> = held.iter().map(|(_, signal)| signal.id).collect();
    let mut cursor = source.read(&ids).unwrap();
    let (mut rows, mut events) = (Rows::new(), vec![0; held.len()]);
    let mut touched: Vec<Option<u64>> = vec![None; held.len()];
    while let Some(at) = cursor.peek().unwrap() {
        cursor.take(|k| {
            let is_again = touched[k].replace(at) == Some(at);
            events[k] += usize::from(!is_again && (at > 0 || !file.has_first_events));
        });
        let cells = held.iter().enumerate().map(|(k, &(column, signal))| {
            let kind = table.columns[column].kind;
            if kind == Kind::Event {
                return events[k].to_string();
            }
            cells::read(kind, signal, &cursor.state, k, file.digits)
        });
        let cells = cells.collect();
        push(&mut rows, source.axis.femtoseconds(at).unwrap(), cells);
    }
    rows
}
