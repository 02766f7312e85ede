//! Pulses of one half cycle, alone and in rows.

use tofsim::firmware::ddr_output::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(4),
    timing: timing::CLK_250,
    fast: &["q"],
    latency: &[Latency { from: "d", to: "q", cycles: |_| 0 }],
    ..Spec::new("ddr_output", "vcsel_driver.ddr_output", record::<DdrOutput>)
};

struct DdrOutput {
    last: u64,
    levels: Cover,
}

impl Block for DdrOutput {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        DdrOutput { last: 0, levels: Cover::new("d in three cycles, as bits", 0..8) }
    }

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> In {
        let d = draw.one_in(2);
        self.last = self.last * 2 % 8 + u64::from(d);
        self.levels.see_if(cycle >= 2, self.last);
        In { d }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.vcsel_driver.ddr_output = top.vcsel_driver.ddr_output.rise(i);
    }

    fn cycle(&mut self, _: usize, i: &In, top: &mut TofTop, sample: &mut dyn FnMut(&TofTop)) {
        sample(top);
        top.vcsel_driver.ddr_output = top.vcsel_driver.ddr_output.fall();
        sample(top);
        self.edge(i, top);
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.levels]
    }
}
