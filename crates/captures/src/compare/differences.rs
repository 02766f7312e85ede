//! Number and position of the differences of each pair.

use tofsim::error::Result;

use crate::source::{Name, SourceState, flow};
use crate::words::{Bits, bit};

use super::both::Both;
use super::matching::Matching;
use super::pair::{Pair, Unknowns};
use super::result::{Compared, Difference};

/// A compared place on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    /// Sequence number of the comparison, from 0.
    pub(super) order: u64,
    pub(super) window: usize,
    /// Position in each source: a tick or a row.
    pub(super) at: [u64; 2],
}

/// Counts of a pair.
#[derive(Clone, Debug, Default)]
pub(super) struct PairCount {
    /// Number of places compared.
    pub(super) compared: u64,
    differing: u64,
    first: Option<Difference>,
    overview: Overview,
}

/// Counts of all pairs, and the pairs to be compared next.
pub(super) struct Differences<'a> {
    pairs: &'a [Pair],
    /// Treatment of unknown bits.
    pub(super) unknowns: Unknowns,
    pub(super) counts: Vec<PairCount>,
    /// Waveform of both sides, if requested.
    pub(super) both: Option<Both>,
    scratch: [Bits; 2],
    /// For each side and signal, the pairs that contain it.
    users: [Vec<Vec<usize>>; 2],
    touched: Vec<usize>,
    is_touched: Vec<bool>,
    /// Whether the event of a pair has occurred on each side; empty without events.
    occurred: Vec<[bool; 2]>,
}

impl<'a> Differences<'a> {
    /// Creates counts that are all zero.
    pub(super) fn new(matching: &'a Matching, unknowns: Unknowns, both: Option<Both>) -> Self {
        let Matching { pairs, slots, .. } = matching;
        let has_events = pairs.iter().any(|pair| pair.is_event);
        let mut users = slots.each_ref().map(|slots| vec![Vec::new(); slots.ids.len()]);
        for (k, pair) in pairs.iter().enumerate() {
            for (side, users) in users.iter_mut().enumerate() {
                let signals = pair.sides[side].iter().map(|part| part.signal);
                let valid = pair.valid.filter(|_| side == 0);
                for signal in signals.chain(valid) {
                    users[signal].push(k);
                }
            }
        }
        Differences {
            pairs,
            unknowns,
            counts: vec![PairCount::default(); pairs.len()],
            both,
            scratch: Default::default(),
            users,
            touched: Vec::new(),
            is_touched: vec![false; pairs.len()],
            occurred: if has_events { vec![[false; 2]; pairs.len()] } else { Vec::new() },
        }
    }

    /// Marks the pairs of a signal that has changed.
    #[inline]
    pub(super) fn touch(&mut self, side: usize, signal: usize) {
        for &pair in &self.users[side][signal] {
            if !std::mem::replace(&mut self.is_touched[pair], true) {
                self.touched.push(pair);
            }
            if let Some(occurred) = self.occurred.get_mut(pair) {
                occurred[side] = true;
            }
        }
    }

    /// Marks all pairs.
    pub(super) fn touch_all(&mut self) {
        self.touched = (0..self.pairs.len()).collect();
        self.is_touched.fill(true);
    }

    /// Returns the pairs that were marked since the last call.
    pub(super) fn take_touched(&mut self) -> Vec<usize> {
        let touched = std::mem::take(&mut self.touched);
        touched.iter().for_each(|&pair| self.is_touched[pair] = false);
        touched
    }

    /// Forgets which of these pairs' events have occurred.
    pub(super) fn end_events(&mut self, pairs: &[usize]) {
        if !self.occurred.is_empty() {
            pairs.iter().for_each(|&pair| self.occurred[pair] = [false; 2]);
        }
    }

    /// Collects the values of both sides; that of an event is whether it has occurred.
    fn gather(&mut self, pair: usize, states: [&SourceState; 2]) {
        if !self.pairs[pair].is_event {
            return self.pairs[pair].gather_both(states, &mut self.scratch);
        }
        for (bits, has_occurred) in self.scratch.iter_mut().zip(self.occurred[pair]) {
            bits.clear(1);
            bits.value[0] = u64::from(has_occurred);
        }
    }

    /// Returns whether the sides of a pair differ, and writes them to the waveform.
    #[inline]
    pub(super) fn differs(&mut self, pair: usize, states: [&SourceState; 2]) -> Result<bool> {
        let differs = match self.occurred.get(pair).filter(|_| self.pairs[pair].is_event) {
            Some([a, b]) => a != b,
            None => !self.pairs[pair].same(states, self.unknowns, &mut self.scratch),
        };
        self.show(pair, states, differs)?;
        Ok(differs)
    }

