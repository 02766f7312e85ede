//! Whole estimations of 32 histograms, which the bench reads out as the histogram builder would:
//! empty, level, full, all hits in one bin at either end or next to it, equal maxima, random and as
//! measured; starts while busy, and a reset in each part.

use tofsim::firmware::centroid_estimator::{DIVIDE, DONE, In, PLACE, Params};
use tofsim::firmware::histogram_builder::BINS;
use tofsim::sim::fast::centroid::locate;

use crate::golden::prelude::*;
use crate::golden::estimations::{Estimations, Histogram, memory};

mod histograms;

use histograms::Case;

pub(super) const SPEC: Spec = Spec {
    stream: Some(22),
    reset: Some("rst"),
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: |_| DONE }],
    glue: Some(histograms::GLUE),
    ..Spec::new("centroid_estimator", "centroid_estimator", record::<CentroidEstimator>)
};

signals! {
    /// Input ports, and what the bench reads `count` from.
    pub(super) struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// Starts an estimation.
        algo_start: bool,
        /// Which histogram is there.
        histogram: U<5>,
    }
}

struct CentroidEstimator {
    params: Params,
    histograms: Vec<Histogram>,
    estimations: Estimations,
    cases: Cover,
}

impl Block for CentroidEstimator {
    type Stimulus = Stimulus;

    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let params = setting.setup.params.centroid_estimator;
        let histograms = histograms::new(&params, &mut draw);
        // Words, no words, quotient, position and depth.
        let bins = BINS as u64;
        let parts = [0..bins, bins..DIVIDE, DIVIDE..PLACE, PLACE..DONE];
        let all = histograms.len();
        CentroidEstimator {
            params,
            histograms,
            estimations: Estimations::new(parts, all, all as u64, setting),
            cases: Cover::new(
                "nothing, peak in bin 0, in bin 255, window cut on the left, on the right, equal maxima",
                Case::reachable(&params).map(|case| case as u64),
            ),
        }
    }

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let phase = top.centroid_estimator.registers.phase();
        if phase == Some(DONE) {
            let histogram = &self.histograms[self.estimations.histogram as usize];
            let words = histogram.map(|count| count.get() as u16);
            for case in Case::of(&self.params, &words, &locate(&self.params, &words)) {
                self.cases.see(case as u64);
            }
        }
        let (rst, algo_start) = self.estimations.next(phase, draw);
        Stimulus { rst, algo_start, histogram: U::new(self.estimations.histogram) }
    }

    fn edge(&mut self, i: &Stimulus, top: &mut TofTop) {
        let word = top.centroid_estimator.registers.read_addr.index();
        let count = self.histograms[i.histogram.index()][word];
        let i = In { rst: i.rst, algo_start: i.algo_start, count };
        top.centroid_estimator.rise(&i, &self.params);
    }

    fn parameters(&self) -> Parameters {
        parameters::centroid_estimator(&self.params)
    }

    fn bench_memory(&self) -> Option<Mem> {
        Some(memory(&self.histograms))
    }

    fn coverage(self) -> Vec<Cover> {
        [self.cases].into_iter().chain(self.estimations.coverage()).collect()
    }
}
