//! The single-photon avalanche diodes on the TDC and their front end, the source of `tdc_stop`.
//!
//! While `spad_rst` is high none can fire; when that falls all are armed. After an avalanche a
//! diode's output stays high until the next `spad_rst` (MODE 0, active reset) or until its dead time
//! has passed, when it is armed again (MODE 1, passive quenching). `tdc_stop` is high while any output
//! is (thesis Fig. 4.3). In MODE 0 nobody sees the avalanches after a first one, so they are left out:
//! where MODE 1 begins behind it, all diodes but that one are taken as armed.

use std::collections::VecDeque;

use crate::kernel::Time;

/// What a diode does at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// An avalanche.
    Avalanche,
    /// The dead time of one has passed.
    Recovery,
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
    fired: VecDeque<Time>,
    /// The next avalanche of one that is armed; never until it has been drawn.
    avalanche: Time,
    /// The next avalanche or recovery.
    next: Time,
}

impl Spads {
    /// That many diodes, armed from power-up, the first avalanche at `first`.
    pub fn new(count: usize, dead_time: Time, first: Time) -> Self {
        Spads {
            count,
            is_off: false,
            passive: false,
            dead_time,
            fired: VecDeque::new(),
            avalanche: first,
            next: first,
        }
    }

    /// When one next does something by itself.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Does what is due at [`Spads::next_event`]. If diodes wait for an avalanche then, [`Spads::arm`]
    /// has to follow.
    pub fn event(&mut self) -> Event {
        let now = self.next;
        let recovers = self.recovery() == now;
        if recovers {
            self.fired.pop_front();
        } else {
            self.fired.push_back(now + self.dead_time);
        }
        self.avalanche = Time::NEVER;
        self.next = self.recovery();
        if recovers { Event::Recovery } else { Event::Avalanche }
    }

    /// Whether `tdc_stop` is high.
    #[inline(always)]
    pub fn output(&self) -> bool {
        !self.fired.is_empty()
    }

    /// Whether an avalanche of an armed diode would be seen.
    #[inline(always)]
    pub fn is_armed(&self) -> bool {
        match self.passive {
            true => !self.is_off && self.fired.len() < self.count,
            false => !self.is_off && self.fired.is_empty(),
        }
    }

    /// Whether one would be seen and has not been drawn.
    #[inline(always)]
    pub fn waits(&self) -> bool {
        self.avalanche == Time::NEVER && self.is_armed()
    }

    /// How much less often one of those that are armed fires than one of all would [1].
    #[inline(always)]
    pub fn share(&self) -> f64 {
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
    }

    /// All are ready to fire, the first at `next`.
    pub fn arm_all(&mut self, next: Time) {
        self.is_off = false;
        self.fired.clear();
        self.arm(next);
    }

    /// `spad_rst` rises.
    pub fn hold(&mut self) {
        self.is_off = true;
        self.fired.clear();
        self.arm(Time::NEVER);
    }

    /// The quench mode changes at `now`. An output that has been high for longer than the dead
    /// time falls as MODE 1 begins. If diodes wait for an avalanche then, [`Spads::arm`] has to follow.
    pub fn set_passive(&mut self, passive: bool, now: Time) {
        self.passive = passive;
        for until in &mut self.fired {
            *until = now.max(*until);
        }
        let unseen = !passive && self.output();
        self.arm(if unseen { Time::NEVER } else { self.avalanche });
    }

    #[inline(always)]
    fn recovery(&self) -> Time {
        match self.fired.front() {
            Some(&until) if self.passive => until,
            _ => Time::NEVER,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEAD: Time = Time::from_ns(20);

    fn one() -> Spads {
        Spads::new(1, DEAD, Time::from_ns(5))
    }

    #[test]
    fn in_mode_0_the_output_stays_high_until_the_reset() {
        for count in [1, 40] {
            let mut spads = Spads::new(count, DEAD, Time::from_ns(5));
            assert_eq!(spads.event(), Event::Avalanche);
            assert!(spads.output() && !spads.is_armed());
            assert_eq!(spads.next_event(), Time::NEVER);
            spads.hold();
            assert!(spads.is_off() && !spads.output() && !spads.is_armed());
            spads.arm_all(Time::from_ns(70));
            assert!(spads.is_armed() && !spads.waits());
            assert_eq!(spads.next_event(), Time::from_ns(70));
        }
    }

    #[test]
    fn in_mode_1_it_recovers_after_the_dead_time() {
        let mut spad = one();
        spad.set_passive(true, Time::ZERO);
        spad.event();
        assert!(!spad.is_armed());
        assert_eq!(spad.next_event(), Time::from_ns(25));
        assert_eq!(spad.event(), Event::Recovery);
        assert!(spad.waits());
        spad.arm(Time::from_ns(40));
        assert_eq!(spad.next_event(), Time::from_ns(40));
    }

    #[test]
    fn in_mode_1_the_others_stay_armed_and_the_last_to_recover_ends_the_output() {
        let mut spads = Spads::new(3, DEAD, Time::from_ns(5));
        spads.set_passive(true, Time::ZERO);
        for (at, share) in [(5, 1.5), (9, 3.0)] {
            assert_eq!(spads.next_event(), Time::from_ns(at));
            assert_eq!(spads.event(), Event::Avalanche);
            assert!(spads.waits());
            assert_eq!(spads.share(), share);
            spads.arm(Time::from_ns(9 + 100 * u64::from(at == 9)));
        }
        for (at, output) in [(25, true), (29, false)] {
            assert_eq!(spads.next_event(), Time::from_ns(at));
            assert_eq!(spads.event(), Event::Recovery);
            assert_eq!(spads.output(), output);
            spads.arm(Time::from_ns(109));
        }
        assert_eq!(spads.next_event(), Time::from_ns(109));
    }

    #[test]
    fn a_change_of_mode_finds_a_diode_that_has_fired() {
        let mut spad = one();
        spad.event();
        spad.set_passive(true, Time::from_ns(10));
        assert_eq!(spad.next_event(), Time::from_ns(25));
        spad.set_passive(false, Time::from_ns(12));
        assert_eq!(spad.next_event(), Time::NEVER);
        spad.set_passive(true, Time::from_ns(90));
        assert_eq!(spad.next_event(), Time::from_ns(90));
    }
}
