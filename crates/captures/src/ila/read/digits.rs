//! Parser of a cell's digits.

use crate::words::{Bits, fill, trim};

use super::super::capture::Radix;

/// Error in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DigitFault {
    /// The cell is empty.
    Empty,
    /// A character is not a digit of the radix.
    Digit,
    /// The value exceeds the probe's width.
    Wide,
}

impl DigitFault {
    /// Formats the error.
    pub(super) fn message(self, radix: Radix, width: u32) -> String {
        match self {
            DigitFault::Empty => format!("expected {radix} digits"),
            DigitFault::Digit => format!("expected {radix} digits only, unless the radix is wrong"),
            DigitFault::Wide if radix == Radix::Signed => {
                let top = width - 1;
                format!("expected a {radix} number of {width} bits, from -2^{top} to 2^{top} - 1")
            }
            DigitFault::Wide => format!(
                "expected a {radix} number of {width} bits at most, unless the radix is wrong"
            ),
        }
    }
}

/// Parses the cell of a probe.
pub(crate) fn read(cell: &[u8], radix: Radix, width: u32) -> Result<Bits, DigitFault> {
    if cell.is_empty() {
        return Err(DigitFault::Empty);
    }
    let mut bits = Bits::zero(width);
    match radix {
        Radix::Hex => grouped(cell, 4, width, &mut bits)?,
        Radix::Octal => grouped(cell, 3, width, &mut bits)?,
        Radix::Binary => grouped(cell, 1, width, &mut bits)?,
        Radix::Signed | Radix::Unsigned if is_unknown(cell) => fill(&mut bits.unknown, width),
        Radix::Unsigned => decimal(cell, width, &mut bits.value)?,
        Radix::Signed => signed(cell, width, &mut bits.value)?,
    }
    Ok(bits)
}

/// Returns whether a cell consists of X only.
pub(super) fn is_unknown(cell: &[u8]) -> bool {
    !cell.is_empty() && cell.iter().all(is_x)
}

fn is_x(byte: &u8) -> bool {
    matches!(byte, b'x' | b'X')
}

/// Parses digits of `size` bits each, least significant last.
fn grouped(cell: &[u8], size: u32, width: u32, bits: &mut Bits) -> Result<(), DigitFault> {
    let digit = |byte: u8| char::from(byte).to_digit(1 << size);
    if !cell.iter().all(|byte| is_x(byte) || digit(*byte).is_some()) {
        return Err(DigitFault::Digit);
    }
    for (place, &byte) in cell.iter().rev().enumerate() {
        let low = place as u32 * size;
        let room = width.saturating_sub(low).min(size);
        let (target, ones) = match digit(byte) {
            Some(digit) => (&mut bits.value, digit),
            // A probe's top digit may have fewer bits than the others; its X stands for those.
            None if room > 0 => (&mut bits.unknown, (1 << room) - 1),
            None => return Err(DigitFault::Wide),
        };
        if ones >> room != 0 {
            return Err(DigitFault::Wide);
        }
        for bit in (0..room).filter(|bit| ones >> bit & 1 == 1).map(|bit| low + bit) {
            target[bit as usize / 64] |= 1 << (bit % 64);
        }
    }
    Ok(())
}

fn signed(cell: &[u8], width: u32, value: &mut [u64]) -> Result<(), DigitFault> {
    let magnitude = cell.strip_prefix(b"-");
    decimal(magnitude.unwrap_or(cell), width, value)?;
    let sign = 1 << ((width - 1) % 64);
    let (top, rest) = value.split_last_mut().ok_or(DigitFault::Wide)?;
    let least = *top == sign && rest.iter().all(|&word| word == 0);
    if *top & sign != 0 && !(magnitude.is_some() && least) {
        // A single bit is 1 or -1: which of them Vivado writes nobody knows.
        return if width == 1 { Ok(()) } else { Err(DigitFault::Wide) };
    }
    if magnitude.is_some() {
        let mut carry = true;
        for word in value.iter_mut() {
            (*word, carry) = (!*word).overflowing_add(carry as u64);
        }
        trim(value, width);
    }
    Ok(())
}

