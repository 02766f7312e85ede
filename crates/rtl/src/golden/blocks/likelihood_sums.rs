//! Terms of the bins of scans, fits and checks, and terms of every size.

use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_sums::In;

use crate::golden::configuration::TWO;
use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    configurations: &[TWO],
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_sums", "likelihood_estimator.likelihood_sums", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_sums,
    rise: |estimator, i, params| estimator.likelihood_sums.tick(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut checks = Cover::new("phase x 2 + check", 0..4);
    let mut fars = Cover::new("far", 0..2);
    let see = |estimator: &LikelihoodEstimator, own: &In, alone: bool| {
        fars.see(estimator.likelihood_sums.far.into());
        checks.see_if(!alone, bits([own.phase, own.check]));
    };
    let (mut drawn, histogram) = (Drawn::default(), setting.histogram());
    let run = PART.record(spec, setting, see, |_, _, draw| drawn.next(&histogram, draw));
    vectors(run, spec, setting, [checks, fars])
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
