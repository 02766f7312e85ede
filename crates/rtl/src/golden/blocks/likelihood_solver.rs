//! All programs, with what comes of loads, scans and fits, and with operands of every size.

use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::likelihood_estimator::words::SCARCE;
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_solver::In;
use tofsim::firmware::likelihood_solver::program::{
    AMBIENT_PROGRAM, END_PROGRAM, PROGRAM, START_PROGRAM, STEP_PROGRAM,
};

use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_solver", "likelihood_estimator.likelihood_solver", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_solver,
    rise: |estimator, i, params| estimator.likelihood_solver.rise(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut counters = Cover::new("instruction", 0..PROGRAM.len() as u64);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| counters.see(estimator.likelihood_solver.counter());
    let (mut running, histogram) = (false, setting.histogram());
    let run = PART.record(spec, setting, see, |estimator, _, draw| {
        running &= !estimator.likelihood_solver.registers.ran;
        let mut own = operands(&histogram, draw);
        own.run = !running && draw.one_in(3);
        running = (running || own.run) && !own.rst;
        own
    });
    vectors(run, spec, setting, [counters])
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
