//! Registers one after the other.

/// Moves words on by a register, the first one in.
#[inline(always)]
pub fn shift<T: Copy, const N: usize>(words: &mut [T; N], first: T) {
    words.copy_within(..N - 1, 1);
    words[0] = first;
}
