//! Reset and lock in every order, some for a single cycle.

use crate::golden::block::{Block, Latency, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::CLK;
use tofsim::firmware::reset_sync::In;
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Clocked;

pub(super) const SPEC: Spec = Spec {
    name: "reset_sync",
    scope: "reset_sync_125",
    stream: Some(14),
    timing: CLK,
    reset: None,
    fast: &[],
    latency: &[
        Latency { from: "rst", to: "rst_sync", cycles: |_| 1 },
        Latency { from: "locked", to: "rst_sync", cycles: |_| 1 },
    ],
    glue: None,
    record: |spec, setting| record(spec, setting, ResetSync::new()),
};

struct ResetSync {
    i: In,
    changes: Cover,
}

impl ResetSync {
    fn new() -> Self {
        let changes = Cover::new("rst x 2 + locked, from x 4 + to", 0..16);
        ResetSync { i: In { rst: false, locked: true }, changes }
    }
}

fn levels(i: &In) -> u64 {
    u64::from(i.rst) * 2 + u64::from(i.locked)
}

impl Block for ResetSync {
    type Stimulus = In;

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let (before, i) = (self.i, &mut self.i);
        i.rst ^= draw.one_in(3);
        i.locked ^= draw.one_in(3);
        self.changes.see(levels(&before) * 4 + levels(i));
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.reset_sync_125 = top.reset_sync_125.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
