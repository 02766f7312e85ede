//! Every change of rate at every phase, acquisition and laser switched on and off, both resets.

use tofsim::firmware::vcsel_driver::{In, PERIODS};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(21),
    timing: timing::BOTH,
    reset: Some("rst"),
    fast: &["laser_on", "laser_pulse", "ddr_output.q"],
    latency: &[Latency { from: "acquire", to: "start", cycles: |_| 5 }],
    ..Spec::new("vcsel_driver", "vcsel_driver", record::<VcselDriver>)
};

struct VcselDriver {
    i: In,
    changes: Cover,
    phases: Cover,
}

impl Block for VcselDriver {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        let i =
            In { rst: true, rst_250: true, acquire: true, laser_en: true, laser_freq: U::new(3) };
        let phases = PERIODS
            .iter()
            .zip(0..)
            .flat_map(|(&period, rate)| (0..period).map(move |count| rate * 32 + count));
        VcselDriver {
            i,
            changes: Cover::new("laser_freq from x 4 + to, taken at a wrap", 0..16),
            phases: Cover::new("laser_freq changes, rate x 32 + count", phases),
        }
    }

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> In {
        let registers = &top.vcsel_driver.registers;
        let i = &mut self.i;
        let before = i.laser_freq;
        if draw.one_in(12) {
            i.laser_freq = draw.word();
        }
        i.laser_en ^= draw.one_in(40);
        i.acquire = if i.acquire { !draw.one_in(300) } else { draw.one_in(5) };
        (i.rst, i.rst_250) = (draw.one_in(400), draw.one_in(400));
        if let Some((rate, count, wraps)) = registers.place() {
            self.changes.see_if(wraps && i.acquire, rate * 4 + i.laser_freq.get());
            self.phases.see_if(before != i.laser_freq, rate * 32 + count);
        }
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.vcsel_driver.rise(i);
    }

    fn cycle(&mut self, cycle: usize, i: &In, top: &mut TofTop, sample: &mut dyn FnMut(&TofTop)) {
        sample(top);
        top.vcsel_driver.fall_250();
        sample(top);
        if cycle > 0 {
            top.vcsel_driver.rise_250(i);
        }
        sample(top);
        top.vcsel_driver.fall_250();
        sample(top);
        self.edge(i, top);
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.changes, self.phases]
    }
}
