//! The oscillator from power-up: before lock, the first edges, and the clocks running.

use tofsim::firmware::pll::Pll as Clocks;
use tofsim::kernel::clock::Clock;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(13),
    timing: timing::OWN,
    fast: &["clk_125", "clk_250", "locked"],
    ..Spec::new("pll", "pll", record::<Pll>)
};

struct Pll {
    clocks: Clocks,
    levels: Cover,
}

/// Level of a clock.
fn level(clock: &Clock, at: Time) -> bool {
    let (first, period) = (clock.rise(0), clock.rise(1) - clock.rise(0));
    at >= first && at < clock.fall((at - first).fs() / period.fs())
}

impl Block for Pll {
    type Stimulus = Nothing;

    fn new(setting: &Setting) -> Self {
        let levels = Cover::new("locked, clk_125, clk_250 as bits", [0, 4, 5, 6, 7]);
        Pll { clocks: setting.setup.pll().clone(), levels }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, _: &mut Draw) -> Nothing {
        Nothing {}
    }

    fn cycle(
        &mut self,
        cycle: usize,
        _: &Nothing,
        top: &mut TofTop,
        sample: &mut dyn FnMut(&TofTop),
    ) {
        for quarter in 1..=4 {
            let at = Time::from_ns(8 * cycle as u64 + 2 * quarter) - Time::from_fs(1000);
            top.clocks.clk_125 = level(&self.clocks.clk_125, at);
            top.clocks.clk_250 = level(&self.clocks.clk_250, at);
            top.pll.locked = at >= self.clocks.locked_at;
            sample(top);
            self.levels.see(bits([top.pll.locked, top.clocks.clk_125, top.clocks.clk_250]));
        }
    }

    fn parameters(&self) -> Parameters {
        vec![("LockTime", Parameter::Number(self.clocks.locked_at.ps()))]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.levels]
    }
}
