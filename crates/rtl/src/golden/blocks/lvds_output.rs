//! Both levels, in every order.

use tofsim::firmware::lvds_output::{self, In};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(12),
    timing: timing::NONE,
    ..Spec::new("lvds_output", "lvds_output", record::<LvdsOutput>)
};

struct LvdsOutput {
    last: bool,
    changes: Cover,
}

impl Block for LvdsOutput {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        LvdsOutput { last: false, changes: Cover::new("i from x 2 + to", 0..4) }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let i = draw.one_in(2);
        self.changes.see(bits([self.last, i]));
        self.last = i;
        In { i }
    }

    fn settle(&mut self, i: &In, top: &mut TofTop) {
        top.lvds_output = lvds_output::out(i);
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes]
    }
}
