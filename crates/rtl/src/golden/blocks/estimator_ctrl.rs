//! Whole estimations with starts while busy in every phase, and estimations cut short by a reset in
//! every third phase and in all about a change of layer; the seed says which third.

use crate::golden::block::{Block, Latency, Parameter, Setting, Spec, neurons};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::timing::CLK_125;
use tofsim::firmware::estimator_ctrl::{In, done};
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Clocked;

/// Phases past this one are all cut short: the changes of layer are there.
const LAYERS: u64 = 254;

pub(super) const SPEC: Spec = Spec {
    name: "estimator_ctrl",
    scope: "depth_estimator.estimator_ctrl",
    stream: Some(6),
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[
        Latency { from: "algo_start", to: "read_en", cycles: |_| 0 },
        Latency { from: "algo_start", to: "algo_done", cycles: done },
    ],
    glue: None,
    record: |spec, setting| record(spec, setting, EstimatorCtrl::new(setting)),
};

struct EstimatorCtrl {
    neurons: usize,
    /// Phases to reset in, the next one last.
    cuts: Vec<u64>,
    /// Where this estimation is cut, if it is.
    cut: Option<u64>,
    /// Estimations begun.
    runs: u64,
    starts: Cover,
    resets: Cover,
    idle: Cover,
}

impl EstimatorCtrl {
    fn new(setting: &Setting) -> Self {
        let third = setting.seed % 3;
        let is_cut = |phase: &u64| phase % 3 == third || *phase == 0 || *phase > LAYERS;
        let neurons = setting.neurons();
        let cuts: Vec<_> = (0..=done(neurons)).filter(is_cut).collect();
        EstimatorCtrl {
            neurons,
            cut: None,
            runs: 0,
            starts: Cover::new("start in cycle after e0", 0..=done(neurons)),
            resets: Cover::new("reset in cycle after e0", cuts.iter().copied()),
            idle: Cover::new("rst x 2 + algo_start while idle", 0..4),
            cuts,
        }
    }
}

impl Block for EstimatorCtrl {
    type Stimulus = In;

    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> In {
        let phase = top.depth_estimator.estimator_ctrl.phase();
        let i = match phase {
            Some(phase) => In {
                rst: self.cut == Some(phase),
                // Every phase within four estimations.
                algo_start: (phase + self.runs).is_multiple_of(4) || draw.one_in(50),
            },
            None => In { rst: draw.one_in(6) && cycle > 0, algo_start: draw.one_in(3) },
        };
        match phase {
            Some(phase) => {
                self.starts.see_if(i.algo_start && !i.rst, phase);
                self.resets.see_if(i.rst, phase);
            }
            None => self.idle.see(u64::from(i.rst) * 2 + u64::from(i.algo_start)),
        }
        if i.algo_start && !i.rst && phase.is_none_or(|phase| phase == done(self.neurons)) {
            self.runs += 1;
            self.cut = if self.runs > 4 && !draw.one_in(20) { self.cuts.pop() } else { None };
        }
        i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        let ctrl = &mut top.depth_estimator.estimator_ctrl;
        *ctrl = ctrl.next(i, &self.neurons);
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        neurons(self.neurons).into_iter().collect()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.starts, self.resets, self.idle]
    }
}
