//! `pre_start` of every length in both modes, with the mode changed and the reset pressed in every
//! phase of it.

use crate::golden::block::{Block, Latency, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::CLK_125;
use tofsim::firmware::spad_control::In;
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Clocked;

pub(super) const SPEC: Spec = Spec {
    name: "spad_control",
    scope: "spad_control",
    stream: Some(15),
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[Latency { from: "pre_start", to: "spad_rst", cycles: |_| 0 }],
    glue: None,
    record: |spec, setting| record(spec, setting, SpadControl::new()),
};

struct SpadControl {
    i: In,
    changes: Cover,
}

impl SpadControl {
    fn new() -> Self {
        let changes = Cover::new("rst, mode, pre_start as bits, from x 8 + to", 0..64);
        SpadControl { i: In::default(), changes }
    }
}

fn levels(i: &In) -> u64 {
    u64::from(i.rst) * 4 + u64::from(i.mode) * 2 + u64::from(i.pre_start)
}

impl Block for SpadControl {
    type Stimulus = In;

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let (before, i) = (self.i, &mut self.i);
        i.rst = draw.one_in(4);
        i.mode ^= draw.one_in(3);
        i.pre_start = draw.one_in(2);
        self.changes.see(levels(&before) * 8 + levels(i));
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.spad_control = top.spad_control.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
