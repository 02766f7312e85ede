//! Whole estimations with starts while busy in every phase, and estimations cut short by a reset in
//! every third phase and in all about a change of layer; the seed says which third.

use tofsim::firmware::estimator_ctrl::{In, done};

use crate::golden::prelude::*;

/// Phases past this one are all cut short: the changes of layer are there.
const LAYERS: u64 = 254;

pub(super) const SPEC: Spec = Spec {
    stream: Some(6),
    reset: Some("rst"),
    latency: &[
        Latency { from: "algo_start", to: "read_en", cycles: |_| 0 },
        Latency { from: "algo_start", to: "algo_done", cycles: done },
    ],
    ..Spec::new("estimator_ctrl", "depth_estimator.estimator_ctrl", record::<EstimatorCtrl>)
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

impl Block for EstimatorCtrl {
    type Stimulus = In;

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
            None => self.idle.see(bits([i.rst, i.algo_start])),
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

    fn parameters(&self) -> Parameters {
        parameters::neurons(self.neurons).into_iter().collect()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.starts, self.resets, self.idle]
    }
}
