//! The single-photon avalanche diodes on the TDC and their front end, the source of `tdc_stop`.
//!
//! While `spad_rst` is high none can fire; when that falls all are armed. After an avalanche a
//! diode's output stays high until the next `spad_rst` (MODE 0, active reset) or until its dead time
//! has passed, when it is armed again (MODE 1, passive quenching). `tdc_stop` is high while any output
//! is (thesis Fig. 4.3). In MODE 0 nobody sees the avalanches after a first one, so they are left out:
//! where MODE 1 begins behind it, all diodes but that one are taken as armed. Of a whole row, of which some are on the TDC
//! and others are not, each is followed to the end of the shot.
//!
//! What diodes do beside that, and which of them, is the matter of a [`Row`].

use crate::kernel::Time;

use super::light::Light;
use super::row::{Effects, Row};

/// What a diode does at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// An avalanche.
    Avalanche,
    /// One that a trapped carrier sets off.
    Afterpulse,
    /// The dead time of one has passed.
    Recovery,
    /// A carrier came to a diode at rest, or to another one while `tdc_stop` was high.
    Unseen,
}

/// Diodes of one row. An avalanche is drawn for all armed ones together ([`Spads::share`]).
#[derive(Clone, Debug)]
pub struct Spads {
    /// How many there are, one or more.
    count: usize,
    /// Held by `spad_rst`.
    is_off: bool,
    passive: bool,
    dead_time: Time,
    /// When the dead time of each that has fired ends, the oldest first.
    fired: Vec<Time>,
    /// How many of those are not on the TDC.
    unwired: usize,
    /// The part of the last avalanche's rate that came without any light, where diodes differ in it [1].
    dark_part: Option<f64>,
    /// The next avalanche of one that is armed; never until it has been drawn.
    avalanche: Time,
    /// The next avalanche, recovery or release.
    next: Time,
    /// So many have fired that nobody sees the next avalanche.
    most: usize,
    /// The diodes one by one, where they do more than fire.
    row: Option<Box<Row>>,
}

impl Spads {
    /// That many diodes, armed from power-up, the first avalanche at `first`.
    pub fn new(count: usize, dead_time: Time, first: Time) -> Self {
        Spads {
            count,
            is_off: false,
            passive: false,
            dead_time,
            fired: Vec::new(),
            unwired: 0,
            dark_part: None,
            avalanche: first,
            next: first,
            most: 1,
            row: None,
        }
    }

    /// The same with what they do beside firing.
    pub fn with_effects(mut self, effects: Effects, seed: u64) -> Self {
        if !effects.are_none(self.count) {
            self.row = Some(Box::new(Row::new(self.count, effects, seed)));
            self.most = self.most();
        }
        self
    }

    /// The diodes one by one, if they do more than fire.
    #[inline(always)]
    pub fn row(&mut self) -> Option<&mut Row> {
        self.row.as_deref_mut()
    }

    /// How many may fire before nobody sees what comes. A trap is filled by avalanches that
    /// nobody sees, and a dead time starts again in a diode at rest.
    fn most(&self) -> usize {
        match &self.row {
            Some(row) if self.passive && row.effects().paralysable => usize::MAX,
            Some(row) if row.effects().afterpulse_probability > 0.0 => self.count,
            Some(row) if row.effects().on_tdc.is_some() => self.count,
            _ if self.passive => self.count,
            _ => 1,
        }
    }

    /// When one next does something by itself.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Does what is due at [`Spads::next_event`]. If diodes wait for an avalanche then, [`Spads::arm`]
    /// has to follow.
    pub fn event(&mut self, light: &mut Light) -> Event {
        if self.row.is_some() {
            return self.event_of_row(light);
        }
        let now = self.next;
        let recovers = self.recovery() == now;
        if recovers {
            self.fired.remove(0);
        } else {
            self.fired.push(now + self.dead_time);
        }
        self.avalanche = Time::NEVER;
        self.next = self.recovery();
        if recovers { Event::Recovery } else { Event::Avalanche }
    }

