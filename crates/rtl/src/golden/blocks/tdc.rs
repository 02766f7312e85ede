//! Shots at all rates and closer, with photons as in both modes and in bursts: exactly on edges and
//! on the boundaries of taps, before the shot and after its window, held over into the next; and a
//! sweep through every number of taps that a hit can have.

use tofsim::firmware::tdc::{In, Params};

use crate::golden::prelude::*;

mod goals;
mod light;

use goals::{Goals, LAST_RESET};
use light::Light;

pub(super) const SPEC: Spec = Spec {
    stream: Some(17),
    reset: Some("rst"),
    latency: &[
        Latency { from: "tdc_stop", to: "tdc_valid", cycles: |_| 3 },
        Latency { from: "tdc_stop", to: "tdc_code", cycles: |_| 3 },
    ],
    ..Spec::new("tdc", "tdc", record::<Tdc>)
};

signals! {
    /// Input ports; `tdc_stop` is no part of a line.
    pub(super) struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// A shot begins.
        start: bool,
    }
}

struct Tdc {
    params: Params,
    light: Light,
    /// Cycle of the last start, and of the next.
    started: usize,
    next: usize,
    /// Cycle after a start in which the next reset comes.
    reset: usize,
    goals: Goals,
}

impl Block for Tdc {
    type Stimulus = Stimulus;

    fn new(setting: &Setting) -> Self {
        let params = setting.setup.params.tdc.clone();
        let light = Light::new(&params.delays);
        let goals = Goals::new(&light.ages, &params);
        Tdc { params, light, started: 0, next: 3, reset: LAST_RESET, goals }
    }

    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let start = cycle == self.next;
        let since = if start { 0 } else { cycle - self.started };
        let rst = since == self.reset && draw.one_in(6);
        if let Some(taps) = self.goals.see(cycle - self.started, start, rst, top) {
            self.light.counted(taps);
        }
        if rst {
            self.reset = (self.reset + 1) % (LAST_RESET + 1);
        }
        if start {
            let period = match draw.below(8) {
                0 => 6,
                1 => 8,
                2 => 13,
                3 => 25,
                4 => 1 + draw.below(3),
                5 => 9 + draw.below(6),
                _ => 3 + draw.below(3),
            };
            (self.started, self.next) = (cycle, cycle + period as usize);
            let edge = |cycle: usize| Time::from_ns(8 * cycle as u64);
            self.light.shoot(edge(self.started), edge(self.next), draw);
        }
        Stimulus { rst, start }
    }

    fn cycle(
        &mut self,
        cycle: usize,
        i: &Stimulus,
        top: &mut TofTop,
        sample: &mut dyn FnMut(&TofTop),
    ) {
        sample(top);
        let (now, stops) = (stops::edge(cycle), &mut self.light.stops);
        stops.advance(now);
        let i = In { rst: i.rst, start: i.start, tdc_stop: stops.line.level() };
        top.tdc.rise(&i, &self.params, &mut stops.line, now);
    }

    fn parameters(&self) -> Parameters {
        let Params { delays, cal, .. } = &self.params;
        files(["DelaysFile", "CalFile"], [roms::tap_delays(delays), mem::tdc_decoder(cal)])
    }

    fn stops(&self) -> &[Time] {
        self.light.stops.times()
    }

    fn coverage(self) -> Vec<Cover> {
        self.goals.coverage()
    }
}
