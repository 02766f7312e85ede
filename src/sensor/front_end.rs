//! The driver of `tdc_stop`: the SPADs through their pulse shaper, or the ring oscillator while it runs.

use crate::kernel::Time;

use super::ring::Ring;
use super::shaper::Shaper;

/// The source of `tdc_stop`.
#[derive(Clone, Debug)]
pub struct FrontEnd {
    /// Source of the TDC's hits during a calibration.
    ring: Ring,
    /// Pulse shaper; without one, the wire follows the SPADs.
    shaper: Option<Box<Shaper>>,
    /// Next event of the ring or the shaper.
    next: Time,
}

impl FrontEnd {
    /// Creates an idle front end.
    pub fn new(ring: Ring, shaper: Option<Shaper>) -> Self {
        FrontEnd { ring, shaper: shaper.map(Box::new), next: Time::NEVER }
    }

    /// Returns the time of the next event of the ring or the shaper.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Processes the event at [`FrontEnd::next_event`]. A call of [`FrontEnd::drive`] must follow.
    pub fn event(&mut self) {
        let now = self.next;
        if self.ring.next_event() == now {
            self.ring.event();
        }
        if let Some(shaper) = &mut self.shaper
            && shaper.next_event() == now
        {
            shaper.event();
        }
        self.look_ahead();
    }

    /// Returns whether the ring runs.
    #[inline(always)]
    pub fn ring_is_on(&self) -> bool {
        self.ring.is_on()
    }

    /// Starts or stops the ring. A call of [`FrontEnd::drive`] must follow.
    pub fn switch_ring(&mut self, on: bool, now: Time) {
        self.ring.switch(on, now);
        self.look_ahead();
    }

    /// Returns the level of `tdc_stop`, given the SPADs' output from `now` on.
    #[inline(always)]
    pub fn drive(&mut self, output: bool, now: Time) -> bool {
        let level = if self.shaper.is_some() { self.shape(output, now) } else { output };
        if self.ring.is_on() { self.ring.level() } else { level }
    }

    #[cold]
    fn shape(&mut self, output: bool, now: Time) -> bool {
        let Some(shaper) = &mut self.shaper else { return output };
        shaper.follow(output, now);
        let level = shaper.level();
        self.look_ahead();
        level
    }

    /// Returns whether an avalanche at `now` can be seen on `tdc_stop`. With a shaper, it must make the SPADs'
    /// output, which was `was_high`, rise outside of the gap.
    pub fn shows(&self, was_high: bool, now: Time) -> bool {
        self.shaper.as_ref().is_none_or(|shaper| !was_high && shaper.takes(now))
    }

    fn look_ahead(&mut self) {
        let falls = self.shaper.as_ref().map_or(Time::NEVER, |shaper| shaper.next_event());
        self.next = self.ring.next_event().min(falls);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{ring, shaper};

    fn front_end(width_ns: Option<u64>) -> FrontEnd {
        let ring = ring::Params { half: Time::from_ns(31), jitter_fs: 0.0 };
        let shaper =
            |ns| Shaper::new(shaper::Params { width: Some(Time::from_ns(ns)), gap: Time::ZERO });
        FrontEnd::new(Ring::new(Some(ring), 1), width_ns.map(shaper))
    }

    #[test]
    fn without_a_shaper_the_wire_follows_the_diodes_and_nothing_is_to_come() {
        let mut front_end = front_end(None);
        for (ns, output) in [(5, true), (25, false)] {
            assert_eq!(front_end.drive(output, Time::from_ns(ns)), output);
            assert_eq!(front_end.next_event(), Time::NEVER);
        }
        assert!(front_end.shows(true, Time::from_ns(6)));
    }

    #[test]
    fn a_pulse_ends_by_itself_and_the_ring_goes_before_it() {
        let mut front_end = front_end(Some(100));
        let now = Time::from_ns(5);
        assert!(front_end.shows(false, now) && !front_end.shows(true, now));
        assert!(front_end.drive(true, now) && !front_end.shows(false, now));
        assert_eq!(front_end.next_event(), Time::from_ns(105));
        front_end.switch_ring(true, Time::from_ns(10));
        assert!(front_end.ring_is_on() && !front_end.drive(true, Time::from_ns(10)));
        let mut levels = Vec::new();
        while front_end.next_event() < Time::from_ns(105) {
            let now = front_end.next_event();
            front_end.event();
            levels.push(front_end.drive(true, now));
        }
        assert_eq!(levels.iter().take(2).collect::<Vec<_>>(), [&true, &false]);
        assert_eq!(front_end.next_event(), Time::from_ns(105));
        front_end.event();
        front_end.switch_ring(false, Time::from_ns(110));
        assert!(!front_end.drive(true, Time::from_ns(110)), "the pulse is over");
        assert_eq!(front_end.next_event(), Time::NEVER);
    }
}
