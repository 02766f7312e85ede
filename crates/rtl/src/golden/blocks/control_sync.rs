//! Every pair of levels of the five signals one after the other, held for a few cycles or one.

use tofsim::firmware::control_sync::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(3),
    latency: &[
        Latency { from: "mode", to: "mode_sync", cycles: |_| 1 },
        Latency { from: "laser_freq", to: "laser_freq_sync", cycles: |_| 1 },
        Latency { from: "laser_en", to: "laser_en_sync", cycles: |_| 1 },
        Latency { from: "dsp_en", to: "dsp_en_sync", cycles: |_| 1 },
        Latency { from: "dsp_rst", to: "dsp_rst_sync", cycles: |_| 1 },
    ],
    ..Spec::new("control_sync", "control_sync", record::<ControlSync>)
};

struct ControlSync {
    i: In,
    levels: Cover,
    rates: Cover,
    alone: Cover,
}

fn levels(i: &In) -> u64 {
    bits([i.mode, i.laser_en, i.dsp_en, i.dsp_rst])
}

impl Block for ControlSync {
    type Stimulus = In;

    fn new(_: &Setting) -> Self {
        ControlSync {
            i: In::default(),
            levels: Cover::new("mode, laser_en, dsp_en, dsp_rst as bits, from x 16 + to", 0..256),
            rates: Cover::new("laser_freq from x 4 + to", 0..16),
            alone: Cover::new("one signal, 0 to 4, changes alone", 0..5),
        }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let (before, i) = (self.i, &mut self.i);
        let which = draw.below(12);
        let turn = |level: bool, one: u64, draw: &mut Draw| match which {
            5..8 => draw.one_in(2),
            _ => level ^ (which == one),
        };
        i.mode = turn(i.mode, 0, draw);
        i.laser_en = turn(i.laser_en, 1, draw);
        i.dsp_en = turn(i.dsp_en, 2, draw);
        i.dsp_rst = turn(i.dsp_rst, 3, draw);
        if (4..8).contains(&which) {
            i.laser_freq = draw.word();
        }
        self.levels.see(levels(&before) * 16 + levels(i));
        self.rates.see(before.laser_freq.get() * 4 + i.laser_freq.get());
        self.alone.see_if(before != *i, which);
        *i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.control_sync = top.control_sync.next(i, &());
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.levels, self.rates, self.alone]
    }
}
