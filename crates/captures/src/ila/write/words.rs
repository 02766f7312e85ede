//! What all forms of a capture are written with.

use std::io::{self, Write};

use crate::words::trim;

use super::super::capture::{Probe, Radix};

/// Bytes gathered before they go to the file.
const BLOCK: usize = 1 << 16;

/// Writes what was gathered, if it is worth it.
pub(super) fn spill(out: &mut dyn Write, text: &mut Vec<u8>) -> io::Result<()> {
    if text.len() >= BLOCK {
        out.write_all(text)?;
        text.clear();
    }
    Ok(())
}

/// Copies the bits from `low` on into `value`, as many as `width`.
#[inline]
pub(super) fn take(sample: &[u64], low: usize, width: usize, value: &mut [u64]) {
    let (first, shift) = (low / 64, low % 64);
    for (place, word) in value.iter_mut().enumerate() {
        let at = first + place;
        let above = sample.get(at + 1).copied().unwrap_or(0);
        *word = if shift == 0 { sample[at] } else { sample[at] >> shift | above << (64 - shift) };
    }
    trim(value, width as u32);
}

/// The radix in which a probe's values are written: decimals end at 128 bits.
pub(super) fn shown(probe: &Probe) -> Radix {
    match probe.radix {
        Radix::Signed | Radix::Unsigned if probe.width > 128 => Radix::Hex,
        radix => radix,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_across_words() {
        let sample = [0xf000_0000_0000_0001, 0x2a, 0];
        let mut value = [0; 1];
        take(&sample, 60, 8, &mut value);
        assert_eq!(value, [0xaf]);
        take(&sample, 0, 64, &mut value);
        assert_eq!(value, [sample[0]]);
        let mut value = [0; 2];
        take(&sample, 4, 68, &mut value);
        assert_eq!(value, [0xaf00_0000_0000_0000, 2]);
    }
}
