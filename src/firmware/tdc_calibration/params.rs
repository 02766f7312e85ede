//! Verilog parameters of the calibration, and what it makes of counts.

use crate::firmware::carry_chain::Delays;
use crate::firmware::tdc;
use crate::firmware::tdc_decoder::TimeScale;

/// Binary digits of a unit in which `Begin` and `Start` are stated [bits].
pub const FRACTION: u32 = 8;

/// Fewest hits of a calibration, as a power of two.
pub const FEWEST_HITS_LOG2: u32 = 10;

/// Parameters that elaboration fixes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Params {
    /// Length of the chain [taps].
    pub taps: usize,
    /// A clock period [units].
    pub cycle: u64,
    /// Hits of a calibration, as a power of two, 10 to 20.
    pub hits_log2: u32,
    /// Frames from one calibration to the next, 1 to 65,535.
    pub frames: u64,
    /// Age of the youngest hits: when they reach tap 0, and the time from the laser edge to bin 0 [1/256 unit].
    pub begin: u64,
    /// Age of a hit at the laser edge, a clock period, and the same time [1/256 unit].
    pub start: u64,
}

impl Params {
    /// For a chain that hits reach within a clock period.
    pub fn new(delays: &Delays, scale: &TimeScale, hits_log2: u32, frames: u64) -> Self {
        let first = scale.first();
        let begin = scale.parts(delays.tap_0() + first, FRACTION);
        let start = scale.parts(scale.period() + first, FRACTION);
        let (taps, cycle) = (delays.taps(), scale.cycle());
        Params { taps, cycle, hits_log2, frames, begin, start }
    }

    /// Returns the parameters of a design that has no calibration: fewest hits, before every frame.
    pub fn stand_in(tdc: &tdc::Params) -> Self {
        Params::new(&tdc.delays, &tdc.decoder.scale, FEWEST_HITS_LOG2, 1)
    }

    /// Hits of a calibration.
    #[inline(always)]
    pub fn hits(&self) -> u64 {
        1 << self.hits_log2
    }

    /// `begin` times twice the number of hits [units].
    pub(super) fn begin_sum(&self) -> u64 {
        self.begin << (self.hits_log2 + 1 - FRACTION)
    }

    /// `start` times the same [units].
    pub(super) fn start_sum(&self) -> u64 {
        self.start << (self.hits_log2 + 1 - FRACTION)
    }

    /// The age of a word from the middle of its ages times the same and a half [units].
    pub(super) fn age(&self, middle: u64) -> u64 {
        middle >> (self.hits_log2 + 1)
    }

    /// An age whose word begins `early`, at the laser edge or before it: no older than a hit at that edge, so that
    /// its time is not negative [units].
    pub(super) fn by_the_edge(&self, age: u64, early: bool) -> u64 {
        let start = (self.start + (1 << (FRACTION - 1))) >> FRACTION;
        if early { age.min(start) } else { age }
    }

    /// The ages for each `n` that so many hits of it come to, for each of the taps and for none: what the block has
    /// of 2^`hits_log2` of them, and the same of any other number [units].
    pub fn ages(&self, counts: &[u64]) -> Vec<u64> {
        let hits = u128::from(counts.iter().sum::<u64>().max(1));
        let (begin, start) = (u128::from(self.begin), u128::from(self.start));
        let cycle = u128::from(self.cycle << FRACTION);
        // Twice the hits before; and all sums are 2 * 256 times the hits too large.
        let mut before = 0;
        let ages = counts.iter().map(|count| {
            let own = u128::from(*count);
            let middle = 2 * begin * hits + cycle * (before + own) + (hits << FRACTION);
            let early = 2 * begin * hits + cycle * before <= 2 * start * hits;
            before += 2 * own;
            self.by_the_edge((middle / ((2 * hits) << FRACTION)) as u64, early)
        });
        ages.collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::Time;

    use super::*;

    #[test]
    fn a_chain_of_equal_taps_has_the_ages_of_its_delays() {
        use crate::firmware::tdc_decoder::{Decoder, Params as DecoderParams};
        let (delays, scale) =
            (Delays::new(Time::from_ns(2), &[500_000; 16]).unwrap(), TimeScale::default());
        let p = Params::new(&delays, &scale, 10, 1);
        assert_eq!((p.begin, p.start), (1280 << FRACTION, 5120 << FRACTION));
        // A period of 8 ns is 16 taps.
        let counts: Vec<_> = (0..=16).map(|n| if n == 0 { 0 } else { 64 }).collect();
        let own = DecoderParams::calibration(&delays, Decoder::Ones, &scale);
        let own: Vec<_> = own.iter().map(|word| word.get()).collect();
        assert_eq!(p.ages(&counts), own);
    }
}
