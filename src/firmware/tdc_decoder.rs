//! Turns a hit into a code of 25 ps.
//!
//! Mirrors `rtl_ref/tdc_decoder.v`. The ones count in two or three steps, its time, and the code:
//!
//! ```text
//! edge       e+1       e+2       e+3       e+4  e+5       e+6  e+7
//! register   hit_taps  sixteens  hundreds  n    age       t    tdc_code = t >> 4
//!                                               = cal[n]  = 5120 (coarse + 1) - age   [25/16 ps]
//! ```
//!
//! With two steps, `n` counts the sixteens and all after it comes an edge earlier. A time outside
//! 0 .. 4095 has no code, and `tdc_code` keeps its value. Each register holds its last hit; only what
//! says that a hit is new has a reset.

use crate::kernel::{Clocked, PartialOnes, S, U, asleep_if};
use crate::signals;

pub use super::carry_chain::Calibration;
use super::carry_chain::Taps;
use super::coarse_counter::Coarse;

/// One cycle of `clk_sys` [25/16 ps].
pub const CYCLE: i64 = 5120;
/// Time codes in a bin of 25 ps, as a shift.
const BIN_SHIFT: u32 = 4;
/// First time past the last bin, 6.4 ns [25/16 ps].
const RANGE: i64 = 256 << BIN_SHIFT;
/// Time from the laser edge, with room for the longest window [25/16 ps].
type TimeWord = S<26>;
/// Registers of the ones count unless elaboration says otherwise.
pub const COUNT_STAGES: u64 = 3;
/// Edges from the one that samples the taps of a hit to the one that makes its `n`, beside those of
/// the count.
const BEFORE_COUNT: u64 = 1;
/// Edges from there to the code.
const AFTER_COUNT: u64 = 3;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// `hit_taps` are those of a new hit.
        pub hit: bool,
        /// Its coarse count.
        #[size("CoarseBits")]
        pub hit_coarse: Coarse,
        /// Its taps.
        #[size("Taps")]
        pub hit_taps: Taps,
    }
}

/// ROM and parameter.
#[derive(Clone, Debug)]
pub struct Params {
    /// Age of a hit for each ones count.
    pub cal: Calibration,
    /// Registers of the ones count, 2 or 3.
    pub count_stages: u64,
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct TdcDecoder {
        /// `tdc_code` is new; one cycle.
        pub tdc_valid: bool,
        /// Time from the laser edge to the hit [25 ps].
        pub tdc_code: U<8>,
        /// Ones among 16 taps each.
        #[size("Sixteens")]
        sixteens: PartialOnes<16>,
        /// `sixteens` is new.
        sixteens_valid: bool,
        /// Coarse count of `sixteens`.
        #[size("CoarseBits")]
        sixteens_coarse: Coarse,
        /// Ones among 128 taps each.
        #[size("Hundreds")]
        hundreds: PartialOnes<128>,
        /// `hundreds` is new.
        hundreds_valid: bool,
        /// Coarse count of `hundreds`.
        #[size("CoarseBits")]
        hundreds_coarse: Coarse,
        /// Taps that the last hit had run through.
        #[size("CountOfTaps")]
        #[view(heading = "TDC", probe = true)]
        n: U<11>,
        /// `n` is new.
        n_valid: bool,
        /// Coarse count of `n`.
        #[size("CoarseBits")]
        n_coarse: Coarse,
        /// The time for `n` [25/16 ps].
        age: U<14>,
        /// `age` is new.
        age_valid: bool,
        /// Coarse count of `age`.
        #[size("CoarseBits")]
        age_coarse: Coarse,
        /// Time from the laser edge [25/16 ps].
        #[size("TimeBits")]
        t: TimeWord,
        /// `t` is new.
        t_valid: bool,
    }
}

impl Params {
    /// Length of the chain [taps].
    #[inline(always)]
    pub fn taps(&self) -> usize {
        self.cal.len() - 1
    }

    /// The last edge after the laser's at which a hit of some ones count has a time in range.
    pub fn last_coded(&self) -> u64 {
        let oldest = self.cal.iter().map(|age| age.get() as i64).max().unwrap_or_default();
        (RANGE + oldest - 1).div_euclid(CYCLE) as u64
    }

    /// From the edge that samples the taps of a hit to the one that makes its code [cycles of clk_sys].
    pub fn latency(&self) -> u64 {
        BEFORE_COUNT + self.count_stages + AFTER_COUNT
    }
}

impl TdcDecoder {
    /// The hit that has just been counted: ones count and coarse count.
    pub fn counted(&self) -> Option<(u64, u64)> {
        self.n_valid.then_some((self.n.get(), self.n_coarse.get()))
    }

    /// Whether a hit is on its way to its code, or a code is new.
    #[inline(always)]
    pub fn has_hit(&self) -> bool {
        let before = self.sixteens_valid | self.hundreds_valid | self.n_valid;
        before | self.age_valid | self.t_valid | self.tdc_valid
    }

    /// Whether the coming edge makes a code, or finds that there is none.
    pub fn decides(&self) -> bool {
        self.t_valid
    }
}

/// The code of a hit, if its time is in range.
#[inline(always)]
pub fn code(coarse: u64, n: usize, cal: &[U<14>]) -> Option<U<8>> {
    code_of(time(coarse, cal[n]))
}

/// Whether the time of such a hit is past the range.
pub fn is_late(coarse: u64, n: usize, cal: &[U<14>]) -> bool {
    time(coarse, cal[n]).get() >= RANGE
}

/// Time from the laser edge, of a hit of that age.
#[inline(always)]
fn time(coarse: u64, age: U<14>) -> TimeWord {
    TimeWord::new(CYCLE * (coarse as i64 + 1) - age.get() as i64)
}

#[inline(always)]
fn code_of(t: TimeWord) -> Option<U<8>> {
    (0..RANGE).contains(&t.get()).then(|| U::new(t.get() as u64 >> BIN_SHIFT))
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
        let code = code_of(self.t).filter(|_| self.t_valid);
        self.tdc_valid = code.is_some();
        self.tdc_code = code.unwrap_or(self.tdc_code);
        self.t_valid = self.age_valid;
        if self.age_valid {
            self.t = time(self.age_coarse.get(), self.age);
        }
        self.age_valid = self.n_valid;
        if self.n_valid {
            (self.age, self.age_coarse) = (p.cal[self.n.index()], self.n_coarse);
        }
        let (taps, counted, coarse) = match p.count_stages {
            2 => (&self.sixteens.0, self.sixteens_valid, self.sixteens_coarse),
            _ => (&self.hundreds.0, self.hundreds_valid, self.hundreds_coarse),
        };
        self.n_valid = counted;
        if counted {
            (self.n, self.n_coarse) = (U::new(taps.ones(p.taps()) as u64), coarse);
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
        Params { cal, count_stages }
    }

    fn decode(coarse: u64, n: usize, p: &Params) -> (bool, u64) {
        let hit = In {
            rst: false,
            hit: true,
            hit_coarse: U::new(coarse),
            hit_taps: Taps::new(true, [n]),
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
