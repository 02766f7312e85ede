//! The wire from the SPAD to the chain.

use crate::kernel::Time;

use super::delays::{Delays, Taps};

/// Transitions that may travel in a chain at once.
pub const MAX_TRANSITIONS: usize = 8;

/// Its level and the transitions still travelling in the chain.
#[derive(Clone, Debug, PartialEq)]
pub struct StopLine {
    level: bool,
    /// Times of the last transitions, the newest first; never where there has been none.
    recent: [Time; MAX_TRANSITIONS],
    travelling: usize,
}

impl Default for StopLine {
    fn default() -> Self {
        StopLine { level: false, recent: [Time::NEVER; MAX_TRANSITIONS], travelling: 0 }
    }
}

impl StopLine {
    /// The level now.
    pub fn level(&self) -> bool {
        self.level
    }

    /// The level changes. A change at the same instant as the last one undoes it: a pulse of no
    /// width is none.
    pub fn toggle(&mut self, now: Time) {
        const OLDEST: usize = MAX_TRANSITIONS - 1;
        self.level = !self.level;
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

    /// Sets it low, as if it had been for long.
    pub fn settle(&mut self) {
        *self = StopLine::default();
    }

    /// Returns the ages of the last transitions at `now`, the newest first, also of those that have left the
    /// chain.
    pub fn ages(&self, now: Time) -> impl Iterator<Item = Time> {
        let known = self.recent.iter().take_while(|at| **at != Time::NEVER);
        known.map(move |at| now - *at)
    }

    /// Instants of the last transitions that came after `past`, the newest first, as far back as it knows.
    pub fn since(&self, past: Time) -> impl Iterator<Item = Time> {
        self.recent.into_iter().take_while(move |at| *at != Time::NEVER && *at > past)
    }

    /// Returns whether the taps of the last edge are those of every edge to come, until the level changes.
    #[inline(always)]
    pub fn is_shown_by(&self, taps: &Taps) -> bool {
        self.travelling == 0 && taps.is_settled_at(self.level)
    }

    /// The taps at a clock edge; forgets transitions that have left the chain.
    #[inline(always)]
    pub fn sample(&mut self, now: Time, delays: &Delays) -> Taps {
        while self.travelling > 0 && now - self.recent[self.travelling - 1] >= delays.longest() {
            self.travelling -= 1;
        }
        match self.travelling {
            0 => Taps::settled(self.level),
            1 => Taps::single(self.level, delays.rank_inside(now - self.recent[0])),
            _ => self.sample_travelling(now, delays),
        }
    }

    fn sample_travelling(&self, now: Time, delays: &Delays) -> Taps {
        let ranks = self.recent[..self.travelling].iter().map(|at| delays.rank_inside(now - *at));
        Taps::new(self.level, ranks)
    }
}

#[cfg(test)]
mod tests {
    use super::super::TAPS;
    use super::*;

    #[test]
    fn an_old_pulse_travels_beside_a_new_one() {
        let delays = Delays::new(Time::from_fs(2_230_000), &[11_500; TAPS]).unwrap();
        let mut line = StopLine::default();
        line.toggle(Time::from_ns(100));
        line.toggle(Time::from_ns(103));
        line.toggle(Time::from_ns(106));
        let taps = line.sample(Time::from_ns(110), &delays);
        let rank = |age_ns| delays.rank(Time::from_ns(age_ns));
        assert_eq!(taps, Taps::new(true, [rank(4), rank(7), rank(10)]));
        assert_eq!(taps.ones(TAPS), rank(4) + rank(10) - rank(7));
        assert_eq!(line.sample(Time::from_ns(150), &delays), Taps::settled(true));
        assert_eq!(line.travelling, 0);
    }

    #[test]
    fn a_pulse_without_width_is_none() {
        let mut line = StopLine::default();
        line.toggle(Time::from_ns(3));
        line.toggle(Time::from_ns(3));
        assert_eq!((line.level(), line.travelling), (false, 0));
    }
}
