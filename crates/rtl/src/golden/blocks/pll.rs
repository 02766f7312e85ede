//! The oscillator from power-up: before lock, the first edges, and the clocks running.

use crate::golden::block::{Block, Parameter, Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::OWN;
use tofsim::firmware::pll::Pll as Clocks;
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Time;
use tofsim::kernel::clock::Clock;
use tofsim::signals;

pub(super) const SPEC: Spec = Spec {
    name: "pll",
    scope: "pll",
    stream: Some(13),
    timing: OWN,
    reset: None,
    fast: &["clk_125", "clk_250", "locked"],
    latency: &[],
    glue: None,
    record: |spec, setting| record(spec, setting, Pll::new(setting)),
};

signals! {
    /// Nothing: the oscillator runs by itself.
    pub(super) struct Stimulus {}
}

struct Pll {
    clocks: Clocks,
    levels: Cover,
}

impl Pll {
    fn new(setting: &Setting) -> Self {
        let levels = Cover::new("locked, clk_125, clk_250 as bits", [0, 4, 5, 6, 7]);
        Pll { clocks: setting.setup.pll().clone(), levels }
    }
}

/// Level of a clock.
fn level(clock: &Clock, at: Time) -> bool {
    let (first, period) = (clock.rise(0), clock.rise(1) - clock.rise(0));
    at >= first && at < clock.fall((at - first).fs() / period.fs())
}

impl Block for Pll {
    type Stimulus = Stimulus;

    fn stimulus(&mut self, _: usize, _: &TofTop, _: &mut Draw) -> Stimulus {
        Stimulus {}
    }

    fn edge(&mut self, _: &Stimulus, _: &mut TofTop) {}

    fn cycle(
        &mut self,
        cycle: usize,
        _: &Stimulus,
        top: &mut TofTop,
        look: &mut dyn FnMut(&TofTop),
    ) {
        for quarter in 1..=4 {
            let at = Time::from_ns(8 * cycle as u64 + 2 * quarter) - Time::from_fs(1000);
            top.clocks.clk_125 = level(&self.clocks.clk_125, at);
            top.clocks.clk_250 = level(&self.clocks.clk_250, at);
            top.pll.locked = at >= self.clocks.locked_at;
            look(top);
            let levels = [top.pll.locked, top.clocks.clk_125, top.clocks.clk_250];
            self.levels.see(levels.iter().fold(0, |sum, &level| sum * 2 + u64::from(level)));
        }
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("LockTime", Parameter::Number(self.clocks.locked_at.ps()))]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.levels]
    }
}
