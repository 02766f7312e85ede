//! VCD files of any design.

use std::io::{self, Write};
use std::path::Path;

use vcd::{IdCode, VarType};

use crate::error::Result;
use crate::files::date;
use crate::files::output::OutputFile;

use super::super::scopes::{Element, nested};
use super::signal::{Dump, DumpKind, DumpSignal, DumpValue, escaped};
use super::tables::Tables;
use super::units::unit;

/// A VCD file of any signals.
pub struct VcdDump {
    file: OutputFile,
    /// Identifier code, width and line end of each id.
    signals: Vec<VcdSignal>,
    /// Last time written.
    stamped: Option<u64>,
    /// Line under construction.
    line: Vec<u8>,
}

#[derive(Clone, Default)]
struct VcdSignal {
    code: String,
    width: u32,
}

impl VcdDump {
    /// Creates a file with signals whose ids are below `ids`; its unit is 10 to the `exponent` seconds, from -15 on, and
    /// the first of `comments` is its origin.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(
        path: &Path,
        exponent: i8,
        signals: &[DumpSignal],
        ids: usize,
        comments: &[String],
    ) -> Result<VcdDump> {
        let mut file = OutputFile::create(path)?;
        let mut known = vec![VcdSignal::default(); ids];
        let date = date::fixed()?;
        let written = header(&mut file, exponent, signals, &mut known, comments, date);
        written.map_err(|error| file.fault(error))?;
        Ok(VcdDump { file, signals: known, stamped: None, line: Vec::new() })
    }
}

/// Writes the header, and sets the identifier codes.
fn header(
    file: &mut OutputFile,
    exponent: i8,
    signals: &[DumpSignal],
    known: &mut [VcdSignal],
    comments: &[String],
    date: Option<String>,
) -> io::Result<()> {
    let mut vcd = vcd::Writer::new(file);
    if let Some(date) = date {
        vcd.date(&date)?;
    }
    vcd.version(concat!("tofsim ", env!("CARGO_PKG_VERSION")))?;
    for comment in comments {
        vcd.comment(&comment.replace("$end", "$ end"))?;
    }
    let (factor, unit) = unit(exponent);
    writeln!(vcd.writer(), "$timescale {factor} {unit} $end")?;
    let mut tables = Tables::default();
    let mut next = IdCode::FIRST;
    for element in nested(signals, DumpSignal::scopes) {
        let signal = match element {
            Element::Enter(name) => {
                vcd.add_module(&word(name))?;
                continue;
            }
            Element::Leave => {
                vcd.upscope()?;
                continue;
            }
            Element::Signal(signal) => signal,
        };
        let value_type = signal.description.as_ref().map_or("", |known| &known.value_type);
        if !value_type.is_empty() {
            writeln!(vcd.writer(), "$attrbegin misc 02 {} 0 $end", word(value_type))?;
        }
        if let Some((table, text)) = tables.of(signal) {
            if let Some(text) = text {
                writeln!(vcd.writer(), "$attrbegin misc 07 {text} {table} $end")?;
            }
            writeln!(vcd.writer(), "$attrbegin misc 07 \"\" {table} $end")?;
        }
        let known = &mut known[signal.id];
        if known.code.is_empty() {
            known.code = next.to_string();
            next = next.next();
        }
        let (kind, width) = match signal.kind {
            DumpKind::Bits(width) => (VarType::Wire, width),
            DumpKind::Real => (VarType::Real, 64),
            DumpKind::Text => (VarType::String, 1),
            DumpKind::Event => (VarType::Event, 1),
        };
        known.width = width;
        let range = signal.range_text().map_or(String::new(), |range| format!(" {range}"));
        let (code, name) = (&known.code, word(&signal.name));
        writeln!(vcd.writer(), "$var {kind} {width} {code} {name}{range} $end")?;
    }
    vcd.enddefinitions()
}

/// Returns the digit by which readers extend a value with this highest digit.
fn extension(digit: u8) -> u8 {
    if digit == b'1' { b'0' } else { digit }
}

/// Replaces blanks, which end a name.
fn word(name: &str) -> String {
    name.replace(char::is_whitespace, "_")
}

impl Dump for VcdDump {
    fn begin(&mut self, at: u64) -> io::Result<()> {
        if self.stamped == Some(at) {
            return Ok(());
        }
        self.stamped = Some(at);
        writeln!(self.file, "#{at}")
    }

    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()> {
        let VcdSignal { code, width } = &self.signals[id];
        let line = &mut self.line;
        line.clear();
        match value {
            DumpValue::Bits { value, unknown } if *width == 1 => {
                line.push(DumpValue::digit(value, unknown, 0));
            }
            DumpValue::Bits { value, unknown } => {
                line.push(b'b');
                let digit = |bit| DumpValue::digit(value, unknown, bit);
                let mut digits = *width;
                while digits > 1 && digit(digits - 1) == extension(digit(digits - 2)) {
                    digits -= 1;
                }
                line.extend((0..digits).rev().map(digit));
                line.push(b' ');
            }
            // Rust leaves out the sign of what is no number.
            DumpValue::Real(number) if number.is_nan() && number.is_sign_negative() => {
                line.extend_from_slice(b"r-NaN ");
            }
            DumpValue::Real(number) => write!(line, "r{number:?} ")?,
            DumpValue::Text(text) => write!(line, "s{} ", escaped(text))?,
            DumpValue::Event => line.push(b'1'),
        }
        line.extend_from_slice(code.as_bytes());
        line.push(b'\n');
        self.file.write_all(line)
    }

    fn finish(mut self: Box<Self>, at: u64) -> Result<()> {
        let ended = self.begin(at);
        ended.map_err(|error| self.file.fault(error))?;
        self.file.commit()
    }
}
