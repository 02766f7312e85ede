//! Changes of files that are right, so that they are nearly right.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// A change of a file: where, how many bytes go, what comes.
pub type Edit = (Index, usize, Vec<u8>);

/// A few changes, of which most put in a piece that means something.
pub fn edits(pieces: &'static [&'static str]) -> impl Strategy<Value = Vec<Edit>> {
    let piece = prop_oneof![
        3 => select(pieces).prop_map(|piece| piece.as_bytes().to_vec()),
        1 => vec(any::<u8>(), 0..4),
        1 => Just(Vec::new()),
    ];
    vec((any::<Index>(), 0usize..12, piece), 0..5)
}

/// The file with its changes.
pub fn edited(mut bytes: Vec<u8>, edits: &[Edit]) -> Vec<u8> {
    for (place, gone, piece) in edits {
        let start = place.index(bytes.len() + 1);
        let end = bytes.len().min(start + gone);
        bytes.splice(start..end, piece.iter().copied());
    }
    bytes
}
