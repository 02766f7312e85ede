//! The decoder's ROM, and what it makes of a count.

use crate::firmware::carry_chain::{Delays, Taps};
use crate::firmware::histogram_builder::Bin;
use crate::kernel::{S, U};

use super::encoder::{Decoder, Encoder};
use super::scale::TimeScale;

/// Time from the begin of bin 0, with room for the longest window in the smallest units [units].
pub(super) type TimeWord = S<44>;
/// Word of the calibration ROM, with room for the same [units].
pub type Age = U<42>;
/// Age of a hit for each `n`, and the time from the laser edge to bin 0 [units].
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
    /// Age of a hit for each `n`.
    pub cal: Calibration,
    /// Registers from the taps to `n`, 2 or 3.
    pub count_stages: u64,
    /// Units of times.
    pub scale: TimeScale,
    /// Encoder from taps to `n`.
    pub encoder: Encoder,
    /// Hits of a calibration, as a power of two, if ages come from `tdc_calibration` and not from the ROM.
    pub calibrated: Option<u32>,
}

impl Params {
    /// Returns the parameters with a ROM that is empty, if ages do not come from it.
    pub fn beside_calibration(&self) -> Self {
        let cal =
            self.cal.iter().map(|age| if self.calibrated.is_some() { U::new(0) } else { *age });
        Params { cal: cal.collect(), ..self.clone() }
    }

    /// Length of the chain [taps].
    #[inline(always)]
    pub fn taps(&self) -> usize {
        self.cal.len() - 1
    }

    /// Width of the ROM: for an age of two clock periods, and the time from the laser edge to bin 0, or for the
    /// oldest hit, which may leave the last tap later; and for the counts that a calibration has in its place
    /// [bits].
    pub fn age_bits(&self) -> u32 {
        let periods = self.scale.units(4 * self.scale.period().fs() + 2 * self.scale.first().fs());
        let age_bits = periods.max(self.oldest()).ilog2() + 1;
        age_bits.max(self.calibrated.map_or(0, |hits_log2| hits_log2 + 1))
    }

    /// The largest word of the ROM [units].
    fn oldest(&self) -> u64 {
        self.cal.iter().map(|age| age.get()).max().unwrap_or_default()
    }

    /// The last edge after the laser's at which a hit of some `n` has a time in range.
    pub fn last_coded(&self) -> u64 {
        (self.scale.range() + self.oldest() - 1) / self.scale.cycle()
    }

    /// The ROM of a chain whose delays are known: for each `n` the middle of the interval of ages that gives it,
    /// rounded half up, as far as a hit of it has reached tap 0, where hits are seen. An `n` that no age gives has
    /// the age between those of less and those of more. The interval that holds a whole clock period (time 0 at
    /// the edge after the laser's) is clamped so that its time is not negative.
    pub fn calibration(delays: &Delays, decoder: Decoder, scale: &TimeScale) -> Calibration {
        let encoder = Encoder::new(decoder, delays);
        let tap_0 = delays.tap_0().fs();
        // The least age with that `n` or more.
        let begin = |n: usize| delays.boundary(encoder.least_rank(n) - 1).fs();
        let ages = (0..=delays.taps()).map(|n| match n {
            0 => 2 * delays.boundary(0).fs(),
            n => {
                let (from, until) = (begin(n), begin(n + 1));
                if until > tap_0 { from.max(tap_0) + until } else { from + until }
            }
        });
        Params::calibration_of(ages, encoder.of_rank(delays.rank(scale.period())), scale)
    }

    /// The ROM of a converter that nobody has calibrated: as if all taps were alike and in order, from the first
    /// that is reached to the end of the chain. Then every decoder has the same.
    pub fn uniform_calibration(delays: &Delays, scale: &TimeScale) -> Calibration {
        Params::calibration(&delays.evened(), Decoder::Ones, scale)
    }

    /// The ROM with the double of such an age for each `n` [fs]; `at_start` is that of an age of a
    /// whole clock period, whose word is clamped.
    pub fn calibration_of(
        twice_fs: impl Iterator<Item = u64>,
        at_start: usize,
        scale: &TimeScale,
    ) -> Calibration {
        let first = 2 * scale.first().fs();
        let word = |twice_fs: u64| Age::new(scale.units(twice_fs + first));
        let mut cal: Calibration = twice_fs.map(word).collect();
        if let Some(age) = cal.get_mut(at_start) {
            *age = (*age).min(word(2 * scale.period().fs()));
        }
        cal
    }

    /// The code of a hit, if its time is in range.
    #[inline(always)]
    pub fn code(&self, coarse: u64, n: usize) -> Option<Bin> {
        self.code_of(self.time(coarse, self.cal[n]))
    }

    /// The code of a hit of which a single transition has reached so many taps, if its time is in range.
    #[inline(always)]
    pub fn code_of_rank(&self, coarse: u64, rank: usize) -> Option<Bin> {
        self.code(coarse, self.encoder.of_rank(rank))
    }

