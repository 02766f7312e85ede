//! Stages of the likelihood estimator: its integers compared with the same algorithm in double precision.
//!
//! Both go from the histogram to the depth each by itself, so that a difference includes all previous roundings. They
//! are one text ([`trace`]); `tests/estimators/likelihood_estimator/twin.rs` compares it with another one.

mod model;

use serde::Serialize;

use tofsim::error::Input;
use tofsim::firmware::likelihood_estimator::words::{
    AMBIENT_FRACTION, CHI_FRACTION, DEPTH_FRACTION, SIGNAL_FRACTION, UNITS,
};
use tofsim::firmware::tof_top::status::StatusSet;
use tofsim::optics::Bins;
use tofsim::sim::estimates::digits;
use tofsim::sim::estimates::likelihood::{Ambient, Best, Found, Point, trace};
use tofsim::sim::setup::Setup;

use model::Model;

/// Value of one in an ambient hazard's word [1 / bin].
const AMBIENT_UNIT: f64 = UNITS as f64 / (1u64 << AMBIENT_FRACTION) as f64;

/// A word of the estimator and its counterpart in double precision.
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
        let found = trace(&self.0, histogram).found;
        (found.depth_m(), found.status)
    }

    /// Explains the estimation of a histogram.
    pub fn explain(&self, histogram: &[u32]) -> ExplainedLikelihood {
        let model = &self.0;
        let (fixed, float) = (trace(&model.words, histogram), trace(model, histogram));
        let mut values = Values { model, stage: String::new(), all: Vec::new() };
        values.ambient(&fixed.ambient, &float.ambient);
        values.best("scan", &fixed.start, &float.start);
        values.stage = "start".to_owned();
        values.point(&fixed.begin, &float.begin);
        for (k, (fixed, float)) in fixed.steps.iter().zip(&float.steps).enumerate() {
            values.stage = format!("step {}", k + 1);
            values.point(&fixed.0, &float.0);
            values.add("shortened by", "bits", fixed.1.cut.into(), float.1.cut.into(), 1.0);
        }
        values.best("rescan", &fixed.other, &float.other);
        values.end(&fixed.found, &float.found);
        ExplainedLikelihood {
            depth_raw: digits(fixed.found.words().depth_m()),
            depth_m: fixed.found.depth_m(),
            sigma_m: fixed.found.sigma_m(),
            status: fixed.found.status,
            status_float: float.found.status,
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
    /// Adds a word and its counterpart, of which one stands for so much.
    fn add(&mut self, value: &str, unit: &'static str, word: i64, float: f64, one: f64) {
        self.add_by(value, unit, word, float, |number| number * one);
    }

    /// Adds a word and its counterpart by what they stand for.
    fn add_by(
        &mut self,
        value: &str,
        unit: &'static str,
        word: i64,
        float: f64,
        stands_for: impl Fn(f64) -> f64,
    ) {
        let [fixed, float] = [word as f64, float].map(stands_for);
        let (stage, value, difference) = (self.stage.clone(), value.to_owned(), fixed - float);
        self.all.push(StageValue { stage, value, unit, word, fixed, float, difference });
    }

    fn ambient(&mut self, fixed: &Ambient<i64>, float: &Ambient<f64>) {
        self.stage = "ambient".to_owned();
        for (k, (block, float)) in fixed.blocks.iter().zip(&float.blocks).enumerate() {
            let level = |log: f64| (log / 64.0).exp2() * UNITS as f64;
            self.add_by(&format!("block {k}"), "1/bin", block.level, float.level, level);
        }
        self.add("believed", "block", fixed.chosen as i64, float.chosen as f64, 1.0);
        self.add("b", "1/bin", fixed.hazard, float.hazard, AMBIENT_UNIT);
    }

    fn best(&mut self, stage: &str, fixed: &Best<i64>, float: &Best<f64>) {
        self.stage = stage.to_owned();
        let [fixed_sum, float_sum] = [fixed.bins, float.bins].map(|(from, until)| from + until);
        self.add("box's middle", "bin", fixed_sum as i64, float_sum as f64, 0.5);
        let squared = |log: f64| (log / 64.0).exp2();
        self.add_by("score", "sd^2", fixed.score, float.score, squared);
    }

    fn point(&mut self, fixed: &Point<i64>, float: &Point<f64>) {
        let one_ps = self.model.unit_ps / 16.0;
        self.add("mu", "ps", fixed.arrival, float.arrival, one_ps);
        let one_m = one_ps * self.model.metres_per_ps;
        self.add("mu", "m", fixed.arrival, float.arrival, one_m);
        let one = (-f64::from(SIGNAL_FRACTION)).exp2();
        self.add("S", "photons", fixed.signal, float.signal, one);
        self.add("b", "1/bin", fixed.ambient, float.ambient, AMBIENT_UNIT);
    }

    fn end(&mut self, fixed: &Found, float: &Found<f64>) {
        self.stage = "end".to_owned();
        let metre = (-f64::from(DEPTH_FRACTION)).exp2();
        let one = (-f64::from(CHI_FRACTION)).exp2();
        self.add("chi-square", "1", fixed.chi_square, float.chi_square, one);
        let status = f64::from(float.status.bits());
        self.add("status", "bits", fixed.status.bits().into(), status, 1.0);
        self.add("sigma", "mm", fixed.sigma, float.sigma, 1e3 * metre);
        self.add("depth", "m", fixed.depth, float.depth, metre);
    }
}

#[cfg(test)]
mod tests;
