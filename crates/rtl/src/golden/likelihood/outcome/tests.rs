//! The outcome without a clock against that of the clocked block.

use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator, State};
use tofsim::firmware::tof_top::slot::SlotEstimator;
use tofsim::kernel::U;
use tofsim::sim::setup::Setup;

use crate::golden::draw::Draw;
use crate::golden::likelihood::Estimations;
use crate::golden::setting::Setting;

use super::*;

/// Steps the block over a histogram.
fn clocked(histogram: &[u32], params: &Params) -> Outcome {
    let (mut block, mut outcome) = (LikelihoodEstimator::default(), Outcome::default());
    for line in 0..=params.done() {
        let memory = &block.likelihood_memory.registers;
        match block.state() {
            State::Start => (outcome.start, outcome.middles[0]) = highest(&block),
            State::Check if memory.word_bin && outcome.waiting.is_none() => {
                outcome.waiting = Some(memory.word_waiting.get());
            }
            _ => {}
        }
        let word = if memory.read_en { histogram[memory.read_addr.index()] } else { 0 };
        let i = In { algo_start: line == 0, count: U::new(word.into()), ..In::default() };
        block.rise(&i, params);
    }
    (outcome.rescan, outcome.middles[1]) = highest(&block);
    let flags = block.likelihood_solver.registers.flags.get();
    outcome.flags = std::array::from_fn(|flag| flags >> flag & 1 != 0);
    outcome.status = block.registers.status.get();
    outcome.cut = block.likelihood_solver.registers.cut.get() != 0;
    outcome
}

/// Returns the highest score of a scan, and the middle bin of its box.
fn highest(block: &LikelihoodEstimator) -> (i64, u64) {
    let scan = &block.likelihood_scan.registers;
    (scan.best_score.get(), scan.box_sum.get() / 2)
}

#[test]
fn the_outcome_is_that_of_the_clocked_block() {
    let setting = Setting::new(Setup::load("kc705", &[]).unwrap());
    let mut estimations = Estimations::new(&setting, true);
    let params = &setting.setup.params.estimators.likelihood_estimator;
    let mut draw = Draw::new(7, 7);
    for kind in 0..KINDS {
        for _ in 0..20 {
            estimations.begun += 1;
            let histogram = estimations.histogram(kind, &mut draw);
            let outcome = Outcome::of(&histogram, params);
            assert_eq!(outcome, clocked(&histogram, params), "kind {kind}: {histogram:?}");
        }
    }
}
