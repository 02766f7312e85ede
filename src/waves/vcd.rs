//! VCD files. The header is written by the crate `vcd`, and the body by hand for speed.
//!
//! State names, units and places in the Verilog are written as `$attrbegin` lines, an extension that Surfer reads and
//! GTKWave ignores.

use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;

use vcd::{IdCode, ReferenceIndex, TimescaleUnit, VarType};

use crate::error::Result;
use crate::files::date;
use crate::files::output::OutputFile;
use crate::firmware::tdc_decoder::Encoder;
use crate::hierarchy::{Entry, IDS, Kind};
use crate::kernel::Thermometer;
use crate::kernel::signals::{Sink, Unit};

use super::body::{Body, Step};
use super::digits::TapDigits;
use super::scopes::{Element, elements};
use super::sources::ScopeSources;
use super::states::StateTables;

mod text;

use text::{Tail, Text};

/// A VCD file being written.
pub(super) struct Vcd {
    file: OutputFile,
    /// Text that has not been written to the file yet.
    text: Text,
    /// Signal of each id; one that is not selected has width 0 and an empty tail.
    signals: Box<[VcdSignal; IDS]>,
    taps: TapDigits,
    /// Last time written; at first a time that never occurs [ps].
    stamped: u64,
}

#[derive(Clone, Copy, Default)]
struct VcdSignal {
    /// End of a value line: a space if the signal is a vector, the identifier code, and a line feed.
    tail: Tail,
    /// Width [bits].
    width: u32,
}

impl Vcd {
    pub(super) fn create(
        path: &Path,
        entries: &[Entry],
        encoder: &Encoder,
        provenance: &[String],
    ) -> Result<Self> {
        let mut signals = Box::new([VcdSignal::default(); IDS]);
        let mut file = OutputFile::create(path)?;
        let date = date::fixed()?;
        header(&mut file, entries, &mut signals[..], provenance, date)
            .map_err(|error| file.fault(error))?;
        let longest = signals.iter().map(|signal| 1 + signal.width as usize + signal.tail.len());
        let text = Text::new(longest.sum());
        Ok(Vcd { file, text, signals, taps: TapDigits::new(encoder), stamped: u64::MAX })
    }
}

impl Sink for Vcd {
    #[inline(always)]
    fn word(&mut self, id: usize, value: u64) {
        let signal = &self.signals[id];
        if signal.width > 1 {
            self.text.number(value & u64::MAX >> (64 - signal.width), signal.tail);
        } else {
            self.text.bit(value, signal.tail);
        }
    }

    #[inline(always)]
    fn bit(&mut self, id: usize, value: bool) {
        self.text.bit(value.into(), self.signals[id].tail);
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        let signal = &self.signals[id];
        if signal.width == 0 {
            return;
        }
        match self.taps.in_order() {
            Some(count) if group == 1 => self.text.taps(value, count, signal.tail),
            _ => self.text.vector(self.taps.bits(value, group).words, signal.tail),
        }
    }
}

impl Body for Vcd {
    /// Length of the text before the step and before its values, its time and its kind.
    type Begun = (usize, usize, u64, Step);

    #[inline(always)]
    fn begin(&mut self, at: u64, step: Step) -> Self::Begun {
        let before = self.text.len;
        if self.stamped != at {
            self.text.stamp(at);
        }
        let empty = self.text.len;
        match step {
            Step::Start => self.text.push(b"$dumpvars\n"),
            Step::Open => self.text.push(b"$dumpon\n"),
            Step::Close => self.text.push(b"$dumpoff\n"),
            Step::Change | Step::Clocks => {}
        }
        (before, empty, at, step)
    }

    #[inline(always)]
    fn end(&mut self, (before, empty, at, step): Self::Begun) -> io::Result<()> {
        if !matches!(step, Step::Change | Step::Clocks) {
            self.text.push(b"$end\n");
        }
        if self.text.len == empty {
            self.text.len = before;
            return Ok(());
        }
        self.stamped = at;
        if self.text.is_full() { self.text.write(&mut self.file) } else { Ok(()) }
    }

    fn unknown(&mut self) {
        for signal in self.signals.iter().filter(|signal| signal.width > 0) {
            self.text.unknown(signal.width > 1, signal.tail);
        }
    }

    fn finish(mut self, at: u64) -> Result<()> {
        if self.stamped != at {
            self.text.stamp(at);
        }
        self.text.write(&mut self.file).map_err(|error| self.file.fault(error))?;
        self.file.commit()
    }
}

fn header(
    file: &mut OutputFile,
    entries: &[Entry],
    signals: &mut [VcdSignal],
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
    let (mut sources, tables) = (ScopeSources::default(), StateTables::of(entries));
    for (table, text) in tables.texts() {
        attribute(&mut vcd, 7, text, table)?;
    }
    let mut codes: Vec<Option<IdCode>> = vec![None; signals.len()];
    let mut next = IdCode::FIRST;
    for element in elements(entries) {
        let entry = match element {
            Element::Enter(name) => {
                let source = sources.enter(name);
                for (path, text) in source.paths {
                    attribute(&mut vcd, 3, text, path)?;
                }
                for (kind, stem) in [(4, source.declared), (5, source.instantiated)] {
                    stem.map_or(Ok(()), |(path, line)| attribute(&mut vcd, kind, path, line))?;
                }
                vcd.add_module(name)?;
                continue;
            }
            Element::Leave => {
                sources.leave();
                vcd.upscope()?;
                continue;
            }
            Element::Signal(entry) => entry,
        };
        if entry.signal.fraction() > 0 || entry.signal.unit != Unit::default() {
            let no_type_of_vhdl = 0;
            attribute(&mut vcd, 2, entry.signal.type_text(), no_type_of_vhdl)?;
        }
        if let Some(table) = tables.number(&entry.signal) {
            attribute(&mut vcd, 7, "\"\"", table)?;
        }
        let code = *codes[entry.id].get_or_insert_with(|| {
            let code = next;
            next = next.next();
            code
        });
        let kind = if entry.kind == Kind::Internal { VarType::Reg } else { VarType::Wire };
        let width = entry.signal.width;
        let range = (width > 1).then(|| ReferenceIndex::Range(width as i32 - 1, 0));
        vcd.var_def(kind, width, code, &entry.signal.name, range)?;
        let tail = Tail::new(&format!("{}{code}\n", if width > 1 { " " } else { "" }));
        signals[entry.id] = VcdSignal { tail, width };
    }
    vcd.enddefinitions()
}

/// Writes an attribute: a kind as in FST, and what it has.
fn attribute(
    vcd: &mut vcd::Writer<&mut OutputFile>,
    kind: u8,
    what: impl Display,
    value: impl Display,
) -> io::Result<()> {
    writeln!(vcd.writer(), "$attrbegin misc {kind:02} {what} {value} $end")
}
