//! The SPADs on the TDC and their front end, which drive `tdc_stop`.
//!
//! While `spad_rst` is high no SPAD can fire; its falling edge arms all. After an avalanche the output of a SPAD
//! stays high until the next `spad_rst` (MODE 0, active reset), or until its dead time has passed and it is armed
//! again (MODE 1, passive quenching). `tdc_stop` is the OR of the outputs (thesis Fig. 4.3). In MODE 0 avalanches
//! after the first one have no effect and are not simulated; if the mode changes to MODE 1 during a shot, all SPADs
//! but the one that fired count as armed. If outputs that are not connected to the TDC are simulated too, every SPAD
//! is tracked to the end of the shot.
//!
//! A [`SpadRow`] tracks SPADs individually for the effects that require it.

use crate::kernel::Time;

use super::light::Light;
use super::row::{Effects, SpadRow};

/// An event in a SPAD.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// An avalanche.
    Avalanche,
    /// An avalanche due to a trapped carrier.
    Afterpulse,
    /// End of a dead time.
    Recovery,
    /// A carrier in a SPAD that is not armed, or an avalanche while `tdc_stop` was high.
    Unseen,
}

/// SPADs of one row. An avalanche is drawn for all armed ones together ([`Spads::share`]).
#[derive(Clone, Debug)]
pub struct Spads {
    /// Number of SPADs, at least one.
    count: usize,
    /// Whether `spad_rst` is high.
    is_off: bool,
    passive: bool,
    dead_time: Time,
    /// Ends of the present dead times, in ascending order.
    fired: Vec<Time>,
    /// Number of fired SPADs that are not connected to the TDC.
    unwired: usize,
    /// Dark fraction of the rate of the SPAD that fired last, if SPADs differ [1].
    dark_part: Option<f64>,
    /// Time of the next avalanche of an armed SPAD; never until it is drawn.
    avalanche: Time,
    /// Time of the next avalanche, recovery or release.
    next: Time,
    /// Number of fired SPADs from which a further avalanche has no effect.
    most: usize,
    /// Individually tracked SPADs, if an effect requires it.
    row: Option<Box<SpadRow>>,
}

impl Spads {
    /// Creates `count` SPADs that are armed from power-up, with the first avalanche at `first`.
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

    /// Adds effects that require individual tracking, if there are any.
    pub fn with_effects(mut self, effects: Effects, seed: u64) -> Self {
        if !effects.are_none(self.count) {
            self.row = Some(Box::new(SpadRow::new(self.count, effects, seed)));
            self.most = self.most();
        }
        self
    }

    /// Returns the individually tracked SPADs, if an effect requires them.
    #[inline(always)]
    pub fn row(&mut self) -> Option<&mut SpadRow> {
        self.row.as_deref_mut()
    }

    /// Returns the number of fired SPADs from which a further avalanche has no effect. With afterpulsing or
    /// paralysable dead time, every avalanche matters.
    fn most(&self) -> usize {
        match &self.row {
            Some(row) if self.passive && row.effects().paralysable => usize::MAX,
            Some(row) if row.effects().trap_probability > 0.0 => self.count,
            Some(row) if row.effects().on_tdc.is_some() => self.count,
            _ if self.passive => self.count,
            _ => 1,
        }
    }

    /// Returns the time of the next event.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Processes the event at [`Spads::next_event`]. If an avalanche must then be drawn, a call of [`Spads::arm`]
    /// must follow.
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

    /// Processes the next event of individually tracked SPADs.
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
            let diode = light.spad().unwrap_or_else(|| row.pick(dark));
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

    /// Returns the level of `tdc_stop`.
    #[inline(always)]
    pub fn output(&self) -> bool {
        self.fired.len() > self.unwired
    }

    /// Returns the outputs of individually tracked SPADs, one bit each.
    pub fn outputs(&self) -> u64 {
        self.row.as_ref().map_or(0, |row| row.outputs())
    }

    /// Returns the dark fraction of the rate of the SPAD that fired last, if SPADs differ [1].
    pub fn dark_part(&self) -> Option<f64> {
        self.dark_part
    }

    /// Returns whether an avalanche of an armed SPAD would have an effect.
    #[inline(always)]
    pub fn is_armed(&self) -> bool {
        !self.is_off && self.fired.len() < self.most
    }

    /// Returns whether an avalanche would have an effect and has not been drawn.
    #[inline(always)]
    pub fn waits(&self) -> bool {
        self.avalanche == Time::NEVER && self.is_armed()
    }

    /// Returns all SPADs over armed SPADs: the factor on the mean waiting time [1].
    #[inline(always)]
    pub fn share(&self) -> f64 {
        if self.row.is_some() {
            return 1.0;
        }
        self.count as f64 / (self.count - self.fired.len()) as f64
    }

    /// Returns whether `spad_rst` is high.
    #[inline(always)]
    pub fn is_off(&self) -> bool {
        self.is_off
    }

    /// Returns whether the quench mode is passive (MODE 1).
    #[inline(always)]
    pub fn is_passive(&self) -> bool {
        self.passive
    }

    /// Sets the time of the next avalanche among the armed SPADs.
    #[inline(always)]
    pub fn arm(&mut self, next: Time) {
        self.avalanche = next;
        self.next = next.min(self.recovery());
        if let Some(row) = &self.row {
            self.next = self.next.min(row.release());
        }
    }

    /// Arms all SPADs, with the first avalanche at `next`.
    pub fn arm_all(&mut self, next: Time) {
        self.is_off = false;
        self.forget();
        self.arm(next);
    }

    /// Processes the rising edge of `spad_rst`.
    pub fn hold(&mut self) {
        self.is_off = true;
        self.forget();
        self.arm(Time::NEVER);
    }

    /// Clears all outputs.
    #[inline(always)]
    fn forget(&mut self) {
        self.fired.clear();
        if let Some(row) = &mut self.row {
            row.arm_all();
            self.unwired = 0;
        }
    }

    /// Changes the quench mode at `now`. When MODE 1 begins, outputs that have been high for longer than the dead
    /// time fall. If an avalanche must then be drawn, a call of [`Spads::arm`] must follow.
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
