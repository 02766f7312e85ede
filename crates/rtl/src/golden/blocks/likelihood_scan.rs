//! Blocks of loads, and bins of scans.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_scan::In;

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    ..Spec::new("likelihood_scan", "likelihood_estimator.likelihood_scan", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut scores = Cover::new("score in 256ths, above none", 0..4);
    let mut lone = Cover::new("lone", 0..2);
    for _ in 0..setting.cycles() {
        let estimator = &mut run.top.likelihood_estimator;
        let i = estimations.next(estimator, &mut run.draw);
        let now = &run.top.likelihood_estimator.likelihood_scan.registers;
        scores.see((now.best_score.get().max(0) >> 8) as u64);
        lone.see(now.lone.into());
        let own = Wires::likelihood_scan(&run.top.likelihood_estimator, &i);
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.likelihood_estimator);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, &["BoxBins", "LogFile"]);
    Ok(Vectors { parameters, ..run.vectors([scores, lone]) })
}
