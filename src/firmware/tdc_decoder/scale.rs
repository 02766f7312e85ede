//! The unit of the decoder's times.

use crate::firmware::histogram_builder::BINS;
use crate::kernel::Time;

/// Fewest binary digits of a time below a bin [bits].
const FEWEST_DIGITS: u32 = 4;

/// How times become codes. A time counts units, of which a bin has a power of two, so that the code is the
/// time without its lowest bits.
///
/// The decoder multiplies the number of an edge by whole units of a clock period. So many units make a bin
/// that this and the rounding of the calibration come to less than 1/32 of a bin at the end of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeScale {
    /// Period of clk_sys.
    period: Time,
    /// Width of a bin.
    bin: Time,
    /// Time at which bin 0 begins, from the laser edge.
    first: Time,
    /// Binary digits of a time below a bin: units in a bin, as a shift [bits].
    digits: u32,
    /// A clock period [units].
    cycle: u64,
    /// Bins, and so codes.
    bins: usize,
}

impl Default for TimeScale {
    /// The KC705's: 5120 units of 25/16 ps in 8 ns, which is exact.
    fn default() -> Self {
        TimeScale::new(Time::from_ns(8), Time::from_fs(25_000), Time::ZERO, 3, BINS)
    }
}

impl TimeScale {
    /// Of so many bins of that width, the first at that time, where windows have 2^`coarse_bits` clock periods.
    pub fn new(period: Time, bin: Time, first: Time, coarse_bits: u32, bins: usize) -> Self {
        let with = |digits: u32| {
            let scale = TimeScale { period, bin, first, digits, cycle: 0, bins };
            TimeScale { cycle: scale.units(2 * period.fs()), ..scale }
        };
        let holds = |digits: &u32| {
            let rounding = (period.fs() << digits).abs_diff(with(*digits).cycle * bin.fs());
            16 * (((2 * rounding) << coarse_bits) + bin.fs()) <= bin.fs() << digits
        };
        // With so many, half a unit at each edge of the window is little enough.
        let most = FEWEST_DIGITS + coarse_bits + 1;
        with((FEWEST_DIGITS..most).find(holds).unwrap_or(most))
    }

    /// A clock period [units].
    #[inline(always)]
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Period of clk_sys.
    pub fn period(&self) -> Time {
        self.period
    }

    /// Binary digits of a time below a bin [bits].
    #[inline(always)]
    pub fn digits(&self) -> u32 {
        self.digits
    }

    /// Width of a bin.
    pub fn bin(&self) -> Time {
        self.bin
    }

    /// Time at which bin 0 begins, from the laser edge.
    pub fn first(&self) -> Time {
        self.first
    }

    /// Bins, and so codes.
    #[inline(always)]
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// First time past the last bin, after the begin of the first [units].
    #[inline(always)]
    pub fn range(&self) -> u64 {
        (self.bins as u64) << self.digits
    }

    /// Half of that many femtoseconds, rounded half up [units].
    pub fn units(&self, twice_fs: u64) -> u64 {
        ((twice_fs << self.digits) + self.bin.fs()) / (2 * self.bin.fs())
    }

    /// A time in units of which each has 2^`fraction` parts, rounded half up [2^-fraction units].
    pub fn parts(&self, time: Time, fraction: u32) -> u64 {
        let doubled = u128::from(time.fs()) << (self.digits + fraction + 1);
        ((doubled + u128::from(self.bin.fs())) / u128::from(2 * self.bin.fs())) as u64
    }

    /// Of a time in units, from the laser edge [ps].
    pub fn ps(&self, units: i64) -> f64 {
        let unit_fs = self.bin.fs() as f64 / (1u64 << self.digits) as f64;
        (units as f64 * unit_fs + self.first.fs() as f64) * 1e-3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_of_the_kc705_is_a_sixteenth_of_a_bin() {
        let scale = TimeScale::default();
        assert_eq!((scale.digits(), scale.cycle(), scale.range()), (4, 5120, 4096));
    }

    #[test]
    fn at_the_end_of_the_window_a_time_is_right_to_a_32nd_of_a_bin() {
        let mut digits = Vec::new();
        for period_fs in [8_000_000, 10_000_000, 3_333_333] {
            for bin_fs in [5_000, 7_001, 12_500, 25_000, 43_000, 100_000, 2_000_000] {
                for coarse_bits in 1..=12 {
                    let [period, bin] = [period_fs, bin_fs].map(Time::from_fs);
                    let scale = TimeScale::new(period, bin, Time::ZERO, coarse_bits, BINS);
                    let units = (scale.cycle() << coarse_bits) as f64;
                    let exact = ((period_fs << coarse_bits) as f64 / bin_fs as f64)
                        * f64::powi(2.0, scale.digits() as i32);
                    let off = (units - exact).abs() + 0.5;
                    assert!(off <= f64::powi(2.0, scale.digits() as i32 - 5) + 1e-6, "{scale:?}");
                    digits.push(scale.digits());
                }
            }
        }
        assert_eq!(digits.iter().min(), Some(&4));
        assert!(digits.iter().max() > Some(&10), "{digits:?}");
    }
}
