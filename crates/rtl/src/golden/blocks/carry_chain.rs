//! Pulses of every width and distance, changes exactly on a clock edge and exactly on a tap's
//! boundary, and several pulses in the chain at once.

use tofsim::firmware::carry_chain::{CarryChain as Chain, Delays, TAPS};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(0),
    latency: &[Latency { from: "tdc_stop", to: "taps", cycles: |_| 0 }],
    ..Spec::new("carry_chain", "tdc.carry_chain", record::<CarryChain>)
};

struct CarryChain {
    delays: Delays,
    stops: Stops,
    ones: Cover,
    travelling: Cover,
}

impl CarryChain {
    /// A change at that instant, or as soon after the last one as the chain can hold.
    fn toggle(&mut self, edge: Time, at: Time) {
        let gap = Time::from_fs(self.delays.longest().fs() / 5);
        self.stops.toggle(at.max(self.stops.last() + gap).max(edge + Time::from_fs(1)));
    }
}

impl Block for CarryChain {
    type Stimulus = Nothing;

    fn new(setting: &Setting) -> Self {
        let delays = setting.setup.params.tdc.delays.clone();
        let arrivals = delays.arrivals();
        let ones = (0..=TAPS).filter(|&n| n == 0 || n == TAPS || arrivals[n - 1] < arrivals[n]);
        CarryChain {
            stops: Stops::default(),
            ones: Cover::new("ones in the taps", ones.map(|n| n as u64)),
            delays,
            travelling: Cover::new("changes from tap to tap", 0..4),
        }
    }

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> Nothing {
        let edge = stops::edge(cycle);
        if self.stops.last() > edge {
            return Nothing {};
        }
        let coming = stops::edge(cycle + 2);
        let quiet = !self.stops.ends_high() && self.stops.last() + self.delays.longest() <= coming;
        let goal = self.ones.missing().find(|ones| *ones > 0);
        match (draw.below(4), goal) {
            (0, _) => {
                let pause = Time::from_ns(draw.below(50));
                self.toggle(edge, stops::before(coming, &self.delays, draw) + pause);
            }
            (1, _) => {
                for _ in 0..4 {
                    self.toggle(edge, self.stops.last() + Time::from_fs(draw.below(4_000_000)));
                }
            }
            (_, Some(ones)) if quiet => {
                self.toggle(edge, coming - self.delays.arrivals()[ones as usize - 1]);
            }
            _ => {
                let coming = stops::edge(cycle + draw.below(3) as usize + 1);
                self.toggle(edge, stops::before(coming, &self.delays, draw));
            }
        }
        Nothing {}
    }

    fn cycle(
        &mut self,
        cycle: usize,
        _: &Nothing,
        top: &mut TofTop,
        sample: &mut dyn FnMut(&TofTop),
    ) {
        sample(top);
        let now = stops::edge(cycle);
        self.stops.advance(now);
        let taps = self.stops.line.sample(now, &self.delays);
        top.tdc.carry_chain = Chain { taps };
        self.ones.see(taps.ones() as u64);
        let changes = (1..TAPS).filter(|&tap| taps.tap(tap) != taps.tap(tap - 1)).count();
        self.travelling.see(changes as u64);
    }

    fn parameters(&self) -> Parameters {
        files(["DelaysFile"], [roms::tap_delays(&self.delays)])
    }

    fn stops(&self) -> &[Time] {
        self.stops.times()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.ones, self.travelling]
    }
}
