//! Blocks of loads, and bins of scans, as measured and of every size, with many ties.

use tofsim::firmware::likelihood_estimator::{LikelihoodEstimator, Wires};
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_scan::In;

use crate::golden::likelihood::part::{Part, vectors};
use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    model: Some(Model::new::<In>(|at| PART.step(at))),
    ..Spec::new("likelihood_scan", "likelihood_estimator.likelihood_scan", record)
};

const PART: Part<In> = Part {
    wires: Wires::likelihood_scan,
    rise: |estimator, i, params| estimator.likelihood_scan.rise(i, params),
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut scores = Cover::new("score in 256ths, above none", 0..4);
    let mut lone = Cover::new("lone", 0..2);
    let see = |estimator: &LikelihoodEstimator, _: &In, _| {
        let now = &estimator.likelihood_scan.registers;
        scores.see((now.best_score.get().max(0) >> 8) as u64);
        lone.see(now.lone.into());
    };
    let (mut drawn, histogram) = (Drawn::default(), setting.histogram());
    let run = PART.record(spec, setting, see, |_, _, draw| drawn.next(&histogram, draw));
    vectors(run, spec, setting, [scores, lone])
}

/// Loads and short scans that are drawn, in turn.
#[derive(Default)]
struct Drawn {
    now: In,
    /// Lines since the load began.
    line: u64,
    /// Lines of the load, and of it and the scan.
    ends: [u64; 2],
    /// Hits and exposure of an ordinary block.
    block: [u64; 2],
    /// Bits of a residual.
    size: u32,
}

/// Lines from one block to the next.
const APART: u64 = 4;

impl Drawn {
    fn next(&mut self, histogram: &histogram_builder::Params, draw: &mut Draw) -> In {
        let (count, bin) = (histogram.count_bits, histogram.bins.ilog2());
        if self.line == self.ends[1] {
            let load = 9 * APART;
            // One in three goes past the last bin, and none so far that the count of bins wraps.
            let all = histogram.bins as u64;
            let beats = if draw.one_in(3) { all + all / 16 } else { draw.below(80.min(all + all / 2)) };
            (self.line, self.ends) = (0, [load, load + 2 + 2 * beats]);
            self.block = [draw.unsigned_of(count), draw.unsigned_of(count + bin + 4)];
            self.size = 4 + draw.below(u64::from(count) + 6) as u32;
        }
        let now = &mut self.now;
        now.load = self.line == 0;
        now.scan = self.line >= self.ends[0];
        now.pass = self.line == self.ends[0];
        now.phase = now.scan && !now.pass && !now.phase;
        now.block_done = !now.load && !now.scan && self.line.is_multiple_of(APART);
        if now.block_done {
            let [ended, exposure] = self.block;
            now.block_ended = U::new([ended, ended, 2 * ended, draw.unsigned_of(count + bin)][draw.below(4) as usize]);
            // The first sets the bound for the others: a 64th of it.
            let first = self.line == APART;
            let any = draw.unsigned_of(count + bin + 10);
            // One has a logarithm that is a step above that bound.
            let others = [exposure, exposure + exposure / 80, 2 * exposure, exposure / 2, any];
            now.block_exposure = U::new(if first { 64 * exposure } else { others[draw.below(5) as usize] });
        }
        if now.scan && !now.phase {
            now.slide = !draw.one_in(16);
            now.waits = !draw.one_in(4);
            let most = i64::MAX >> (64 - self.size);
            let high = self.ends[1] - self.line < 30;
            now.residual = S::new(if high { most } else if draw.one_in(3) { 0 } else { draw.signed_within(self.size) });
            now.predicted = U::new(if draw.one_in(3) { 0 } else { draw.unsigned_of(self.size + 9) });
            now.middle = U::new(draw.unsigned_of(count + 1));
        }
        self.line += 1;
        *now
    }
}
