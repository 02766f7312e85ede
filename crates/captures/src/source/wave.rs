//! VCD and FST files, read by the crate `wellen`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use wellen::stream::{Filter, StreamError, StreamingWaveform};
use wellen::{Hierarchy, SignalEncoding, SignalRef, SignalValueRef, Var};

use tofsim::error::{Error, Input, Result};
use tofsim::waves::dump::SignalDescription;

use crate::ila::read::LONGEST_WORD;
use crate::words::Bits;

use super::bytes::Bytes;
use super::end::{Body, body};
use super::fst;
use super::fst::Comments;
use super::guard::{DAMAGED, guarded};
use super::head::{Head, HeadWords};
use super::library::{fault, set};
use super::locate::located;
use super::marks::{Marking, Style};
use super::names::Name;
use super::opened::{Opened, open};
use super::signals::{self, Axis, Signal, SignalKind, Source, SourceFormat, WIDEST, Words};
use super::span::Fault;
use super::spliced::Piece;
use super::stream::{Cursor, Disconnected, Feed};
use super::tables::Tables;
use super::tick::Tick;
use super::variables::{joined, variables};

/// Width of a number of events [bits].
const EVENTS: u32 = 32;

/// Note on a file without a time scale, such as a VCD of Yosys; GTKWave reads it in nanoseconds too.
const UNSCALED: &str = "has no $timescale: times are read as nanoseconds";

/// Path and format of a waveform.
#[derive(Clone, Debug)]
struct WaveOrigin {
    path: PathBuf,
    format: SourceFormat,
    /// The file as the library sees it.
    pieces: Arc<[Piece]>,
    /// The library's signal for each id.
    references: Vec<SignalRef>,
    /// Marks of a logic analyser.
    marks: Option<Style>,
    /// The file as it was opened, whose header need not be read again by the first who reads its changes.
    opened: Opened,
}

/// Opens the waveform at `path`, until `stop` is set.
pub(super) fn source(path: &Path, format: SourceFormat, stop: &AtomicBool) -> Result<Source> {
    let mut file = fst::open(path)?;
    let mut comments = Comments::default();
    let (end, pieces) = match format {
        SourceFormat::Fst => {
            let contents = fst::check(&mut file).map_err(|fault| fault.of_file(path))?;
            comments = contents.comments;
            (contents.end, contents.pieces)
        }
        // Time stamps are looked for in text alone: packed bytes may look like some.
        _ => {
            let Body { end, texts } = body(path, Some(stop))?;
            (end, Head::read(path, &mut HeadWords::new(file), &texts, |_, _| ())?.pieces().into())
        }
    };
    let pieces = Arc::from(pieces);
    let described = guarded(&path.display().to_string(), || {
        described(path, format, open(path, &pieces)?, Arc::clone(&pieces))
    });
    let source = described.map_err(|error| at_place(path, format, error))?;
    let source = commented(source, comments);
    Ok(if source.is_capture() { source } else { Source { end, ..source } })
}

/// Adds the comments of an FST file to its source.
fn commented(mut source: Source, mut comments: Comments) -> Source {
    source.comments = comments.on_file;
    for signal in &mut source.signals {
        if comments.on_signals.is_empty() {
            break;
        }
        let path = signal.scopes.iter().chain([&signal.own]).map(String::as_str);
        let Some(meaning) = comments.on_signals.remove(&path.collect::<Vec<_>>().join(".")) else {
            continue;
        };
        let known = signal.description.take().map(|known| known.value_type.clone());
        let value_type = known.unwrap_or_default();
        signal.description = Some(SignalDescription { value_type, meaning }.into());
    }
    source
}

/// Adds line or byte, and signal, to an error about a file that the library cannot read.
fn at_place(path: &Path, format: SourceFormat, error: Error) -> Error {
    match &error {
        _ if format == SourceFormat::Vcd => located(path, error),
        Error::Input(input) if input.expected == DAMAGED => {
            fst_fault(path).map_or(error, |fault| fault.of_file(path))
        }
        _ => error,
    }
}

/// Returns the first part of an FST file that cannot be unpacked, or the block that cannot be decoded.
fn fst_fault(path: &Path) -> Option<Fault> {
    let mut file = fst::open(path).ok()?;
    let contents = fst::check(&mut file).ok()?;
    let pieces = contents.pieces.clone().into();
    let wave = guarded("", || open(path, &pieces)).ok();
    let found = contents.fault(&mut file, |index| {
        let hierarchy = wave.as_ref().map(StreamingWaveform::hierarchy);
        let name = hierarchy.and_then(|hierarchy| {
            let mut vars = hierarchy.all_vars().map(|var| &hierarchy[var]);
            Some(vars.find(|var| var.signal_ref().index() == index)?.full_name(hierarchy))
        });
        name.unwrap_or_else(|| format!("signal {index}"))
    });
    found.or_else(|| wave.as_ref().and_then(|_| contents.undecoded()))
}

