//! Loads, and passes over bins around echoes and over all of them, some cut short by a reset.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_memory::In;

use crate::golden::configuration::{GLASS, TWO, TWO_BEHIND_GLASS};
use crate::golden::likelihood::Estimations;
use crate::golden::likelihood::part::vectors;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    configurations: &[GLASS, TWO, TWO_BEHIND_GLASS],
    model: Some(Model::new::<In>(|at| {
        let i = at.input();
        at.top.likelihood_estimator.likelihood_memory.rise(&i, &at.params.estimators.likelihood_estimator);
    })),
    ..Spec::new("likelihood_memory", "likelihood_estimator.likelihood_memory", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, true);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut kinds = Cover::new("a bin, the rest, an edge, a blanked bin", 0..4);
    for _ in 0..setting.cycles() {
        let estimator = &mut run.top.likelihood_estimator;
        let i = estimations.next(estimator, &mut run.draw);
        let now = &run.top.likelihood_estimator.likelihood_memory.registers;
        kinds.see_if(now.word_bin, 0);
        kinds.see_if(now.word_rest, 1);
        kinds.see_if(now.word_edge, 2);
        kinds.see_if(now.word_slide && !now.word_bin, 3);
        let own = Wires::likelihood_memory(&run.top.likelihood_estimator, &i);
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.estimators.likelihood_estimator);
    }
    vectors(run, spec, setting, [kinds])
}
