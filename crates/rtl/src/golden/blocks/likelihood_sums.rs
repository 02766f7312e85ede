//! Terms of the bins of scans, fits and checks, and terms of every size.

use tofsim::firmware::likelihood_estimator::Wires;
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_sums::In;

use crate::golden::likelihood::Estimations;
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    model: Some(Model::new::<In>(|at| {
        let i = at.input();
        at.top.likelihood_estimator.likelihood_sums.tick(&i, &at.params.estimators.likelihood_estimator);
    })),
    ..Spec::new("likelihood_sums", "likelihood_estimator.likelihood_sums", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut estimations = Estimations::new(setting, false);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut checks = Cover::new("phase x 2 + check", 0..4);
    let mut fars = Cover::new("far", 0..2);
    let mut drawn = Drawn::default();
    for _ in 0..setting.cycles() {
        let estimator = &run.top.likelihood_estimator;
        fars.see(estimator.likelihood_sums.far.into());
        let params = &*setting.setup.params.estimators.likelihood_estimator;
        if estimations.over(estimator, setting.cycles()) {
            let own = drawn.next(&setting.setup.params.histogram, &mut run.draw);
            run.line(&own);
            let sums = &mut run.top.likelihood_estimator.likelihood_sums;
            sums.tick(&own, params);
            continue;
        }
        let i = estimations.next(estimator, &mut run.draw);
        let own = Wires::likelihood_sums(&run.top.likelihood_estimator, &i);
        checks.see(bits([own.phase, own.check]));
        run.line(&own);
        run.top.likelihood_estimator.rise(&i, params);
    }
    let parameters = parameters::of_likelihood(&setting.setup.params, spec.verilog);
    Ok(Vectors { parameters, ..run.vectors([checks, fars]) })
}

/// Lines in which what is on the way comes to its sum, with nothing after it.
const FLUSHED: u64 = 22;

/// Passes over bins that are drawn, one after the other.
#[derive(Default)]
struct Drawn {
    now: In,
    kind: u64,
    left: u64,
}

impl Drawn {
    fn next(&mut self, histogram: &histogram_builder::Params, draw: &mut Draw) -> In {
        let now = &mut self.now;
        (now.pass, now.phase) = (self.left == 0, !now.phase && self.left != 0);
        if now.pass {
            (self.kind, self.left) = (draw.below(5), FLUSHED + draw.below(40));
            now.check = self.kind != 0;
        }
        self.left -= 1;
        if now.pass || now.phase {
            return *now;
        }
        now.gain = U::new(draw.near_ends(4097));
        now.share = U::new(draw.near_ends(4097));
        now.slope = S::new(draw.signed_within(9));
        now.single = !draw.one_in(8);
        if self.left < FLUSHED {
            (now.residual, now.predicted) = (S::new(0), U::new(0));
            return *now;
        }
        let count = histogram.count_bits;
        let residual = match self.kind {
            0 | 1 => {
                now.predicted = U::new(draw.unsigned_of(count + 18));
                draw.signed_within(count + 9)
            }
            // What stands for all other bins is never far; of a bin the bound is sharp: 5 deviations are not
            // far, and one unit above them is.
            kind => {
                let root = 9 + draw.below((1 << (count / 2)) - 9) as i64;
                now.predicted = U::new((root * root - 64) as u64 * 64);
                (now.gain, now.single) = (U::new(4096), kind != 2);
                10 * root + i64::from(kind != 3) * (1 + draw.below(2) as i64)
            }
        };
        now.residual = S::new(residual);
        *now
    }
}