    /// The same where the diodes are told apart.
    #[cold]
    fn event_of_row(&mut self, light: &mut Light) -> Event {
        let (now, was_high) = (self.next, self.output());
        let recovers = self.recovery() == now;
        let Some(row) = &mut self.row else { return Event::Unseen };
        let again = self.passive && row.effects().paralysable;
        let dead_time = self.dead_time;
        let (fires, seen) = if recovers {
            row.recover(now);
            (true, Event::Recovery)
        } else if row.release() == now {
            let diode = row.released().filter(|_| !self.is_off);
            let fires = diode.is_some_and(|diode| row.carrier(diode, now, dead_time, again));
            (fires && !was_high, Event::Afterpulse)
        } else {
            self.avalanche = Time::NEVER;
            light.take(now);
            let dark = light.dark_part(now);
            let diode = row.pick(dark);
            let differ = row.effects().on_tdc.is_some();
            self.dark_part = differ.then(|| row.dark_part(diode, dark));
            let fires = row.carrier(diode, now, dead_time, again);
            (fires && !was_high, Event::Avalanche)
        };
        self.fired.clear();
        self.fired.extend(row.fired());
        self.unwired = row.unwired();
        let kept = if self.is_armed() { self.avalanche } else { Time::NEVER };
        self.arm(kept);
        if fires { seen } else { Event::Unseen }
    }

    /// Whether `tdc_stop` is high.
    #[inline(always)]
    pub fn output(&self) -> bool {
        self.fired.len() > self.unwired
    }

    /// The outputs that are high, a bit each, where the diodes are told apart.
    pub fn outputs(&self) -> u64 {
        self.row.as_ref().map_or(0, |row| row.outputs())
    }

    /// The part of the last avalanche's rate that came without any light, where diodes differ in it [1].
    pub fn dark_part(&self) -> Option<f64> {
        self.dark_part
    }

    /// Whether an avalanche of an armed diode would be seen, or matters otherwise.
    #[inline(always)]
    pub fn is_armed(&self) -> bool {
        !self.is_off && self.fired.len() < self.most
    }

    /// Whether one would be seen and has not been drawn.
    #[inline(always)]
    pub fn waits(&self) -> bool {
        self.avalanche == Time::NEVER && self.is_armed()
    }

    /// How much less often one of those that are armed fires than one of all would [1].
    #[inline(always)]
    pub fn share(&self) -> f64 {
        if self.row.is_some() {
            return 1.0;
        }
        self.count as f64 / (self.count - self.fired.len()) as f64
    }

    /// Whether `spad_rst` holds the diodes.
    #[inline(always)]
    pub fn is_off(&self) -> bool {
        self.is_off
    }

    /// Whether outputs recover by themselves.
    #[inline(always)]
    pub fn is_passive(&self) -> bool {
        self.passive
    }

    /// The next avalanche of those that are armed will be at `next`.
    #[inline(always)]
    pub fn arm(&mut self, next: Time) {
        self.avalanche = next;
        self.next = next.min(self.recovery());
        if let Some(row) = &self.row {
            self.next = self.next.min(row.release());
        }
    }

    /// All are ready to fire, the first at `next`.
    pub fn arm_all(&mut self, next: Time) {
        self.is_off = false;
        self.forget();
        self.arm(next);
    }

    /// `spad_rst` rises.
    pub fn hold(&mut self) {
        self.is_off = true;
        self.forget();
        self.arm(Time::NEVER);
    }

    /// None has fired.
    #[inline(always)]
    fn forget(&mut self) {
        self.fired.clear();
        if let Some(row) = &mut self.row {
            row.arm_all();
            self.unwired = 0;
        }
    }

    /// The quench mode changes at `now`. An output that has been high for longer than the dead
    /// time falls as MODE 1 begins. If diodes wait for an avalanche then, [`Spads::arm`] has to follow.
    pub fn set_passive(&mut self, passive: bool, now: Time) {
        self.passive = passive;
        self.most = self.most();
        for until in &mut self.fired {
            *until = now.max(*until);
        }
        if let Some(row) = &mut self.row {
            row.not_before(now);
        }
        self.arm(if self.is_armed() { self.avalanche } else { Time::NEVER });
    }

    #[inline(always)]
    fn recovery(&self) -> Time {
        match self.fired.first() {
            Some(&until) if self.passive => until,
            _ => Time::NEVER,
        }
    }
}

#[cfg(test)]
mod tests;
