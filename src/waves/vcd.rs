//! VCD files: the header by the crate `vcd`, the body by hand, for speed.
//!
//! The state names of state machines go in as `$attrbegin` lines, an extension that Surfer reads
//! and GTKWave skips.

use std::io::{self, Write};
use std::path::Path;

use vcd::{IdCode, ReferenceIndex, TimescaleUnit, VarType};

use crate::error::{Error, Result};
use crate::hierarchy::{Entry, IDS, Kind};
use crate::kernel::Thermometer;
use crate::kernel::signals::{Format, Sink};
use crate::output::OutputFile;

use super::digits::{TapDigits, of_word};
use super::scopes::{Element, elements};
use super::{Body, Step, date};

/// Bytes gathered before they go to the file.
const BLOCK: usize = 1 << 16;

/// A VCD file being written.
pub(super) struct Vcd {
    file: OutputFile,
    /// What is not in the file yet.
    text: Vec<u8>,
    /// By id; what is not selected is `None`.
    signals: Vec<Option<Signal>>,
    taps: TapDigits,
    /// Last time written, if any [ps].
    stamped: Option<u64>,
}

struct Signal {
    /// What follows a value: a space if it is a vector, the identifier code, the end of the line.
    tail: Box<[u8]>,
    vector: bool,
}

impl Vcd {
    /// Begins a file.
    pub(super) fn create(
        path: &Path,
        entries: &[Entry],
        order: &[u16],
        provenance: &[String],
    ) -> Result<Self> {
        let mut signals: Vec<Option<Signal>> = (0..IDS).map(|_| None).collect();
        let mut file = OutputFile::create(path)?;
        let date = date::fixed()?;
        header(&mut file, entries, &mut signals, provenance, date)
            .map_err(|error| file.fault(error))?;
        let text = Vec::with_capacity(2 * BLOCK);
        Ok(Vcd { file, text, signals, taps: TapDigits::new(order), stamped: None })
    }

    fn stamp(&mut self, at: u64) {
        let mut digits = [b'0'; 20];
        let (mut rest, mut first) = (at, digits.len());
        while rest > 0 || first == digits.len() {
            first -= 1;
            digits[first] += (rest % 10) as u8;
            rest /= 10;
        }
        self.text.push(b'#');
        self.text.extend_from_slice(&digits[first..]);
        self.text.push(b'\n');
    }

    fn write(&mut self) -> io::Result<()> {
        self.file.write_all(&self.text)?;
        self.text.clear();
        Ok(())
    }
}

impl Sink for Vcd {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        let Some(signal) = &self.signals[id] else { return };
        if signal.vector {
            self.text.push(b'b');
            push_number(&mut self.text, &of_word(value));
        } else {
            self.text.push(b'0' + (value & 1) as u8);
        }
        self.text.extend_from_slice(&signal.tail);
    }

    fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
        let Some(signal) = &self.signals[id] else { return };
        self.text.push(b'b');
        push_number(&mut self.text, self.taps.of(value));
        self.text.extend_from_slice(&signal.tail);
    }
}

/// Appends binary digits without leading zeros, but for one if they all are.
#[inline]
fn push_number(text: &mut Vec<u8>, digits: &[u8]) {
    let last = digits.len() - 1;
    let first = digits[..last].iter().position(|&digit| digit != b'0').unwrap_or(last);
    text.extend_from_slice(&digits[first..]);
}

impl Body for Vcd {
    #[inline]
    fn step(&mut self, at: u64, step: Step, fill: impl FnOnce(&mut Self)) -> io::Result<()> {
        let begin = self.text.len();
        if self.stamped != Some(at) {
            self.stamp(at);
        }
        let empty = self.text.len();
        match step {
            Step::Start => self.text.extend_from_slice(b"$dumpvars\n"),
            Step::Open => self.text.extend_from_slice(b"$dumpon\n"),
            Step::Close => self.text.extend_from_slice(b"$dumpoff\n"),
            Step::Change => {}
        }
        fill(self);
        if step != Step::Change {
            self.text.extend_from_slice(b"$end\n");
        }
        if self.text.len() == empty {
            self.text.truncate(begin);
            return Ok(());
        }
        self.stamped = Some(at);
        if self.text.len() < BLOCK { Ok(()) } else { self.write() }
    }