fn described(
    path: &Path,
    format: SourceFormat,
    wave: StreamingWaveform<Bytes>,
    pieces: Arc<[Piece]>,
) -> Result<Source> {
    let hierarchy = wave.hierarchy();
    let source = path.display().to_string();
    let mut signals = Vec::new();
    let mut references: Vec<SignalRef> = Vec::new();
    let (mut ids, mut tables) = (HashMap::new(), Tables::default());
    for (var, scopes) in variables(hierarchy) {
        let reference = var.signal_ref();
        let id = *ids.entry(reference).or_insert_with(|| {
            references.push(reference);
            references.len() - 1
        });
        signals.push(signal(var, scopes, hierarchy, &mut tables, id));
    }
    if let Some(wide) = signals.iter().find(|signal| signal.width > WIDEST) {
        let expected = format!("expected {WIDEST} bits at most");
        return Err(Input::new(source, expected).field(&wide.name.text).value(wide.width).into());
    }
    let style = Style::of(&signals, hierarchy.version());
    let tick = tick(&source, hierarchy);
    let (path, opened) = (path.to_owned(), Opened::new(wave));
    let mut origin = WaveOrigin { path, format, pieces, references, marks: None, opened };
    if let Some(style) = style.filter(|_| format == SourceFormat::Vcd) {
        style.hide(&mut signals);
        origin.marks = Some(style);
        let source = Source::new(source, SourceFormat::IlaVcd, Axis::Samples, signals, origin);
        return Ok(Source { radix_stated: false, ..source });
    }
    let tick = tick?;
    let axis = Axis::Time(tick.unwrap_or(Tick::NANOSECOND));
    let notes = if tick.is_none() { vec![UNSCALED.to_owned()] } else { Vec::new() };
    Ok(Source { notes, ..Source::new(source, format, axis, signals, origin) })
}

fn signal(
    var: &Var,
    scopes: Arc<[String]>,
    hierarchy: &Hierarchy,
    tables: &mut Tables,
    id: usize,
) -> Signal {
    let (kind, width) = match var.signal_encoding(hierarchy) {
        SignalEncoding::BitVector(0) => (SignalKind::Event, EVENTS),
        SignalEncoding::String => (SignalKind::Text, 8 * LONGEST_WORD as u32),
        SignalEncoding::BitVector(width) => (SignalKind::Bits, width),
        SignalEncoding::Real => (SignalKind::Real, 64),
    };
    // The library makes scopes of the indices of arrays.
    let (scopes, own) = joined(scopes, var.name(hierarchy));
    let name = Name::new(var.full_name(hierarchy).replace(".[", "["));
    let range = var.index().map(|index| [index.msb(), index.lsb()]);
    let states = if kind == SignalKind::Bits { tables.of(var, hierarchy) } else { Arc::default() };
    let (lsb, words) = (range.map_or(0, |[_, lsb]| lsb), Words { states, ..Words::default() });
    let value_type = var.vhdl_type_name(hierarchy).map(str::to_owned);
    let of_type = |value_type| SignalDescription { value_type, meaning: String::new() }.into();
    Signal {
        name,
        scopes,
        own,
        width,
        lsb,
        range,
        kind,
        radix: None,
        shape: None,
        words,
        description: value_type.map(of_type),
        id,
    }
}

/// Returns the unit of times, if the file states it.
fn tick(source: &str, hierarchy: &Hierarchy) -> Result<Option<Tick>> {
    let Some(scale) = hierarchy.timescale() else { return Ok(None) };
    let tick = scale.unit.to_exponent().and_then(|exponent| Tick::new(scale.factor, exponent));
    let fault = || {
        let expected = "expected a number and one of zs, as, fs, ps, ns, us, ms, s";
        let value = format!("{} {:?}", scale.factor, scale.unit);
        Input::new(source, expected).field("$timescale").value(value).into()
    };
    tick.map(Some).ok_or_else(fault)
}

impl signals::Origin for WaveOrigin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let references: Vec<SignalRef> = ids.iter().map(|&id| self.references[id]).collect();
        let origin = self.clone();
        Ok(Cursor::spawn(widths, move |feed| {
            let source = origin.path.display().to_string();
            let result = guarded(&source, || stream(&origin, &references, feed));
            result.map_err(|error| at_place(&origin.path, origin.format, error))
        }))
    }
}

fn stream(origin: &WaveOrigin, references: &[SignalRef], feed: &mut Feed) -> Result<()> {
    let mut wave = match origin.opened.take() {
        Some(wave) => wave,
        None => open(&origin.path, &origin.pieces)?,
    };
    let mut marking = origin.marks.as_ref().map(|style| Marking::new(style, &origin.references));
    let mut wanted = references.to_vec();
    wanted.extend(marking.iter().flat_map(Marking::references));
    wanted.sort();
    wanted.dedup();
    let last = wanted.iter().map(|reference| reference.index()).max().unwrap_or(0);
    let mut places = vec![Vec::new(); last + 1];
    for (signal, reference) in references.iter().enumerate() {
        places[reference.index()].push(signal);
    }
    let mut bits = Bits::default();
    let mut events = vec![0u32; places.len()];
    let (mut last, mut is_back) = (0, false);
    let result = wave.stream_changes(Filter::include_signals(&wanted), |at, reference, value| {
        is_back |= at < last;
        if is_back {
            return Err(Disconnected);
        }
        last = at;
        feed.at(at)?;
        if let Some(marking) = &mut marking
            && let SignalValueRef::BitVec(level) = value
        {
            marking.change(reference, at, u8::from(level.get_bit(0)) == 1, feed);
        }
        if let SignalValueRef::Event = value {
            let count = &mut events[reference.index()];
            *count = count.wrapping_add(1);
        }
        for &signal in &places[reference.index()] {
            set(&mut bits, value, feed.words(signal), origin.format);
            if let SignalValueRef::Event = value {
                bits.value[0] = u64::from(events[reference.index()]);
            }
            feed.change(signal, &bits.value, &bits.unknown);
        }
        Ok::<(), Disconnected>(())
    });
    if is_back {
        let expected = format!("time goes back from {last}");
        return Err(Input::new(origin.path.display(), expected).into());
    }
    match result {
        Ok(()) | Err(StreamError::Callback(Disconnected)) => Ok(()),
        Err(StreamError::Wellen(error)) => Err(fault(&origin.path, error)),
    }
}
