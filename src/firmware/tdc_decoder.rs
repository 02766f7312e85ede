//! Turns a hit into a code, of 25 ps on the KC705.
//!
//! Mirrors `rtl_ref/tdc_decoder.v`. The number of the taps in two or three steps, its time, and the code:
//!
//! ```text
//! edge       e+1       e+2       e+3       e+4  e+5       e+6  e+7
//! register   hit_taps  sixteens  hundreds  n    age       t    tdc_code = t >> Digits
//!                                               = cal[n]  = Cycle (coarse + 1) - age   [units]
//! ```
//!
//! [`TimeScale`] says what a unit is: 25/16 ps on the KC705, of which `Cycle` is 5120. Time 0 is where bin 0
//! begins; the ages in the ROM know by how much that is after the laser edge. With two steps, `n` counts
//! the sixteens and all after it comes an edge earlier. A time outside the bins has no code, and `tdc_code`
//! keeps its value. What `n` is of the taps, [`Decoder`] says: their ones count, or the place of the highest one.
//! Each register holds its last hit; only what says that a hit is new has a reset. Where the firmware calibrates
//! itself the age is that of `tdc_calibration`, which reads its RAM as this block does its ROM.

mod encoder;
mod params;
mod scale;

use crate::kernel::{Clocked, PartialOnes, U, asleep_if};
use crate::signals;

use super::carry_chain::Taps;
use super::coarse_counter::Coarse;
use super::histogram_builder::Bin;
pub use encoder::{Decoder, Encoder};
use params::TimeWord;
pub use params::{Age, COUNT_STAGES, Calibration, Params};
pub use scale::TimeScale;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// `hit_taps` are those of a new hit.
        pub hit: bool,
        /// Its coarse count.
        #[size(CoarseBits)]
        pub hit_coarse: Coarse,
        /// Its taps.
        #[size(Taps)]
        pub hit_taps: Taps,
        /// The time for `n` by the last calibration, a cycle after `n` [units].
        #[only_if(Calibrated)]
        #[size(AgeBits)]
        pub calibrated_age: Age,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct TdcDecoder {
        /// `tdc_code` is new; one cycle.
        pub tdc_valid: bool,
        /// Time of the hit [bins].
        #[size(BinBits)]
        pub tdc_code: Bin,
        /// Ones among 16 taps each, or the place of the highest.
        #[size(Sixteens)]
        sixteens: PartialOnes<16>,
        /// `sixteens` is new.
        sixteens_valid: bool,
        /// Coarse count of `sixteens`.
        #[size(CoarseBits)]
        sixteens_coarse: Coarse,
        /// Ones among 128 taps each, or the place of the highest.
        #[size(Hundreds)]
        hundreds: PartialOnes<128>,
        /// `hundreds` is new.
        hundreds_valid: bool,
        /// Coarse count of `hundreds`.
        #[size(CoarseBits)]
        hundreds_coarse: Coarse,
        /// Taps that the last hit had run through, by the decoder.
        #[only_if(Calibrated)]
        #[size(CountOfTaps)]
        #[view(heading = "TDC", probe = true)]
        pub n: U<11>,
        /// `n` is new.
        #[only_if(Calibrated)]
        pub n_valid: bool,
        /// Coarse count of `n`.
        #[size(CoarseBits)]
        n_coarse: Coarse,
        /// The time for `n` [units].
        #[size(AgeBits)]
        age: Age,
        /// `age` is new.
        age_valid: bool,
        /// Coarse count of `age`.
        #[size(CoarseBits)]
        age_coarse: Coarse,
        /// Time from the begin of bin 0 [units].
        #[size(TimeBits)]
        t: TimeWord,
        /// `t` is new.
        t_valid: bool,
    }
}

impl TdcDecoder {
    /// The hit that has just been counted: `n` and coarse count.
    pub fn counted(&self) -> Option<(u64, u64)> {
        self.n_valid.then_some((self.n.get(), self.n_coarse.get()))
    }

    /// Returns whether a hit is on its way to its code, or a code is new.
    #[inline(always)]
    pub fn has_hit(&self) -> bool {
        let before = self.sixteens_valid | self.hundreds_valid | self.n_valid;
        before | self.age_valid | self.t_valid | self.tdc_valid
    }

