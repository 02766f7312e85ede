//! `pre_start` of every length in both modes, with the mode changed and the reset pressed in every
//! phase of it.

use tofsim::firmware::spad_control::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(15),
    reset: Some("rst"),
    latency: &[Latency { from: "pre_start", to: "spad_rst", cycles: |_| 0 }],
    ..Spec::new("spad_control", "spad_control", record::<SpadControl>)
};

struct SpadControl {
    i: In,
    changes: Cover,
}

impl Block for SpadControl {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        let changes = Cover::new("rst, mode, pre_start as bits, from x 8 + to", 0..64);
        SpadControl { i: In::default(), changes }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let levels = |i: In| bits([i.rst, i.mode, i.pre_start]);
        let (before, i) = (self.i, &mut self.i);
        i.rst = draw.one_in(4);
        i.mode ^= draw.one_in(3);
        i.pre_start = draw.one_in(2);
        self.changes.see(levels(before) * 8 + levels(*i));
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.spad_control = top.spad_control.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
