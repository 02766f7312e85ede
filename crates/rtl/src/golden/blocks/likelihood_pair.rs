//! Bins of fits of two echoes, as the other blocks hand them on, and words of every size.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::likelihood_pair::In;

use crate::golden::configuration::{TWO_BEHIND_GLASS, with_second};
use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    configurations: &[TWO_BEHIND_GLASS],
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_pair", "likelihood_estimator.likelihood_pair", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_pair,
    rise: |estimator, i, params| estimator.likelihood_pair.tick(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut lights = Cover::new("bits of a hazard", [0].into_iter().chain(4..27));
    let mut shares = Cover::new("share in 16ths", 0..17);
    let mut signs = Cover::new("sign of the score", 0..2);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| {
        let now = &estimator.likelihood_pair;
        lights.see(u64::from(u64::BITS - now.other_light.get().leading_zeros()));
        shares.see(now.still_share.get() >> 8);
        signs.see((now.still_score.get() < 0).into());
    };
    // A design that finds one target has no such block.
    let setting = &with_second(setting.clone());
    let params = &*setting.setup.params.estimators.likelihood_estimator;
    let mut drawn = Drawn::default();
    let run = PART.record(spec, setting, see, |_, _, draw| drawn.next(params, draw));
    vectors(run, spec, setting, [lights, shares, signs])
}

/// Passes over bins that are drawn, one after the other.
#[derive(Default)]
struct Drawn {
    now: In,
    left: u64,
}

impl Drawn {
    fn next(&mut self, params: &Params, draw: &mut Draw) -> In {
        let now = &mut self.now;
        (now.pass, now.phase) = (self.left == 0, !now.phase && self.left != 0);
        if now.pass {
            self.left = 30 + draw.below(90);
            now.paired = !draw.one_in(4);
            now.other_arrival = U::new(draw.below(params.end() as u64 + 1));
            now.other_strength = U::new(draw.near_ends(1 << 24) >> draw.below(24));
        }
        self.left -= 1;
        if now.pass || now.phase {
            return *now;
        }
        let (count, bin) = (params.histogram.count_bits, params.histogram.bins.ilog2());
        // Times within the pulse, around the ends of its ROM, and anywhere.
        let (step, arrival) = (8i64 << params.step_log2, now.other_arrival.get() as i64);
        let steps = match draw.below(4) {
            0 => draw.below(2048) as i64 - 1024,
            1 => draw.below(7) as i64 - 1027,
            2 => draw.below(7) as i64 + 1020,
            _ => draw.below(256) as i64 - 128,
        };
        let end = (arrival + 2 * step * steps) / 8 + draw.below(step as u64) as i64;
        now.word_end = U::new(end.clamp(0, (1 << (bin + 8)) - 1) as u64);
        let kind = draw.below(8);
        (now.word_edge, now.word_bin) = (kind == 0, kind > 1);
        now.word_first = draw.one_in(8);
        if params.glass.bins() > 0 {
            now.glass_light = U::new(draw.near_ends(1 << 26) >> draw.below(26));
        }
        now.ambient_light = U::new(draw.near_ends(1 << 26) >> draw.below(26));
        // No hazard of ambient light and a glass is above that of its bin.
        now.hazard_bits = U::new(26);
        now.hazard_reciprocal = U::new(512 + draw.below(512));
        now.residual = S::new(draw.signed_within(count + 9));
        now.weight_first = U::new(draw.near_ends(1 << (count + 8).max(24)));
        now.share = U::new(draw.near_ends(4097));
        now.slope = S::new(draw.signed_within(9));
        *now
    }
}
