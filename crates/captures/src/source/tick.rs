//! The unit that a waveform counts time in.

use std::fmt;

/// Length of a unit of time [1e-21 s].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tick(u128);

impl Tick {
    /// A femtosecond.
    pub const FEMTOSECOND: Tick = Tick(1_000_000);

    /// `factor` times 10 to the `exponent` seconds; `None` below 1e-21 s or for nothing.
    pub fn new(factor: u32, exponent: i8) -> Option<Tick> {
        let power = u32::try_from(exponent as i32 + 21).ok()?;
        let length = 10u128.checked_pow(power)?.checked_mul(factor as u128)?;
        (length > 0).then_some(Tick(length))
    }

    /// `at`, counted in this unit, in the unit `other`, rounded down.
    pub fn convert(self, at: u64, other: Tick) -> u64 {
        if self == other {
            return at;
        }
        (at as u128 * self.0 / other.0) as u64
    }

    /// `at`, counted in this unit [fs].
    pub fn femtoseconds(self, at: u64) -> u128 {
        at as u128 * self.0 / Tick::FEMTOSECOND.0
    }

    /// A time in this unit, rounded down.
    pub fn count(self, femtoseconds: u128) -> u64 {
        (femtoseconds * Tick::FEMTOSECOND.0 / self.0) as u64
    }

    /// A time in this unit, rounded up: the first that is not before it.
    pub fn count_up(self, femtoseconds: u128) -> u64 {
        (femtoseconds * Tick::FEMTOSECOND.0).div_ceil(self.0) as u64
    }
}

impl fmt::Display for Tick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const UNITS: [&str; 8] = ["zs", "as", "fs", "ps", "ns", "us", "ms", "s"];
        let (mut length, mut unit) = (self.0, 0);
        while unit + 1 < UNITS.len() && length.is_multiple_of(1000) {
            (length, unit) = (length / 1000, unit + 1);
        }
        write!(f, "{length} {}", UNITS[unit])
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
    fn units_read_as_people_write_them() {
        assert_eq!(Tick::new(10, -12).unwrap().to_string(), "10 ps");
        assert_eq!(Tick::new(1, 0).unwrap().to_string(), "1 s");
        assert_eq!(Tick::new(0, -12), None);
        assert_eq!(Tick::new(1, -22), None);
    }
}
