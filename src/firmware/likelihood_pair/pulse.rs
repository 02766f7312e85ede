//! The part of the other echo's pulse that lies in a bin.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::kernel::{S, U};

use super::{In, LikelihoodPair};

impl LikelihoodPair {
    /// The words of the pulse around the word's end, one in each cycle of a beat, and a straight line between them.
    pub(super) fn fetch(&self, i: &In, p: &Params, d: &mut Self) {
        d.from_arrival = S::new(((i.word_end.get() as i64) << 3) - i.other_arrival.get() as i64);
        let time = self.from_arrival.get();
        let place = (time >> (p.step_log2 + 4)).clamp(-1024, 1022) + 1024;
        d.place = U::new(place as u64 + u64::from(!i.phase));
        d.fetched_part = U::new(p.pulse[self.place.index()].part as u64);
        if i.phase {
            shift(&mut d.sixteenths, U::new((time >> p.step_log2) as u64));
            shift(&mut d.low_part, self.fetched_part);
        }
        d.rise = self.fetched_part - self.low_part[0].get();
        d.risen = U::new(self.rise.get() * self.sixteenths[1].get());
        d.pulse_part = self.low_part[1] + (self.risen.get() >> 4);
    }

    /// Cuts out the part that lies in the bin.
    pub(super) fn cut_out(&self, i: &In, d: &mut Self) {
        shift(&mut d.bin, i.word_bin);
        shift(&mut d.edge_alone, i.word_edge);
        shift(&mut d.first, i.word_first);
        let none = self.edge_alone[2] && self.first[2];
        d.last_part = if none { U::new(0) } else { self.pulse_part };
        d.part = if self.bin[2] { self.pulse_part - self.last_part.get() } else { U::new(0) };
    }
}
