//! All programs, with what comes of loads, scans and fits.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_solver::In;
use tofsim::firmware::likelihood_solver::program::PROGRAM;

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    ..Spec::new("likelihood_solver", "likelihood_estimator.likelihood_solver", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut counters = Cover::new("instruction", 0..PROGRAM.len() as u64);
    for _ in 0..setting.cycles() {
        let estimator = &mut run.top.likelihood_estimator;
        let i = estimations.next(estimator, &mut run.draw);
        counters.see(run.top.likelihood_estimator.likelihood_solver.counter());
        let own = Wires::likelihood_solver(&run.top.likelihood_estimator, &i);
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.likelihood_estimator);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, &["Kappa", "StepLog2", "PulseSigma", "WindowEnd", "Metres", "MetresShift"]);
    Ok(Vectors { parameters, ..run.vectors([counters]) })
}
