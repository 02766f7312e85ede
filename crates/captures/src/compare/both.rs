//! A waveform of both sides and their differences, with setups for GTKWave and Surfer.

use std::io;
use std::path::Path;

use vcd::Value;

use tofsim::error::{Error, Input, Result};
use tofsim::files::output::{OutputFile, write_bytes};
use tofsim::waves::side_by_side::{
    BINARY, HEXADECIMAL, Layout, SIDES, Scope, Shown, SideBySide, TimescaleUnit, View,
};
use tofsim::waves::zoom;

use super::pair::Pair;
use super::result::{Compared, Comparison};
use crate::source::{Axis, Tick};
use crate::words::Bits;

/// Names of the scopes: both sides, and the differences.
const SCOPES: [&str; 3] = [SIDES[0], SIDES[1], "differs"];
/// Name of the outermost scope, and of the bit in it that is high while any pair differs.
const TOP: [&str; 2] = ["compare", "any_differs"];

/// Number of pairs shown at first.
const SHOWN: usize = 32;
/// Inverse of the fraction of the waveform shown around the first difference.
const PART: u64 = 16;
/// Width of the traces in GTKWave's window [pixels].
const PIXELS: u32 = 680;
/// GTKWave's colours of the three scopes: green, yellow, red.
const COLOURS: [u32; 3] = [4, 3, 1];

/// Writer of a waveform of both sides.
pub(super) struct Both {
    wave: SideBySide<OutputFile>,
    /// Unit of the times.
    unit: Tick,
    widths: Vec<u32>,
    is_event: Vec<bool>,
    /// Pairs whose event is shown at the last time.
    raised: Vec<usize>,
    wrong: Vec<bool>,
    /// Number of pairs that differ, and the last written level of the bit that shows it.
    count: usize,
    shown: Option<bool>,
    first: Option<u64>,
    last: Option<u64>,
}

impl Both {
    /// Creates the waveform at `path`, whose extension must be `.vcd`. Its unit is a picosecond, or a femtosecond if
    /// the sides have times below a picosecond.
    ///
    /// # Errors
    /// If it cannot be written, or the sides have times below a femtosecond.
    pub(super) fn create(path: &Path, pairs: &[Pair], sides: [Axis; 2]) -> Result<Both> {
        let coarse = sides.into_iter().filter_map(Axis::tick).max().unwrap_or(Tick::PICOSECOND);
        if coarse < Tick::FEMTOSECOND {
            let expected = "expected waveforms with times of 1 fs or more";
            return Err(Input::new("--waves", expected).into());
        }
        let (unit, tick) = if coarse < Tick::PICOSECOND {
            (TimescaleUnit::FS, Tick::FEMTOSECOND)
        } else {
            (TimescaleUnit::PS, Tick::PICOSECOND)
        };
        if path.extension().is_none_or(|extension| extension != "vcd") {
            let expected = "expected a name that ends in .vcd";
            return Err(Input::new("--waves", expected).value(path.display()).into());
        }
        let version = Some(concat!("tofsim ", env!("CARGO_PKG_VERSION")));
        let layout = Layout { version, unit, top: TOP[0], first: None, last: Some(TOP[1]) };
        let scopes: [Scope; 3] = SCOPES.map(|scope| {
            let width = |pair: &Pair| if scope == SCOPES[2] { 1 } else { pair.width };
            (scope, pairs.iter().map(|pair| (flat(&pair.name), width(pair))).collect())
        });
        let file = OutputFile::create(path)?;
        Ok(Both {
            wave: SideBySide::begin(file, &layout, &scopes).map_err(Error::io(path, "write"))?,
            unit: tick,
            widths: pairs.iter().map(|pair| pair.width).collect(),
            is_event: pairs.iter().map(|pair| pair.is_event).collect(),
            // All are low at first.
            raised: (0..pairs.len()).filter(|&pair| pairs[pair].is_event).collect(),
            wrong: vec![false; pairs.len()],
            count: 0,
            shown: None,
            first: None,
            last: None,
        })
    }

    /// Sets the place of the changes that follow.
    pub(super) fn at(&mut self, axis: Axis, at: u64) -> Result<()> {
        self.go_to(axis.place(at, self.unit)).map_err(|error| self.wave.out().fault(error))
    }

