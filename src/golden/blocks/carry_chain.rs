//! Pulses of every width and distance, changes exactly on a clock edge and exactly on a tap's
//! boundary, and several pulses in the chain at once.

use crate::firmware::carry_chain::{CarryChain as Chain, Delays, TAPS};
use crate::firmware::tof_top::TofTop;
use crate::golden::block::{Block, Parameter, Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::roms;
use crate::golden::stops::{self, Stops};
use crate::golden::timing::CLK_125;
use crate::kernel::Time;
use crate::network::mem::Mem;
use crate::signals;

pub(super) const SPEC: Spec = Spec {
    name: "carry_chain",
    scope: "tdc.carry_chain",
    timing: CLK_125,
    reset: None,
    fast: &[],
    latency: &[],
    glue: None,
    record: |spec, setting| record(spec, setting, CarryChain::new(setting)),
};

signals! {
    /// Nothing: `tdc_stop` is no part of a line.
    pub(super) struct Stimulus {}
}

struct CarryChain {
    delays: Delays,
    stops: Stops,
    ones: Cover,
    travelling: Cover,
}

impl CarryChain {
    fn new(setting: &Setting) -> Self {
        CarryChain {
            delays: setting.setup.params.tdc.delays.clone(),
            stops: Stops::default(),
            ones: Cover::new("ones in the taps", 0..=TAPS as u64),
            travelling: Cover::new("changes from tap to tap", 0..4),
        }
    }
}

impl Block for CarryChain {
    type Stimulus = Stimulus;

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> Stimulus {
        let gap = Time::from_fs(self.delays.longest().fs() / 5);
        let pause = if draw.one_in(3) { Time::from_ns(draw.below(50)) } else { Time::ZERO };
        let edge = stops::edge(cycle);
        if self.stops.last() <= edge {
            let coming = stops::edge(cycle + draw.below(3) as usize + 1);
            let wanted = stops::before(coming, &self.delays, draw) + pause;
            self.stops.toggle(wanted.max(self.stops.last() + gap).max(edge + Time::from_fs(1)));
        }
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
        look(top);
        let now = stops::edge(cycle);
        self.stops.advance(now);
        let taps = self.stops.line.sample(now, &self.delays);
        top.tdc.carry_chain = Chain { taps };
        self.ones.see(taps.ones() as u64);
        let changes = (1..TAPS).filter(|&tap| taps.tap(tap) != taps.tap(tap - 1)).count();
        self.travelling.see(changes as u64);
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("DelaysFile", Parameter::File("tap_delays.mem"))]
    }

    fn roms(&self) -> Vec<Mem> {
        vec![roms::tap_delays(&self.delays)]
    }

    fn stops(&self) -> &[Time] {
        self.stops.times()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.ones, self.travelling]
    }
}
