//! Random changes of valid files, which make them nearly valid.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// A change of a file: position, number of bytes removed, and bytes inserted.
pub type Edit = (Index, usize, Vec<u8>);

/// Generates a few changes, most of which insert a text with a meaning.
pub fn edits(pieces: &'static [&'static str]) -> impl Strategy<Value = Vec<Edit>> {
    let piece = prop_oneof![
        3 => select(pieces).prop_map(|piece| piece.as_bytes().to_vec()),
        1 => vec(any::<u8>(), 0..4),
        1 => Just(Vec::new()),
    ];
    vec((any::<Index>(), 0usize..12, piece), 0..5)
}

/// A number that replaces a length, size or count: position, number of bytes, whether it is big-endian, and value.
pub type Plant = (Index, usize, bool, u64);

/// Generates a few such numbers, most of which are too large.
pub fn plants() -> impl Strategy<Value = Vec<Plant>> {
    let value = prop_oneof![
        select(vec![u64::MAX, u64::MAX - 8, 1 << 63, 1 << 48, u64::MAX >> 1, 1 << 35]),
        select(vec![u64::from(u32::MAX), 1 << 31, 1 << 28, 1 << 24, 0xffff_ff7f, 0x7fff_ffff]),
        select(vec![0, 1, 7, 9, 0x7fff_ff0f]),
        any::<u64>(),
    ];
    let bytes = select(vec![1, 2, 4, 5, 8, 8]);
    vec((any::<Index>(), bytes, any::<bool>(), value), 1..4)
}

/// Returns the file with the numbers at some of the places.
pub fn planted(mut bytes: Vec<u8>, places: &[usize], plants: &[Plant]) -> Vec<u8> {
    for (place, count, is_big, value) in plants {
        let start = *place.get(places);
        let word = if *is_big { value.to_be_bytes() } else { value.to_le_bytes() };
        let word = if *is_big { &word[8 - count..] } else { &word[..*count] };
        let end = bytes.len().min(start + count);
        bytes[start..end].copy_from_slice(&word[..end - start]);
    }
    bytes
}

/// Returns the file with the changes.
pub fn edited(mut bytes: Vec<u8>, edits: &[Edit]) -> Vec<u8> {
    for (place, gone, piece) in edits {
        let start = place.index(bytes.len() + 1);
        let end = bytes.len().min(start + gone);
        bytes.splice(start..end, piece.iter().copied());
    }
    bytes
}