    /// Returns whether the time of such a hit is past the range.
    pub fn is_late(&self, coarse: u64, rank: usize) -> bool {
        self.time(coarse, self.cal[self.encoder.of_rank(rank)]).get() >= self.scale.range() as i64
    }

    /// `n` of the taps of a hit.
    #[inline(always)]
    pub fn number(&self, taps: &Taps) -> usize {
        self.encoder.of_taps(taps, self.taps())
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
        let cal = Params::calibration(&delays, Decoder::Ones, &TimeScale::default());
        assert_eq!(cal[480], 5116);
        assert_eq!(cal[479], 5108);
        assert_eq!(cal[481], 5120, "holds an age of exactly 8 ns");
        assert_eq!(cal[482], 5132);
        assert_eq!(cal[0], 1280);
        assert_eq!(cal[800], 1280 + 8 * 800 - 4);
    }

    #[test]
    fn nobody_s_calibration_of_equal_taps_is_the_right_one() {
        let scale = TimeScale::default();
        let alike = Delays::new(Time::from_ns(2), &[12_500; TAPS]).unwrap();
        let cal = Params::calibration(&alike, Decoder::Leading, &scale);
        assert_eq!(Params::uniform_calibration(&alike, &scale), cal);
        let uneven: Vec<_> = (0..TAPS).map(|tap| [24_000, 1_000][tap % 2]).collect();
        let uneven = Delays::new(Time::from_ns(2), &uneven).unwrap();
        assert_eq!(Params::uniform_calibration(&uneven, &scale), cal);
        assert_ne!(Params::calibration(&uneven, Decoder::Ones, &scale), cal);
    }

    /// Sixteen taps of which every second is reached before the one below it.
    fn crossed() -> Delays {
        let taps: Vec<_> = (0..16).map(|tap| [1_500_000, -500_000][tap % 2]).collect();
        Delays::new(Time::from_ns(2), &taps).unwrap()
    }

    #[test]
    fn a_word_is_the_mean_age_of_the_hits_that_have_its_number() {
        let (delays, scale) = (crossed(), TimeScale::default());
        for decoder in Decoder::ALL {
            let encoder = Encoder::new(decoder, &delays);
            let cal = Params::calibration(&delays, decoder, &scale);
            // Every 10 ps, between the arrivals, from the first until the hit has left.
            let ages = (delays.boundary(0).fs()..delays.boundary(16).fs()).step_by(10_000);
            let ages: Vec<_> = ages.map(|fs| Time::from_fs(fs + 5_000)).collect();
            // The last tap is reached as the hit leaves.
            for (n, word) in cal.iter().enumerate().take(16).skip(1) {
                let own = ages.iter().filter(|age| encoder.of_rank(delays.rank(**age)) == n);
                let own: Vec<_> = own.map(|age| age.fs()).collect();
                assert_eq!(!own.is_empty(), encoder.occurs(n), "{decoder:?} {n}");
                if own.is_empty() || own.contains(&8_005_000) {
                    continue;
                }
                let mean_fs = own.iter().sum::<u64>() / own.len() as u64;
                assert_eq!(word.get(), scale.units(2 * mean_fs), "{decoder:?} {n}");
            }
        }
    }

    #[test]
    fn a_number_that_never_occurs_has_the_age_at_which_the_leading_one_passes_it() {
        let delays = crossed();
        // Taps 0, 2, 1, 4, 3 and so on are reached, the first two 1 ns apart.
        assert_eq!(delays.order()[..5], [0, 2, 1, 4, 3]);
        let cal = Params::calibration(&delays, Decoder::Leading, &TimeScale::default());
        let encoder = Encoder::new(Decoder::Leading, &delays);
        assert!(!encoder.occurs(2) && encoder.occurs(3));
        // From 2 to 3 ns there is tap 0, from then to 4 ns tap 2 leads; 1 ns is 640 units.
        assert_eq!([1, 2, 3].map(|n| cal[n].get()), [5 * 320, 6 * 320, 7 * 320]);
    }

    #[test]
    fn a_word_of_the_rom_holds_a_hit_that_leaves_the_last_tap_late() {
        let delays = Delays::new(Time::from_fs(800_000), &[1_000_000; 16]).unwrap();
        let scale = TimeScale::new(Time::from_ns(8), Time::from_fs(15_700), Time::ZERO, 3, 256);
        let cal = Params::calibration(&delays, Decoder::Ones, &scale);
        let oldest = cal[16].get();
        let two_periods = 2 * scale.cycle();
        assert!(two_periods.ilog2() < oldest.ilog2(), "{two_periods}, {oldest}");
        let bits =
            Params { cal, count_stages: 3, scale, encoder: Encoder::default(), calibrated: None }
                .age_bits();
        assert!(oldest < 1 << bits, "{oldest} in {bits} bits");
    }
}
