//! The transitions of `tdc_stop` on their way through the chain.

use crate::kernel::Time;

use super::delays::{Delays, Taps};

/// Transitions that may travel in a chain at once.
pub const MAX_TRANSITIONS: usize = 8;

/// Times of the last transitions of `tdc_stop`, and how many of them still travel in the chain.
///
/// The level that they lead to is the pin's.
#[derive(Clone, Debug, PartialEq)]
pub struct Transitions {
    /// Newest first; never where there has been none.
    recent: [Time; MAX_TRANSITIONS],
    travelling: usize,
}

impl Default for Transitions {
    fn default() -> Self {
        Transitions { recent: [Time::NEVER; MAX_TRANSITIONS], travelling: 0 }
    }
}

impl Transitions {
    /// Adds a transition at `now`. One at the same instant as the last undoes that: a pulse of no width is none.
    pub fn push(&mut self, now: Time) {
        const OLDEST: usize = MAX_TRANSITIONS - 1;
        if self.travelling > 0 && self.recent[0] == now {
            self.recent.copy_within(1.., 0);
            self.recent[OLDEST] = Time::NEVER;
            self.travelling -= 1;
        } else {
            self.recent.copy_within(..OLDEST, 1);
            self.recent[0] = now;
            self.travelling = (self.travelling + 1).min(MAX_TRANSITIONS);
        }
    }

    /// Returns the ages of the last transitions at `now`, newest first, also of those that have left the chain.
    pub fn ages(&self, now: Time) -> impl Iterator<Item = Time> {
        let known = self.recent.iter().take_while(|at| **at != Time::NEVER);
        known.map(move |at| now - *at)
    }

    /// Returns the instants of the last transitions after `past`, newest first, as many as are known.
    pub fn since(&self, past: Time) -> impl Iterator<Item = Time> {
        self.recent.into_iter().take_while(move |at| *at != Time::NEVER && *at > past)
    }

    /// Whether every edge to come samples `taps`, those of the last edge, as long as the pin stays at `level`.
    #[inline(always)]
    pub fn are_over(&self, level: bool, taps: &Taps) -> bool {
        self.travelling == 0 && taps.is_settled_at(level)
    }

    /// Samples the taps at a clock edge, with the pin at `level`; forgets transitions that have left the chain.
    #[inline(always)]
    pub fn sample(&mut self, level: bool, now: Time, delays: &Delays) -> Taps {
        while self.travelling > 0 && now - self.recent[self.travelling - 1] >= delays.longest() {
            self.travelling -= 1;
        }
        match self.travelling {
            0 => Taps::settled(level),
            1 => Taps::single(level, delays.rank_inside(now - self.recent[0])),
            _ => self.sample_travelling(level, now, delays),
        }
    }

    fn sample_travelling(&self, level: bool, now: Time, delays: &Delays) -> Taps {
        let ranks = self.recent[..self.travelling].iter().map(|at| delays.rank_inside(now - *at));
        Taps::new(level, ranks)
    }
}

#[cfg(test)]
mod tests {
    use super::super::TAPS;
    use super::*;

    #[test]
    fn an_old_pulse_travels_beside_a_new_one() {
        let delays = Delays::new(Time::from_fs(2_230_000), &[11_500; TAPS]).unwrap();
        let mut transitions = Transitions::default();
        [100, 103, 106].into_iter().for_each(|ns| transitions.push(Time::from_ns(ns)));
        let taps = transitions.sample(true, Time::from_ns(110), &delays);
        let rank = |age_ns| delays.rank(Time::from_ns(age_ns));
        assert_eq!(taps, Taps::new(true, [rank(4), rank(7), rank(10)]));
        assert_eq!(taps.ones(TAPS), rank(4) + rank(10) - rank(7));
        assert_eq!(transitions.sample(true, Time::from_ns(150), &delays), Taps::settled(true));
        assert_eq!(transitions.travelling, 0);
    }

    #[test]
    fn a_pulse_without_width_is_none() {
        let mut transitions = Transitions::default();
        [3, 3].into_iter().for_each(|ns| transitions.push(Time::from_ns(ns)));
        assert_eq!(transitions, Transitions::default());
    }
}
