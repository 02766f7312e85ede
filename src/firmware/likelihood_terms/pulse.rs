//! The part of the pulse that lies in a bin, and the slope of its logarithm.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::pulse::PulseWord;
use crate::kernel::{S, U};

use super::{In, LikelihoodTerms};

impl LikelihoodTerms {
    /// The words of the pulse around the word's end, one in each cycle of a beat, and a straight line between them.
    pub(super) fn fetch(&self, i: &In, p: &Params, d: &mut Self) {
        d.from_arrival = S::new(((i.word_end.get() as i64) << 3) - i.arrival.get() as i64);
        let time = self.from_arrival.get();
        let place = (time >> (p.step_log2 + 4)).clamp(-1024, 1022) + 1024;
        d.place = U::new(place as u64 + u64::from(!i.phase));
        let PulseWord { part, slope, first } = p.pulse[self.place.index()];
        d.fetched_part = U::new(part as u64);
        (d.fetched_slope, d.fetched_first) = (S::new(slope), S::new(first));
        if i.phase {
            shift(&mut d.sixteenths, U::new((time >> p.step_log2) as u64));
            shift(&mut d.low_part, self.fetched_part);
            shift(&mut d.low_slope, self.fetched_slope);
            shift(&mut d.low_first, self.fetched_first);
        }
        d.rise = self.fetched_part - self.low_part[0].get();
        d.risen = U::new(self.rise.get() * self.sixteenths[1].get());
        d.pulse_part = self.low_part[1] + (self.risen.get() >> 4);
        (d.pulse_slope, d.pulse_first) = (self.low_slope[1], self.low_first[1]);
    }

    /// Cuts out the part that lies in the bin.
    pub(super) fn cut_out(&self, i: &In, p: &Params, d: &mut Self) {
        let none = self.edge_alone[2] && self.first[2];
        d.last_part = if none { U::new(0) } else { self.pulse_part };
        d.last_slope = self.pulse_slope;
        let dark = if p.has_more_light() { i.dark } else { i.scan };
        let lit = self.bin[2] && !dark;
        d.part = if lit { self.pulse_part - self.last_part.get() } else { U::new(0) };
        let between = (self.pulse_slope.get() + self.last_slope.get()) >> 1;
        let z = if self.first[2] { self.pulse_first.get() } else { between };
        shift(&mut d.z, S::new(if self.rest[2] { 0 } else { z }));
    }
}
