//! Both levels, in every order.

use crate::golden::block::{Block, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::NONE;
use tofsim::firmware::lvds_output::{self, In};
use tofsim::firmware::tof_top::TofTop;

pub(super) const SPEC: Spec = Spec {
    name: "lvds_output",
    scope: "lvds_output",
    stream: Some(12),
    timing: NONE,
    reset: None,
    fast: &[],
    latency: &[],
    glue: None,
    record: |spec, setting| record(spec, setting, LvdsOutput::new()),
};

struct LvdsOutput {
    last: bool,
    changes: Cover,
}

impl LvdsOutput {
    fn new() -> Self {
        LvdsOutput { last: false, changes: Cover::new("i from x 2 + to", 0..4) }
    }
}

impl Block for LvdsOutput {
    type Stimulus = In;

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let i = draw.one_in(2);
        self.changes.see(u64::from(self.last) * 2 + u64::from(i));
        self.last = i;
        In { i }
    }

    fn settle(&mut self, i: &In, top: &mut TofTop) {
        top.lvds_output = lvds_output::out(i);
    }

    fn edge(&mut self, _: &In, _: &mut TofTop) {}

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
