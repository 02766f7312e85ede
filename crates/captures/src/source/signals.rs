//! Signals of a source, and the types of its places and values.

use std::collections::HashMap;
use std::fmt::Debug;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use strum::{Display, IntoStaticStr};

use tofsim::error::Result;
use tofsim::kernel::signals::SignalFormat as Shape;
use tofsim::waves::dump::SignalDescription;

use crate::ila::Radix;
use crate::ila::read::NamedValue;

use super::names::Name;
use super::stream::Cursor;
use super::tick::Tick;

/// Format of a source. Its text is the name used in outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, IntoStaticStr)]
#[strum(serialize_all = "UPPERCASE")]
pub enum SourceFormat {
    /// Value change dump of a simulator.
    Vcd,
    /// GTKWave's compressed waveform.
    Fst,
    /// GHDL's waveform.
    Ghw,
    /// A logic analyser's CSV with a row of radices.
    #[strum(serialize = "ILA CSV")]
    IlaCsv,
    /// A logic analyser's CSV without a row of radices.
    #[strum(serialize = "ILA CSV without radix row")]
    LegacyIlaCsv,
    /// A logic analyser's VCD.
    #[strum(serialize = "ILA VCD")]
    IlaVcd,
    /// A logic analyser's archive.
    #[strum(serialize = "ILA archive")]
    Ila,
    /// Simulation by tofsim.
    #[strum(serialize = "simulation")]
    Simulation,
}

/// Unit of the places in a source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Time, in ticks of the given length.
    Time(Tick),
    /// Sample number, for a clock that the source does not contain.
    #[default]
    Samples,
}

impl Axis {
    /// Returns the time of a place [fs], if places are times.
    pub fn femtoseconds(self, at: u64) -> Option<u128> {
        self.tick().map(|tick| tick.femtoseconds(at))
    }

    /// Formats a place: a time in nanoseconds, or a sample number.
    pub fn place_text(self, at: u64) -> String {
        let Some(tick) = self.tick() else { return format!("sample {at}") };
        let [whole, rest] = tick.nanoseconds(at);
        let text = format!("{whole}.{rest:012}");
        format!("{} ns", text.trim_end_matches('0').trim_end_matches('.'))
    }

    /// Returns a place as a number: picoseconds, or a sample number.
    pub fn place_number(self, at: u64) -> f64 {
        self.tick().map_or(at as f64, |tick| tick.picoseconds(at))
    }

    /// Returns the unit of times, if places are times.
    pub(crate) fn tick(self) -> Option<Tick> {
        match self {
            Axis::Time(tick) => Some(tick),
            Axis::Samples => None,
        }
    }

    /// Returns the time of a place in a waveform of both sides, in its unit: the sample number if places are no times.
    pub(crate) fn place(self, at: u64, unit: Tick) -> u64 {
        self.tick().map_or(at, |tick| tick.convert(at, unit))
    }
}

/// Type of a signal's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// Bits, each 0, 1 or unknown.
    Bits,
    /// Floating-point number.
    Real,
    /// Words as bytes, first one lowest, padded with zeros.
    Text,
    /// Events of a simulator; the value is the number of events so far.
    Event,
    /// Words of unknown values, which are not compared.
    Other,
}

impl SignalKind {
    /// Returns what values of the type are called.
    pub(crate) fn plural(self) -> &'static str {
        match self {
            SignalKind::Bits => "bits",
            SignalKind::Real => "real numbers",
            SignalKind::Text | SignalKind::Other => "words",
            SignalKind::Event => "events",
        }
    }
}

/// Words that represent values of a signal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// Width of the represented values, 0 if the source does not state it [bits].
    pub width: u32,
    /// Whether the source has numbers among the words.
    pub mixed: bool,
    /// Known words, with their values if the source states them; a waveform's words are known once it is read.
    pub states: Arc<[NamedValue]>,
}

