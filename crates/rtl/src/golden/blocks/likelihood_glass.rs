//! Bins of fits behind a cover glass, as the other blocks hand them on, and words of every size.

use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::likelihood_glass::In;

use crate::golden::configuration::{TWO_BEHIND_GLASS, behind_glass};
use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    configurations: &[Configuration { parameters: &["Targets"], ..TWO_BEHIND_GLASS }],
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_glass", "likelihood_estimator.likelihood_glass", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_glass,
    rise: |estimator, i, params| estimator.likelihood_glass.tick(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut lights = Cover::new("bits of a hazard", 0..27);
    let mut signs = Cover::new("sign of the score", 0..2);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| {
        let now = &estimator.likelihood_glass;
        lights.see(u64::from(u64::BITS - now.glass_light.get().leading_zeros()));
        signs.see((now.score_4.get() < 0).into());
    };
    // A design without glass has no such block.
    let setting = &behind_glass(setting.clone());
    let has_second = setting.setup.params.estimators.likelihood_estimator.has_second();
    let (mut drawn, histogram) = (Drawn { has_second, ..Drawn::default() }, setting.histogram());
    let run = PART.record(spec, setting, see, |_, _, draw| drawn.next(&histogram, draw));
    vectors(run, spec, setting, [lights, signs])
}

/// Passes over bins that are drawn, one after the other.
#[derive(Default)]
struct Drawn {
    now: In,
    left: u64,
    has_second: bool,
}

impl Drawn {
    fn next(&mut self, histogram: &histogram_builder::Params, draw: &mut Draw) -> In {
        let now = &mut self.now;
        (now.pass, now.phase) = (self.left == 0, !now.phase && self.left != 0);
        if now.pass {
            self.left = 30 + draw.below(90);
            now.glass = U::new(draw.near_ends(1 << 24) >> draw.below(24));
            now.paired = self.has_second && draw.one_in(2);
        }
        self.left -= 1;
        if now.pass || now.phase {
            return *now;
        }
        let count = histogram.count_bits;
        now.word_glass = U::new(draw.near_ends(1 << 17) >> draw.below(17));
        // No hazard of the glass is above that of its bin.
        now.hazard_bits = U::new(26);
        now.hazard_reciprocal = U::new(512 + draw.below(512));
        now.residual = S::new(draw.signed_within(count + 9));
        now.weight_first = U::new(draw.near_ends(1 << (count + 8).max(24)));
        now.share = U::new(draw.near_ends(4097));
        now.slope = S::new(draw.signed_within(9));
        if self.has_second {
            now.still_share = U::new(draw.near_ends(4097));
        }
        *now
    }
}
