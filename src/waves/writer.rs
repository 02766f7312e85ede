//! Writer of a waveform file in windows.

use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::firmware::tdc_decoder::Encoder;
use crate::firmware::tof_top::TofTop;
use crate::hierarchy::{Entry, Part, ROW};
use crate::kernel::Time;
use crate::kernel::signals::Sink;

use super::body::{Body, Step};
use super::fst::Fst;
use super::vcd::Vcd;

/// File format of a waveform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveFormat {
    /// Value change dump: text, read by every tool.
    Vcd,
    /// GTKWave's binary format, about twenty times smaller.
    Fst,
}

/// A waveform file under construction. If it is dropped before the run has ended, no file remains.
pub struct Waves {
    path: PathBuf,
    writer: Writer,
    state: WindowState,
    /// Signals in the file, with their last written values, from the first window on.
    shown: Box<Part>,
    row: SpadOutputs,
    /// Time of the last call [ps].
    last: u64,
    /// First write error.
    pub(super) failed: Option<io::Error>,
}

enum Writer {
    Vcd(Box<Vcd>),
    Fst(Box<Fst>),
}

#[derive(Clone, Copy, PartialEq)]
enum WindowState {
    /// Before the first window.
    Blank,
    /// Within a window.
    Open,
    /// After a window that ended at this time [ps]. Its end is not written yet, because the next window may start at
    /// the same time.
    Ended(u64),
}

impl Waves {
    /// Creates a file with the signals `entries`, which [`Setup::waves`](crate::Setup::waves) selects by name.
    /// `order` is the physical tap at each position in order of arrival; `provenance` describes the origin of the
    /// file, in one or more lines.
    ///
    /// # Errors
    /// If the file cannot be created.
    #[doc(hidden)]
    pub fn create(
        path: &Path,
        format: WaveFormat,
        entries: &[Entry],
        encoder: &Encoder,
        provenance: &[String],
    ) -> Result<Waves> {
        let writer = match format {
            WaveFormat::Vcd => {
                Writer::Vcd(Box::new(Vcd::create(path, entries, encoder, provenance)?))
            }
            WaveFormat::Fst => {
                Writer::Fst(Box::new(Fst::create(path, entries, encoder, provenance)?))
            }
        };
        let shown = Part::of(entries.iter().map(|entry| entry.id)).of_whole_edges();
        let shown = Box::new(shown);
        let (path, state, row) = (path.to_owned(), WindowState::Blank, SpadOutputs::of(entries));
        Ok(Waves { path, writer, state, shown, row, last: 0, failed: None })
    }

    /// Starts a window, and writes the present value of every signal; later calls write changes only.
    ///
    /// Write errors in this and the following methods are kept for [`Waves::check`].
    pub(crate) fn begin(&mut self, now: Time, top: &TofTop) {
        let at = self.at(now);
        match self.state {
            WindowState::Open => return self.sample(now, top),
            WindowState::Ended(end) if end == at => {
                self.state = WindowState::Open;
                return self.sample(now, top);
            }
            WindowState::Ended(end) => self.mark(end, Step::Close, None),
            WindowState::Blank if at > 0 => self.mark(0, Step::Start, None),
            WindowState::Blank => {}
        }
        let step = if at > 0 { Step::Open } else { Step::Start };
        self.state = WindowState::Open;
        self.mark(at, step, Some(top));
    }

    /// Writes all changes since the last call; does nothing outside windows. Within a window it must be called at
    /// every edge of `clk_laser` and at every change between edges.
    #[inline]
    pub(crate) fn sample(&mut self, now: Time, top: &TofTop) {
        if self.state == WindowState::Open {
            let at = self.at(now);
            self.write(at, Step::Change, Some(top));
        }
    }

    /// Sets the outputs of the SPAD row for the following steps, one bit each.
    #[inline]
    pub(crate) fn outputs(&mut self, outputs: u64) {
        self.row.now = outputs;
    }

    /// Writes changes at an instant when only clock levels can change.
    #[inline]
    pub(crate) fn tick(&mut self, now: Time, top: &TofTop) {
        if self.state == WindowState::Open {
            let at = self.at(now);
            self.write(at, Step::Clocks, Some(top));
        }
    }

