//! The wire from the SPAD to the chain.

use crate::kernel::Time;

use super::delays::{Delays, Taps};
use super::disturbance::Disturbance;

/// Transitions that may travel in a chain at once.
const MAX_TRANSITIONS: usize = 8;

/// Its level and the transitions still travelling in the chain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StopLine {
    level: bool,
    /// Times of the last transitions, a ring.
    recent: [Time; MAX_TRANSITIONS],
    /// Place of the newest.
    newest: usize,
    travelling: usize,
    /// What makes the chain another at each edge, if something does.
    disturbance: Option<Box<Disturbance>>,
}

impl StopLine {
    /// Low, to a chain that is another at each edge.
    pub fn disturbed(disturbance: Disturbance) -> Self {
        StopLine { disturbance: Some(Box::new(disturbance)), ..StopLine::default() }
    }

    /// Whether the chain is another at each edge.
    pub fn is_disturbed(&self) -> bool {
        self.disturbance.is_some()
    }

    /// It is low, and has been for long.
    pub fn settle(&mut self) {
        (self.level, self.travelling) = (false, 0);
    }

    /// The level now.
    pub fn level(&self) -> bool {
        self.level
    }

    /// The level changes. A change at the same instant as the last one undoes it: a pulse of no
    /// width is none.
    pub fn toggle(&mut self, now: Time) {
        self.level = !self.level;
        if self.travelling > 0 && self.at(0) == now {
            self.newest = (self.newest + 1) % MAX_TRANSITIONS;
            self.travelling -= 1;
        } else {
            self.newest = (self.newest + MAX_TRANSITIONS - 1) % MAX_TRANSITIONS;
            self.recent[self.newest] = now;
            self.travelling = (self.travelling + 1).min(MAX_TRANSITIONS);
        }
    }

    /// How old the `nth` transition that still travels is at `now`, 0 the newest.
    #[cfg(test)]
    pub(super) fn age_of(&self, nth: usize, now: Time) -> Option<Time> {
        (nth < self.travelling).then(|| now - self.at(nth))
    }

    /// When the `nth` transition was, 0 the newest.
    #[inline(always)]
    fn at(&self, nth: usize) -> Time {
        self.recent[(self.newest + nth) % MAX_TRANSITIONS]
    }

    /// Whether the taps of the last edge are those of every edge to come, until the level changes.
    #[inline(always)]
    pub fn is_shown_by(&self, taps: &Taps) -> bool {
        self.travelling == 0 && taps.is_settled_at(self.level)
    }

    /// The taps at a clock edge; forgets transitions that have left the chain.
    #[inline(always)]
    pub fn sample(&mut self, now: Time, delays: &Delays) -> Taps {
        if self.travelling > 0 && self.is_disturbed() {
            return self.sample_disturbed(now, delays);
        }
        while self.travelling > 0 && now - self.at(self.travelling - 1) >= delays.longest() {
            self.travelling -= 1;
        }
        match self.travelling {
            0 => Taps::settled(self.level),
            1 => Taps::single(self.level, delays.rank_inside(now - self.at(0))),
            _ => self.sample_travelling(now, delays),
        }
    }

    fn sample_travelling(&self, now: Time, delays: &Delays) -> Taps {
        let ages = (0..self.travelling).map(|nth| now - self.at(nth));
        Taps::new(self.level, ages.map(|age| delays.rank_inside(age)))
    }

    #[cold]
    fn sample_disturbed(&mut self, now: Time, delays: &Delays) -> Taps {
        let mut ages = [Time::ZERO; MAX_TRANSITIONS];
        let ages = &mut ages[..self.travelling];
        for (nth, age) in ages.iter_mut().enumerate() {
            *age = now - self.at(nth);
        }
        let Some(disturbance) = &mut self.disturbance else { return Taps::settled(self.level) };
        disturbance.usual(ages, now);
        let end = delays.longest() + disturbance.half_window();
        self.travelling = ages.partition_point(|age| *age < end);
        disturbance.sample((self.level, &ages[..self.travelling]), now, delays)
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
