//! Whole estimations of histograms, which the bench reads out as the histogram builder would:
//! empty, level, as measured, random, and all hits in one bin such that each neuron saturates at
//! either end; starts while busy, and a reset in each layer.

use crate::golden::block::{Block, Latency, Parameter, Setting, Spec, neurons};
use crate::golden::cover::Cover;
use crate::golden::draw::{Draw, MEMORIES};
use crate::golden::record::record;
use crate::golden::timing::CLK_125;
use tofsim::firmware::depth_estimator::{In, Params};
use tofsim::firmware::estimator_ctrl::done;
use tofsim::firmware::tansig::{ENTRIES, address};
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::U;
use tofsim::network::mem::{self, Mem};
use tofsim::signals;

mod histograms;

use histograms::{COUNT, Histogram};

/// Estimations, of which the last is cut short.
const CUT: u64 = 6;

pub(super) const SPEC: Spec = Spec {
    name: "depth_estimator",
    scope: "depth_estimator",
    stream: Some(5),
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: done }],
    glue: Some(histograms::GLUE),
    record: |spec, setting| record(spec, setting, DepthEstimator::new(setting)),
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
    histogram: U<6>,
    /// Estimations begun.
    runs: u64,
    /// Cycle after e0 in which this one is cut short.
    cut: Option<u64>,
    /// How long a slower estimator is left alone after an estimation [cycles], and how long yet.
    slack: u64,
    rest: u64,
    done: Cover,
    ends: Cover,
    starts: Cover,
    resets: Cover,
}

impl DepthEstimator {
    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let params = setting.setup.params.depth_estimator.clone();
        let (histograms, special, ends) = histograms::new(&params, &mut draw);
        DepthEstimator {
            params,
            histograms,
            histogram: U::new(0),
            runs: 0,
            cut: None,
            slack: setting.slack,
            rest: 0,
            done: Cover::new("estimations of histogram", 0..special),
            ends: Cover::new("neuron x 4096 + address at either end of the tansig", ends),
            starts: Cover::new("start in layer, with algo_done (4), idle (5)", 0..6),
            resets: Cover::new("reset in layer", 0..4),
        }
    }
}

/// Products and bias of the hidden layer, tansig, output layer; or the end.
fn layer(phase: u64, done: u64) -> u64 {
    match phase {
        0..256 => 0,
        256 => 1,
        257 => 2,
        _ if phase == done => 4,
        _ => 3,
    }
}

impl Block for DepthEstimator {
    type Stimulus = Stimulus;

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let estimator = &top.depth_estimator;
        let (phase, end) = (estimator.estimator_ctrl.phase(), self.params.cycles());
        let rst = phase.is_some() && phase == self.cut;
        self.rest = if phase.is_some() { self.slack } else { self.rest.saturating_sub(1) };
        let algo_start = draw.one_in(3) && self.rest == 0;
        let place = phase.map_or(5, |phase| layer(phase, end));
        self.starts.see_if(algo_start && !rst, place);
        self.resets.see_if(rst, place);
        self.done.see_if(phase == Some(end), self.histogram.get());
        if estimator.estimator_ctrl.tansig_en && !rst {
            let sums = &estimator.forward1.l1_in[..self.params.neurons()];
            for (neuron, &l1_in) in sums.iter().enumerate() {
                self.ends.see((neuron * ENTRIES + address(l1_in)) as u64);
            }
        }
        if algo_start && !rst && phase.is_none_or(|phase| phase == end) {
            let next = self.done.missing().next();
            self.histogram = U::new(next.unwrap_or_else(|| draw.below(COUNT as u64)));
            self.runs += 1;
            let places = [draw.below(256), 256, 257, 258 + draw.below(end - 258)];
            let place = places[(self.runs / CUT) as usize % places.len()];
            self.cut = self.runs.is_multiple_of(CUT).then_some(place);
        }
        Stimulus { rst, algo_start, histogram: self.histogram }
    }

    fn edge(&mut self, i: &Stimulus, top: &mut TofTop) {
        let ctrl = &top.depth_estimator.estimator_ctrl;
        let word = self.histograms[i.histogram.index()][ctrl.read_addr.index()];
        let count = if ctrl.read_en { word } else { U::new(0) };
        let i = In { rst: i.rst, algo_start: i.algo_start, count };
        top.depth_estimator.rise(&i, &self.params);
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let files = ["w1.mem", "b1.mem", "w2.mem", "b2.mem", "tansig.mem"];
        let names = ["W1File", "B1File", "W2File", "B2File", "TansigFile"];
        let files = names.into_iter().zip(files.map(Parameter::File));
        files.chain(neurons(self.params.neurons())).collect()
    }

    fn roms(&self) -> Vec<Mem> {
        let own = histograms::mem(&self.histograms);
        mem::depth_estimator(&self.params).into_iter().chain([own]).collect()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.done, self.ends, self.starts, self.resets]
    }
}
