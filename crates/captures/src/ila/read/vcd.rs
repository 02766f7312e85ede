//! Reader of an archive's `waveform.vcd`, in Vivado's dialect: one flat scope, and sample numbers as times.
//!
//! It has the bits of every column, in the order of the CSV's columns, including views that System ILA derives from
//! other probes, but it ends with the last change.

use std::collections::HashMap;

use tofsim::error::{Input, Result};

use super::super::capture::Radix;
use super::buffer::Buffer;
use super::digits;
use super::header;
use super::opened::Column;

/// Names of the variables that are not probes: trigger, window, gap.
const MARKS: [&str; 3] = ["_TRIGGER", "_WINDOW", "_GAP"];

/// Largest number of samples if only the VCD determines it; Vivado's buffers have 2^17.
const DEEPEST: u64 = 1 << 20;

/// Place and width of each variable by its identifier.
type Ids<'a> = HashMap<&'a str, (usize, u32)>;

/// Contents of a file.
#[derive(Debug, Default)]
pub(super) struct Vcd {
    /// Probes.
    pub(super) columns: Vec<Column>,
    /// Changes of each probe, then of each mark: sample, and value as words.
    changes: Vec<Vec<(u64, Vec<u64>)>>,
    last: u64,
}

impl Vcd {
    /// Parses a file.
    pub(super) fn read(source: &str, text: &str) -> Result<Self> {
        let mut vcd = Vcd::default();
        let mut lines = (1..).zip(text.lines());
        let ids = vcd.declarations(source, &mut lines)?;
        vcd.changes.resize(vcd.columns.len() + MARKS.len(), Vec::new());
        vcd.changes(source, lines, &ids)?;
        Ok(vcd)
    }

    /// Parses the declarations. Returns place and width of each variable by its identifier.
    fn declarations<'a>(
        &mut self,
        source: &str,
        lines: &mut impl Iterator<Item = (usize, &'a str)>,
    ) -> Result<Ids<'a>> {
        let (mut ids, mut marks) = (Ids::new(), HashMap::new());
        for (number, line) in lines {
            let fault = |expected: &str| Input::new(source, expected).at(number, 1).value(line);
            let mut words = line.split_ascii_whitespace();
            match words.next() {
                Some("$enddefinitions") if words.clone().eq(["$end"]) => break,
                Some("$enddefinitions") => {
                    return Err(
                        fault("expected `$enddefinitions $end` on a line of its own").into()
                    );
                }
                Some("$var") => {}
                _ => continue,
            }
            let words: Vec<&str> = words.collect();
            let ["reg", width, id, name, range @ .., "$end"] = &words[..] else {
                return Err(fault("expected `$var reg WIDTH ID NAME [RANGE] $end`").into());
            };
            if let Some(mark) = MARKS.iter().position(|mark| mark == name) {
                marks.insert(*id, mark);
                continue;
            }
            let name = name.strip_prefix('\\').unwrap_or(name);
            let column =
                header::parse(&format!("{name}{}", range.concat())).map_err(|e| fault(&e))?;
            if *width != column.width.to_string() {
                return Err(fault("expected a range as wide as the variable").into());
            }
            ids.insert(id, (self.columns.len(), column.width));
            self.columns.push(column);
        }
        let probes = self.columns.len();
        ids.extend(marks.into_iter().map(|(id, mark)| (id, (probes + mark, 1))));
        Ok(ids)
    }

    /// Parses the changes.
    fn changes<'a>(
        &mut self,
        source: &str,
        lines: impl Iterator<Item = (usize, &'a str)>,
        ids: &Ids,
    ) -> Result<()> {
        let mut sample = 0;
        for (number, line) in lines {
            let fault = |expected: &str| Input::new(source, expected).at(number, 1).value(line);
            let (digits, id) = match line.as_bytes().first() {
                None | Some(b'$') => continue,
                Some(b'#') => {
                    let next = line[1..].trim().parse();
                    sample = next.map_err(|_| fault("expected the number of a sample"))?;
                    if sample < self.last {
                        return Err(fault("expected a sample after those before").into());
                    }
                    self.last = sample;
                    continue;
                }
                Some(b'b') => line[1..].trim().split_once(' ').unwrap_or_default(),
                Some(_) => line.trim().split_at_checked(1).unwrap_or_default(),
            };
            let Some(&(variable, width)) = ids.get(id) else {
                return Err(fault("expected a variable's identifier").into());
            };
            let Some(value) = bits(digits, width) else {
                return Err(fault(&format!("expected {width} bits at most, each 0 or 1")).into());
            };
            self.changes[variable].push((sample, value));
        }
        Ok(())
    }

    /// Copies a probe to the channels from `low` on; its last value extends to the end.
    pub(super) fn fill(&self, probe: usize, buffer: &mut Buffer, low: usize) {
        let changes = &self.changes[probe];
        for (k, (begin, value)) in changes.iter().enumerate() {
            let end = changes.get(k + 1).map_or(buffer.samples, |next| next.0);
            for sample in *begin..end.min(buffer.samples) {
                buffer.put(low, self.columns[probe].width, sample, value);
            }
        }
    }

    /// Returns all samples up to the last change, with the lowest channel of each probe; `None` if the size limit is
    /// exceeded.
    pub(super) fn buffer(&self) -> Option<(Buffer, Vec<usize>)> {
        let mut buffer = Buffer::default();
        if self.last >= DEEPEST {
            return None;
        }
        buffer.size(self.last + 1);
        // Each mark turns over at its samples.
        let turns = |mark: usize| {
            let changes = self.changes[self.columns.len() + mark].windows(2);
            changes.filter(|pair| pair[0].1 != pair[1].1).map(|pair| pair[1].0)
        };
        buffer.windows = [0].into_iter().chain(turns(1)).collect();
        let first = self.changes[self.columns.len()].first();
        let at_once = first.is_some_and(|(_, value)| value != &[0]).then_some(0);
        buffer.triggers = at_once.into_iter().chain(turns(0)).collect();
        let mut places = Vec::new();
        for (probe, column) in self.columns.iter().enumerate() {
            let low = buffer.add(column.width)?;
            self.fill(probe, &mut buffer, low);
            places.push(low);
        }
        Some((buffer, places))
    }
}

