//! Time unit of a waveform.

/// Length of a unit of time [1e-21 s].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tick(u128);

impl Tick {
    /// One femtosecond.
    pub const FEMTOSECOND: Tick = Tick(1_000_000);
    /// One picosecond.
    pub const PICOSECOND: Tick = Tick(1_000_000_000);
    /// One nanosecond.
    pub(super) const NANOSECOND: Tick = Tick(1_000_000_000_000);

    /// Creates a unit of `factor` times 10 to the `exponent` seconds; `None` if it is 0 or not a multiple of 1e-21 s.
    pub fn new(factor: u32, exponent: i8) -> Option<Tick> {
        let power = u32::try_from(exponent as i32 + 21).ok()?;
        let length = 10u128.checked_pow(power)?.checked_mul(factor as u128)?;
        (length > 0).then_some(Tick(length))
    }

    /// Converts `at` from this unit to the unit `other`, rounded down.
    pub fn convert(self, at: u64, other: Tick) -> u64 {
        if self == other {
            return at;
        }
        u64::try_from(at as u128 * self.0 / other.0).unwrap_or(u64::MAX)
    }

    /// Returns the largest power of ten, as an exponent [s], of which this unit is a multiple, and that multiple.
    pub(crate) fn decimal(self) -> (i8, u64) {
        let (mut length, mut exponent) = (self.0, -21);
        while length.is_multiple_of(10) {
            (length, exponent) = (length / 10, exponent + 1);
        }
        (exponent, length as u64)
    }

    /// Converts `at` from this unit to whole nanoseconds, and a rest [1e-21 s].
    pub(crate) fn nanoseconds(self, at: u64) -> [u128; 2] {
        let (length, nanosecond) = (at as u128 * self.0, 1000 * Tick::PICOSECOND.0);
        [length / nanosecond, length % nanosecond]
    }

    /// Converts `at` from this unit [ps].
    pub(crate) fn picoseconds(self, at: u64) -> f64 {
        if self.0.is_multiple_of(Tick::FEMTOSECOND.0) {
            return self.femtoseconds(at) as f64 / 1e3;
        }
        (at as u128 * self.0) as f64 / Tick::PICOSECOND.0 as f64
    }

    /// Converts `at` from this unit [fs].
    pub fn femtoseconds(self, at: u64) -> u128 {
        at as u128 * self.0 / Tick::FEMTOSECOND.0
    }

    /// Converts a time to this unit, rounded down.
    pub fn count(self, femtoseconds: u128) -> u64 {
        (femtoseconds * Tick::FEMTOSECOND.0 / self.0) as u64
    }

    /// Converts a time to this unit, rounded up.
    pub fn count_up(self, femtoseconds: u128) -> u64 {
        (femtoseconds * Tick::FEMTOSECOND.0).div_ceil(self.0) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_rounded_down_to_the_coarser_unit() {
        let (fine, coarse) = (Tick::new(1, -15).unwrap(), Tick::new(1, -12).unwrap());
        assert_eq!(fine.convert(1999, coarse), 1);
        assert_eq!(coarse.convert(7, coarse), 7);
        assert_eq!(Tick::new(100, -12).unwrap().convert(19, Tick::new(1, -9).unwrap()), 1);
        assert_eq!((coarse.count(1999), coarse.count_up(1001), coarse.count_up(1000)), (1, 2, 1));
    }

    #[test]
    fn a_time_below_a_femtosecond_is_not_zero() {
        let tick = Tick::new(10, -18).unwrap();
        assert_eq!((tick.picoseconds(1), tick.nanoseconds(25)), (1e-5, [0, 250_000]));
        assert_eq!(Tick::new(100, -12).unwrap().nanoseconds(19), [1, 900_000_000_000]);
        assert_eq!(Tick::PICOSECOND.picoseconds(u64::MAX), u64::MAX as f64);
    }

    #[test]
    fn a_unit_is_something_and_not_below_a_zeptosecond() {
        assert_eq!(Tick::new(1, -21), Some(Tick(1)));
        assert_eq!(Tick::new(0, -12), None);
        assert_eq!(Tick::new(1, -22), None);
    }
}
