//! Codes that are counted in the histogram.

use crate::firmware::histogram_builder::HistogramBuilder;
use crate::firmware::tof_top::TofTop;

use super::edge::{EdgeState, Numbers};
use super::{Content, Transaction};

/// Follows codes to their words.
#[derive(Clone, Debug, Default)]
pub(super) struct Counts {
    /// The last code.
    code: Option<Transaction>,
    /// The count under way, the bank of its word, and the edge with which it began.
    open: Option<(Transaction, usize, u64)>,
    /// Whether the histogram is cleared in the cycle that the coming edge ends.
    clears: bool,
    /// Numbers of the counts since the last Clear.
    of_histogram: Vec<u64>,
}

/// Cycles of a count: its word is read in the first, and written back at the end of the second.
const CYCLES: u64 = 2;

impl Counts {
    /// Takes a new code.
    pub(super) fn take(&mut self, code: Option<Transaction>) {
        if code.is_some() {
            self.code = code;
        }
    }

    /// Follows an edge.
    pub(super) fn edge(
        &mut self,
        edge: &EdgeState,
        numbers: &mut Numbers,
        complete: &mut Vec<Transaction>,
    ) {
        let is_lost = std::mem::replace(&mut self.clears, edge.top.frame_ctrl.clear);
        if is_lost {
            self.open = None;
        }
        let is_written = |(.., begun): &mut (_, _, u64)| *begun + CYCLES == edge.cycle;
        if let Some((mut count, bank, _)) = self.open.take_if(is_written)
            && let Content::Count { bin, after, .. } = &mut count.content
        {
            *after = word(banks(edge.top)[bank], *bin);
            count.end = edge.now;
            self.of_histogram.push(count.id);
            complete.push(count);
        }
        let Some(bank) = banks(edge.top).iter().position(|bank| bank.has_hit()) else { return };
        if self.open.is_none()
            && let Some(code) = self.code.take()
            && let Content::Code { code: bin, .. } = code.content
        {
            let before = word(banks(edge.top)[bank], bin);
            let count = Transaction {
                id: numbers.next(),
                begin: edge.now,
                origin: Some(code.as_origin()),
                content: Content::Count { bin, before, after: before },
                ..code
            };
            self.open = Some((count, bank, edge.cycle));
        }
    }

    /// Returns the numbers of the counts in the histogram, which is then another or empty.
    pub(super) fn take_histogram(&mut self) -> Vec<u64> {
        std::mem::take(&mut self.of_histogram)
    }
}

/// Returns both banks of the histogram.
fn banks(top: &TofTop) -> [&HistogramBuilder; 2] {
    [&top.histogram_builder, &top.second_bank]
}

/// Returns a word of a histogram [hits].
fn word(histogram: &HistogramBuilder, bin: u64) -> u64 {
    histogram.ram[bin as usize].get()
}
