//! All programs, with what comes of loads, scans and fits, and with operands of every size.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::likelihood_estimator::words::SCARCE;
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_solver::In;
use tofsim::firmware::likelihood_solver::program::{
    AMBIENT_PROGRAM, END_PROGRAM, PROGRAM, START_PROGRAM, STEP_PROGRAM,
};

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    model: Some(Model::new::<In>(|at| {
        let i = at.input();
        at.top.likelihood_estimator.likelihood_solver.rise(&i, &at.params.estimators.likelihood_estimator);
    })),
    ..Spec::new("likelihood_solver", "likelihood_estimator.likelihood_solver", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut counters = Cover::new("instruction", 0..PROGRAM.len() as u64);
    let mut running = false;
    for _ in 0..setting.cycles() {
        let estimator = &run.top.likelihood_estimator;
        counters.see(estimator.likelihood_solver.counter());
        let params = &*setting.setup.params.estimators.likelihood_estimator;
        if estimations.over(estimator, setting.cycles()) {
            running &= !estimator.likelihood_solver.registers.ran;
            let mut own = operands(&setting.setup.params.histogram, &mut run.draw);
            own.run = !running && run.draw.one_in(3);
            running = (running || own.run) && !own.rst;
            run.line(&own);
            let solver = &mut run.top.likelihood_estimator.likelihood_solver;
            solver.rise(&own, params);
            continue;
        }
        let i = estimations.next(estimator, &mut run.draw);
        let own = Wires::likelihood_solver(&run.top.likelihood_estimator, &i);
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, params);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, spec.verilog);
    Ok(Vectors { parameters, ..run.vectors([counters]) })
}

/// Draws a program and its operands.
fn operands(histogram: &histogram_builder::Params, draw: &mut Draw) -> In {
    let (count, bin) = (histogram.count_bits, histogram.bins.ilog2());
    let (start, step) = (START_PROGRAM, STEP_PROGRAM);
    // Most arrivals are next to an end of the window, and a step leads out of it.
    let last = 2 * histogram.bins as u64 - 1;
    let programs = [AMBIENT_PROGRAM, start, start, step, step, step, END_PROGRAM];
    let mut slope = || S::new(draw.signed_within(count + 24));
    let (sum_12, sum_13, score_1) = (slope(), slope(), slope());
    let mut sum = || S::new(draw.signed_within(count + 19));
    let (sum_23, score_2, score_3) = (sum(), sum(), sum());
    // Around the least information on log b with which b may fall.
    let sum_33 = if draw.one_in(4) {
        SCARCE - 2 + draw.below(4) as i64
    } else {
        draw.unsigned_of(count + 18) as i64
    };
    In {
        rst: draw.one_in(1000),
        run: false,
        entry: U::new(programs[draw.below(programs.len() as u64) as usize]),
        ambient_ended: U::new(draw.unsigned_of(count)),
        ambient_exposure: U::new(draw.unsigned_of(count + bin + 10)),
        lone: draw.one_in(2),
        best_excess: S::new(draw.signed_within(count + bin + 14)),
        best_middle: U::new(draw.unsigned_of(count + bin + 1)),
        box_length: U::new(1 + draw.below(histogram.bins as u64)),
        box_sum: U::new([0, last, draw.near_ends(last + 1)][draw.below(3) as usize]),
        sum_11: S::new(draw.unsigned_of(count + 19) as i64),
        sum_12,
        sum_13,
        sum_22: S::new(draw.unsigned_of(count + 18) as i64),
        sum_23,
        sum_33: S::new(sum_33),
        score_1,
        score_2,
        score_3,
    }
}
