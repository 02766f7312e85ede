//! The photons of a TDC's stimulus.

use tofsim::firmware::carry_chain::Delays;

use crate::golden::prelude::*;

/// Period of `clk_sys`.
const CYCLE: Time = Time::from_ns(8);
/// Width of a pulse in MODE 1.
const DEAD_TIME: Time = Time::from_ns(20);

/// First and last age of a hit that has so many taps high.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ages {
    /// Taps.
    pub(super) taps: u64,
    /// The age at which the last of them is reached, or tap 0.
    pub(super) first: Time,
    last: Time,
}

/// For every number of taps that a hit can have.
fn ages(delays: &Delays) -> impl Iterator<Item = Ages> {
    let arrivals = delays.arrivals().iter().copied();
    let end = delays.tap_0() + CYCLE;
    let next = arrivals.clone().skip(1).chain([end]);
    arrivals.zip(next).zip(1..=delays.taps() as u64).filter_map(move |((at, next), taps)| {
        let first = at.max(delays.tap_0());
        let last = next.min(end).since(Time::from_fs(1));
        (first <= last).then_some(Ages { taps, first, last })
    })
}

/// Coarse count of a hit that has that age at the edge which samples it, if it is not before the
/// laser edge.
pub(super) fn coarse(age: Time) -> u64 {
    (age.fs() - 1) / CYCLE.fs()
}

/// What the SPAD sees.
pub(super) struct Light {
    /// Its output.
    pub(super) stops: Stops,
    /// What is swept.
    pub(super) ages: Vec<Ages>,
    turn: usize,
    delays: Delays,
}

impl Light {
    pub(super) fn new(delays: &Delays) -> Self {
        let ages = ages(delays).collect();
        Light { stops: Stops::default(), ages, turn: 0, delays: delays.clone() }
    }

    /// A hit with so many taps high has been counted: the sweep goes on if it was its own.
    pub(super) fn counted(&mut self, taps: u64) {
        self.turn += usize::from(self.ages[self.turn % self.ages.len()].taps == taps);
    }

    /// Plans the shot between two laser edges.
    pub(super) fn shoot(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        let quiet = self.stops.last() + self.delays.longest() <= laser + CYCLE;
        match draw.below(8) {
            _ if self.stops.ends_high() => self.toggle(laser, within(20, draw)),
            0..5 if quiet => self.sweep(laser, end, draw),
            0..6 => self.single(laser, end, draw),
            6 => self.pulses(laser, end, draw),
            _ => self.burst(laser, draw),
        }
    }

    /// MODE 0, with the next number of taps, to the first or the last femtosecond.
    fn sweep(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        let Ages { first, last, .. } = self.ages[self.turn % self.ages.len()];
        let age = match draw.below(4) {
            0 => last,
            1 => first + Time::from_fs(draw.below((last - first).fs() + 1)),
            _ => first,
        };
        let edge = Time::from_fs((coarse(age) + 1) * CYCLE.fs());
        self.toggle(laser, edge - age);
        self.toggle(laser, end - CYCLE - laser);
    }

    /// MODE 0, anywhere in the shot or too late for it; then the level is held over.
    fn single(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        let cycles = (end - laser).fs() / CYCLE.fs();
        let edge = Time::from_fs(laser.fs() + (1 + draw.below(cycles + 1)) * CYCLE.fs());
        self.toggle(laser, stops::before(edge, &self.delays, draw).since(laser));
        if self.stops.last() + CYCLE < end {
            self.toggle(laser, end - CYCLE - laser);
        }
    }

    /// MODE 1, on into the next shot.
    fn pulses(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        while self.stops.last() < end {
            let armed = self.stops.last().since(laser);
            self.toggle(laser, armed + within(30, draw));
            let rise = self.stops.last().since(laser);
            self.toggle(laser, rise + DEAD_TIME);
        }
    }

    /// Pulses as short as the chain can hold.
    fn burst(&mut self, laser: Time, draw: &mut Draw) {
        for _ in 0..2 * (1 + draw.below(4)) {
            let armed = self.stops.last().since(laser);
            self.toggle(laser, armed + within(6, draw));
        }
    }

    /// A change so long after the laser edge, or as soon after the last change as may be.
    fn toggle(&mut self, laser: Time, after: Time) {
        let gap = Time::from_fs(self.delays.longest().fs() / 5);
        self.stops.toggle((laser + after).max(self.stops.last() + gap));
    }
}

/// Up to so many nanoseconds.
fn within(ns: u64, draw: &mut Draw) -> Time {
    Time::from_fs(draw.below(ns * 1_000_000))
}
