//! Integers as the firmware's words have them.

/// A number over 2^bits, half rounded up; times 2^-bits where there are less than none.
pub fn shifted(value: i64, bits: i64) -> i64 {
    match bits {
        ..=0 => value << -bits,
        63.. => 0,
        _ => (value >> bits) + (value >> (bits - 1) & 1),
    }
}

/// A product over 2^bits, kept within a signed word.
pub fn product(a: i64, b: i64, bits: i64, word: u32) -> i64 {
    clamped(shifted(a.wrapping_mul(b), bits), word)
}

/// A number kept within a signed word.
pub fn clamped(value: i64, word: u32) -> i64 {
    let most = 1 << (word - 1);
    value.clamp(-most, most - 1)
}

/// Root of a number of 50 bits, rounded down, as the root of 25 bits comes digit by digit.
pub fn root(value: i64) -> i64 {
    value.isqrt()
}
