//! Terms of the bins of scans, fits and checks.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_sums::In;

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    ..Spec::new("likelihood_sums", "likelihood_estimator.likelihood_sums", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut checks = Cover::new("phase x 2 + check", 0..4);
    let mut fars = Cover::new("far", 0..2);
    for _ in 0..setting.cycles() {
        let estimator = &mut run.top.likelihood_estimator;
        let i = estimations.next(estimator, &mut run.draw);
        let estimator = &run.top.likelihood_estimator;
        fars.see(estimator.likelihood_sums.far.into());
        let own = Wires::likelihood_sums(&run.top.likelihood_estimator, &i);
        checks.see(bits([own.phase, own.check]));
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.likelihood_estimator);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, &[]);
    Ok(Vectors { parameters, ..run.vectors([checks, fars]) })
}
