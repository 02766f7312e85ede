//! Words that wrap like Verilog's `reg [N-1:0]` and `reg signed [N-1:0]`.

use std::ops::{Add, Sub};

/// An `N`-bit unsigned word, 1 <= N <= 64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct U<const N: u32>(u64);

impl<const N: u32> U<N> {
    /// All ones.
    pub const MAX: Self = U(u64::MAX >> (64 - N));

    /// The low `N` bits of `value`.
    pub const fn new(value: u64) -> Self {
        U(value & Self::MAX.0)
    }

    /// The value, below 2^N.
    pub const fn get(self) -> u64 {
        self.0
    }

    /// The value as an array index.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl<const N: u32> Add<u64> for U<N> {
    type Output = Self;
    fn add(self, rhs: u64) -> Self {
        U::new(self.0.wrapping_add(rhs))
    }
}

impl<const N: u32> Sub<u64> for U<N> {
    type Output = Self;
    fn sub(self, rhs: u64) -> Self {
        U::new(self.0.wrapping_sub(rhs))
    }
}

impl<const N: u32> PartialEq<u64> for U<N> {
    fn eq(&self, rhs: &u64) -> bool {
        self.0 == *rhs
    }
}

/// An `N`-bit two's complement word with `F` fraction bits, 1 <= N <= 64; F may exceed N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct S<const N: u32, const F: u32 = 0>(i64);

impl<const N: u32, const F: u32> S<N, F> {
    /// The low `N` bits of `value`, sign-extended: what a register of that width keeps.
    pub const fn new(value: i64) -> Self {
        S(value << (64 - N) >> (64 - N))
    }

    /// The integer it holds, from -2^(N-1) to 2^(N-1) - 1.
    pub const fn get(self) -> i64 {
        self.0
    }

    /// The number it stands for: the integer over 2^F.
    pub fn to_f64(self) -> f64 {
        self.0 as f64 / (1u64 << F) as f64
    }

    /// The `N` bits as an unsigned word, as a waveform shows them.
    pub const fn bits(self) -> u64 {
        self.0 as u64 & (u64::MAX >> (64 - N))
    }
}

impl<const N: u32, const F: u32> Add<i64> for S<N, F> {
    type Output = Self;
    fn add(self, rhs: i64) -> Self {
        S::new(self.0.wrapping_add(rhs))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unsigned_word_wraps_both_ways() {
        assert_eq!(U::<3>::new(7) + 1, U::new(0));
        assert_eq!(U::<3>::new(0) - 1, U::new(7));
        assert_eq!(U::<64>::MAX.get(), u64::MAX);
    }

    #[test]
    fn a_signed_word_wraps_at_its_sign_bit() {
        assert_eq!(S::<36>::new((1 << 35) - 1) + 1, S::new(-(1 << 35)));
        assert_eq!(S::<36>::new(-1).bits(), (1 << 36) - 1);
        assert_eq!(S::<4>::new(9).get(), -7);
    }
}
