//! Merging of an archive's parts: the dump, completed by the CSV and the VCD.

use std::collections::BTreeMap;

use tofsim::error::Result;

use super::super::buffer::Buffer;
use super::super::digits;
use super::super::opened::{CaptureRow, Column, Opened, word};
use super::super::vcd::Vcd;

/// Samples of an archive under construction.
pub(super) struct Merge<'a> {
    buffer: Buffer,
    columns: Vec<Merged>,
    vcd: Option<&'a Vcd>,
    /// Whether there is a CSV with usable numbers.
    has_table: bool,
    notes: &'a mut Vec<String>,
}

/// A column under construction.
struct Merged {
    column: Column,
    /// Lowest channel, once it has one.
    place: Option<usize>,
    /// Whether its bits come from another part than the CSV.
    has_bits: bool,
    /// Words that stand for several values, with the first two.
    ambiguous: BTreeMap<String, [u64; 2]>,
    /// Number of cells that differ from its bits, and the sample of the first.
    differing: (u64, u64),
}

impl<'a> Merge<'a> {
    /// Creates a merge, with the samples of a dump if there is one, and the lowest channels of the columns in it.
    pub(super) fn new(
        buffer: Option<Buffer>,
        columns: Vec<Column>,
        places: Vec<Option<usize>>,
        vcd: Option<&'a Vcd>,
        has_table: bool,
        notes: &'a mut Vec<String>,
    ) -> Self {
        let has_dump = buffer.is_some();
        let merged = |(column, place): (Column, Option<usize>)| {
            let has_bits = place.is_some();
            Merged { column, place, has_bits, ambiguous: BTreeMap::new(), differing: (0, 0) }
        };
        let columns = columns.into_iter().zip(places).map(merged).collect();
        let buffer = buffer.unwrap_or_default();
        let mut merge = Merge { buffer, columns, vcd, has_table, notes };
        if has_dump {
            merge.fill();
        }
        merge
    }

    /// Copies columns without channels from the VCD.
    fn fill(&mut self) {
        let Some(vcd) = self.vcd else { return };
        let mut filled = Vec::new();
        for (probe, merged) in self.columns.iter_mut().enumerate() {
            if merged.place.is_none()
                && (merged.column.text || !self.has_table)
                && let Some(low) = self.buffer.add(merged.column.width)
            {
                vcd.fill(probe, &mut self.buffer, low);
                (merged.place, merged.has_bits) = (Some(low), true);
                filled.push(merged.column.head());
            }
        }
        if !filled.is_empty() && self.buffer.samples > 0 {
            self.notes.push(format!("taken from waveform.vcd: {}", listed(&filled)));
        }
    }

    /// Reads the CSV: names of values, and values that no other part has. Without a dump it also determines the
    /// samples, of which there are at most `most`.
    pub(super) fn table(&mut self, mut table: Opened, most: Option<u64>) -> Result<()> {
        self.notes.append(&mut table.notes);
        if let Some(most) = most {
            self.buffer.size(most);
            self.fill();
        }
        self.add();
        let (mut row, mut count) = (CaptureRow::default(), 0);
        while table.rows.next(&mut row)? {
            if count < self.buffer.samples {
                if most.is_some() {
                    self.buffer.mark(&row, count);
                }
                self.row(&row, count);
            }
            count += 1;
        }
        if most.is_some() {
            self.buffer.samples = count;
        } else if count != self.buffer.samples {
            let samples = self.buffer.samples;
            let text = format!("waveform.csv has {count} samples, waveform.dmp {samples}");
            self.notes.push(format!("{text}; the dump has priority"));
        }
        self.disagreements();
        Ok(())
    }

    /// Adds channels for the columns that only the CSV has.
    fn add(&mut self) {
        let mut added = Vec::new();
        for merged in self.columns.iter_mut().filter(|merged| merged.place.is_none()) {
            merged.place = self.buffer.add(merged.column.bits());
            added.push(merged.column.head());
        }
        let partly = added.len() < self.columns.len();
        if !added.is_empty() && partly && self.buffer.samples > 0 {
            self.notes.push(format!("taken from waveform.csv: {}", listed(&added)));
        }
    }

    /// Processes a row of the CSV.
    fn row(&mut self, row: &CaptureRow, sample: u64) {
        for Merged { column, place, has_bits, ambiguous, differing } in &mut self.columns {
            let (Some(low), value) = (*place, &row.value[column.place()]) else { continue };
            if !*has_bits {
                self.buffer.put(low, column.bits(), sample, value);
                continue;
            }
            let mut bits = vec![0; column.width.div_ceil(64) as usize];
            self.buffer.get(low, column.width, sample, &mut bits);
            let cell = column.text.then(|| word(value));
            let same = match &cell {
                Some(cell) => column.radix.is_some_and(|radix| {
                    digits::read(cell.as_bytes(), radix, column.width)
                        .is_ok_and(|read| read.value == bits)
                }),
                None => value == bits,
            };
            // A word that is not kept, being one of too many, cannot be checked.
            let mut known = |cell: &String| {
                let Some(state) = column.states.iter_mut().find(|s| s.name == *cell) else {
                    return true;
                };
                let first = *state.bits.get_or_insert(bits[0]);
                if first != bits[0] {
                    ambiguous.entry(cell.clone()).or_insert([first, bits[0]]);
                }
                first == bits[0]
            };
            if !same && !cell.as_ref().is_some_and(&mut known) {
                *differing = (differing.0 + 1, if differing.0 == 0 { sample } else { differing.1 });
            }
        }
    }

    /// Adds notes on columns whose cells differ from their bits, and removes the values of ambiguous words.
    fn disagreements(&mut self) {
        for Merged { column, ambiguous, differing: (count, first), .. } in &mut self.columns {
            let head = column.head();
            for (word, [first, second]) in ambiguous.iter() {
                let states = column.states.iter_mut().filter(|state| state.name == *word);
                states.for_each(|state| state.bits = None);
                self.notes.push(format!(
                    "{head}: `{word}` represents both {first:#x} and {second:#x}, and is read as unknown"
                ));
            }
            let count = *count;
            if count > 0 {
                let text =
                    format!("{head}: {count} cells of waveform.csv, the first at sample {first}");
                self.notes.push(format!(
                    "{text} differ from the bits of the other parts, which have priority"
                ));
            }
        }
    }

    /// Returns the samples, the columns that have values, and their lowest channels.
    pub(super) fn finish(self) -> (Buffer, Vec<Column>, Vec<usize>) {
        let (mut columns, mut places, mut lost) = (Vec::new(), Vec::new(), Vec::new());
        for Merged { mut column, place, has_bits, .. } in self.columns {
            let Some(place) = place else {
                lost.push(column.head());
                continue;
            };
            if has_bits {
                (column.text, column.mixed) = (false, false);
                column.states.retain(|state| state.bits.is_some() && column.width <= 64);
            }
            columns.push(column);
            places.push(place);
        }
        if !lost.is_empty() {
            self.notes.push(format!("no part has the values of {}", listed(&lost)));
        }
        (self.buffer, columns, places)
    }
}

/// Formats names for a note.
fn listed(names: &[String]) -> String {
    const LISTED: usize = 8;
    let more = format!(" and {} more", names.len().saturating_sub(LISTED));
    crate::words::listed(names, LISTED, &more)
}
