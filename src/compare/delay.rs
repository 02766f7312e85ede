//! Pairs that cannot be compared by the values at one place alone.

use std::collections::VecDeque;

use crate::error::Result;
use crate::source::State;

use super::pair::Bits;
use super::plan::Plan;
use super::tallies::Tallies;
use super::tally::Spot;

/// A pair of which one side is late, or that is compared only at times.
pub(super) struct Delay {
    pair: usize,
    /// Values of the side that is early.
    early: VecDeque<(Bits, Bits, Spot, bool)>,
}

impl Delay {
    /// Of that pair.
    pub(super) fn new(pair: usize) -> Self {
        Delay { pair, early: VecDeque::new() }
    }

    /// A window begins: nothing is kept from the one before.
    pub(super) fn clear(&mut self) {
        self.early.clear();
    }

    /// Takes a sample, and compares as soon as both sides have come.
    pub(super) fn compare(
        &mut self,
        plan: &Plan,
        spot: Spot,
        states: [&State; 2],
        tallies: &mut Tallies,
    ) -> Result<()> {
        let differs = self.step(plan, spot, states, tallies);
        tallies.show(self.pair, states, differs)
    }

    /// Whether the pair differs at the sample that has both sides now.
    fn step(
        &mut self,
        plan: &Plan,
        spot: Spot,
        states: [&State; 2],
        tallies: &mut Tallies,
    ) -> bool {
        let pair = &plan.matching.pairs[self.pair];
        let (mut a, mut b) = (Bits::default(), Bits::default());
        pair.gather(0, states[0], &mut a);
        pair.gather(1, states[1], &mut b);
        let off = pair.is_off(states[0]);
        self.early.push_back((a, b, spot, off));
        let late = pair.latency.unsigned_abs() as usize;
        if self.early.len() <= late {
            return false;
        }
        let Some((a_early, b_early, spot_early, off_early)) = self.early.pop_front() else {
            return false;
        };
        let now = self.early.back().cloned();
        let (a_now, b_now, spot_now, off_now) =
            now.unwrap_or((a_early.clone(), b_early.clone(), spot_early, off_early));
        let (a, b, off, spot) = match pair.latency >= 0 {
            true => (a_early, b_now, off_early, [spot_early, spot_now]),
            false => (a_now, b_early, off_now, [spot_now, spot_early]),
        };
        if off {
            return false;
        }
        tallies.tallies[self.pair].compared += 1;
        let differs = !pair.equal(&a, &b, tallies.unknowns());
        if differs {
            let at = [spot[0].at[0], spot[1].at[1]];
            tallies.count_values(self.pair, Spot { at, ..spot_now }, &a, &b);
        }
        differs
    }
}