    fn unknown(&mut self) {
        for signal in self.signals.iter().flatten() {
            let value: &[u8] = if signal.vector { b"bx" } else { b"x" };
            self.text.extend_from_slice(value);
            self.text.extend_from_slice(&signal.tail);
        }
    }

    fn finish(mut self, at: u64) -> Result<()> {
        if self.stamped != Some(at) {
            self.stamp(at);
        }
        self.write().map_err(|error| self.file.fault(error))?;
        self.file.commit()
    }

    fn fault(&self, source: io::Error) -> Error {
        self.file.fault(source)
    }
}

fn header(
    file: &mut OutputFile,
    entries: &[Entry],
    signals: &mut [Option<Signal>],
    provenance: &[String],
    date: Option<String>,
) -> io::Result<()> {
    let mut vcd = vcd::Writer::new(file);
    if let Some(date) = date {
        vcd.date(&date)?;
    }
    vcd.version(concat!("tofsim ", env!("CARGO_PKG_VERSION")))?;
    for line in provenance {
        vcd.comment(&line.replace("$end", "$ end"))?;
    }
    vcd.timescale(1, TimescaleUnit::PS)?;
    let tables = state_tables(entries);
    for (table, (name, states, width)) in tables.iter().enumerate() {
        let codes: Vec<_> = (0..states.len()).map(|code| format!("{code:0width$b}")).collect();
        let (count, labels, codes) = (states.len(), states.join(" "), codes.join(" "));
        writeln!(
            vcd.writer(),
            "$attrbegin misc 07 {name} {count} {labels} {codes} {} $end",
            table + 1
        )?;
    }
    let mut codes: Vec<Option<IdCode>> = vec![None; signals.len()];
    let mut next = IdCode::FIRST;
    for element in elements(entries) {
        let entry = match element {
            Element::Enter(name) => {
                vcd.add_module(name)?;
                continue;
            }
            Element::Leave => {
                vcd.upscope()?;
                continue;
            }
            Element::Signal(entry) => entry,
        };
        if let Format::State(states) = entry.signal.format
            && let Some(table) = tables.iter().position(|table| table.1 == states)
        {
            writeln!(vcd.writer(), "$attrbegin misc 07 \"\" {} $end", table + 1)?;
        }
        let code = *codes[entry.id].get_or_insert_with(|| {
            let code = next;
            next = next.next();
            code
        });
        let kind = if entry.kind == Kind::Internal { VarType::Reg } else { VarType::Wire };
        let width = entry.signal.width;
        let vector = width > 1;
        let range = vector.then(|| ReferenceIndex::Range(width as i32 - 1, 0));
        vcd.var_def(kind, width, code, &entry.signal.name, range)?;
        let tail = format!("{}{code}\n", if vector { " " } else { "" });
        signals[entry.id] = Some(Signal { tail: tail.into_bytes().into(), vector });
    }
    vcd.enddefinitions()
}

/// The different sets of states, each with a name and the width of its codes.
fn state_tables(entries: &[Entry]) -> Vec<(String, &'static [&'static str], usize)> {
    let mut tables: Vec<(String, &[&str], usize)> = Vec::new();
    for entry in entries {
        if let Format::State(states) = entry.signal.format
            && tables.iter().all(|table| table.1 != states)
        {
            let module = entry.scope.rsplit('.').next().unwrap_or(&entry.scope);
            let name = format!("{module}_{}", entry.signal.name);
            tables.push((name, states, entry.signal.width as usize));
        }
    }
    tables
}
