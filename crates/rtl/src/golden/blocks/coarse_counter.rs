//! Shots of every length: cut short, exactly full, and with a pause after the window.

use crate::golden::block::{Block, Latency, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::CLK_125;
use tofsim::firmware::coarse_counter::In;
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Clocked;

pub(super) const SPEC: Spec = Spec {
    name: "coarse_counter",
    scope: "tdc.coarse_counter",
    stream: Some(1),
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[Latency { from: "start", to: "window", cycles: |_| 0 }],
    glue: None,
    record: |spec, setting| record(spec, setting, CoarseCounter::new()),
};

struct CoarseCounter {
    /// Edges until the next start.
    wait: u64,
    coarse: Cover,
    started_at: Cover,
}

impl CoarseCounter {
    fn new() -> Self {
        let coarse = Cover::new("coarse", 0..8);
        let started_at = Cover::new("start at coarse, or with the window closed (8)", 0..9);
        CoarseCounter { wait: 0, coarse, started_at }
    }
}

impl Block for CoarseCounter {
    type Stimulus = In;

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> In {
        let counter = &top.tdc.coarse_counter;
        let start = self.wait == 0;
        self.wait = if start { draw.below(14) } else { self.wait - 1 };
        let coarse = counter.coarse.get();
        self.coarse.see_if(counter.window, coarse);
        self.started_at.see_if(start, if counter.window { coarse } else { 8 });
        In { rst: draw.one_in(100), start }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.tdc.coarse_counter = top.tdc.coarse_counter.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.coarse, self.started_at]
    }
}