fn decimal(cell: &[u8], width: u32, value: &mut [u64]) -> Result<(), DigitFault> {
    if cell.is_empty() || !cell.iter().all(u8::is_ascii_digit) {
        return Err(DigitFault::Digit);
    }
    for digit in cell {
        let mut carry = u128::from(digit - b'0');
        for word in value.iter_mut() {
            let product = *word as u128 * 10 + carry;
            (*word, carry) = (product as u64, product >> 64);
        }
        if carry != 0 {
            return Err(DigitFault::Wide);
        }
    }
    let top = value[value.len() - 1];
    if !width.is_multiple_of(64) && top >> (width % 64) != 0 {
        Err(DigitFault::Wide)
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(cell: &str, radix: Radix, width: u32) -> Result<(Vec<u64>, Vec<u64>), DigitFault> {
        read(cell.as_bytes(), radix, width).map(|bits| (bits.value, bits.unknown))
    }

    fn known(cell: &str, radix: Radix, width: u32) -> Vec<u64> {
        let (value, unknown) = value(cell, radix, width).unwrap();
        assert!(unknown.iter().all(|&word| word == 0));
        value
    }

    #[test]
    fn digits_of_every_radix_are_read() {
        assert_eq!(known("0fF", Radix::Hex, 9), [0xff]);
        assert_eq!(known("123456789abcdef01", Radix::Hex, 65), [0x2345_6789_abcd_ef01, 1]);
        assert_eq!(known("777", Radix::Octal, 9), [0o777]);
        assert_eq!(known(&format!("1{}", "0".repeat(22)), Radix::Octal, 67), [0, 4]);
        assert_eq!(known(&format!("7{}", "0".repeat(21)), Radix::Octal, 66), [7 << 63, 3]);
        assert_eq!(known("0101", Radix::Binary, 4), [5]);
        assert_eq!(known("255", Radix::Unsigned, 8), [255]);
        assert_eq!(known("-128", Radix::Signed, 8), [128]);
        assert_eq!(known("-1", Radix::Signed, 8), [255]);
        assert_eq!(known("127", Radix::Signed, 8), [127]);
    }

    #[test]
    fn decimals_of_128_bits_and_more_are_exact() {
        assert_eq!(known(&u128::MAX.to_string(), Radix::Unsigned, 128), [u64::MAX; 2]);
        assert_eq!(known(&i128::MIN.to_string(), Radix::Signed, 128), [0, 1 << 63]);
        assert_eq!(known("-1", Radix::Signed, 130), [u64::MAX, u64::MAX, 3]);
        let above = "340282366920938463463374607431768211456";
        assert_eq!(known(above, Radix::Unsigned, 129), [0, 0, 1]);
        assert_eq!(value(above, Radix::Unsigned, 128), Err(DigitFault::Wide));
    }

    #[test]
    fn what_a_probe_cannot_hold_is_refused() {
        for (cell, radix, width) in [
            ("200", Radix::Hex, 9),
            ("1ff", Radix::Hex, 8),
            ("1000", Radix::Octal, 9),
            ("10", Radix::Binary, 1),
            ("256", Radix::Unsigned, 8),
            ("128", Radix::Signed, 8),
            ("-129", Radix::Signed, 8),
            ("-2", Radix::Signed, 1),
            ("XX", Radix::Hex, 4),
        ] {
            assert_eq!(
                value(cell, radix, width),
                Err(DigitFault::Wide),
                "{cell} {radix:?} {width}"
            );
        }
    }

    #[test]
    fn other_characters_are_refused() {
        for (cell, radix) in [
            ("0g", Radix::Hex),
            ("-1", Radix::Hex),
            ("8", Radix::Octal),
            ("2", Radix::Binary),
            ("-1", Radix::Unsigned),
            ("1.5", Radix::Signed),
            ("-", Radix::Signed),
            ("--1", Radix::Signed),
            ("1X", Radix::Unsigned),
            ("zfff", Radix::Hex),
        ] {
            assert_eq!(value(cell, radix, 8), Err(DigitFault::Digit), "{cell} {radix:?}");
        }
        assert_eq!(value("", Radix::Hex, 8), Err(DigitFault::Empty));
    }

    #[test]
    fn x_stands_for_the_bits_of_its_digit() {
        assert_eq!(value("X1", Radix::Hex, 8), Ok((vec![1], vec![0xf0])));
        assert_eq!(value("x", Radix::Hex, 1), Ok((vec![0], vec![1])));
        assert_eq!(value("XXX", Radix::Hex, 9), Ok((vec![0], vec![0x1ff])));
        assert_eq!(value("X", Radix::Signed, 70), Ok((vec![0; 2], vec![u64::MAX, 63])));
    }

    #[test]
    fn a_single_signed_bit_is_one_or_minus_one() {
        assert_eq!(known("1", Radix::Signed, 1), [1]);
        assert_eq!(known("-1", Radix::Signed, 1), [1]);
    }
}
