//! The groups of signals that someone looks at, so that the others cost nothing.

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::TofTop;
use crate::kernel::signals::Sink;

use super::{RAM, groups};

/// Some of the groups of signals, and some words of the RAM.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// A bit for each group.
    pub(super) groups: u32,
    /// Words of the RAM, each once.
    words: Vec<usize>,
}

impl Part {
    /// The part with the values of those ids.
    pub fn of(ids: impl IntoIterator<Item = usize>) -> Self {
        let groups: Vec<usize> = groups()
            .iter()
            .scan(0, |end, (.., signals)| {
                *end += signals.len();
                Some(*end)
            })
            .collect();
        let mut part = Part::default();
        for id in ids {
            match groups.iter().position(|&end| id < end) {
                Some(group) => part.groups |= 1 << group,
                None => part.words.push(id - RAM),
            }
        }
        part.words.sort_unstable();
        part.words.dedup();
        part
    }

    #[inline]
    pub(super) fn follow_ram(&self, top: &TofTop, kept: &mut TofTop, sink: &mut impl Sink) {
        let (now, then) = (&top.histogram_builder.ram, &mut kept.histogram_builder.ram);
        for &bin in &self.words {
            if then[bin] != now[bin] {
                sink.word(RAM + bin, now[bin].get());
                then[bin] = now[bin];
            }
        }
    }
}

/// Reports every word of the RAM that differs from `before`, or every one.
pub(super) fn ram_changes(top: &TofTop, before: Option<&TofTop>, sink: &mut impl Sink) {
    let now = &top.histogram_builder.ram;
    let then = before.map(|b| &b.histogram_builder.ram);
    if then != Some(now) {
        for bin in 0..BINS {
            if then.is_none_or(|then| then[bin] != now[bin]) {
                sink.word(RAM + bin, now[bin].get());
            }
        }
    }
}
