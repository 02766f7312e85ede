//! What the algorithm knows of an instrument, in whichever numbers it is computed.

use std::ops::Range;

use crate::firmware::likelihood_estimator::params::{Params, Scales};
use crate::firmware::likelihood_estimator::words::UNITS;

use super::number::Number;

/// Bins, pulse and scales of an instrument.
pub trait Instrument {
    /// Numbers of the estimate.
    type Number: Number;

    /// The estimator's parameters in the firmware: lengths, sizes and shots are taken from here.
    fn words(&self) -> &Params;

    /// Width of a bin [units].
    fn width(&self, bin: usize) -> Self::Number;

    /// The pulse at an edge: the part that came before with 17 fraction bits, the slope of its logarithm, and that of
    /// this part's logarithm.
    fn pulse(&self, edge: usize, arrival: Self::Number) -> [Self::Number; 3];

    /// The part of the cover glass's light in a bin, 17 fraction bits.
    fn glass(&self, bin: usize) -> Self::Number;

    /// Numbers that times and distances are reckoned with.
    fn scales(&self) -> Scales<Self::Number>;

    /// Returns whether it knows of light from a cover glass.
    fn has_glass(&self) -> bool {
        self.words().glass.bins() > 0
    }

    /// Returns whether a bin has a width; the others are none.
    fn has(&self, bin: usize) -> bool {
        self.width(bin) > Self::Number::default()
    }

    /// Bins of the fit of an echo at that time.
    fn window(&self, arrival: Self::Number) -> Range<usize> {
        let Params { histogram, before, after, .. } = self.words();
        let bin = arrival.floored(i64::from(UNITS.ilog2()) + 4);
        let centre = bin.place().min(histogram.bins - 1);
        centre.saturating_sub(*before)..(centre + after + 1).min(histogram.bins)
    }
}

impl Instrument for Params {
    type Number = i64;

    fn words(&self) -> &Params {
        self
    }

    fn width(&self, bin: usize) -> i64 {
        Params::width(self, bin)
    }

    /// Straight between two words of the pulse's ROM.
    fn pulse(&self, edge: usize, arrival: i64) -> [i64; 3] {
        let time = (i64::from(self.edges[edge]) << 3) - arrival;
        let place = (time >> (self.step_log2 + 4)).clamp(-1024, 1022);
        let word = |place: i64| self.pulse[(place + 1024) as usize];
        let (low, high) = (word(place), word(place + 1));
        let sixteenths = (time >> self.step_log2) & 15;
        let part = low.part + (((high.part - low.part) * sixteenths) >> 4);
        [part, low.slope, low.first]
    }

    fn glass(&self, bin: usize) -> i64 {
        self.glass.part(bin)
    }

    fn scales(&self) -> Scales<i64> {
        Params::scales(self)
    }
}
