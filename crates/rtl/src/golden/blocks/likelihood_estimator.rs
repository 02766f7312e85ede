//! Whole estimations, as measured and extreme, starts while busy, and a reset in each state.

use tofsim::firmware::likelihood_estimator::In;

use crate::golden::configuration;
use crate::golden::likelihood::Estimations;
use crate::golden::likelihood::part::vectors;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: |vectors| vectors.sizes.likelihood_cycles.into() }],
    configurations: &[LATE, configuration::GLASS, configuration::TWO, configuration::TWO_BEHIND_GLASS],
    model: Some(Model::new::<In>(|at| {
        let i = at.input();
        at.top.likelihood_estimator.rise(&i, &at.params.estimators.likelihood_estimator);
    })),
    ..Spec::new("likelihood_estimator", "likelihood_estimator", record)
};

/// Light that leaves well after the laser edge.
const LATE: Configuration = Configuration {
    name: "late",
    set: &["laser.delay_ps=1234.5"],
    parameters: &["LaserDelay"],
    ..configuration::DEFAULTS
};

/// Lines unless told otherwise: a reset in each of ten states, and a whole estimation of each kind [clock cycles].
const CYCLES: usize = 126_000;
/// The same where an estimation takes longer.
const CYCLES_WITH_GLASS: usize = 200_000;
const CYCLES_OF_TWO: usize = 600_000;

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, true);
    let mut run = Recorder::without_parts(spec, setting, In::list());
    let params = &setting.setup.params.estimators.likelihood_estimator;
    let cycles = match (params.has_second(), params.glass.bins() > 0) {
        (true, _) => CYCLES_OF_TWO,
        (false, true) => CYCLES_WITH_GLASS,
        (false, false) => CYCLES,
    };
    for _ in 0..setting.cycles.unwrap_or(cycles) {
        let i = estimations.next(&run.top.likelihood_estimator, &mut run.draw);
        run.line(&i);
        run.top.likelihood_estimator.rise(&i, &setting.setup.params.estimators.likelihood_estimator);
    }
    vectors(run, spec, setting, estimations.coverage())
}
