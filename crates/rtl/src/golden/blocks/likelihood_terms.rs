//! Bins of scans and fits, as the estimator's memory hands them on, and bins around the ends of the pulse's ROM,
//! with words of every size.

use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_terms::In;

use crate::golden::configuration::{GLASS, TWO, TWO_BEHIND_GLASS};
use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    configurations: &[GLASS, TWO, TWO_BEHIND_GLASS],
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_terms", "likelihood_estimator.likelihood_terms", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_terms,
    rise: |estimator, i, params| estimator.likelihood_terms.tick(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut predicted = Cover::new("bits of an expected count", [0].into_iter().chain(10..24));
    let mut shares = Cover::new("share in 16ths", 0..17);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| {
        let now = &estimator.likelihood_terms;
        predicted.see(u64::from(u64::BITS - now.predicted.get().leading_zeros()));
        shares.see(now.share.get() >> 8);
    };
    let params = &*setting.setup.params.estimators.likelihood_estimator;
    let run = PART.record(spec, setting, see, |_, mut own, random| {
        own.phase = !own.phase;
        if !own.phase {
            draw(&mut own, params, random);
        }
        own
    });
    vectors(run, spec, setting, [predicted, shares])
}

/// Draws a word, and now and then another point.
fn draw(own: &mut In, params: &Params, draw: &mut Draw) {
    let (count, bin) = (params.histogram.count_bits, params.histogram.bins.ilog2());
    let size = |bits: u32, draw: &mut Draw| match draw.one_in(3) {
        true => draw.bits() >> (64 - bits),
        false => draw.unsigned_of(bits),
    };
    if draw.one_in(12) {
        own.scan = draw.one_in(8);
        own.arrival = U::new(draw.below(params.end() as u64 + 1));
        own.strength = U::new(size(24, draw));
        own.ambient = U::new(size(24, draw));
    }
    if params.has_more_light() {
        own.dark = draw.one_in(8);
    }
    if params.glass.bins() > 0 {
        own.glass_light = U::new(size(26, draw));
    }
    if params.has_second() {
        own.other_light = U::new(size(26, draw));
    }
    let (step, arrival) = (8i64 << params.step_log2, own.arrival.get() as i64);
    let steps = match draw.below(4) {
        0 => draw.below(2048) as i64 - 1024,
        1 => draw.below(7) as i64 - 1027,
        2 => draw.below(7) as i64 + 1020,
        _ => draw.below(64) as i64 - 32,
    };
    let end = (arrival + 2 * step * steps) / 8 + draw.below(step as u64) as i64;
    own.word_end = U::new(end.clamp(0, (1 << (bin + 8)) - 1) as u64);
    let kind = draw.below(8);
    (own.word_edge, own.word_rest) = (kind == 0, kind == 1);
    own.word_bin = kind > 2;
    own.word_slide = own.scan && kind != 0;
    own.word_first = draw.one_in(8);
    let shots = count + if own.word_rest { bin } else { 0 };
    own.word_ended = U::new(size(shots, draw));
    own.word_waiting = U::new(size(shots, draw));
    own.word_width = U::new(if draw.one_in(4) { draw.unsigned_of(10) } else { 48 + draw.below(32) });
}