    /// Compares pairs at a place, unless they are excluded there.
    pub(super) fn compare(
        &mut self,
        pairs: &[usize],
        spot: Spot,
        states: [&SourceState; 2],
    ) -> Result<()> {
        for &pair in pairs {
            if self.pairs[pair].is_off(states[0]) {
                continue;
            }
            self.counts[pair].compared += 1;
            if self.differs(pair, states)? {
                self.count(pair, spot, states);
            }
        }
        self.end_events(pairs);
        Ok(())
    }

    /// Writes a pair to the waveform.
    pub(super) fn show(
        &mut self,
        pair: usize,
        states: [&SourceState; 2],
        differs: bool,
    ) -> Result<()> {
        if self.both.is_none() {
            return Ok(());
        }
        self.gather(pair, states);
        let Some(both) = &mut self.both else { return Ok(()) };
        both.change(pair, &self.scratch, differs)
    }

    /// Counts a difference of a pair, with the values in the states.
    pub(super) fn count(&mut self, pair: usize, spot: Spot, states: [&SourceState; 2]) {
        self.gather(pair, states);
        let [a, b] = &self.scratch;
        self.counts[pair].differs(&self.pairs[pair], spot, a, b);
    }

    /// Returns the result of each pair after `compared` places: the first to differ first, then in the order of the
    /// data flow.
    pub(super) fn results(&self, compared: u64) -> Vec<Compared> {
        let result = |(pair, count): (&Pair, &PairCount)| Compared {
            name: pair.name.clone(),
            other: pair.other.clone(),
            how: pair.how,
            aliases: pair.aliases,
            width: pair.width,
            compared: count.compared,
            differing: count.differing,
            first: count.first.clone(),
            overview: count.overview.text(compared),
        };
        let mut results: Vec<_> = self.pairs.iter().zip(&self.counts).map(result).collect();
        results.sort_by_cached_key(|pair| match &pair.first {
            Some(first) => (first.order, flow(&Name::new(pair.name.as_str()))),
            None => (u64::MAX, 0),
        });
        results
    }
}

impl PairCount {
    /// Counts a difference, with the values of both sides.
    pub(super) fn differs(&mut self, pair: &Pair, spot: Spot, a: &Bits, b: &Bits) {
        let Spot { order, window, at } = spot;
        self.differing += 1;
        self.overview.mark(order);
        self.first.get_or_insert_with(|| {
            let differs = |k: &u32| bit(&a.value, *k) != bit(&b.value, *k);
            let known = a.is_known() && b.is_known();
            let bits = if known { (0..pair.width).filter(differs).collect() } else { Vec::new() };
            let (expected, got) = (pair.text(a), pair.text(b));
            Difference { order, window, at, expected, got, bits }
        });
    }
}

/// Length of an overview [characters].
const LENGTH: usize = 64;

/// Marks in equal parts of a range of unknown length; the parts grow with the range.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Overview {
    marks: [u64; LENGTH],
    /// Binary logarithm of a part's length.
    scale: u32,
}

impl Default for Overview {
    fn default() -> Self {
        Overview { marks: [0; LENGTH], scale: 0 }
    }
}

impl Overview {
    /// Marks the part that contains `place`.
    fn mark(&mut self, place: u64) {
        self.reach(place);
        self.marks[(place >> self.scale) as usize] += 1;
    }

    /// Extends the range to contain `place`.
    fn reach(&mut self, place: u64) {
        while (place >> self.scale) >= LENGTH as u64 {
            for k in 0..LENGTH / 2 {
                self.marks[k] = self.marks[2 * k] + self.marks[2 * k + 1];
            }
            self.marks[LENGTH / 2..].fill(0);
            self.scale += 1;
        }
    }

    /// Formats a range of the given length: `#` for parts with marks, `.` for others.
    fn text(&self, length: u64) -> String {
        let (mut whole, last) = (self.clone(), length.saturating_sub(1));
        whole.reach(last);
        let parts = &whole.marks[..=(last >> whole.scale) as usize];
        parts.iter().map(|&count| if count > 0 { '#' } else { '.' }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_overview_grows_coarser_as_the_range_grows() {
        let mut overview = Overview::default();
        overview.mark(3);
        overview.mark(60);
        assert_eq!(overview.text(64).matches('#').count(), 2);
        assert_eq!(overview.text(8), "...#....");
        overview.mark(127);
        let text = overview.text(128);
        assert_eq!((text.len(), text.find('#'), text.rfind('#')), (64, Some(1), Some(63)));
        assert_eq!(overview.text(1024).len(), 64);
        assert_eq!(Overview::default().text(0), ".");
    }
}
