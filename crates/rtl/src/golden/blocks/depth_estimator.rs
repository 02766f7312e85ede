//! Whole estimations of histograms, which the bench reads out as the histogram builder would:
//! empty, level, as measured, random, and all hits in one bin such that each neuron saturates at
//! either end; starts while busy, and a reset in each layer.

use tofsim::firmware::depth_estimator::{In, Params};
use tofsim::firmware::estimator_ctrl::done;
use tofsim::firmware::tansig::{ENTRIES, address};

use crate::golden::prelude::*;
use crate::golden::estimations::{Estimations, Histogram, memory};

mod histograms;

pub(super) const SPEC: Spec = Spec {
    stream: Some(5),
    reset: Some("rst"),
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: done }],
    glue: Some(histograms::GLUE),
    ..Spec::new("depth_estimator", "depth_estimator", record::<DepthEstimator>)
};

signals! {
    /// Input ports, and what the bench reads `count` from.
    pub(super) struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// Starts an estimation.
        algo_start: bool,
        /// Which histogram is there.
        histogram: U<6>,
    }
}

struct DepthEstimator {
    params: Params,
    histograms: Vec<Histogram>,
    estimations: Estimations,
    ends: Cover,
}

impl Block for DepthEstimator {
    type Stimulus = Stimulus;

    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let params = setting.setup.params.depth_estimator.clone();
        let (histograms, special, ends) = histograms::new(&params, &mut draw);
        // Products and bias of the hidden layer, tansig, output layer.
        let layers = [0..256, 256..257, 257..258, 258..params.cycles()];
        DepthEstimator {
            estimations: Estimations::new(layers, histograms.len(), special, setting),
            params,
            histograms,
            ends: Cover::new("neuron x 4096 + address at either end of the tansig", ends),
        }
    }

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let estimator = &top.depth_estimator;
        let (rst, algo_start) = self.estimations.next(estimator.estimator_ctrl.phase(), draw);
        if estimator.estimator_ctrl.tansig_en && !rst {
            let sums = &estimator.forward1.l1_in[..self.params.neurons()];
            for (neuron, &l1_in) in sums.iter().enumerate() {
                self.ends.see((neuron * ENTRIES + address(l1_in)) as u64);
            }
        }
        Stimulus { rst, algo_start, histogram: U::new(self.estimations.histogram) }
    }

    fn edge(&mut self, i: &Stimulus, top: &mut TofTop) {
        let ctrl = &top.depth_estimator.estimator_ctrl;
        let word = self.histograms[i.histogram.index()][ctrl.read_addr.index()];
        let count = if ctrl.read_en { word } else { U::new(0) };
        let i = In { rst: i.rst, algo_start: i.algo_start, count };
        top.depth_estimator.rise(&i, &self.params);
    }

    fn parameters(&self) -> Parameters {
        parameters::with_neurons(parameters::depth_estimator(&self.params), self.params.neurons())
    }

    fn bench_memory(&self) -> Option<Mem> {
        Some(memory(&self.histograms))
    }

    fn coverage(self) -> Vec<Cover> {
        [self.ends].into_iter().chain(self.estimations.coverage()).collect()
    }
}
