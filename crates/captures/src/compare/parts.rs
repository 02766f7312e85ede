//! What a comparison reads of a source: signals, each once, and some bits of them.

use std::collections::HashMap;

use crate::source::Signal;

/// The signals of a source that a comparison reads, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    /// Id of each.
    pub(super) ids: Vec<usize>,
    by_id: HashMap<usize, usize>,
}

impl Slots {
    /// The place of a signal, which is read from now on.
    pub(super) fn place(&mut self, id: usize) -> usize {
        let next = self.ids.len();
        let place = *self.by_id.entry(id).or_insert(next);
        if place == next {
            self.ids.push(id);
        }
        place
    }
}

/// Bits of a signal of a cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Signal of the cursor.
    pub(super) signal: usize,
    /// Lowest bit.
    pub(super) low: u32,
    /// Number of bits.
    pub(super) width: u32,
    /// Whether that is the whole signal.
    pub(super) whole: bool,
}

impl Part {
    /// All of a signal, which is read from now on.
    pub(super) fn whole(slots: &mut Slots, signal: &Signal) -> Self {
        Part { signal: slots.place(signal.id), low: 0, width: signal.width, whole: true }
    }
}