/// A signal under one of its names.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Name with all scopes.
    pub name: Name,
    /// Its scopes, outermost first.
    pub scopes: Arc<[String]>,
    /// Name in its scope, without range.
    pub own: String,
    /// Width [bits].
    pub width: u32,
    /// Index of the lowest bit.
    pub lsb: i64,
    /// Indices of the highest and the lowest bit, if the source states them.
    pub range: Option<[i64; 2]>,
    /// Type of its values.
    pub kind: SignalKind,
    /// Radix of its values, if the source states it.
    pub radix: Option<Radix>,
    /// Meaning of its values, if the source states it.
    pub shape: Option<Shape>,
    /// Words that represent its values.
    pub words: Words,
    /// Description, if the source has one.
    pub description: Option<Arc<SignalDescription>>,
    /// Number of the signal in its source, which all its names share.
    pub id: usize,
}

impl Signal {
    /// Returns whether its values can be compared with another's; the width of words may be unknown.
    pub(crate) fn fits(&self, other: &Signal) -> bool {
        let is_width = self.width == other.width || self.width == 0 || other.width == 0;
        self.kind == other.kind && is_width
    }
}

/// A source whose list of signals is known.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path, or name of the scenario.
    pub name: String,
    /// Format of the source.
    pub format: SourceFormat,
    /// Unit of its places.
    pub axis: Axis,
    /// Signals, in the source's order.
    pub signals: Vec<Signal>,
    /// Last place, if the source states it.
    pub end: Option<u64>,
    /// Whether the source states the radix of values, if that matters.
    pub radix_stated: bool,
    /// Notes on deviations from the usual format, and on values taken from another part.
    pub notes: Vec<String>,
    /// Comments in the source, which may state its origin.
    pub comments: Vec<String>,
    pub(super) origin: Arc<dyn Origin>,
    /// Flag that stops reading.
    pub(super) stop: Arc<AtomicBool>,
    /// Signals by the last part of their names, computed on first use.
    pub(super) by_last: OnceLock<HashMap<String, Vec<usize>>>,
}

/// Widest signal that is read [bits].
pub(super) const WIDEST: u32 = 1 << 20;

/// Implementation of a source's format.
pub(super) trait Origin: Debug + Send + Sync {
    /// Starts to read the signals with the given ids and widths.
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor>;

    /// Returns the last place to search for a match, for a source of unlimited length.
    fn searched(&self) -> Result<Option<u64>> {
        Ok(None)
    }
}

impl Source {
    /// Creates a source without end, notes and comments, which needs no radix.
    pub(super) fn new(
        name: String,
        format: SourceFormat,
        axis: Axis,
        signals: Vec<Signal>,
        origin: impl Origin + 'static,
    ) -> Source {
        Source {
            name,
            format,
            axis,
            signals,
            end: None,
            radix_stated: true,
            notes: Vec::new(),
            comments: Vec::new(),
            origin: Arc::new(origin),
            stop: Arc::default(),
            by_last: OnceLock::new(),
        }
    }

    /// Returns the source with a flag: once `stop` is set, reading fails as interrupted.
    pub fn stopped_by(self, stop: Arc<AtomicBool>) -> Source {
        Source { stop, ..self }
    }

    /// Starts to read the signals with the given ids; signal `k` of the cursor is `ids[k]`.
    ///
    /// # Errors
    /// If the file has changed or cannot be read any more.
    pub fn read(&self, ids: &[usize]) -> Result<Cursor> {
        // The first name of a signal says how wide it is.
        let mut known = vec![0; self.id_count()];
        self.signals.iter().rev().for_each(|signal| known[signal.id] = signal.width);
        let widths: Vec<u32> = ids.iter().map(|&id| known.get(id).copied().unwrap_or(0)).collect();
        let mut cursor = self.origin.read(ids, &widths)?;
        cursor.stop = Arc::clone(&self.stop);
        Ok(cursor)
    }

    /// Returns the number that all ids are below.
    pub(crate) fn id_count(&self) -> usize {
        self.signals.iter().map(|signal| signal.id + 1).max().unwrap_or(0)
    }

    /// Returns the last place to search for a match: for a simulation of unlimited length, the end of its first
    /// frame.
    ///
    /// # Errors
    /// If that frame does not end.
    pub(crate) fn searched(&self) -> Result<u64> {
        Ok(self.origin.searched()?.unwrap_or(u64::MAX))
    }

    /// Returns whether it is a capture of a logic analyser.
    pub fn is_capture(&self) -> bool {
        self.axis == Axis::Samples
    }
}
