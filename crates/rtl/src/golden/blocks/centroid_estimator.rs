//! Whole estimations of 32 histograms, which the bench reads out as the histogram builder would:
//! empty, level, full, all hits in one bin at either end or next to it, equal maxima, random and as
//! measured; starts while busy, and a reset in each part.

use crate::golden::block::{Block, Latency, Parameter, Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::{Draw, MEMORIES};
use crate::golden::record::record;
use crate::golden::timing::CLK_125;
use tofsim::firmware::centroid_estimator::{DIVIDE, DONE, In, PLACE, Params};
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::U;
use tofsim::network::mem::Mem;
use tofsim::signals;
use tofsim::sim::fast::centroid::locate;

mod histograms;

use histograms::{COUNT, Case, Histogram};

/// Estimations, of which the last is cut short.
const CUT: u64 = 6;

pub(super) const SPEC: Spec = Spec {
    name: "centroid_estimator",
    scope: "centroid_estimator",
    stream: Some(22),
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: |_| DONE }],
    glue: Some(histograms::GLUE),
    record: |spec, setting| record(spec, setting, CentroidEstimator::new(setting)),
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
    histogram: U<5>,
    /// Estimations begun.
    runs: u64,
    /// Cycle after e0 in which this one is cut short.
    cut: Option<u64>,
    /// How long a slower estimator is left alone after an estimation [cycles], and how long yet.
    slack: u64,
    rest: u64,
    done: Cover,
    cases: Cover,
    starts: Cover,
    resets: Cover,
}

impl CentroidEstimator {
    fn new(setting: &Setting) -> Self {
        let mut draw = Draw::new(setting.seed, MEMORIES);
        let params = setting.setup.params.centroid_estimator;
        CentroidEstimator {
            params,
            histograms: histograms::new(&params, &mut draw),
            histogram: U::new(0),
            runs: 0,
            cut: None,
            slack: setting.slack,
            rest: 0,
            done: Cover::new("estimations of histogram", 0..COUNT as u64),
            cases: Cover::new(
                "nothing, peak in bin 0, in bin 255, window cut on the left, on the right, equal maxima",
                Case::reachable(&params).map(|case| case as u64),
            ),
            starts: Cover::new("start in part, with algo_done (4), idle (5)", 0..6),
            resets: Cover::new("reset in part", 0..4),
        }
    }
}

/// The parts of an estimation: words, no words, quotient, position and depth; or the end.
fn part(phase: u64) -> u64 {
    match phase {
        DONE => 4,
        PLACE.. => 3,
        DIVIDE.. => 2,
        phase => u64::from(phase >= BINS as u64),
    }
}

impl Block for CentroidEstimator {
    type Stimulus = Stimulus;

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let phase = top.centroid_estimator.registers.phase();
        let rst = phase.is_some() && phase == self.cut;
        self.rest = if phase.is_some() { self.slack } else { self.rest.saturating_sub(1) };
        let algo_start = draw.one_in(3) && self.rest == 0;
        self.starts.see_if(algo_start && !rst, phase.map_or(5, part));
        self.resets.see_if(rst, phase.map_or(5, part));
        if phase == Some(DONE) {
            self.done.see(self.histogram.get());
            let words = self.histograms[self.histogram.index()].map(|count| count.get() as u16);
            for case in Case::of(&self.params, &words, &locate(&self.params, &words)) {
                self.cases.see(case as u64);
            }
        }
        if algo_start && !rst && phase.is_none_or(|phase| phase == DONE) {
            let next = self.done.missing().next();
            self.histogram = U::new(next.unwrap_or_else(|| draw.below(COUNT as u64)));
            self.runs += 1;
            let places = [
                draw.below(BINS as u64),
                BINS as u64 + draw.below(DIVIDE - BINS as u64),
                DIVIDE + draw.below(PLACE - DIVIDE),
                PLACE + draw.below(DONE - PLACE),
            ];
            let place = places[(self.runs / CUT) as usize % places.len()];
            self.cut = self.runs.is_multiple_of(CUT).then_some(place);
        }
        Stimulus { rst, algo_start, histogram: self.histogram }
    }

    fn edge(&mut self, i: &Stimulus, top: &mut TofTop) {
        let word = top.centroid_estimator.registers.read_addr.index();
        let count = self.histograms[i.histogram.index()][word];
        let i = In { rst: i.rst, algo_start: i.algo_start, count };
        top.centroid_estimator.rise(&i, &self.params);
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        parameters(&self.params)
    }

    fn roms(&self) -> Vec<Mem> {
        vec![histograms::mem(&self.histograms)]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.done, self.cases, self.starts, self.resets]
    }
}

/// The Verilog parameters, here and in the top.
pub(in crate::golden) fn parameters(p: &Params) -> Vec<(&'static str, Parameter)> {
    vec![
        ("HalfWidth", Parameter::Number(p.half_width)),
        ("Background", Parameter::Number(p.background.into())),
        ("Slope", Parameter::Number(p.slope.get())),
        ("Offset", Parameter::Number(p.offset.bits())),
    ]
}
