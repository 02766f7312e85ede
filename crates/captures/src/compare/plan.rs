//! Plan of a comparison: the signals that it reads, and how it samples them.

use std::fmt::Display;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use crate::condition::Condition;
use crate::source::Source;

use super::matching::{Matching, Unmatched, UnmatchedReason};
use super::operands::SideCondition;
use super::pair::Pair;
use super::parts::Part;
use super::samples::{Clocking, Sample, SampleClock, Samples};

/// Two sources with matched signals, to be read any number of times.
pub(super) struct Plan<'a> {
    pub(super) sources: [&'a Source; 2],
    pub(super) matching: Matching,
    /// Signals of each side without a partner, which are read to find one.
    pub(super) unpaired: [Vec<(String, Part)>; 2],
    clocking: [Clocking; 2],
    /// Trigger condition for a waveform.
    pub(super) trigger: [Option<SideCondition>; 2],
    /// Condition under which a logic analyser stored a sample.
    pub(super) qualifier: [Option<SideCondition>; 2],
    pub(super) terms: Terms,
}

/// Largest number of signals without a partner that are read.
const UNPAIRED: usize = 64;

/// Conditions, clock and times, as given.
#[derive(Clone, Debug, Default)]
pub(super) struct Terms {
    pub(super) sampling: Option<SampleClock>,
    pub(super) trigger: Option<Condition>,
    pub(super) qualifier: Option<Condition>,
    /// Time before which a waveform is ignored.
    pub(super) after: Time,
    /// End of the comparison [fs].
    pub(super) until_fs: u128,
    /// Number of samples before `after` that a logic analyser's input registers delay.
    pub(super) stages: u64,
}

impl<'a> Plan<'a> {
    /// Creates a plan to compare samples or changes.
    pub(super) fn new(
        sources: [&'a Source; 2],
        mut matching: Matching,
        terms: Terms,
        sampled: bool,
    ) -> Result<Plan<'a>> {
        let mut clocking = [0, 1].map(|_| Clocking::Rows { endless: false });
        let (mut trigger, mut qualifier) = ([None, None], [None, None]);
        for (side, source) in sources.into_iter().enumerate().filter(|_| sampled) {
            let slots = &mut matching.slots[side];
            clocking[side] = Clocking::new(source, terms.sampling.as_ref(), slots)?;
            if source.is_capture() {
                continue;
            }
            let mut bind = |condition: &Option<Condition>| {
                let bind = |condition| SideCondition::new(source, side, &mut matching, condition);
                condition.as_ref().map(bind).transpose()
            };
            trigger[side] = bind(&terms.trigger)?;
            qualifier[side] = bind(&terms.qualifier)?;
        }
        let unpaired = [0, 1].map(|side| unpaired(sources, side, &mut matching));
        Ok(Plan { sources, matching, unpaired, clocking, trigger, qualifier, terms })
    }

    /// Reads the samples of a side, from the first on.
    pub(super) fn samples(&self, side: usize) -> Result<Samples> {
        let slots = &self.matching.slots[side];
        Samples::new(self.sources[side], slots, self.clocking[side].clone())
    }

    /// Returns whether a pair is the sampling clock of a side.
    pub(super) fn is_clock(&self, pair: &Pair) -> bool {
        (0..2).any(|side| match (&self.clocking[side], &pair.sides[side][..]) {
            (Clocking::Rising(clock), [part]) => part.signal == *clock,
            _ => false,
        })
    }

    /// Returns whether a sample is not before the start of the comparison.
    pub(super) fn is_looked_at(&self, side: usize, sample: Sample) -> bool {
        let time = self.sources[side].axis.femtoseconds(sample.at);
        time.is_none_or(|fs| fs >= self.terms.after.fs() as u128)
    }

    /// Returns whether the end of the comparison is reached on a side, if it has times.
    pub(super) fn is_reached(&self, side: usize, sample: Sample) -> Option<bool> {
        Some(self.sources[side].axis.femtoseconds(sample.at)? >= self.terms.until_fs)
    }

    /// Creates an error about a side.
    pub(super) fn fault(&self, side: usize, expected: impl Display) -> Input {
        Input::new(&self.sources[side].name, expected)
    }

    /// Returns the side that is a capture, if the other is not.
    pub(super) fn capture(&self) -> Option<usize> {
        match self.sources.map(Source::is_capture) {
            [true, false] => Some(0),
            [false, true] => Some(1),
            _ => None,
        }
    }
}

/// Returns the signals of a side without a partner, if the other side has such signals too.
fn unpaired(sources: [&Source; 2], side: usize, matching: &mut Matching) -> Vec<(String, Part)> {
    if !sources.iter().any(|source| source.is_capture()) {
        return Vec::new();
    }
    let Matching { unmatched, slots, .. } = matching;
    let own = |reason: &Unmatched| reason.side == side && reason.reason == UnmatchedReason::Alone;
    let unpaired = unmatched.iter().filter(|unmatched| own(unmatched)).take(UNPAIRED);
    unpaired
        .map(|unmatched| {
            let signal = &sources[side].signals[unmatched.signal];
            (unmatched.name.clone(), Part::whole(&mut slots[side], signal))
        })
        .collect()
}
