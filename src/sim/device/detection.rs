//! The asynchronous half of a device: avalanches, the wire from the detector, and what clock edges do to both.

use crate::firmware::carry_chain::Transitions;
use crate::kernel::Time;
use crate::optics::hazard::Cause;
use crate::sensor::spad::Event;

use super::{AvalancheListener, Device, SignalProbe};

impl Device {
    /// Handles asynchronous events up to and at `until`, in order of time. Returns whether there was one at `until`
    /// itself, which is not sampled yet; edges of the oscillator do not count.
    #[inline(always)]
    pub fn settle<T: SignalProbe, R: AvalancheListener>(
        &mut self,
        until: Time,
        probe: &mut T,
        listener: &mut R,
    ) -> bool {
        let mut unseen = false;
        loop {
            let next = self.next_event();
            if T::ON {
                while self.oscillator.next_edge() < next.min(until) {
                    let now = self.oscillator.next_edge();
                    self.top.clocks.clk_in = self.oscillator.edge();
                    probe.tick(now, &self.top);
                }
                if self.oscillator.next_edge() == next.min(until) {
                    self.top.clocks.clk_in = self.oscillator.edge();
                }
            }
            if next > until {
                return unseen;
            }
            self.happen::<R>(next, listener);
            unseen = next == until;
            if T::ON && !unseen {
                self.sample(next, probe);
            }
        }
    }

    /// Returns the instant of the next asynchronous event.
    #[inline(always)]
    pub(in crate::sim) fn next_event(&self) -> Time {
        let next = self.spads.next_event().min(self.timeline.next_event());
        next.min(self.front_end.next_event())
    }

    fn happen<R: AvalancheListener>(&mut self, now: Time, listener: &mut R) {
        if self.timeline.next_event() == now {
            self.timeline.event(&mut self.top.pins);
        }
        if self.spads.next_event() == now {
            self.detect(listener);
        }
        if self.front_end.next_event() == now {
            self.front_end.event();
            self.drive_stop(now);
        }
    }

    /// Begins a frame: the next shot takes up its random numbers.
    pub fn begin_frame(&mut self, frame: u64) {
        self.light.begin_frame(frame);
        if let Some(row) = self.spads.row() {
            row.begin_frame(frame);
        }
    }

    /// Handles the detector's event that is due.
    #[inline(always)]
    pub(in crate::sim) fn detect<R: AvalancheListener>(&mut self, listener: &mut R) {
        let now = self.spads.next_event();
        let output = self.spads.output();
        let event = self.spads.event(&mut self.light);
        if R::ON && self.front_end.shows(output, now) {
            match event {
                Event::Avalanche => {
                    listener.avalanche(now, self.light.cause(now, self.spads.dark_part()))
                }
                Event::Afterpulse => listener.avalanche(now, Some(Cause::Afterpulse)),
                Event::Recovery | Event::Unseen => {}
            }
        }
        if self.spads.waits() {
            self.draw(now);
        }
        if self.spads.output() != output {
            self.drive_stop(now);
        }
    }

    /// Passes the signals that the edge at `now` changed to the detector and the light; `laser` if it switched the
    /// laser on.
    #[inline(always)]
    pub(in crate::sim) fn react(&mut self, now: Time, laser: bool) {
        let passive = self.top.control_sync.mode_sync;
        if passive != self.spads.is_passive() {
            self.spads.set_passive(passive, now);
            if self.spads.waits() {
                self.draw(now);
            }
        }
        let ring_on = self.top.tdc_calibration.registers.ring_on;
        if ring_on != self.front_end.ring_is_on() {
            self.front_end.switch_ring(ring_on, now);
            self.drive_stop(now);
        }
        self.react_to_shot(now, laser);
    }

    /// Passes start, laser and SPAD reset of the edge at `now` to detector and light; mode and ring hold.
    #[inline(always)]
    pub(in crate::sim) fn react_to_shot(&mut self, now: Time, laser: bool) {
        let start = self.top.vcsel_driver.registers.start;
        let hold = self.top.spad_control.spad_rst;
        if start || laser {
            self.light.begin_shot(now, laser);
            if let Some(row) = self.spads.row() {
                row.begin_shot();
            }
            if self.spads.is_armed() {
                self.draw(now);
            }
        }
        if hold == self.spads.is_off() {
            return;
        }
        if hold {
            let output = self.spads.output();
            self.spads.hold();
            if output {
                self.drive_stop(now);
            }
        } else {
            self.spads.arm_all(self.light.next_avalanche(now, 1.0));
        }
    }

    /// Draws the next avalanche of the diodes that are armed at `now`.
    #[inline(always)]
    fn draw(&mut self, now: Time) {
        self.spads.arm(self.light.next_avalanche(now, self.spads.share()));
    }

    /// Sets `tdc_stop` to the level of the front end.
    fn drive_stop(&mut self, now: Time) {
        let level = self.front_end.drive(self.spads.output(), now);
        if level != self.top.pins.tdc_stop {
            self.top.pins.tdc_stop = level;
            self.transitions.push(now);
        }
    }

    /// Puts `tdc_stop` low, as it has been for longer than the delay line.
    pub(in crate::sim) fn rest_stop(&mut self) {
        self.top.pins.tdc_stop = false;
        self.transitions = Transitions::default();
    }
}
