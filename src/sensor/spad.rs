//! The single-photon avalanche diode and its front end, the source of `tdc_stop`.
//!
//! While `spad_rst` is high it cannot fire; when that falls it is armed. After an avalanche its
//! output stays high until the next `spad_rst` (MODE 0, active reset) or until the dead time has
//! passed, when it is armed again (MODE 1, passive quenching).

use crate::kernel::Time;

/// State of the diode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Held by `spad_rst`.
    Off,
    /// Ready to fire.
    Armed,
    /// Fired, and not recovered.
    Fired,
}

/// What the diode does at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// An avalanche: `tdc_stop` rises.
    Avalanche,
    /// The dead time has passed: `tdc_stop` falls, and the diode needs its next avalanche.
    Recovery,
}

#[derive(Clone, Debug)]
pub struct Spad {
    state: State,
    passive: bool,
    dead_time: Time,
    /// The next avalanche or recovery.
    next: Time,
    /// When the dead time of the last avalanche ends.
    dead_until: Time,
}

impl Spad {
    /// A diode that is armed from power-up, its first avalanche at `first`.
    pub fn new(dead_time: Time, first: Time) -> Self {
        let dead_until = Time::ZERO;
        Spad { state: State::Armed, passive: false, dead_time, next: first, dead_until }
    }

    /// When the diode next does something by itself.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Does what is due at [`Spad::next_event`]. After a recovery, [`Spad::arm`] has to follow.
    pub fn event(&mut self) -> Event {
        let now = self.next;
        match self.state {
            State::Armed => {
                self.state = State::Fired;
                self.dead_until = now + self.dead_time;
                self.next = if self.passive { self.dead_until } else { Time::NEVER };
                Event::Avalanche
            }
            State::Fired | State::Off => {
                self.next = Time::NEVER;
                Event::Recovery
            }
        }
    }

    /// Whether an avalanche is awaited.
    pub fn is_armed(&self) -> bool {
        self.state == State::Armed
    }

    /// Whether `spad_rst` holds the diode.
    #[inline(always)]
    pub fn is_off(&self) -> bool {
        self.state == State::Off
    }

    /// Whether the output recovers by itself.
    #[inline(always)]
    pub fn is_passive(&self) -> bool {
        self.passive
    }

    /// Ready to fire; the next avalanche will be at `next`.
    pub fn arm(&mut self, next: Time) {
        (self.state, self.next) = (State::Armed, next);
    }

    /// `spad_rst` rises. Returns whether the output falls.
    pub fn hold(&mut self) -> bool {
        let fired = self.state == State::Fired;
        (self.state, self.next) = (State::Off, Time::NEVER);
        fired
    }

    /// The quench mode changes at `now`. An output that has been high for longer than the dead
    /// time falls as MODE 1 begins.
    pub fn set_passive(&mut self, passive: bool, now: Time) {
        self.passive = passive;
        if self.state == State::Fired {
            self.next = if passive { self.dead_until.max(now) } else { Time::NEVER };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEAD: Time = Time::from_ns(20);

    #[test]
    fn in_mode_0_the_output_stays_high_until_the_reset() {
        let mut spad = Spad::new(DEAD, Time::from_ns(5));
        assert_eq!(spad.event(), Event::Avalanche);
        assert_eq!(spad.next_event(), Time::NEVER);
        assert!(spad.hold());
        assert!(spad.is_off() && !spad.hold());
    }

    #[test]
    fn in_mode_1_it_recovers_after_the_dead_time() {
        let mut spad = Spad::new(DEAD, Time::from_ns(5));
        spad.set_passive(true, Time::ZERO);
        spad.event();
        assert_eq!(spad.next_event(), Time::from_ns(25));
        assert_eq!(spad.event(), Event::Recovery);
        spad.arm(Time::from_ns(40));
        assert!(spad.is_armed());
        assert_eq!(spad.next_event(), Time::from_ns(40));
    }

    #[test]
    fn a_change_of_mode_finds_a_diode_that_has_fired() {
        let mut spad = Spad::new(DEAD, Time::from_ns(5));
        spad.event();
        spad.set_passive(true, Time::from_ns(10));
        assert_eq!(spad.next_event(), Time::from_ns(25));
        spad.set_passive(false, Time::from_ns(12));
        assert_eq!(spad.next_event(), Time::NEVER);
        spad.set_passive(true, Time::from_ns(90));
        assert_eq!(spad.next_event(), Time::from_ns(90));
    }
}
