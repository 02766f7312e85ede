//! Random words of a stream, eight blocks of ChaCha8 at a time, one in each lane of a vector register.
//!
//! Exact: these are the words of [`ChaCha8Rng`] in another order, on which a count does not depend.

#![expect(
    clippy::needless_range_loop,
    reason = "loops over lanes become vectors, iterators do not"
)]

use pulp::{Arch, Simd, WithSimd};
use rand_chacha::ChaCha8Rng;

/// Blocks that are computed together, one in each lane of a vector.
const LANES: usize = 8;
/// Rows of 32 bits in a block.
const ROWS: usize = 16;
/// Length of a block [32-bit words].
pub const BLOCK: u128 = ROWS as u128;
/// 64-bit words in [`LANES`] blocks.
pub const WORDS: usize = LANES * ROWS / 2;

/// Double rounds of ChaCha8.
const DOUBLE_ROUNDS: usize = 4;

/// A row of each block.
type Row = [u32; LANES];

/// Blocks of a stream from a position on.
#[derive(Clone, Debug)]
pub struct Blocks {
    arch: Arch,
    /// Constants, key, number of the next block, number of the stream.
    input: [u32; ROWS],
    next: u64,
}

impl Blocks {
    /// Creates the blocks of `stream` from its position on, which must be the start of a block.
    pub fn of(stream: &ChaCha8Rng) -> Self {
        let mut bytes = *b"expand 32-byte k................................................";
        bytes[16..48].copy_from_slice(&stream.get_seed());
        bytes[56..].copy_from_slice(&stream.get_stream().to_le_bytes());
        let mut input = [0; ROWS];
        for (row, bytes) in input.iter_mut().zip(bytes.as_chunks().0) {
            *row = u32::from_le_bytes(*bytes);
        }
        Blocks { arch: Arch::new(), input, next: (stream.get_word_pos() / BLOCK) as u64 }
    }

    /// Computes the words of the next blocks: the first of each, then the second of each, and so on.
    pub fn fill(&mut self, words: &mut [u64; WORDS]) {
        self.arch.dispatch(Fill { blocks: self, words });
        self.next = self.next.wrapping_add(LANES as u64);
    }
}

/// Computation of the next blocks, compiled for the vector registers of each kind of processor.
struct Fill<'a> {
    blocks: &'a Blocks,
    words: &'a mut [u64; WORDS],
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Fill { blocks, words } = self;
        let mut input = [[0; LANES]; ROWS];
        for row in 0..ROWS {
            input[row] = [blocks.input[row]; LANES];
        }
        for lane in 0..LANES {
            let number = blocks.next.wrapping_add(lane as u64);
            (input[12][lane], input[13][lane]) = (number as u32, (number >> 32) as u32);
        }
        let mut rows = input;
        for _ in 0..DOUBLE_ROUNDS {
            quarter_round::<0, 4, 8, 12>(&mut rows);
            quarter_round::<1, 5, 9, 13>(&mut rows);
            quarter_round::<2, 6, 10, 14>(&mut rows);
            quarter_round::<3, 7, 11, 15>(&mut rows);
            quarter_round::<0, 5, 10, 15>(&mut rows);
            quarter_round::<1, 6, 11, 12>(&mut rows);
            quarter_round::<2, 7, 8, 13>(&mut rows);
            quarter_round::<3, 4, 9, 14>(&mut rows);
        }
        for (row, input) in rows.iter_mut().zip(&input) {
            add(row, input);
        }
        for pair in 0..ROWS / 2 {
            let [low, high] = [rows[2 * pair], rows[2 * pair + 1]];
            for lane in 0..LANES {
                words[pair * LANES + lane] = u64::from(low[lane]) | u64::from(high[lane]) << 32;
            }
        }
    }
}

#[inline(always)]
fn quarter_round<const A: usize, const B: usize, const C: usize, const D: usize>(
    rows: &mut [Row; ROWS],
) {
    let [mut a, mut b, mut c, mut d] = [rows[A], rows[B], rows[C], rows[D]];
    half_round::<16, 12>(&mut a, &mut b, &mut c, &mut d);
    half_round::<8, 7>(&mut a, &mut b, &mut c, &mut d);
    [rows[A], rows[B], rows[C], rows[D]] = [a, b, c, d];
}

#[inline(always)]
fn half_round<const BY_D: u32, const BY_B: u32>(
    a: &mut Row,
    b: &mut Row,
    c: &mut Row,
    d: &mut Row,
) {
    add(a, b);
    xor_rotated::<BY_D>(d, a);
    add(c, d);
    xor_rotated::<BY_B>(b, c);
}

#[inline(always)]
fn add(row: &mut Row, other: &Row) {
    for lane in 0..LANES {
        row[lane] = row[lane].wrapping_add(other[lane]);
    }
}

#[inline(always)]
fn xor_rotated<const BY: u32>(row: &mut Row, other: &Row) {
    for lane in 0..LANES {
        row[lane] = (row[lane] ^ other[lane]).rotate_left(BY);
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::Rng;

    use super::*;
    use crate::sensor::streams::{Source, stream};

    #[test]
    fn the_words_are_those_of_the_stream() {
        let mut plain = stream(0x0123_4567_89ab_cdef, Source::Avalanche, 0xfedc_ba98_7654);
        // Numbers of blocks that need their upper half, too, within eight blocks and after them.
        for first in [0, 3, 0xffff_fffd, 0xffff_fff8, u64::MAX - 2] {
            plain.set_word_pos(u128::from(first) * BLOCK);
            let mut blocks = Blocks::of(&plain);
            let mut words = [0; WORDS];
            for _ in 0..3 {
                blocks.fill(&mut words);
                for (block, place) in (0..LANES).flat_map(|b| (0..ROWS / 2).map(move |p| (b, p))) {
                    let found = words[place * LANES + block];
                    assert_eq!(found, plain.next_u64(), "{first:x} {block} {place}");
                }
            }
        }
    }
}