    /// Returns whether the coming edge makes a code, or finds that there is none.
    pub fn decides(&self) -> bool {
        self.t_valid
    }
}

impl Clocked for TdcDecoder {
    type In = In;
    type Params = Params;

    /// From the end on, so that each register takes what the one before it was.
    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        if !(i.rst | i.hit | self.has_hit()) {
            return;
        }
        let code = if self.t_valid { p.code_of(self.t) } else { None };
        self.tdc_valid = code.is_some();
        if let Some(code) = code {
            self.tdc_code = code;
        }
        self.t_valid = self.age_valid;
        if self.age_valid {
            let age = if p.calibrated.is_some() { i.calibrated_age } else { self.age };
            self.t = p.time(self.age_coarse.get(), age);
        }
        self.age_valid = self.n_valid;
        if self.n_valid {
            (self.age, self.age_coarse) = (p.cal[self.n.index()], self.n_coarse);
        }
        let number = |taps: &Taps| U::new(p.number(taps) as u64);
        if p.count_stages == 2 {
            self.n_valid = self.sixteens_valid;
            if self.sixteens_valid {
                (self.n, self.n_coarse) = (number(&self.sixteens.0), self.sixteens_coarse);
            }
        } else {
            self.n_valid = self.hundreds_valid;
            if self.hundreds_valid {
                (self.n, self.n_coarse) = (number(&self.hundreds.0), self.hundreds_coarse);
            }
        }
        self.hundreds_valid = self.sixteens_valid;
        if self.sixteens_valid {
            self.hundreds = PartialOnes(self.sixteens.0);
            self.hundreds_coarse = self.sixteens_coarse;
        }
        self.sixteens_valid = i.hit;
        if i.hit {
            (self.sixteens, self.sixteens_coarse) = (PartialOnes(i.hit_taps), i.hit_coarse);
        }
        if i.rst {
            (self.tdc_valid, self.tdc_code) = (false, U::new(0));
            (self.sixteens_valid, self.hundreds_valid) = (false, false);
            (self.n_valid, self.age_valid, self.t_valid) = (false, false, false);
        }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, _: &Params) -> u64 {
        asleep_if(!(i.rst | i.hit | self.has_hit()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::carry_chain::TAPS;
    use super::*;

    fn params(cal: Calibration, count_stages: u64) -> Params {
        let (scale, encoder) = (TimeScale::default(), Encoder::default());
        Params { cal, count_stages, scale, encoder, calibrated: None }
    }

    fn decode(coarse: u64, n: usize, p: &Params) -> (bool, u64) {
        let hit = In {
            rst: false,
            hit: true,
            hit_coarse: U::new(coarse),
            hit_taps: Taps::new(true, [n]),
            calibrated_age: U::new(0),
        };
        let idle = In { hit: false, hit_taps: Taps::settled(false), ..hit };
        let mut decoder = TdcDecoder::default().next(&hit, p);
        for _ in 0..p.latency() - 2 {
            assert!(!decoder.tdc_valid);
            decoder = decoder.next(&idle, p);
        }
        (decoder.tdc_valid, decoder.tdc_code.get())
    }

    #[test]
    fn the_time_is_the_edge_less_the_calibrated_delay() {
        let mut cal = vec![U::new(0); TAPS + 1];
        cal[100] = U::new(5120);
        cal[101] = U::new(5119);
        cal[102] = U::new(5121);
        cal[103] = U::new(5120 - 4095);
        cal[104] = U::new(5120 - 4096);
        for p in [params(cal.clone(), 2), params(cal, 3)] {
            assert_eq!(decode(0, 100, &p), (true, 0));
            assert_eq!(decode(0, 101, &p), (true, 0));
            assert_eq!(decode(0, 102, &p), (false, 0), "before the laser edge");
            assert_eq!(decode(0, 103, &p), (true, 255));
            assert_eq!(decode(0, 104, &p), (false, 0), "past the range");
            assert_eq!(decode(7, 100, &p), (false, 0), "a late cycle");
        }
    }
}
