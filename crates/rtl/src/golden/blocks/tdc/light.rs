//! The photons of a TDC's stimulus.

use tofsim::firmware::carry_chain::Delays;
use tofsim::firmware::tdc_decoder::Encoder;

use crate::golden::prelude::*;

/// Width of a pulse in MODE 1 [eighths of a clock period].
const DEAD_TIME: u64 = 20;

/// First and last age of a hit that has so many taps high.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ages {
    /// Taps.
    pub(super) taps: u64,
    /// The age at which the last of them is reached, or tap 0.
    pub(super) first: Time,
    last: Time,
}

/// For every number of taps that a hit can have, where the clock has the period `cycle`.
fn ages(delays: &Delays, cycle: Time) -> impl Iterator<Item = Ages> {
    let arrivals = delays.arrivals().iter().copied();
    let end = delays.tap_0() + cycle;
    let next = arrivals.clone().skip(1).chain([end]);
    arrivals.zip(next).zip(1..=delays.taps() as u64).filter_map(move |((at, next), taps)| {
        let first = at.max(delays.tap_0());
        let last = next.min(end).since(Time::from_fs(1));
        (first <= last).then_some(Ages { taps, first, last })
    })
}

/// Pulses that the SPAD makes.
pub(super) struct Light {
    /// Its output.
    pub(super) stops: Stops,
    /// Ages that are swept.
    pub(super) ages: Vec<Ages>,
    turn: usize,
    delays: Delays,
    encoder: Encoder,
}

impl Light {
    pub(super) fn new(delays: &Delays, encoder: &Encoder, cycle: Time) -> Self {
        let ages = ages(delays, cycle).collect();
        Light { stops: Stops::new(cycle), ages, turn: 0, delays: delays.clone(), encoder: encoder.clone() }
    }

    /// Coarse count of a hit that has that age at the edge which samples it, if it is not before the
    /// laser edge.
    pub(super) fn coarse(&self, age: Time) -> u64 {
        (age.fs() - 1) / self.stops.cycle.fs()
    }

    /// A hit of which the decoder has made that number: the sweep goes on if it was its own.
    pub(super) fn counted(&mut self, n: u64) {
        let own = self.ages[self.turn % self.ages.len()].taps as usize;
        self.turn += usize::from(self.encoder.of_rank(own) as u64 == n);
    }

    /// Plans the shot between two laser edges.
    pub(super) fn shoot(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        let quiet = self.stops.last() + self.delays.longest() <= laser + self.stops.cycle;
        match draw.below(8) {
            _ if self.stops.ends_high() => self.toggle(laser, self.within(20, draw)),
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
        let cycle = self.stops.cycle;
        let edge = Time::from_fs((self.coarse(age) + 1) * cycle.fs());
        self.toggle(laser, edge - age);
        self.toggle(laser, end - cycle - laser);
    }

    /// MODE 0, anywhere in the shot or too late for it; then the level is held over.
    fn single(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        let cycle = self.stops.cycle;
        let cycles = (end - laser).fs() / cycle.fs();
        let edge = Time::from_fs(laser.fs() + (1 + draw.below(cycles + 1)) * cycle.fs());
        self.toggle(laser, self.stops.before(edge, &self.delays, draw).since(laser));
        if self.stops.last() + cycle < end {
            self.toggle(laser, end - cycle - laser);
        }
    }

    /// MODE 1, on into the next shot.
    fn pulses(&mut self, laser: Time, end: Time, draw: &mut Draw) {
        while self.stops.last() < end {
            let armed = self.stops.last().since(laser);
            self.toggle(laser, armed + self.within(30, draw));
            let rise = self.stops.last().since(laser);
            self.toggle(laser, rise + stops::of_eighths(DEAD_TIME, self.stops.cycle));
        }
    }

    /// Pulses as short as the chain can hold.
    fn burst(&mut self, laser: Time, draw: &mut Draw) {
        for _ in 0..2 * (1 + draw.below(4)) {
            let armed = self.stops.last().since(laser);
            self.toggle(laser, armed + self.within(6, draw));
        }
    }

    /// A change so long after the laser edge, or as soon after the last change as may be.
    fn toggle(&mut self, laser: Time, after: Time) {
        let gap = Time::from_fs(self.delays.longest().fs() / 5);
        self.stops.toggle((laser + after).max(self.stops.last() + gap));
    }

    /// Up to so many eighths of a clock period.
    fn within(&self, eighths: u64, draw: &mut Draw) -> Time {
        Time::from_fs(draw.below(stops::of_eighths(eighths, self.stops.cycle).fs()))
    }
}
