//! A capture whose probes are looked up by the names of a design.

use tofsim::error::Result;

use crate::choice::SignalChoice;
use crate::source::{Signal, Source};
use crate::words::Bits;

use super::find;
use super::map::SignalMap;
use super::matching::{Matching, matching};
use super::parts::Slots;
use super::samples::{Clocking, Sample, SampleClock, Samples};

/// Samples of a capture, with the design's signals that it contains.
pub(crate) struct Probed<'a> {
    design: &'a Source,
    matching: Matching,
    samples: Samples,
    scratch: Bits,
}

impl<'a> Probed<'a> {
    /// Finds the signals of `design` in a capture, and starts to read it.
    ///
    /// # Errors
    /// If the map names a signal that does not exist, or the capture cannot be read.
    pub(crate) fn new(design: &'a Source, capture: &Source, map: &SignalMap) -> Result<Self> {
        let matching = matching([design, capture], map, &SignalChoice::default(), Signal::fits)?;
        let clocking = Clocking::Rows { endless: false };
        let samples = Samples::new(capture, &matching.slots[1], clocking)?;
        Ok(Probed { design, matching, samples, scratch: Bits::default() })
    }

    /// Returns the probe of a signal of the design, by its full name or one of its aliases.
    pub(crate) fn probe(&self, name: &str) -> Option<usize> {
        let signal = self.design.signals.iter().find(|signal| signal.name.text == name)?;
        let ids = &self.matching.slots[0].ids;
        self.matching.pairs.iter().position(|pair| match &pair.sides[0][..] {
            [part] => part.whole && ids[part.signal] == signal.id,
            _ => false,
        })
    }

    /// Reads the next sample; returns `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<Sample>> {
        self.samples.next()
    }

    /// Returns the value of a probe at the sample, if all bits are known.
    pub(crate) fn value(&mut self, probe: usize) -> Option<u64> {
        let pair = &self.matching.pairs[probe];
        pair.gather(1, &self.samples.state, &mut self.scratch);
        self.scratch.number().and_then(|number| u64::try_from(number).ok())
    }
}

/// Finds the sample of a waveform at which a one-bit signal rises for the `count`-th time, counted from 0, and
/// returns its number and its place; `None` if there is none.
///
/// # Errors
/// If there is no such signal or clock, or the waveform cannot be read.
pub(crate) fn pulse(
    source: &Source,
    clock: &SampleClock,
    signal: &str,
    mut count: u64,
) -> Result<Option<(u64, u64)>> {
    let mut slots = Slots::default();
    let (_, part) = find::part(source, signal, &mut slots)?;
    let clocking = Clocking::new(source, Some(clock), &mut slots)?;
    let mut samples = Samples::new(source, &slots, clocking)?;
    let mut before = true;
    while let Some(sample) = samples.next()? {
        let now = samples.state.value(part.signal)[0] == 1;
        if now && !before {
            match count.checked_sub(1) {
                Some(left) => count = left,
                None => return Ok(Some((sample.index, sample.at))),
            }
        }
        before = now;
    }
    Ok(None)
}
