//! Double precision: no word is too short, and nothing is rounded.

use crate::firmware::likelihood_estimator::words::HAZARD_FRACTION;

use super::Number;

/// One, with 12, 24, and as many fraction bits as a hazard.
const ONE_12: f64 = 4096.0;
const ONE_24: f64 = 16_777_216.0;
const ONE_HAZARD: f64 = (1 << HAZARD_FRACTION) as f64;

impl Number for f64 {
    const LEAST: Self = f64::MIN_POSITIVE;

    fn whole(value: i64) -> Self {
        value as f64
    }

    fn constant(_: i64, exact: f64) -> Self {
        exact
    }

    fn value(self, fraction: u32) -> f64 {
        self.shifted(fraction.into())
    }

    fn place(self) -> usize {
        self as usize
    }

    fn shifted(self, bits: i64) -> Self {
        libm::scalbn(self, -bits as i32)
    }

    fn floored(self, bits: i64) -> Self {
        self.shifted(bits)
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn less(self, a: Self, b: Self) -> Self {
        self - a * b
    }

    fn kept(self, _: u32) -> Self {
        self
    }

    fn filled(self, _: u32) -> Self {
        self
    }

    fn wrapped(self, _: u32) -> Self {
        self
    }

    fn reciprocal(self) -> (Self, i64) {
        (f64::from(1 << 16) / self, 0)
    }

    fn root(self) -> Self {
        self.sqrt()
    }

    fn bits(magnitudes: &[Self]) -> u32 {
        let most = magnitudes.iter().fold(0.0, |most: f64, magnitude| most.max(*magnitude));
        if most < 1.0 { 0 } else { most.log2().floor() as u32 + 1 }
    }

    fn log2_64(self) -> Self {
        64.0 * self.max(0.5).log2()
    }

    fn hazard(chance: Self) -> Self {
        -(-chance / ONE_24).ln_1p() * ONE_24
    }

    fn k(hazard: Self) -> Self {
        let hazard = hazard / ONE_HAZARD;
        hazard / -(-hazard).exp_m1() * ONE_12
    }

    fn share(signal: Self, hazard: Self) -> Self {
        signal / hazard * ONE_12
    }

    fn expected(shots: Self, hazard: Self) -> Self {
        shots * hazard / ONE_HAZARD * ONE_12
    }

    fn over(square: Self, variance: Self) -> Self {
        (square / variance).shifted(-8)
    }
}
