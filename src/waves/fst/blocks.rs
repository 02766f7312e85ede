//! Blocks of an FST file: each has a type, its length without the type, and its contents.
//!
//! Numbers in blocks are big-endian 64-bit integers or unsigned LEB128 (GTKWave's `block_format.txt`).

use std::io::{self, Write};

/// Type of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Block {
    /// Extent of the file, and the writing program.
    Header = 0,
    /// Width of each signal.
    Geometry = 3,
    /// Scopes and names, compressed with LZ4.
    Hierarchy = 6,
    /// A section of value changes.
    Changes = 8,
}

impl Block {
    /// Writes a block whose contents are the concatenation of `parts`.
    pub(super) fn write(self, file: &mut impl Write, parts: &[&[u8]]) -> io::Result<()> {
        let contents: usize = parts.iter().map(|part| part.len()).sum();
        let length = size_of::<u64>() + contents;
        file.write_all(&[self as u8])?;
        file.write_all(&(length as u64).to_be_bytes())?;
        parts.iter().try_for_each(|part| file.write_all(part))
    }
}

/// Appends a 64-bit integer.
pub(super) fn long(bytes: &mut Vec<u8>, value: u64) {
    bytes.extend_from_slice(&value.to_be_bytes());
}

/// Appends an unsigned LEB128 integer.
#[inline]
pub(super) fn number(bytes: &mut Vec<u8>, mut value: u64) {
    while value > 0x7f {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

/// Appends an integer that is read as signed LEB128, whose highest bit is the sign.
pub(super) fn signed(bytes: &mut Vec<u8>, mut value: u64) {
    while value > 0x3f {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(append: impl Fn(&mut Vec<u8>, u64), value: u64) -> Vec<u8> {
        let mut bytes = Vec::new();
        append(&mut bytes, value);
        bytes
    }

    #[test]
    fn numbers_take_seven_bits_a_byte_and_signed_ones_a_bit_more() {
        assert_eq!(bytes(number, 0x7f), [0x7f]);
        assert_eq!(bytes(number, 0x80), [0x80, 1]);
        assert_eq!(bytes(number, 624_485), [0xe5, 0x8e, 0x26]);
        assert_eq!(bytes(signed, 0x3f), [0x3f]);
        assert_eq!(bytes(signed, 0x40), [0xc0, 0]);
        assert_eq!(bytes(signed, 0x1fff), [0xff, 0x3f]);
        assert_eq!(bytes(signed, 0x2000), [0x80, 0xc0, 0]);
    }

    #[test]
    fn a_block_says_how_long_it_is_without_its_type() {
        let mut file = Vec::new();
        Block::Geometry.write(&mut file, &[b"ab", b"", b"c"]).unwrap();
        assert_eq!(file, b"\x03\0\0\0\0\0\0\0\x0babc");
    }
}
