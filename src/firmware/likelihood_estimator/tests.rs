//! Tests of the status at the limits of the scores.

use super::words::{ANOTHER_SCORE, CERTAIN_SCORE, LEAST_SCORE, SURE_SCORE};
use super::*;
use crate::firmware::tof_top::status::Status;
use crate::kernel::S;
use crate::sim::setup::Setup;

/// Flags of an end program: log S is not known to a quarter, to a fifth.
const NOT_TO_A_QUARTER: u64 = 1;
const NOT_TO_A_FIFTH: u64 = 2;

/// Status of an estimation whose scans have such scores, and whose end program raised such flags.
fn status_of(start_score: i64, other_score: i64, flags: u64) -> u64 {
    let params = Setup::load("kc705", &[]).unwrap().likelihood(30_000).unwrap();
    let mut block = LikelihoodEstimator::default();
    (block.registers.state, block.registers.start_score) = (State::End, S::new(start_score));
    block.likelihood_scan.registers.best_score = S::new(other_score);
    let solver = &mut block.likelihood_solver.registers;
    (solver.ran, solver.flags) = (true, U::new(flags));
    let ended = block.next(&In::default(), &params);
    assert!(ended.algo_done && ended.valid == (ended.status == 0));
    ended.status.get()
}

/// Each limit, by the squared deviations that it stands for.
#[test]
fn limits_are_64_logarithms_of_squared_deviations() {
    let limits = [
        (LEAST_SCORE, 25.0f64),
        (SURE_SCORE, 100.0),
        (ANOTHER_SCORE, 36.0),
        (CERTAIN_SCORE, 10_000.0),
    ];
    for (limit, squared) in limits {
        assert_eq!(limit, (64.0 * squared.log2()).round() as i64);
    }
}

#[test]
fn an_echo_has_at_least_the_least_score() {
    let no_echo = [296, 297, 298].map(|score| status_of(score, 0, 0));
    assert_eq!(no_echo, [Status::NoEcho.bit().into(), 0, 0]);
}

#[test]
fn an_unsure_echo_has_at_least_the_sure_score() {
    let unsure = [424, 425, 426].map(|score| status_of(score, 0, NOT_TO_A_FIFTH));
    assert_eq!(unsure, [Status::NoEcho.bit().into(), 0, 0]);
    assert_eq!(status_of(424, 0, 0), 0);
}

#[test]
fn only_a_certain_echo_may_have_an_uncertain_signal() {
    let flags = NOT_TO_A_QUARTER | NOT_TO_A_FIFTH;
    let uncertain = [425, 849, 850].map(|score| status_of(score, 0, flags));
    let no_echo = u64::from(Status::NoEcho.bit());
    assert_eq!(uncertain, [no_echo, no_echo, 0]);
}

#[test]
fn another_echo_has_more_than_its_score() {
    let another = [330, 331, 332].map(|score| status_of(500, score, 0));
    assert_eq!(another, [0, 0, Status::Another.bit().into()]);
}
