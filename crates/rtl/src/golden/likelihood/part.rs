//! A block inside the likelihood estimator: driven by whole estimations, and then alone.

use tofsim::error::Result;
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator};
use tofsim::firmware::tof_top::slot::SlotEstimator;
use tofsim::kernel::signals::Signals;

use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::model::Stepping;
use crate::golden::parameters;
use crate::golden::record::Recorder;
use crate::golden::setting::Setting;
use crate::golden::spec::{Spec, Vectors};

use super::Estimations;

/// A block with the input ports `I`.
pub struct Part<I> {
    /// Returns its input ports in the estimator.
    pub wires: fn(&LikelihoodEstimator, &In) -> I,
    /// Steps the block alone.
    pub rise: fn(&mut LikelihoodEstimator, &I, &Params),
}

impl<I: Signals + Default> Part<I> {
    /// Steps the block as somebody else drives it.
    pub fn step(&self, at: &mut Stepping) {
        let i = at.input();
        let params = &at.params.estimators.likelihood_estimator;
        (self.rise)(&mut at.top.likelihood_estimator, &i, params);
    }

    /// Records whole estimations, and then lines of the block alone, each of which `drawn` makes from the one before.
    /// `see` sees each line before the block takes it, and whether the block is alone.
    pub fn record<'a>(
        &self,
        spec: &'static Spec,
        setting: &'a Setting,
        mut see: impl FnMut(&LikelihoodEstimator, &I, bool),
        mut drawn: impl FnMut(&LikelihoodEstimator, I, &mut Draw) -> I,
    ) -> Recorder<'a> {
        let mut estimations = Estimations::new(setting, false);
        let mut run = Recorder::new(spec, setting, I::list());
        let params = &*setting.setup.params.estimators.likelihood_estimator;
        let mut own = I::default();
        for _ in 0..setting.cycles() {
            let (estimator, draw) = (&mut run.top.likelihood_estimator, &mut run.draw);
            let alone = estimations.over(estimator, setting.cycles());
            let i = (!alone).then(|| estimations.next(estimator, draw));
            own = match &i {
                Some(i) => (self.wires)(estimator, i),
                None => drawn(estimator, own, draw),
            };
            see(estimator, &own, alone);
            run.line(&own);
            let estimator = &mut run.top.likelihood_estimator;
            match &i {
                Some(i) => estimator.rise(i, params),
                None => (self.rise)(estimator, &own, params),
            }
        }
        run
    }
}

/// Returns the vectors of the estimator or a block of it.
pub fn vectors(
    run: Recorder,
    spec: &Spec,
    setting: &Setting,
    coverage: impl Into<Vec<Cover>>,
) -> Result<Vectors> {
    let parameters = parameters::of_likelihood(&setting.setup.params, spec.verilog);
    Ok(Vectors { parameters, ..run.vectors(coverage) })
}
