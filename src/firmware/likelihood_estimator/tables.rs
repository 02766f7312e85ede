//! Tables that are the same for every instrument, and the arithmetic on leading ones that uses them.

use std::sync::LazyLock;

/// Entries of each table.
const ENTRIES: usize = 64;
/// Hazard at which the table of k ends [1].
const MOST_HAZARD: f64 = 16.0;
/// Fraction bits of k.
const K_FRACTION: u32 = 12;
/// Fraction bits of the reciprocal of a mantissa.
const RECIPROCAL_FRACTION: u32 = 10;
/// Bits of a normalised divisor.
const DIVISOR_BITS: u32 = 17;

/// 64 log2(1 + (i + 1/2) / 64), rounded.
pub static LOG2: LazyLock<[i64; ENTRIES]> =
    LazyLock::new(|| std::array::from_fn(|i| round(64.0 * libm::log2(middle(i)))));

/// Tables for the terms of a bin.
#[derive(Debug)]
pub struct Tables {
    /// k at the begin of each quarter, 12 fraction bits.
    pub k: [i64; ENTRIES],
    /// Growth of k within a quarter.
    pub growth: [i64; ENTRIES],
    /// Reciprocal of a mantissa from 1 to 2, 10 fraction bits.
    pub reciprocal: [i64; ENTRIES],
}

/// The tables.
pub static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let k = |i: usize| {
        let hazard = i as f64 * MOST_HAZARD / ENTRIES as f64;
        let k = if i == 0 { 1.0 } else { hazard / -libm::expm1(-hazard) };
        round(k * f64::from(1 << K_FRACTION))
    };
    Tables {
        k: std::array::from_fn(k),
        growth: std::array::from_fn(|i| k(i + 1) - k(i)),
        reciprocal: std::array::from_fn(|i| round(f64::from(1 << RECIPROCAL_FRACTION) / middle(i))),
    }
});

impl Tables {
    /// k(lambda) = lambda / (1 - exp(-lambda)) of a hazard below 16 with 22 fraction bits; 12 fraction bits.
    pub fn k(hazard: i64) -> i64 {
        Self::k_before(hazard) + (Self::k_grown(hazard) >> 10)
    }

    /// k(lambda) at the quarter before that hazard.
    pub fn k_before(hazard: i64) -> i64 {
        TABLES.k[(hazard >> 20) as usize]
    }

    /// Returns the growth of k from the start of the quarter, with 22 fraction bits.
    pub fn k_grown(hazard: i64) -> i64 {
        Self::k_growth(hazard) * (hazard >> 10 & 1023)
    }

    /// Returns the growth of k within the quarter.
    pub fn k_growth(hazard: i64) -> i64 {
        TABLES.growth[(hazard >> 20) as usize]
    }

    /// Reciprocal of a mantissa whose leading one is bit `top`; 10 fraction bits.
    pub fn reciprocal(mantissa: i64, top: u32) -> i64 {
        TABLES.reciprocal[(mantissa >> (top - 6) & 63) as usize]
    }
}

fn middle(i: usize) -> f64 {
    1.0 + (i as f64 + 0.5) / ENTRIES as f64
}

fn round(value: f64) -> i64 {
    libm::round(value) as i64
}

/// Bits of a number: the place of its leading one, plus one; 0 of 0.
pub fn length(value: i64) -> u32 {
    u64::BITS - (value.max(0) as u64).leading_zeros()
}

/// 64 times the logarithm to base 2, to a 64th; that of 0 is the one of a half.
pub fn log2_64(value: i64) -> i64 {
    let length = length(value);
    if length == 0 {
        return -64;
    }
    let mantissa = if length > 7 { value >> (length - 7) } else { value << (7 - length) };
    (i64::from(length) - 1) * 64 + LOG2[(mantissa & 63) as usize]
}

/// The reciprocal of a positive number as a mantissa of 17 bits, and the number's bits: 1 / x is about
/// mantissa / 2^(16 + bits).
pub fn reciprocal(value: i64) -> (i64, u32) {
    let bits = length(value);
    let divisor = match bits > DIVISOR_BITS {
        true => value >> (bits - DIVISOR_BITS),
        false => value << (DIVISOR_BITS - bits),
    };
    (((1 << (2 * DIVISOR_BITS - 1)) - 1) / divisor, bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn k_is_within_half_a_thousandth() {
        for hazard in [0.0, 1e-4, 0.1, 0.33, 1.0, 2.2, 7.7, 15.99] {
            let k = Tables::k((hazard * f64::from(1 << 22)) as i64) as f64 / 4096.0;
            let expected = if hazard == 0.0 { 1.0 } else { hazard / -f64::exp_m1(-hazard) };
            assert!((k / expected - 1.0).abs() < 3e-3, "{hazard}: {k} {expected}");
        }
    }

    #[test]
    fn a_reciprocal_is_right_to_sixteen_bits() {
        for value in [1, 2, 3, 1000, 65_535, 65_536, 65_537, 123_456_789, 1 << 40] {
            let (mantissa, bits) = reciprocal(value);
            let found = mantissa as f64 / 2f64.powi(16 + bits as i32);
            assert!((1 << 16..1 << 17).contains(&mantissa), "{value}: {mantissa}");
            assert!((found * value as f64 - 1.0).abs() < 2f64.powi(-15), "{value}: {found}");
        }
    }

    #[test]
    fn a_logarithm_is_right_to_a_64th() {
        for value in [1, 2, 3, 64, 65, 1000, 99_999, 1 << 40] {
            let expected = 64.0 * (value as f64).log2();
            assert!((log2_64(value) as f64 - expected).abs() < 1.3, "{value}");
        }
        assert_eq!(log2_64(0), -64);
    }
}
