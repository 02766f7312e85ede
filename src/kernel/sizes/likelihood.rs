//! Widths of the likelihood estimator that its firmware reckons with too.

/// Bits of a bin's width [units].
pub const WIDTH_BITS: u32 = 10;
/// Bits of an edge above those of a bin's number [half units].
pub const EDGE_BITS: u32 = 8;
/// Fewest bits of a word of the solver: products of two of 16 bits, and 32 m.
const FEWEST_WORD_BITS: u32 = 35;
/// Fewest bits of a weight.
const FEWEST_WEIGHT_BITS: u32 = 24;

/// Bits of a weight: those of a count above its 6 fraction bits with two more.
pub fn weight_bits(count_bits: u32) -> u32 {
    (count_bits + 8).max(FEWEST_WEIGHT_BITS)
}

/// Bits of a word of the solver: enough for sums over a fit, and for the exposure of all bins.
pub fn word_bits(bin_bits: u32, count_bits: u32) -> u32 {
    (count_bits + 19.max(bin_bits + WIDTH_BITS + 1)).max(FEWEST_WORD_BITS)
}