/// Parses binary digits; leading zeros may be missing.
fn bits(text: &str, width: u32) -> Option<Vec<u64>> {
    let bits = digits::read(text.as_bytes(), Radix::Binary, width).ok()?;
    (bits.is_known() && text.len() <= width as usize).then_some(bits.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ila::read::opened::{CaptureRow, CaptureRows};

    const HEAD: &str = "$timescale\n\t1ps\n$end\n$scope module dut $end\n\
        $var reg 3 \" \\r[1] [4:2] $end\n$var reg 1 % a/b $end\n$var reg 1 & _TRIGGER $end\n\
        $var reg 1 ' _WINDOW $end\n$var reg 1 ( _GAP $end\n$enddefinitions $end\n";

    fn fault(body: &str) -> String {
        let read = Vcd::read("a.vcd", &format!("{HEAD}{body}"));
        read.map_or_else(|error| error.to_string(), |_| "fine".to_owned())
    }

    #[test]
    fn values_marks_and_names_are_read() {
        let body =
            "#0\n$dumpvars\nb10 \"\n0%\n0&\n1'\n0(\n$end\n#1\n1&\n#3\nb101 \"\n1%\n0'\n#4\n0&\n";
        let vcd = Vcd::read("a.vcd", &format!("{HEAD}{body}").replace('\n', "\r\n")).unwrap();
        let (buffer, places) = vcd.buffer().unwrap();
        let mut columns = vcd.columns.clone();
        assert_eq!(columns.iter().map(Column::head).collect::<Vec<_>>(), ["r[1][4:2]", "a/b"]);
        super::super::opened::lay_out(&mut columns);
        let mut rows = buffer.rows(columns, places);
        let (mut row, mut found) = (CaptureRow::default(), Vec::new());
        while rows.next(&mut row).unwrap() {
            found.push((row.value[0], row.value[1], row.trigger, row.window_start));
        }
        let expected = [
            (2, 0, false, true),
            (2, 0, true, false),
            (2, 0, false, false),
            (5, 1, false, true),
            (5, 1, true, false),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        assert_eq!(fault("#0\nb101 \"\n"), "fine");
        assert!(
            fault("#0\nb1010 \"\n").starts_with("a.vcd:12:1: b1010 \": expected 3 bits at most")
        );
        assert!(fault("#0\n1!\n").ends_with("1!: expected a variable's identifier"));
        assert!(fault("#x\n").ends_with("#x: expected the number of a sample"));
        assert!(fault("#2\n#1\n").ends_with("#1: expected a sample after those before"));
        assert!(Vcd::read("a.vcd", "$var wire 1 ! a $end\n").is_err());
        assert!(Vcd::read("a.vcd", "$enddefinitions $end #0 1!\n").is_err());
        assert!(Vcd::read("a.vcd", "$var reg 2 ! a $end\n").is_err());
    }
}
