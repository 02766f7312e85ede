//! Bins of scans and fits, as the estimator's memory hands them on.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_terms::In;

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    ..Spec::new("likelihood_terms", "likelihood_estimator.likelihood_terms", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut predicted = Cover::new("bits of an expected count", [0].into_iter().chain(10..24));
    let mut shares = Cover::new("share in 16ths", 0..17);
    for _ in 0..setting.cycles() {
        let estimator = &mut run.top.likelihood_estimator;
        let i = estimations.next(estimator, &mut run.draw);
        let now = &run.top.likelihood_estimator.likelihood_terms;
        predicted.see(u64::from(u64::BITS - now.predicted.get().leading_zeros()));
        shares.see(now.share.get() >> 8);
        let own = Wires::likelihood_terms(&run.top.likelihood_estimator, &i);
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.likelihood_estimator);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, &["StepLog2", "PulseFile", "HazardFile"]);
    Ok(Vectors { parameters, ..run.vectors([predicted, shares]) })
}
