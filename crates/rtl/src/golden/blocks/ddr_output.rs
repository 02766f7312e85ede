//! Pulses of one half cycle, alone and in rows.

use crate::golden::block::{Block, Latency, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::CLK_250;
use tofsim::firmware::ddr_output::In;
use tofsim::firmware::tof_top::TofTop;

pub(super) const SPEC: Spec = Spec {
    name: "ddr_output",
    scope: "vcsel_driver.ddr_output",
    stream: Some(4),
    timing: CLK_250,
    reset: None,
    fast: &["q"],
    latency: &[Latency { from: "d", to: "q", cycles: |_| 0 }],
    glue: None,
    record: |spec, setting| record(spec, setting, DdrOutput::new()),
};

struct DdrOutput {
    last: u64,
    levels: Cover,
}

impl DdrOutput {
    fn new() -> Self {
        DdrOutput { last: 0, levels: Cover::new("d in three cycles, as bits", 0..8) }
    }
}

impl Block for DdrOutput {
    type Stimulus = In;

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> In {
        let d = draw.one_in(2);
        self.last = self.last * 2 % 8 + u64::from(d);
        self.levels.see_if(cycle >= 2, self.last);
        In { d }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.vcsel_driver.ddr_output = top.vcsel_driver.ddr_output.rise(i);
    }

    fn cycle(&mut self, _: usize, i: &In, top: &mut TofTop, look: &mut dyn FnMut(&TofTop)) {
        look(top);
        top.vcsel_driver.ddr_output = top.vcsel_driver.ddr_output.fall();
        look(top);
        self.edge(i, top);
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.levels]
    }
}
