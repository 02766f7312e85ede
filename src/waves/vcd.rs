//! VCD files. The header is written by the crate `vcd`, and the body by hand for speed.
//!
//! State names are written as `$attrbegin` lines, an extension that Surfer reads and GTKWave ignores.

use std::io::{self, Write};
use std::path::Path;

use vcd::{IdCode, ReferenceIndex, TimescaleUnit, VarType};

use crate::error::Result;
use crate::files::date;
use crate::files::output::OutputFile;
use crate::firmware::tdc_decoder::Encoder;
use crate::hierarchy::{Entry, IDS, Kind};
use crate::kernel::Thermometer;
use crate::kernel::signals::{SignalFormat, Sink};

use super::body::{Body, Step};
use super::digits::TapDigits;
use super::scopes::{Element, elements};

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
        if let SignalFormat::State(states) = entry.signal.format
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
        let range = (width > 1).then(|| ReferenceIndex::Range(width as i32 - 1, 0));
        vcd.var_def(kind, width, code, &entry.signal.name, range)?;
        let tail = Tail::new(&format!("{}{code}\n", if width > 1 { " " } else { "" }));
        signals[entry.id] = VcdSignal { tail, width };
    }
    vcd.enddefinitions()
}

/// Returns the distinct sets of states, each with a name and the width of its codes.
fn state_tables(entries: &[Entry]) -> Vec<(String, &'static [&'static str], usize)> {
    let mut tables: Vec<(String, &[&str], usize)> = Vec::new();
    for entry in entries {
        if let SignalFormat::State(states) = entry.signal.format
            && tables.iter().all(|table| table.1 != states)
        {
            let module = entry.scope.rsplit('.').next().unwrap_or(&entry.scope);
            let name = format!("{module}_{}", entry.signal.name);
            tables.push((name, states, entry.signal.width as usize));
        }
    }
    tables
}
