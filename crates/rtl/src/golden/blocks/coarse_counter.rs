//! Shots of every length: cut short, exactly full, and with a pause after the window.

use tofsim::firmware::coarse_counter::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(1),
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "window", cycles: |_| 0 }],
    ..Spec::new("coarse_counter", "tdc.coarse_counter", record::<CoarseCounter>)
};

struct CoarseCounter {
    /// Edges until the next start.
    wait: u64,
    coarse: Cover,
    started_at: Cover,
}

impl Block for CoarseCounter {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        let coarse = Cover::new("coarse", 0..8);
        let started_at = Cover::new("start at coarse, or with the window closed (8)", 0..9);
        CoarseCounter { wait: 0, coarse, started_at }
    }

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
