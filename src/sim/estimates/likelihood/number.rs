//! Numbers of the algorithm: words as the firmware has them, or the same values without rounding.
//!
//! Both have the same unit: a value with 14 fraction bits is 16,384 times what it stands for, in double precision
//! too. So a shift is exact there, and what differs is rounding, and what the firmware looks up in tables.

mod exact;
mod words;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A number that the estimate is computed in.
pub trait Number:
    Copy
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Neg<Output = Self>
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
{
    /// Smallest positive number.
    const LEAST: Self;

    /// A whole number.
    fn whole(value: i64) -> Self;

    /// A constant: its word in the firmware, which is rounded, or its exact value in the word's unit.
    fn constant(word: i64, exact: f64) -> Self;

    /// What a number with so many fraction bits stands for.
    fn value(self, fraction: u32) -> f64;

    /// The place that a number without fraction bits lies in, from 0 on.
    fn place(self) -> usize;

    /// A number over 2^bits, half rounded up; times 2^-bits where there are less than none.
    fn shifted(self, bits: i64) -> Self;

    /// A number over 2^bits, rounded down; times 2^-bits where there are less than none.
    fn floored(self, bits: i64) -> Self;

    /// A product, of which a word of 64 bits has the lower ones.
    fn times(self, other: Self) -> Self;

    /// Less a product, as [`Number::times`] has it.
    fn less(self, a: Self, b: Self) -> Self;

    /// Keeps a number within a signed word.
    fn kept(self, bits: u32) -> Self;

    /// Keeps a positive number within an unsigned word.
    fn filled(self, bits: u32) -> Self;

    /// The lower bits of a number, as a signed word.
    fn wrapped(self, bits: u32) -> Self;

    /// A reciprocal's mantissa and exponent: 1 / x is mantissa / 2^(16 + exponent).
    fn reciprocal(self) -> (Self, i64);

    /// The root.
    fn root(self) -> Self;

    /// Bits of the largest of some magnitudes: the place of its leading one, plus one.
    fn bits(magnitudes: &[Self]) -> u32;

    /// 64 times the logarithm to base 2, and that of a half where there is nothing.
    fn log2_64(self) -> Self;

    /// -log(1 - p) of a chance p, both with 24 fraction bits.
    fn hazard(chance: Self) -> Self;

    /// k(lambda) = lambda / (1 - exp(-lambda)), 12 fraction bits, of a hazard with 22.
    fn k(hazard: Self) -> Self;

    /// The part of a hazard that is the signal's, 12 fraction bits.
    fn share(signal: Self, hazard: Self) -> Self;

    /// Shots times a hazard, 12 fraction bits.
    fn expected(shots: Self, hazard: Self) -> Self;

    /// A square over a variance, 8 fraction bits.
    fn over(square: Self, variance: Self) -> Self;

    /// This number, or `least` if that is larger.
    fn at_least(self, least: Self) -> Self {
        if self < least { least } else { self }
    }

    /// This number, or `most` if that is smaller.
    fn at_most(self, most: Self) -> Self {
        if self > most { most } else { self }
    }

    /// This number within limits.
    fn within(self, [least, most]: [Self; 2]) -> Self {
        self.at_least(least).at_most(most)
    }

    /// The magnitude.
    fn abs(self) -> Self {
        if self < Self::default() { -self } else { self }
    }
}

/// A product over 2^bits, kept within a signed word.
pub fn product<N: Number>(a: N, b: N, bits: i64, word: u32) -> N {
    a.times(b).shifted(bits).kept(word)
}
