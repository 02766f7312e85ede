//! The signals of a source, and what its places and values are.

use std::collections::{HashMap, HashSet};
use std::fmt::Debug;
use std::sync::{Arc, OnceLock};

use tofsim::error::Result;
use tofsim::kernel::signals::SignalFormat as Shape;

use crate::ila::Radix;
use crate::ila::read::State;

use super::names::Name;
use super::stream::Cursor;
use super::tick::Tick;

/// What kind of file or program a source is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceFormat {
    /// Value change dump of a simulator.
    Vcd,
    /// GTKWave's compressed waveform.
    Fst,
    /// GHDL's waveform.
    Ghw,
    /// An ILA's samples as CSV with a row of radices.
    IlaCsv,
    /// The same without.
    LegacyIlaCsv,
    /// An ILA's samples as VCD.
    IlaVcd,
    /// An ILA's archive.
    Ila,
    /// tofsim itself.
    Simulation,
}

impl SourceFormat {
    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            SourceFormat::Vcd => "VCD",
            SourceFormat::Fst => "FST",
            SourceFormat::Ghw => "GHW",
            SourceFormat::IlaCsv => "ILA CSV",
            SourceFormat::LegacyIlaCsv => "ILA CSV without radix row",
            SourceFormat::IlaVcd => "ILA VCD",
            SourceFormat::Ila => "ILA archive",
            SourceFormat::Simulation => "simulation",
        }
    }
}

/// What the places in a source are counted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Time, in ticks of that length.
    Time(Tick),
    /// Samples of a clock that the source does not have.
    #[default]
    Samples,
}

impl Axis {
    /// The time of a place [fs], if places are times.
    pub fn femtoseconds(self, at: u64) -> Option<u128> {
        match self {
            Axis::Time(tick) => Some(tick.femtoseconds(at)),
            Axis::Samples => None,
        }
    }
}

/// What the values of a signal are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// Bits, each 0, 1 or unknown.
    Bits,
    /// A number in floating point.
    Real,
    /// Words, each as its bytes, the first lowest; a place beyond its end is 0.
    Text,
    /// Text of a simulator or events, which are not compared.
    Other,
}

/// Words that stand for values of a signal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// Width of the values that they stand for [bits].
    pub width: u32,
    /// Whether the source has numbers among them.
    pub mixed: bool,
    /// The words that are known, with their bits if the source tells these.
    pub states: Vec<State>,
}

/// A signal by one of its names.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Its name with all scopes.
    pub name: Name,
    /// Its width [bits].
    pub width: u32,
    /// Index of its lowest bit.
    pub lsb: i64,
    /// What its values are.
    pub kind: SignalKind,
    /// How its values are shown, if the source says.
    pub radix: Option<Radix>,
    /// What its values mean, if the source says.
    pub shape: Option<Shape>,
    /// Words that stand for values of it.
    pub words: Words,
    /// Names of the same signal share it.
    pub id: usize,
}

/// A source, of which the list of signals is known.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path, or name of the scenario.
    pub name: String,
    /// What it is.
    pub format: SourceFormat,
    /// What its places are counted in.
    pub axis: Axis,
    /// Its signals, in its order.
    pub signals: Vec<Signal>,
    /// Its last place, if it says.
    pub end: Option<u64>,
    /// Whether it says how values are written, where that matters.
    pub radix_told: bool,
    /// What was read otherwise than it is usually written, or taken from elsewhere.
    pub notes: Vec<String>,
    pub(super) origin: Arc<dyn Origin>,
    /// Signals by the last parts of their names, once somebody has asked.
    pub(super) by_last: OnceLock<HashMap<String, Vec<usize>>>,
}

/// Widest signal that is read [bits].
pub(super) const WIDEST: u32 = 1 << 20;

/// Where the changes of a source come from.
pub(super) trait Origin: Debug + Send + Sync {
    /// Begins to read the signals with those ids and widths.
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor>;

    /// The last place that is searched for what may lie anywhere, if it goes on for long.
    fn searched(&self) -> Result<Option<u64>> {
        Ok(None)
    }
}

impl Source {
    /// Begins to read the signals with those ids; signal `k` of the cursor is `ids[k]`.
    ///
    /// # Errors
    /// When the file has changed or cannot be read any more.
    pub fn read(&self, ids: &[usize]) -> Result<Cursor> {
        // The first name of a signal says how wide it is.
        let signals = self.signals.iter().rev();
        let widths: HashMap<usize, u32> = signals.map(|s| (s.id, s.width)).collect();
        let widths: Vec<u32> = ids.iter().map(|id| widths.get(id).copied().unwrap_or(0)).collect();
        self.origin.read(ids, &widths)
    }

    /// The last place that is searched for what may lie anywhere: of a simulation that goes on for
    /// as long as it is asked to, the end of its first frame.
    ///
    /// # Errors
    /// When that frame does not end.
    pub(crate) fn searched(&self) -> Result<u64> {
        Ok(self.origin.searched()?.unwrap_or(u64::MAX))
    }

    /// Whether its places are samples of a logic analyser.
    pub fn is_capture(&self) -> bool {
        self.axis == Axis::Samples
    }

    /// Adds ranges to names that several signals would share without.
    pub(super) fn distinguish(mut self) -> Self {
        let mut ids: HashMap<String, HashSet<usize>> = HashMap::new();
        for signal in &self.signals {
            ids.entry(signal.name.text.clone()).or_default().insert(signal.id);
        }
        for signal in &mut self.signals {
            let shared = ids.get(&signal.name.text).is_some_and(|ids| ids.len() > 1);
            if shared && signal.kind == SignalKind::Bits {
                let top = signal.lsb + i64::from(signal.width) - 1;
                let text = format!("{}[{top}:{}]", signal.name.text, signal.lsb);
                signal.name = Name::new(text);
            }
        }
        self
    }

    /// The signals whose names have that last part, whatever their ranges, in ascending order.
    pub(crate) fn called(&self, last: &str) -> &[usize] {
        let by_last = self.by_last.get_or_init(|| {
            let mut by_last: HashMap<String, Vec<usize>> = HashMap::new();
            for (k, signal) in self.signals.iter().enumerate() {
                by_last.entry(bare(signal.name.last()).to_owned()).or_default().push(k);
            }
            by_last
        });
        by_last.get(bare(last)).map_or(&[], Vec::as_slice)
    }
}

/// A name without what stands in brackets behind it.
fn bare(last: &str) -> &str {
    last.split('[').next().unwrap_or(last)
}
