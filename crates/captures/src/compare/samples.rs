//! A source as a sequence of samples: rows of a logic analyser, or a waveform at the edges of a clock.

use std::str::FromStr;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;
use tofsim::kernel::clock::Clock;

use crate::ila::clock::{AnalyserClock, quantity};
use crate::source::{Axis, Cursor, Marks, Source, SourceFormat, SourceState, Tick};

use super::find;
use super::parts::{Part, Slots};

/// Sampling clock of a waveform.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SampleClock {
    /// Sample just before the rising edges of a signal.
    Signal(String),
    /// Sample just before the edges of a clock that is not a signal.
    Free {
        /// Frequency [Hz].
        frequency_hz: u64,
        /// Time of the first edge.
        phase: Time,
    },
}

impl FromStr for SampleClock {
    type Err = String;

    /// Parses a signal name, or a frequency and the time of the first edge such as `125MHz` or `125MHz + 2ns`.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        Ok(match text.parse() {
            Ok(AnalyserClock::Free { frequency_hz, phase }) => {
                SampleClock::Free { frequency_hz, phase }
            }
            Err(expected)
                if text.trim_start().starts_with(|first: char| first.is_ascii_digit()) =>
            {
                return Err(expected.to_owned());
            }
            _ => SampleClock::Signal(text.to_owned()),
        })
    }
}

/// Parses a time with its unit.
pub fn time(text: &str) -> Option<Time> {
    const UNITS: [(&str, f64); 6] =
        [("fs", 1e-3), ("ps", 1.0), ("ns", 1e3), ("us", 1e6), ("ms", 1e9), ("s", 1e12)];
    let ps = quantity(text, &UNITS)?;
    (0.0..=1e16).contains(&ps).then(|| Time::from_ps_f64(ps))
}

/// A sample of a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sample {
    /// Sample number, from 0.
    pub(crate) index: u64,
    /// Place in the source: a tick, or the number of the row.
    pub(crate) at: u64,
    pub(crate) marks: Marks,
    /// Whether the source does not contain the sample, and its values are those of the last one.
    pub(crate) is_extended: bool,
}

/// Sampling of a source.
#[derive(Clone)]
pub(super) enum Clocking {
    /// At the rising edges of a signal of the cursor.
    Rising(usize),
    Free {
        clock: Clock,
        tick: Tick,
    },
    /// At each row; rows after the last may repeat it.
    Rows {
        endless: bool,
    },
}

impl Clocking {
    /// Creates the sampling of a source by a clock, whose signal is added to the signals to read.
    pub(super) fn new(
        source: &Source,
        sampling: Option<&SampleClock>,
        slots: &mut Slots,
    ) -> Result<Clocking> {
        let Axis::Time(tick) = source.axis else {
            return Ok(Clocking::Rows { endless: source.format == SourceFormat::IlaVcd });
        };
        match sampling {
            Some(SampleClock::Signal(name)) => match find::part(source, name, slots)? {
                (_, Part { width: 1, signal, .. }) => Ok(Clocking::Rising(signal)),
                (_, Part { width, .. }) => {
                    let expected = format!("expected a clock of one bit, not {width}");
                    Err(Input::new(&source.name, expected).field(name).into())
                }
            },
            Some(&SampleClock::Free { frequency_hz, phase }) => {
                Ok(Clocking::Free { clock: Clock::new(frequency_hz, phase), tick })
            }
            None => {
                let expected = "a waveform has no samples; say which clock they are taken by \
                    with --clock";
                Err(Input::new(&source.name, expected).into())
            }
        }
    }
}

/// Reader of a source as a sequence of samples.
pub(super) struct Samples {
    cursor: Cursor,
    clocking: Clocking,
    /// Values at the sample.
    pub(super) state: SourceState,
    /// Signals whose values in the cursor are newer than the sample.
    newer: Vec<usize>,
    /// Signals that have changed since the last call of [`Samples::changes`].
    changed: Vec<usize>,
    next: u64,
}

impl Samples {
    /// Starts to read the signals of `slots`.
    pub(super) fn new(source: &Source, slots: &Slots, clocking: Clocking) -> Result<Samples> {
        let cursor = source.read(&slots.ids)?;
        let (state, newer) = (cursor.state.clone(), Vec::new());
        Ok(Samples { cursor, clocking, state, newer, changed: Vec::new(), next: 0 })
    }

    /// Reports the signals that have changed since the last call; a signal may be reported twice.
    pub(super) fn changes(&mut self, changed: impl FnMut(usize)) {
        self.changed.drain(..).for_each(changed);
    }

    fn catch_up(&mut self) {
        for &signal in &self.newer {
            self.state.take(&self.cursor.state, signal);
        }
        self.changed.append(&mut self.newer);
    }

    /// Copies the changes of the cursor's next instant into the sample.
    fn take(&mut self) -> Marks {
        let newer = &mut self.newer;
        let marks = self.cursor.take(|signal| newer.push(signal));
        self.catch_up();
        marks
    }

    /// Reads the next sample; returns `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Sample>> {
        self.catch_up();
        match self.clocking {
            Clocking::Rising(signal) => self.next_edge(signal),
            Clocking::Free { ref clock, tick } => {
                let skipped = u64::from(clock.rise(0) == Time::ZERO);
                self.next_instant(clock.rise(self.next + skipped), tick)
            }
            Clocking::Rows { endless } => self.next_row(endless),
        }
    }

    fn sample(&mut self, at: u64, marks: Marks, is_extended: bool) -> Option<Sample> {
        let index = self.next;
        self.next += 1;
        Some(Sample { index, at, marks, is_extended })
    }

    fn next_edge(&mut self, clock: usize) -> Result<Option<Sample>> {
        let level = |state: &SourceState| match state.unknown(clock)[0] {
            0 => Some(state.value(clock)[0]),
            _ => None,
        };
        while let Some(at) = self.cursor.peek()? {
            let newer = &mut self.newer;
            self.cursor.take(|signal| newer.push(signal));
            if level(&self.state) == Some(0) && level(&self.cursor.state) == Some(1) {
                return Ok(self.sample(at, Marks::default(), false));
            }
            self.catch_up();
        }
        Ok(None)
    }

    fn next_instant(&mut self, edge: Time, tick: Tick) -> Result<Option<Sample>> {
        while let Some(at) = self.cursor.peek()? {
            if tick.femtoseconds(at) >= edge.fs() as u128 {
                return Ok(self.sample(tick.count(edge.fs() as u128), Marks::default(), false));
            }
            self.take();
        }
        Ok(None)
    }

    fn next_row(&mut self, endless: bool) -> Result<Option<Sample>> {
        let row = self.next;
        match self.cursor.peek()? {
            Some(at) if at == row => {
                let marks = self.take();
                Ok(self.sample(row, marks, false))
            }
            Some(_) => Ok(self.sample(row, Marks::default(), false)),
            None if endless => Ok(self.sample(row, Marks::default(), true)),
            None => Ok(None),
        }
    }
}
