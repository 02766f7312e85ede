//! Reset and lock in every order, some for a single cycle.

use tofsim::firmware::reset_sync::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(14),
    timing: timing::CLK,
    latency: &[
        Latency { from: "rst", to: "rst_sync", cycles: |_| 1 },
        Latency { from: "locked", to: "rst_sync", cycles: |_| 1 },
    ],
    ..Spec::new("reset_sync", "reset_sync_125", record::<ResetSync>)
};

struct ResetSync {
    i: In,
    changes: Cover,
}

impl Block for ResetSync {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        let changes = Cover::new("rst x 2 + locked, from x 4 + to", 0..16);
        ResetSync { i: In { rst: false, locked: true }, changes }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let levels = |i: In| bits([i.rst, i.locked]);
        let (before, i) = (self.i, &mut self.i);
        i.rst ^= draw.one_in(3);
        i.locked ^= draw.one_in(3);
        self.changes.see(levels(before) * 4 + levels(*i));
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.reset_sync_125 = top.reset_sync_125.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
