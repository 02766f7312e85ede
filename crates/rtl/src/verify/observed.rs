//! Values that the bench observed, line by line, beside the expected ones.

use std::path::Path;

use tofsim::error::{Input, Result, read_text};

use crate::golden::bench::Bench;
use crate::golden::table::{Column, Table};

use super::verdict::Mismatch;

/// The lines that a bench writes with `+got=`, and what it compared them with.
#[derive(Clone, Debug)]
pub struct Observed<'a> {
    /// In hexadecimal.
    pub lines: Vec<String>,
    bench: &'a Bench<'a>,
    /// True if registers were looked at.
    registers: bool,
}

/// Cycles shown before and after the first mismatch.
const AROUND: usize = 2;
/// Inputs wider than this are not shown [bits].
const WIDEST: usize = 64;

impl<'a> Observed<'a> {
    /// From the file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(path: &Path, bench: &'a Bench<'a>, registers: bool) -> Result<Self> {
        let text = read_text(path)?;
        if text.is_empty() {
            return Err(Input::new(path.display(), "the bench has written nothing").into());
        }
        Ok(Observed { lines: text.lines().map(str::to_owned).collect(), bench, registers })
    }

    /// Returns whether the design has a column, as far as was looked.
    pub fn has(&self, column: &Column) -> bool {
        let is_absent = self.bench.allowed.absent.contains(&column.name);
        !is_absent && (self.registers || !column.internal)
    }

    /// A value as binary digits, the highest first, with x and z.
    pub fn bits(&self, row: usize, column: &Column) -> String {
        let digits = self.lines.get(row).map_or("", String::as_str).trim();
        let Column { low, width, .. } = *column;
        let (first, last) = (low / 4, (low + width).div_ceil(4));
        let Some(end) = digits.len().checked_sub(first) else { return String::new() };
        let begin = digits.len().saturating_sub(last);
        let nibble = |digit: char| match digit.to_digit(16) {
            Some(value) => format!("{value:04b}"),
            None => String::from(digit.to_ascii_lowercase()).repeat(4),
        };
        let bits: String = digits.get(begin..end).unwrap_or("").chars().map(nibble).collect();
        let end = bits.len().saturating_sub(low % 4);
        bits.get(end.saturating_sub(width)..end).unwrap_or("").to_owned()
    }

    /// Returns the expected value, as binary digits, or x where nothing is expected: before an output that
    /// comes later has come, where it means nothing, and of one that is not compared.
    pub fn wanted(&self, cycle: usize, column: &Column) -> String {
        let (vectors, allowed) = (self.bench.vectors, &self.bench.allowed);
        let row = usize::try_from(cycle as i64 - allowed.delay(&column.name)).ok();
        let row = row.filter(|row| *row < vectors.expected.rows());
        let row = row.filter(|_| !allowed.is_cut(cycle, &column.name, vectors));
        let is_valid = |row: &usize| {
            let table = |name| match name {
                "stimulus" => &vectors.stimulus,
                _ => &vectors.expected,
            };
            let valid = allowed.valid(column, vectors);
            valid.is_none_or(|valid| table(valid.table).row(*row)[valid.column.low])
        };
        match row.filter(is_valid).filter(|_| !allowed.ignored.contains(&column.name)) {
            Some(row) => binary(&vectors.expected, row, column),
            None => "x".repeat(column.width),
        }
    }

    /// Returns whether the two sides differ there, in what is compared.
    pub fn differs(&self, cycle: usize, column: &Column) -> bool {
        let (wanted, bits) = (self.wanted(cycle, column), self.bits(cycle, column));
        let compared = self.bench.allowed.bits.get(&column.name).map_or(column.width, |bits| *bits);
        let low =
            |digits: &str| digits.get(digits.len().saturating_sub(compared)..).map(str::to_owned);
        self.has(column) && !wanted.contains('x') && low(&wanted) != low(&bits)
    }

    /// The five cycles around the first mismatch, a row for each line of a table: inputs, and both
    /// sides of what differs there, below the numbers of the cycles.
    pub fn around(&self, first: &Mismatch) -> Vec<Vec<String>> {
        let vectors = self.bench.vectors;
        let begin = first.cycle.saturating_sub(AROUND);
        let cycles = begin..(first.cycle + AROUND + 1).min(self.lines.len());
        let row = |name: &str, side: &str, values: &dyn Fn(usize) -> String| {
            let head = [name.to_owned(), side.to_owned()];
            head.into_iter().chain(cycles.clone().map(values)).collect()
        };
        let mut rows: Vec<Vec<String>> = vec![row("cycle", "", &|cycle| {
            if cycle == first.cycle { format!("{cycle} *") } else { cycle.to_string() }
        })];
        for (k, column) in vectors.stimulus.columns().iter().enumerate() {
            if column.width <= WIDEST {
                rows.push(row(&column.name, "input", &|cycle| vectors.stimulus.hex(cycle, k)));
            }
        }
        for column in vectors.expected.columns() {
            if self.differs(first.cycle, column) && column.width <= WIDEST {
                let wanted = |cycle| hexadecimal(&self.wanted(cycle, column));
                rows.push(row(&column.name, "expected", &wanted));
                let got = |cycle| hexadecimal(&self.bits(cycle, column));
                rows.push(row(&column.name, "got", &got));
            }
        }
        rows
    }
}

/// A value of a line as binary digits, the highest first.
pub fn binary(table: &Table, row: usize, column: &Column) -> String {
    let bits = &table.row(row)[column.low..column.low + column.width];
    bits.iter().rev().map(|bit| if *bit { '1' } else { '0' }).collect()
}

/// Binary digits as hexadecimal ones; a digit of which a part is unknown is x.
fn hexadecimal(bits: &str) -> String {
    let padding = (4 - bits.len() % 4) % 4;
    let padded = "0".repeat(padding) + bits;
    let digit = |k: usize| {
        let nibble = &padded[4 * k..4 * k + 4];
        u8::from_str_radix(nibble, 2).map_or("x".to_owned(), |value| format!("{value:x}"))
    };
    (0..padded.len() / 4).map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::blocks;
    use crate::golden::setting::Setting;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn column(width: usize, low: usize) -> Column {
        Column { name: String::new(), width, low, sample: 0, internal: false }
    }

    #[test]
    fn a_column_is_cut_out_of_a_line_with_unknown_bits() {
        let setup = Setup::new(scenario::load(scenario::DEFAULT, &[]).unwrap()).unwrap();
        let spec = blocks::find("coarse_counter").unwrap();
        let setting = Setting { cycles: Some(9), ..Setting::new(setup) };
        let vectors = (spec.record)(spec, &setting).unwrap();
        let mut bench = Bench::new(&vectors);
        bench.allowed.delays.insert("window".to_owned(), 1);
        let lines = vec!["0x5".to_owned(), "fff".to_owned()];
        let observed = Observed { lines, bench: &bench, registers: false };
        assert_eq!(observed.bits(0, &column(6, 1)), "xxx010");
        assert_eq!(observed.bits(1, &column(3, 9)), "111");
        assert_eq!(observed.bits(7, &column(1, 0)), "");
        assert_eq!(hexadecimal("xxx010"), "xx");
        assert_eq!(hexadecimal("10101"), "15");

        let window = &vectors.expected.columns()[1];
        assert_eq!(observed.wanted(0, window), "x", "comes a clock later");
        assert_eq!(observed.wanted(1, window), binary(&vectors.expected, 0, window));
    }
}
