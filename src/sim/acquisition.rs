//! The device while it only acquires: most of a run, and the same cycle again and again.
//!
//! What cannot happen is left out of the loop, and what can end it ends the loop: the last shot, a
//! change of a control signal, or a limit of the caller's. With [`Gait::Skip`] cycles in which
//! nothing would move but hidden counters are counted and not stepped: the clock sleeps as long as
//! every module is quiet, and the first edge at or after an avalanche wakes it.

use crate::firmware::tof_top::Params;
use crate::kernel::{AWAKE, Time};

use super::device::{Device, Off};
use super::frames::Frames;

/// How a device goes through time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gait {
    /// Every cycle.
    Step,
    /// Every cycle that changes something.
    Skip,
    /// Shots of an undisturbed acquisition as a whole.
    Leap,
}

impl Device {
    /// Goes on until `limit`, or until something else begins than an acquisition [cycles of
    /// clk_125]. Does nothing if that is so from the start.
    /// `at_shot` may move the device on in each cycle in which a shot has begun.
    pub fn acquire<const SKIP: bool>(
        &mut self,
        p: &Params,
        frames: &mut Frames,
        limit: u64,
        mut at_shot: impl FnMut(&mut Self, &mut Frames),
    ) {
        let Some(period) = self.steady_period() else { return };
        let limit = limit.min(self.cycle.saturating_add(self.cycles_of_steady_control(period)));
        let (mut emitter_wakes, mut converter_wakes) = (self.cycle, self.cycle);
        let mut now = self.pll.clk_125.rise(self.cycle);
        while self.top.frame_ctrl.acquire && self.cycle < limit {
            while self.spad.next_event() <= now {
                self.detect(&mut Off);
                converter_wakes = self.cycle;
            }
            let emits = emitter_wakes <= self.cycle;
            if converter_wakes <= self.cycle {
                self.top.convert_acquiring(p, &mut self.line, now);
                frames.count_hit(&self.top);
                let quiet = self.top.converter_quiet(p, &self.line);
                converter_wakes = (self.cycle + 1).saturating_add(quiet);
            } else if SKIP && !emits {
                let quiet = limit.min(emitter_wakes).min(converter_wakes) - self.cycle;
                now += Time::from_fs(self.skip(quiet, now, period) * period.fs());
                continue;
            } else {
                self.top.skip_converter(1);
            }
            self.cycle += 1;
            if !emits {
                self.top.skip_emitter(1);
                now += period;
                continue;
            }
            self.top.emit_acquiring(p);
            self.react_acquiring(now);
            self.top.rest_acquiring();
            emitter_wakes = self.cycle.saturating_add(self.top.emitter_quiet());
            if self.top.rouses_converter(&self.line) {
                converter_wakes = self.cycle;
            }
            now += period;
            if self.top.vcsel_driver.registers.start {
                frames.count_shot(&self.top);
                at_shot(self, frames);
                emitter_wakes = self.cycle;
                now = self.pll.clk_125.rise(self.cycle);
            }
        }
    }

    /// Whether the edge at `now` finds the top [only acquiring](TofTop::only_acquires). Pins change
    /// when the timeline says so and not before.
    #[inline(always)]
    pub(super) fn only_acquires(&mut self, now: Time) -> bool {
        if !self.top.frame_ctrl.acquire {
            return false;
        }
        if now >= self.acquires_until && self.top.only_acquires() {
            self.acquires_until = self.timeline.next_event();
        }
        now < self.acquires_until
    }

    /// Cycles that can be skipped before the next one, whatever the device does.
    pub fn skip_idle(&mut self, p: &Params, limit: u64) {
        if self.jitter.is_none()
            && let Some(period) = self.pll.clk_125.whole_period()
        {
            let quiet = self.top.quiet(p, &self.line);
            let cycles = quiet
                .min(self.cycles_of_steady_control(period))
                .min(limit.saturating_sub(self.cycle));
            if cycles != AWAKE {
                self.skip(cycles, self.pll.clk_125.rise(self.cycle), period);
            }
        }
    }

    /// Coming cycles that end before a control signal changes, or just then.
    fn cycles_of_steady_control(&self, period: Time) -> u64 {
        let next = self.pll.clk_125.rise(self.cycle);
        self.timeline.next_event().since(next).fs() / period.fs()
    }

    /// So many cycles later, at the begin of `frame`, with a detector that has been quiet for long.
    pub fn pass(&mut self, cycles: u64, frame: u64) {
        let begun = self.pll.clk_125.rise(self.cycle);
        self.cycle += cycles;
        self.timeline.pass(self.pll.clk_125.rise(self.cycle) - begun);
        self.light.begin_frame(frame);
        self.spad.arm(Time::NEVER);
        self.line.settle_low();
    }

    /// The period of `clk_125`, if the device only acquires, at an even pace.
    pub(super) fn steady_period(&self) -> Option<Time> {
        let even = self.jitter.is_none() && self.top.only_acquires();
        self.pll.clk_125.whole_period().filter(|_| even)
    }

    /// Skips that many quiet cycles, the first of them at `now`, or those whose edge of `clk_125`
    /// comes before the detector's next event. Returns how many.
    #[inline(always)]
    fn skip(&mut self, quiet: u64, now: Time, period: Time) -> u64 {
        let event = self.spad.next_event();
        let cycles = match event < now.saturating_add(Time::from_fs(quiet * period.fs())) {
            true => event.since(now).fs().div_ceil(period.fs()),
            false => quiet,
        };
        self.top.skip(cycles);
        self.cycle += cycles;
        cycles
    }
}