    /// Ends a window; every signal becomes unknown.
    pub(crate) fn end(&mut self, now: Time) {
        let at = self.at(now);
        if self.state == WindowState::Open {
            self.state = WindowState::Ended(at);
        }
    }

    /// Returns the first write error so far.
    ///
    /// # Errors
    /// The first write error.
    #[inline]
    pub(crate) fn check(&self) -> Result<()> {
        match &self.failed {
            None => Ok(()),
            Some(error) => Err(self.fault(error)),
        }
    }

    #[cold]
    fn fault(&self, error: &io::Error) -> Error {
        let error = io::Error::new(error.kind(), error.to_string());
        Error::io(&self.path, "write")(error)
    }

    /// Ends the file at the end of the run, and moves it to its final path.
    ///
    /// # Errors
    /// If the file could not be written.
    pub(crate) fn finish(mut self, end: Time) -> Result<()> {
        let at = self.at(end);
        match self.state {
            WindowState::Blank => self.mark(0, Step::Start, None),
            WindowState::Ended(end) if end < at => self.mark(end, Step::Close, None),
            WindowState::Ended(_) | WindowState::Open => {}
        }
        self.check()?;
        match self.writer {
            Writer::Vcd(file) => file.finish(at),
            Writer::Fst(file) => file.finish(at),
        }
    }

    /// Converts a time to the file's unit, and makes it monotonic [ps].
    #[inline(always)]
    fn at(&mut self, now: Time) -> u64 {
        self.last = now.ps().max(self.last);
        self.last
    }

    /// Writes a step; without a top everything is unknown.
    /// A step that comes once or twice a window.
    #[cold]
    #[inline(never)]
    fn mark(&mut self, at: u64, step: Step, top: Option<&TofTop>) {
        self.write(at, step, top);
    }

    #[inline(always)]
    fn write(&mut self, at: u64, step: Step, top: Option<&TofTop>) {
        let shown = (&mut *self.shown, &mut self.row);
        let written = match &mut self.writer {
            Writer::Vcd(file) => write(&mut **file, at, step, shown, top),
            Writer::Fst(file) => write(&mut **file, at, step, shown, top),
        };
        if let Err(error) = written {
            self.failed.get_or_insert(error);
        }
    }
}

/// Outputs of the SPAD row, one bit each.
#[derive(Clone, Copy, Default)]
struct SpadOutputs {
    /// Mask of the outputs in the file.
    has: u64,
    now: u64,
    shown: u64,
}

impl SpadOutputs {
    fn of(entries: &[Entry]) -> Self {
        let places = entries.iter().filter_map(|entry| entry.id.checked_sub(ROW));
        SpadOutputs { has: places.fold(0, |has, place| has | 1 << place), ..SpadOutputs::default() }
    }

    /// Reports the outputs that have changed, or all.
    #[cold]
    fn show(&mut self, all: bool, sink: &mut impl Sink) {
        let mut left = self.has & if all { u64::MAX } else { self.now ^ self.shown };
        while left > 0 {
            let place = left.trailing_zeros();
            sink.word(ROW + place as usize, self.now >> place & 1);
            left &= left - 1;
        }
        self.shown = self.now;
    }
}

/// A step of a file: the signals of `top` that belong to it, or none that are known.
#[inline(always)]
fn write(
    file: &mut impl Body,
    at: u64,
    step: Step,
    (shown, row): (&mut Part, &mut SpadOutputs),
    top: Option<&TofTop>,
) -> io::Result<()> {
    let begun = file.begin(at, step);
    match (step, top) {
        (_, None) => file.unknown(),
        (Step::Change, Some(top)) => shown.follow(top, file),
        (Step::Clocks, Some(top)) => shown.tick(top, file),
        (_, Some(top)) => shown.show(top, file),
    }
    let changes_only = matches!(step, Step::Change | Step::Clocks);
    if top.is_some() && row.has > 0 && !(changes_only && row.now == row.shown) {
        row.show(!changes_only, file);
    }
    file.end(begun)
}
