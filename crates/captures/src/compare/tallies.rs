//! The books of a comparison: a tally for each pair, filled place by place.

use crate::source::State;

use super::both::Both;
use super::pair::{Bits, Pair, Unknowns};
use super::tally::{First, Spot, Tally};
use tofsim::error::Result;

/// The books of a comparison.
pub(super) struct Tallies<'a> {
    pairs: &'a [Pair],
    unknowns: Unknowns,
    pub(super) tallies: Vec<Tally>,
    /// Both sides as a waveform, if that is wanted.
    pub(super) both: Option<Both>,
    scratch: [Bits; 2],
    /// For each side and signal the pairs that look at it.
    users: [Vec<Vec<u32>>; 2],
    touched: Vec<u32>,
    is_touched: Vec<bool>,
}

impl<'a> Tallies<'a> {
    /// Empty books; `signals` are the numbers of signals that each side reads.
    pub(super) fn new(
        pairs: &'a [Pair],
        signals: [usize; 2],
        unknowns: Unknowns,
        both: Option<Both>,
    ) -> Self {
        let mut users = signals.map(|signals| vec![Vec::new(); signals]);
        for (k, pair) in pairs.iter().enumerate() {
            for (side, users) in users.iter_mut().enumerate() {
                let signals = pair.sides[side].iter().map(|part| part.signal);
                let valid = pair.valid.filter(|_| side == 0);
                for signal in signals.chain(valid) {
                    users[signal].push(k as u32);
                }
            }
        }
        Tallies {
            pairs,
            unknowns,
            tallies: vec![Tally::default(); pairs.len()],
            both,
            scratch: Default::default(),
            users,
            touched: Vec::new(),
            is_touched: vec![false; pairs.len()],
        }
    }

    /// What an unknown bit is the same as.
    pub(super) fn unknowns(&self) -> Unknowns {
        self.unknowns
    }

    /// A signal of a side has changed.
    #[inline]
    pub(super) fn touch(&mut self, side: usize, signal: usize) {
        for &pair in &self.users[side][signal] {
            if !self.is_touched[pair as usize] {
                self.is_touched[pair as usize] = true;
                self.touched.push(pair);
            }
        }
    }

    /// All pairs are looked at next.
    pub(super) fn touch_all(&mut self) {
        self.touched = (0..self.pairs.len() as u32).collect();
        self.is_touched.fill(true);
    }

    /// Hands out the pairs touched since the last time.
    pub(super) fn take_touched(&mut self, into: &mut Vec<u32>) {
        into.clear();
        std::mem::swap(into, &mut self.touched);
        into.iter().for_each(|&pair| self.is_touched[pair as usize] = false);
    }

    /// Whether a pair is not compared here.
    #[inline]
    pub(super) fn is_off(&self, pair: usize, states: [&State; 2]) -> bool {
        self.pairs[pair].is_off(states[0])
    }

    /// Whether the sides of a pair are the same.
    #[inline]
    pub(super) fn is_same(&mut self, pair: usize, states: [&State; 2]) -> bool {
        self.pairs[pair].same(states, self.unknowns, &mut self.scratch)
    }

    /// Shows a pair in the waveform.
    pub(super) fn show(&mut self, pair: usize, states: [&State; 2], differs: bool) -> Result<()> {
        let Some(both) = &mut self.both else { return Ok(()) };
        let [a, b] = &mut self.scratch;
        self.pairs[pair].gather(0, states[0], a);
        self.pairs[pair].gather(1, states[1], b);
        both.change(pair, [a, b], differs)
    }

    /// Counts a pair that differs at a place, with the values in the states.
    pub(super) fn count(&mut self, pair: usize, spot: Spot, states: [&State; 2]) {
        let [a, b] = &mut self.scratch;
        let kind = &self.pairs[pair];
        if self.tallies[pair].first.is_none() {
            kind.gather(0, states[0], a);
            kind.gather(1, states[1], b);
        }
        self.tallies[pair].differs(spot.order, || first(kind, spot, a, b));
    }

    /// Counts a pair whose values are at hand.
    pub(super) fn count_values(&mut self, pair: usize, spot: Spot, a: &Bits, b: &Bits) {
        let kind = &self.pairs[pair];
        self.tallies[pair].differs(spot.order, || first(kind, spot, a, b));
    }
}

fn first(pair: &Pair, spot: Spot, a: &Bits, b: &Bits) -> First {
    let differing = |bit: &u32| {
        let (word, place) = (*bit as usize / 64, bit % 64);
        (a.value[word] ^ b.value[word]) >> place & 1 == 1
    };
    let known = a.is_known() && b.is_known();
    let bits = if known { (0..pair.width).filter(differing).collect() } else { Vec::new() };
    let (expected, got) = (pair.show.text(a, pair.width), pair.show.text(b, pair.width));
    First { spot, expected, got, bits }
}
