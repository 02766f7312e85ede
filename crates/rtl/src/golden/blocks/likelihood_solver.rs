//! All programs, with what comes of loads, scans and fits, and with operands of every size.

use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::likelihood_estimator::words::SCARCE;
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_solver::In;
use tofsim::firmware::likelihood_solver::program::Program;
use tofsim::firmware::likelihood_estimator::params::Params;

use crate::golden::configuration::{GLASS, TWO, TWO_BEHIND_GLASS};
use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    configurations: &[GLASS, TWO, TWO_BEHIND_GLASS],
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_solver", "likelihood_estimator.likelihood_solver", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_solver,
    rise: |estimator, i, params| estimator.likelihood_solver.rise(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let params = &*setting.setup.params.estimators.likelihood_estimator;
    let program = params.program();
    let mut counters = Cover::new("instruction", 0..program.instructions.len() as u64);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| counters.see(estimator.likelihood_solver.counter());
    let (mut running, histogram) = (false, setting.histogram());
    let run = PART.record(spec, setting, see, |estimator, _, draw| {
        running &= !estimator.likelihood_solver.registers.ran;
        let mut own = operands(&histogram, params, draw);
        own.run = !running && draw.one_in(3);
        running = (running || own.run) && !own.rst;
        own
    });
    vectors(run, spec, setting, [counters])
}

/// Draws a program and its operands.
fn operands(histogram: &histogram_builder::Params, params: &Params, draw: &mut Draw) -> In {
    let (count, bin) = (histogram.count_bits, histogram.bins.ilog2());
    let Program { ambient, start, step, end, second, swap, .. } = *params.program();
    // Most arrivals are next to an end of the window, and a step leads out of it.
    let last = 2 * histogram.bins as u64 - 1;
    let mut programs = vec![ambient, start, start, step, step, step, end];
    if params.has_second() {
        programs.extend([second, swap, swap]);
    }
    let mut slope = || S::new(draw.signed_within(count + 24));
    let (sum_12, sum_13, score_1) = (slope(), slope(), slope());
    let mut sum = || S::new(draw.signed_within(count + 19));
    let (sum_23, score_2, score_3) = (sum(), sum(), sum());
    let has_glass = params.glass.bins() > 0;
    let mut of_glass = |bits: u32| if has_glass { draw.signed_within(bits) } else { 0 };
    let (sum_14, sum_24, sum_34) = (of_glass(count + 24), of_glass(count + 19), of_glass(count + 19));
    let (sum_44, score_4) = (of_glass(count + 19).abs(), of_glass(count + 19));
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
        sum_14: S::new(sum_14),
        sum_24: S::new(sum_24),
        sum_34: S::new(sum_34),
        sum_44: S::new(sum_44),
        score_4: S::new(score_4),
        ..of_pair(count, params, draw)
    }
}

/// Draws the sums of log b beside another echo.
fn of_pair(count: u32, params: &Params, draw: &mut Draw) -> In {
    if !params.has_second() {
        return In::default();
    }
    let still_33 = if draw.one_in(4) {
        SCARCE - 2 + draw.below(4) as i64
    } else {
        draw.unsigned_of(count + 18) as i64
    };
    In {
        paired: draw.one_in(2),
        still_13: S::new(draw.signed_within(count + 24)),
        still_23: S::new(draw.signed_within(count + 19)),
        still_33: S::new(still_33),
        still_score: S::new(draw.signed_within(count + 19)),
        ..In::default()
    }
}
