//! Random input under constraints.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use tofsim::kernel::{S, U};
use tofsim::sensor::streams::{Source, stream};

/// Number of the stream that fills a block's memories.
pub const MEMORIES: u64 = 1 << 32;

/// Draws for the stimulus of one block.
#[derive(Clone, Debug)]
pub struct Draw(ChaCha8Rng);

impl Draw {
    /// The stream of that number, which belongs to a block ([`Spec::stream`](super::spec::Spec::stream)).
    pub fn new(seed: u64, number: u64) -> Self {
        Draw(stream(seed, Source::Stimulus, number))
    }

    /// The stream itself.
    pub fn rng(&mut self) -> &mut ChaCha8Rng {
        &mut self.0
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number from 0 to `n` - 1.
    pub fn below(&mut self, n: u64) -> u64 {
        ((self.bits() as u128 * n as u128) >> 64) as u64
    }

    /// True once in `n` times.
    pub fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// A number from 0 to `n` - 1 of many: most of the time one of the first or the last eight.
    pub fn near_ends(&mut self, n: u64) -> u64 {
        match self.below(5) {
            0 => self.below(n),
            1..3 => self.below(8),
            _ => n - 1 - self.below(8),
        }
    }

    /// A word, all values alike.
    pub fn word<const N: u32>(&mut self) -> U<N> {
        U::new(self.bits())
    }

    /// A number of so many bits, every size alike.
    pub fn unsigned_of(&mut self, bits: u32) -> u64 {
        self.bits() >> (63 - self.below(bits.into()))
    }

    /// A signed word: any value, or one within a few bits of zero, or an end of the range, so that
    /// every size of number comes up.
    pub fn signed<const N: u32, const F: u32>(&mut self) -> S<N, F> {
        S::new(self.signed_of(N))
    }

    /// Draws a signed word of so many bits as [`Draw::signed`] does; the word drops what is above them.
    pub fn signed_of(&mut self, bits: u32) -> i64 {
        let any = self.bits() as i64;
        match self.below(8) {
            0 => i64::MAX >> (64 - bits),
            1 => i64::MIN >> (64 - bits),
            2 => any,
            _ => any >> (64 - 1 - self.below(bits.into())),
        }
    }

    /// Draws a signed word as [`Draw::signed_of`] does, sign-extended, for a port that is narrower than its
    /// word.
    pub fn signed_within(&mut self, bits: u32) -> i64 {
        self.signed_of(bits) << (64 - bits) >> (64 - bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_seeds_draw_differently() {
        let first = |seed, block| Draw::new(seed, block).bits();
        assert_ne!(first(1, 0), first(1, 1));
        assert_ne!(first(1, 0), first(2, 0));
        assert_eq!(first(1, 0), first(1, 0));
    }

    #[test]
    fn signed_words_reach_both_ends_and_zero() {
        let mut draw = Draw::new(1, 0);
        let seen: Vec<i64> = (0..4000).map(|_| draw.signed::<16, 0>().get()).collect();
        for value in [-32768, 32767, 0, -1, 1] {
            assert!(seen.contains(&value), "{value}");
        }
        assert!((0..1000).all(|_| draw.below(5) < 5));
    }
}
