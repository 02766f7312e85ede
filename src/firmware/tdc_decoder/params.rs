//! The decoder's ROM, and what it makes of a count.

use crate::firmware::carry_chain::Delays;
use crate::firmware::histogram_builder::Bin;
use crate::kernel::{S, U};

use super::scale::TimeScale;

/// Time from the begin of bin 0, with room for the longest window in the smallest units [units].
pub(super) type TimeWord = S<44>;
/// Word of the calibration ROM, with room for the same [units].
pub(super) type Age = U<42>;
/// Age of a hit for each ones count, and the time from the laser edge to bin 0 [units].
pub type Calibration = Vec<Age>;
/// Registers of the ones count unless elaboration says otherwise.
pub const COUNT_STAGES: u64 = 3;
/// Edges from the one that samples the taps of a hit to the one that makes its `n`, beside those of
/// the count.
const BEFORE_COUNT: u64 = 1;
/// Edges from there to the code.
const AFTER_COUNT: u64 = 3;

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
    pub fn code(&self, coarse: u64, n: usize) -> Option<Bin> {
        self.code_of(self.time(coarse, self.cal[n]))
    }

    /// Whether the time of such a hit is past the range.
    pub fn is_late(&self, coarse: u64, n: usize) -> bool {
        self.time(coarse, self.cal[n]).get() >= self.scale.range() as i64
    }

    /// Time from the begin of bin 0, of a hit of that age.
    #[inline(always)]
    pub(super) fn time(&self, coarse: u64, age: Age) -> TimeWord {
        TimeWord::new((self.scale.cycle() * (coarse + 1)) as i64 - age.get() as i64)
    }

    /// The code of a time, if it is in range.
    #[inline(always)]
    pub(super) fn code_of(&self, t: TimeWord) -> Option<Bin> {
        let is_in_range = (0..self.scale.range() as i64).contains(&t.get());
        is_in_range.then(|| U::new(t.get() as u64 >> self.scale.digits()))
    }

    /// From the edge that samples the taps of a hit to the one that makes its code [cycles of clk_sys].
    pub fn latency(&self) -> u64 {
        BEFORE_COUNT + self.count_stages + AFTER_COUNT
    }
}

#[cfg(test)]
mod tests {
    use crate::firmware::carry_chain::TAPS;
    use crate::kernel::Time;

    use super::*;

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
        let scale = TimeScale::new(Time::from_ns(8), Time::from_fs(15_700), Time::ZERO, 3, 256);
        let cal = Params::calibration(&delays, &scale);
        let oldest = cal[16].get();
        let two_periods = 2 * scale.cycle();
        assert!(two_periods.ilog2() < oldest.ilog2(), "{two_periods}, {oldest}");
        let bits = Params { cal, count_stages: 3, scale }.age_bits();
        assert!(oldest < 1 << bits, "{oldest} in {bits} bits");
    }
}
