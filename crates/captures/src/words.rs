//! Bits of wide values, in words of 64, the lowest first.

/// A bit.
#[inline]
pub(crate) fn bit(words: &[u64], bit: u32) -> u64 {
    words[bit as usize / 64] >> (bit % 64) & 1
}

/// The bits that word `k` of a value of `width` bits has.
pub(crate) fn ones(width: u32, k: usize) -> u64 {
    match (width as usize).saturating_sub(64 * k) {
        0 => 0,
        bits if bits >= 64 => u64::MAX,
        bits => (1 << bits) - 1,
    }
}

/// Clears what is above the width in the words of a value.
#[inline]
pub(crate) fn trim(words: &mut [u64], width: u32) {
    if let Some(top) = words.last_mut()
        && !width.is_multiple_of(64)
    {
        *top &= (1 << (width % 64)) - 1;
    }
}

/// A two's complement number of `width` bits.
pub(crate) fn extend(value: u128, width: u32) -> i128 {
    let shift = 128 - width.clamp(1, 128);
    ((value << shift) as i128) >> shift
}
