//! Turns a hit into a code, of 25 ps on the KC705.
//!
//! Mirrors `rtl_ref/tdc_decoder.v`. The ones count in two or three steps, its time, and the code:
//!
//! ```text
//! edge       e+1       e+2       e+3       e+4  e+5       e+6  e+7
//! register   hit_taps  sixteens  hundreds  n    age       t    tdc_code = t >> Digits
//!                                               = cal[n]  = Cycle (coarse + 1) - age   [units]
//! ```
//!
//! [`TimeScale`] says what a unit is: 25/16 ps on the KC705, of which `Cycle` is 5120. Time 0 is where bin 0
//! begins; the ages in the ROM know by how much that is after the laser edge. With two steps, `n` counts
//! the sixteens and all after it comes an edge earlier. A time outside 256 bins has no code, and `tdc_code`
//! keeps its value. Each register holds its last hit; only what says that a hit is new has a reset.

mod scale;

use crate::kernel::{Clocked, PartialOnes, S, U, asleep_if};
use crate::signals;

use super::carry_chain::{Delays, Taps};
use super::coarse_counter::Coarse;
pub use scale::{CODES, TimeScale};

/// Time from the begin of bin 0, with room for the longest window in the smallest units [units].
type TimeWord = S<44>;
/// Word of the calibration ROM, with room for the same [units].
type Age = U<42>;
/// Age of a hit for each ones count, and the time from the laser edge to bin 0 [units].
pub type Calibration = Vec<Age>;
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
    /// What times count.
    pub scale: TimeScale,
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct TdcDecoder {
        /// `tdc_code` is new; one cycle.
        pub tdc_valid: bool,
        /// Time of the hit [bins].
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
        /// The time for `n` [units].
        #[size("AgeBits")]
        age: Age,
        /// `age` is new.
        age_valid: bool,
        /// Coarse count of `age`.
        #[size("CoarseBits")]
        age_coarse: Coarse,
        /// Time from the begin of bin 0 [units].
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

    /// Width of the ROM: for an age of two clock periods, and the time from the laser edge to bin 0, or for the
    /// oldest hit, which may leave the last tap later [bits].
    pub fn age_bits(&self) -> u32 {
        let periods = self.scale.units(4 * self.scale.period().fs() + 2 * self.scale.first().fs());
        periods.max(self.oldest()).ilog2() + 1
    }

    /// The largest word of the ROM [units].
    fn oldest(&self) -> u64 {
        self.cal.iter().map(|age| age.get()).max().unwrap_or_default()
    }

    /// The last edge after the laser's at which a hit of some ones count has a time in range.
    pub fn last_coded(&self) -> u64 {
        (self.scale.range() + self.oldest() - 1) / self.scale.cycle()
    }

    /// The ROM of a chain whose delays are known: for each ones count the middle of the interval of ages that
    /// gives it, rounded half up. The interval that holds a whole clock period (time 0 at the edge after the
    /// laser's) is clamped so that its time is not negative.
    pub fn calibration(delays: &Delays, scale: &TimeScale) -> Calibration {
        let boundary = |n: usize| delays.boundary(n).fs();
        let first = 2 * scale.first().fs();
        let word = |twice_fs: u64| Age::new(scale.units(twice_fs + first));
        let mut cal = vec![word(2 * boundary(0)); delays.taps() + 1];
        for (n, age) in cal.iter_mut().enumerate().skip(1) {
            *age = word(boundary(n - 1) + boundary(n));
        }
        let period = scale.period();
        let at_start = delays.rank(period);
        cal[at_start] = cal[at_start].min(word(2 * period.fs()));
        cal
    }

    /// The code of a hit, if its time is in range.
    #[inline(always)]
    pub fn code(&self, coarse: u64, n: usize) -> Option<U<8>> {
        self.code_of(self.time(coarse, self.cal[n]))
    }

    /// Whether the time of such a hit is past the range.
    pub fn is_late(&self, coarse: u64, n: usize) -> bool {
        self.time(coarse, self.cal[n]).get() >= self.scale.range() as i64
    }

    /// Time from the begin of bin 0, of a hit of that age.
    #[inline(always)]
    fn time(&self, coarse: u64, age: Age) -> TimeWord {
        TimeWord::new((self.scale.cycle() * (coarse + 1)) as i64 - age.get() as i64)
    }

    #[inline(always)]
    fn code_of(&self, t: TimeWord) -> Option<U<8>> {
        let is_in_range = (0..self.scale.range() as i64).contains(&t.get());
        is_in_range.then(|| U::new(t.get() as u64 >> self.scale.digits()))
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

impl Clocked for TdcDecoder {
    type In = In;
    type Params = Params;

    /// From the end on, so that each register takes what the one before it was.
    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        if !(i.rst | i.hit | self.has_hit()) {
            return;
        }
        let code = p.code_of(self.t).filter(|_| self.t_valid);
        self.tdc_valid = code.is_some();
        self.tdc_code = code.unwrap_or(self.tdc_code);
        self.t_valid = self.age_valid;
        if self.age_valid {
            self.t = p.time(self.age_coarse.get(), self.age);
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
    use crate::kernel::Time;

    use super::*;

    fn params(cal: Calibration, count_stages: u64) -> Params {
        Params { cal, count_stages, scale: TimeScale::default() }
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
    fn ideal_taps_are_two_to_a_bin_and_time_zero_is_clamped() {
        let delays = Delays::new(Time::from_ns(2), &[12_500; TAPS]).unwrap();
        let cal = Params::calibration(&delays, &TimeScale::default());
        assert_eq!(cal[480], 5116);
        assert_eq!(cal[479], 5108);
        assert_eq!(cal[481], 5120, "holds an age of exactly 8 ns");
        assert_eq!(cal[482], 5132);
        assert_eq!(cal[0], 1280);
        assert_eq!(cal[800], 1280 + 8 * 800 - 4);
    }

    #[test]
    fn a_word_of_the_rom_holds_a_hit_that_leaves_the_last_tap_late() {
        let delays = Delays::new(Time::from_fs(800_000), &[1_000_000; 16]).unwrap();
        let scale = TimeScale::new(Time::from_ns(8), Time::from_fs(15_700), Time::ZERO, 3);
        let cal = Params::calibration(&delays, &scale);
        let oldest = cal[16].get();
        let two_periods = 2 * scale.cycle();
        assert!(two_periods.ilog2() < oldest.ilog2(), "{two_periods}, {oldest}");
        let bits = Params { cal, count_stages: 3, scale }.age_bits();
        assert!(oldest < 1 << bits, "{oldest} in {bits} bits");
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
