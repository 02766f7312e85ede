//! Four-byte integers of a GHW file.

use super::super::span::{Checked, Span, at_most};

/// Parses a four-byte integer.
pub(super) fn word(file: &mut Span, is_big: bool) -> Checked<u64> {
    let bytes = file.take(4)?.iter();
    let add = |word, &byte: &u8| word << 8 | u64::from(byte);
    Ok(if is_big { bytes.fold(0, add) } else { bytes.rev().fold(0, add) })
}

/// Parses the number of a section's items, of at least one byte each.
pub(super) fn count(file: &mut Span, is_big: bool, field: &str) -> Checked<u64> {
    let count = word(file, is_big)?;
    at_most(field, count, file.left())
}
