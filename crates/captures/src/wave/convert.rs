//! Conversion of a waveform to VCD, FST, CSV and WaveJSON.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use tofsim::error::{Error, Input, Result};
use tofsim::waves::dump::{Dump, DumpKind, DumpSignal, DumpState, DumpValue, FstDump, VcdDump};

use crate::ila::read::{NamedValue, word};
use crate::source::{Axis, Signal, SignalKind, Source, is_shortened};

use super::columns::Columns;
use super::csv::CsvDump;
use super::excerpt::{Chosen, Excerpt, Instant};
use super::json::WaveJson;
use super::values::has_value;

/// Format of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputFormat {
    /// Value change dump.
    Vcd,
    /// GTKWave's compressed format.
    Fst,
    /// A row for each instant, a column for each signal.
    Csv,
    /// WaveDrom's timing diagrams.
    WaveJson,
}

impl OutputFormat {
    /// Returns the format that a file's ending stands for.
    ///
    /// # Errors
    /// If it stands for none.
    pub fn of(path: &Path) -> Result<OutputFormat> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Ok(match &ending[..] {
            "vcd" => OutputFormat::Vcd,
            "fst" => OutputFormat::Fst,
            "csv" => OutputFormat::Csv,
            "json" | "wavejson" => OutputFormat::WaveJson,
            _ => {
                let expected = "expected a name that ends in .vcd, .fst, .csv or .json (WaveJSON)";
                return Err(Input::new("--output", expected).value(path.display()).into());
            }
        })
    }
}

/// Begins the comment with the origin of a converted file.
const ORIGIN: &str = "converted from ";
/// Begins the record of a command, from which `tofsim rerun` makes a file again.
const RECORD: &str = "tofsim-record ";
/// Units of time below a second.
const FEMTOSECOND: i8 = -15;

/// Writes an excerpt of a source to a file, and returns its end in units of the source.
///
/// # Errors
/// If the source cannot be read, the file cannot be written, or the format cannot have a value.
pub fn convert(source: &Source, excerpt: &Excerpt, path: &Path) -> Result<u64> {
    let format = OutputFormat::of(path)?;
    let chosen = excerpt.of(source)?;
    let (exponent, factor) = match source.axis {
        Axis::Time(tick) => tick.decimal(),
        Axis::Samples if matches!(format, OutputFormat::Vcd | OutputFormat::Fst) => {
            let expected = "is a capture without times, which VCD and FST need: expected a name \
                that ends in .csv or .json";
            return Err(Input::new("--output", expected).value(path.display()).into());
        }
        Axis::Samples => (0, 1),
    };
    if exponent < FEMTOSECOND && format == OutputFormat::Vcd {
        let expected = format!("has times of 1e{exponent} s, and VCD's are 1 fs or more");
        return Err(Input::new(&source.name, expected).into());
    }
    // A record of another file's command is none of this one's.
    let own = source.comments.iter().filter(|text| !text.starts_with(ORIGIN));
    let own = own.map(|text| text.replace(RECORD, "record "));
    let comments: Vec<_> = [format!("{ORIGIN}{}", source.name)].into_iter().chain(own).collect();
    let mut dump: Box<dyn Dump> = match format {
        OutputFormat::Vcd => {
            let signals = declared(&chosen);
            Box::new(VcdDump::create(path, exponent, &signals, chosen.len(), &comments)?)
        }
        OutputFormat::Fst => {
            let signals = declared(&chosen);
            Box::new(FstDump::create(path, exponent, &signals, chosen.len(), &comments)?)
        }
        OutputFormat::Csv => Box::new(CsvDump::create(path, Columns::new(&chosen, source))?),
        OutputFormat::WaveJson => Box::new(WaveJson::create(path, Columns::new(&chosen, source))?),
    };
    let firsts = chosen.firsts();
    let scaled = |at: u64| {
        let expected = "has times beyond 2^64 units";
        at.checked_mul(factor).ok_or_else(|| Error::from(Input::new(&source.name, expected)))
    };
    let end = chosen.read(|instant| {
        let at = scaled(instant.at)?;
        let begun = dump.begin(at);
        begun.map_err(Error::io(path, "write"))?;
        instant
            .changed
            .iter()
            .try_for_each(|&place| put(&mut *dump, path, source, firsts[place], place, instant))
    })?;
    dump.finish(scaled(end)?)?;
    Ok(end)
}

/// Writes a change of a signal.
fn put(
    dump: &mut dyn Dump,
    path: &Path,
    source: &Source,
    signal: &Signal,
    place: usize,
    instant: &Instant,
) -> Result<()> {
    let (value, unknown) = (instant.state.value(place), instant.state.unknown(place));
    let text;
    let value = match signal.kind {
        SignalKind::Bits => DumpValue::Bits { value, unknown },
        SignalKind::Event => DumpValue::Event,
        _ if !has_value(signal, unknown) => return Ok(()),
        SignalKind::Real => DumpValue::Real(f64::from_bits(value[0])),
        SignalKind::Text | SignalKind::Other => {
            text = word(value);
            if is_shortened(&text) {
                let expected = format!(
                    "expected a text of 128 bytes at most at {}; `tofsim wave cut --ignore` leaves \
                     the signal out",
                    source.axis.place_text(instant.at)
                );
                let fault = Input::new(&source.name, expected).field(&signal.name.text);
                return Err(fault.value(text).into());
            }
            DumpValue::Text(&text)
        }
    };
    dump.change(place, value).map_err(Error::io(path, "write"))
}

/// Returns the signals as a waveform declares them. Those that share their states do so in the output, too.
fn declared(chosen: &Chosen) -> Vec<DumpSignal> {
    let firsts = chosen.firsts();
    let mut tables: HashMap<*const NamedValue, Arc<[DumpState]>> = HashMap::new();
    let mut of = |signal: &Signal| {
        let named = signal.words.states.iter().filter(|_| signal.kind == SignalKind::Bits);
        let states = || named.filter_map(|state| Some((state.name.clone(), state.bits?))).collect();
        Arc::clone(tables.entry(signal.words.states.as_ptr()).or_insert_with(states))
    };
    let declare = |&(signal, id): &(&Signal, usize)| {
        // All names of a signal are of one type: that of the first.
        let kind = match firsts[id].kind {
            SignalKind::Bits => DumpKind::Bits(firsts[id].width),
            SignalKind::Real => DumpKind::Real,
            SignalKind::Text => DumpKind::Text,
            SignalKind::Event | SignalKind::Other => DumpKind::Event,
        };
        let (scopes, name, range) = (Arc::clone(&signal.scopes), signal.own.clone(), signal.range);
        let (states, description) = (of(signal), signal.description.clone());
        DumpSignal { scopes, name, range, kind, states, description, id }
    };
    chosen.names.iter().map(declare).collect()
}
