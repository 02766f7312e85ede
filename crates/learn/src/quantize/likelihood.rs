//! Stages of the likelihood estimator: its integers compared with the same algorithm in double precision.
//!
//! The double-precision version is independent from the histogram on, so that a difference includes all previous
//! roundings.

mod model;
mod scan;
mod shots;
mod step;
mod twin;

use serde::Serialize;

use tofsim::error::Input;
use tofsim::firmware::likelihood_estimator::words::{
    AMBIENT_FRACTION, CHI_FRACTION, DEPTH_FRACTION, SIGNAL_FRACTION, UNITS,
};
use tofsim::firmware::tof_top::status::StatusSet;
use tofsim::optics::Bins;
use tofsim::sim::estimates::digits;
use tofsim::sim::estimates::likelihood::{Best, Point, Trace, trace};
use tofsim::sim::setup::Setup;

use model::Model;
use twin::Twin;

/// A word of the estimator and its twin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageValue {
    /// Stage of the value: `ambient`, `scan`, `start`, `step 1` to `step 6`, `rescan`, `end`.
    pub stage: String,
    /// Name of the value.
    pub value: String,
    /// Unit of the next but one and of what follows it.
    pub unit: &'static str,
    /// The word as an integer.
    pub word: i64,
    /// Value of the word.
    pub fixed: f64,
    /// The same in double precision.
    pub float: f64,
    /// Fixed less float.
    pub difference: f64,
}

/// Everything about one estimation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExplainedLikelihood {
    /// The depth word's 36 bits in hexadecimal.
    pub depth_raw: String,
    /// The depth [m].
    pub depth_m: f64,
    /// Its standard deviation [m].
    pub sigma_m: f64,
    /// Reasons to reject it.
    pub status: StatusSet,
    /// The same in double precision.
    pub status_float: StatusSet,
    /// Values of the stages, in order.
    pub values: Vec<StageValue>,
}

/// Explains estimations of the histograms of one instrument.
#[derive(Clone, Debug)]
pub struct LikelihoodExplainer(Model);

impl LikelihoodExplainer {
    /// For the frames of a scenario.
    ///
    /// # Errors
    /// When the estimator's model does not hold for it.
    pub fn new(setup: &Setup) -> Result<Self, Input> {
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        setup.likelihood_by(shots, Model::new).map(LikelihoodExplainer)
    }

    /// The same where bins and shots are not those of the scenario.
    ///
    /// # Errors
    /// When the estimator's model does not hold for it.
    pub fn of_bins(setup: &Setup, shots: u64, bins: &Bins) -> Result<Self, Input> {
        setup.likelihood_of(shots, bins, Model::new).map(LikelihoodExplainer)
    }

    /// The depth in double precision [m], and its status.
    pub fn float(&self, histogram: &[u32]) -> (f64, StatusSet) {
        let twin = Twin::new(&self.0, histogram);
        (twin.depth_m, twin.status)
    }

    /// Explains the estimation of a histogram.
    pub fn explain(&self, histogram: &[u32]) -> ExplainedLikelihood {
        let model = &self.0;
        let (fixed, float) = (trace(&model.words, histogram), Twin::new(model, histogram));
        let mut values = Values { model, stage: String::new(), all: Vec::new() };
        values.ambient(&fixed, &float);
        values.best("scan", &fixed.start, &float.start);
        values.stage = "start".to_owned();
        values.point(&fixed.begin, &float.begin);
        for (k, (fixed, float)) in fixed.steps.iter().zip(&float.steps).enumerate() {
            values.stage = format!("step {}", k + 1);
            values.point(&fixed.0, &float.0);
            values.add("shortened by", "bits", fixed.1.cut.into(), 1.0, float.1.cut.into());
        }
        values.best("rescan", &fixed.other, &float.other);
        values.end(&fixed, &float);
        ExplainedLikelihood {
            depth_raw: digits(fixed.found.words().depth_m()),
            depth_m: fixed.found.depth.to_f64(),
            sigma_m: fixed.found.sigma_m(),
            status: fixed.found.status,
            status_float: float.status,
            values: values.all,
        }
    }
}

/// Collected values of the stages, in order.
struct Values<'a> {
    model: &'a Model,
    stage: String,
    all: Vec<StageValue>,
}

impl Values<'_> {
    /// Adds a word of which one stands for so much.
    fn add(&mut self, value: &str, unit: &'static str, word: i64, one: f64, float: f64) {
        self.add_as(value, unit, word, word as f64 * one, float);
    }

    fn add_as(&mut self, value: &str, unit: &'static str, word: i64, fixed: f64, float: f64) {
        let (stage, value, difference) = (self.stage.clone(), value.to_owned(), fixed - float);
        self.all.push(StageValue { stage, value, unit, word, fixed, float, difference });
    }

    fn ambient(&mut self, fixed: &Trace, float: &Twin) {
        self.stage = "ambient".to_owned();
        let Trace { ambient, .. } = fixed;
        for (k, (block, float)) in ambient.blocks.iter().zip(&float.ambient.blocks).enumerate() {
            let level = (block.level as f64 / 64.0).exp2() * UNITS as f64;
            self.add_as(&format!("block {k}"), "1/bin", block.level, level, *float);
        }
        self.add("believed", "block", ambient.chosen as i64, 1.0, float.ambient.chosen as f64);
        self.add("b", "1/bin", ambient.hazard, self.ambient_unit(), float.ambient.hazard);
    }

    fn best(&mut self, stage: &str, fixed: &Best, float: &scan::Best) {
        self.stage = stage.to_owned();
        let (from, until) = float.bins;
        let middle = (from + until) as f64 / 2.0;
        self.add("box's middle", "bin", (fixed.bins.0 + fixed.bins.1) as i64, 0.5, middle);
        let score = (fixed.score as f64 / 64.0).exp2();
        self.add_as("score", "sd^2", fixed.score, score, float.score);
    }

    fn point(&mut self, fixed: &Point, float: &step::Point) {
        let unit_ps = self.model.bin_ps / UNITS as f64 / 16.0;
        let metres = self.model.metres_per_ps;
        self.add("mu", "ps", fixed.arrival, unit_ps, float.arrival_ps);
        self.add("mu", "m", fixed.arrival, unit_ps * metres, float.arrival_ps * metres);
        let one = (-f64::from(SIGNAL_FRACTION)).exp2();
        self.add("S", "photons", fixed.signal, one, float.signal);
        self.add("b", "1/bin", fixed.ambient, self.ambient_unit(), float.ambient);
    }

    fn end(&mut self, fixed: &Trace, float: &Twin) {
        self.stage = "end".to_owned();
        let metre = (-f64::from(DEPTH_FRACTION)).exp2();
        let one = (-f64::from(CHI_FRACTION)).exp2();
        let found = &fixed.found;
        self.add("chi-square", "1", found.chi_square as i64, one, float.chi_square);
        let status = f64::from(float.status.bits());
        self.add("status", "bits", found.status.bits().into(), 1.0, status);
        self.add("sigma", "mm", found.sigma as i64, 1e3 * metre, 1e3 * float.sigma_m);
        self.add("depth", "m", found.depth.get(), metre, float.depth_m);
    }

    /// Returns the value of one in an ambient hazard's word [1 / bin].
    fn ambient_unit(&self) -> f64 {
        UNITS as f64 * (-f64::from(AMBIENT_FRACTION)).exp2()
    }
}

#[cfg(test)]
mod tests;