    fn go_to(&mut self, at: u64) -> io::Result<()> {
        if self.last == Some(at) {
            return Ok(());
        }
        self.sum_up()?;
        self.first.get_or_insert(at);
        self.last = Some(at);
        self.wave.time(at)?;
        for pair in std::mem::take(&mut self.raised) {
            self.lower(pair)?;
        }
        Ok(())
    }

    /// Ends the pulse of an event.
    fn lower(&mut self, pair: usize) -> io::Result<()> {
        (0..SCOPES.len()).try_for_each(|scope| self.wave.scalar(scope, pair, Value::V0))?;
        self.count -= usize::from(std::mem::take(&mut self.wrong[pair]));
        Ok(())
    }

    /// Writes the bit that shows whether any pair differs, at the last time.
    fn sum_up(&mut self) -> io::Result<()> {
        let now = Some(self.count > 0);
        if self.last.is_some() && now != self.shown {
            self.shown = now;
            self.wave.bit(self.count > 0)?;
        }
        Ok(())
    }

    /// Writes a change of a pair's values.
    pub(super) fn change(&mut self, pair: usize, sides: &[Bits; 2], differs: bool) -> Result<()> {
        self.write(pair, sides, differs).map_err(|error| self.wave.out().fault(error))
    }

    fn write(&mut self, pair: usize, sides: &[Bits; 2], differs: bool) -> io::Result<()> {
        let width = self.widths[pair];
        for (side, bits) in sides.iter().enumerate() {
            match width {
                1 => self.wave.scalar(side, pair, bits.level(0))?,
                _ => {
                    let levels = (0..width).rev().map(|bit| bits.level(bit));
                    self.wave.vector(side, pair, levels)?;
                }
            }
        }
        self.wave.scalar(2, pair, differs.into())?;
        self.count += usize::from(differs);
        self.count -= usize::from(self.wrong[pair]);
        self.wrong[pair] = differs;
        if self.is_event[pair] {
            self.raised.push(pair);
        }
        Ok(())
    }

    /// Completes the waveform, and writes viewer setups next to it.
    pub(super) fn finish(mut self, result: &Comparison) -> Result<()> {
        self.sum_up().map_err(|error| self.wave.out().fault(error))?;
        let file = self.wave.into_out();
        let path = file.target().to_owned();
        file.commit()?;
        if !std::fs::metadata(&path).is_ok_and(|found| found.is_file()) {
            return Ok(());
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let view = view(result, self.unit, self.first.unwrap_or(0), self.last.unwrap_or(0));
        write_bytes(&path.with_extension("gtkw"), view.gtkwave(&name))?;
        write_bytes(&path.with_extension("sucl"), view.surfer())
    }
}

/// Replaces dots, which would separate scopes, and spaces in a name.
fn flat(name: &str) -> String {
    name.replace('.', "/").replace(' ', "_").replace('\\', "")
}

/// Returns the initial view of a waveform with the given unit, start and end; the first signals to differ are on top.
fn view(result: &Comparison, unit: Tick, begin: u64, end: u64) -> View<'static> {
    let firsts = result.pairs.iter().filter_map(|pair| pair.first.as_ref());
    let first = firsts.map(|first| result.sides[0].axis.place(first.at[0], unit)).min();
    let whole = end.saturating_sub(begin).max(1);
    let (from, span) = match first {
        Some(first) => (first.saturating_sub(whole / PART / 2), (whole / PART).max(1)),
        None => (begin, whole),
    };
    let show = |pair: &Compared| {
        let (name, width) = (flat(&pair.name), pair.width);
        [0, 1, 2].map(|k| Shown {
            flags: if k == 2 || width == 1 { BINARY } else { HEXADECIMAL },
            colour: Some(COLOURS[k]),
            label: format!("{name} {}", SCOPES[k]),
            scope: SCOPES[k],
            name: name.clone(),
            width: if k == 2 { 1 } else { width },
        })
    };
    View {
        top: TOP,
        colour: Some(COLOURS[2]),
        from,
        zoom: format!("{:.6}", zoom(span, PIXELS)),
        height: 800,
        columns: Some([160, 420]),
        marker: first,
        signals: result.pairs.iter().take(SHOWN).flat_map(show).collect(),
    }
}
