//! Depth, deviation and status, from what the last step knew.

use crate::firmware::forward2::Depth;
use crate::firmware::likelihood_estimator::words::{
    ANOTHER_SCORE, CERTAIN_SCORE, CHI_FRACTION, DEPTH_FRACTION, FAR, LEAST_SCORE, LEAST_WAITING,
    SIGNAL_FRACTION, SURE_SCORE, WEIGHT_FRACTION,
};
use crate::firmware::tof_top::slot::{EstimateWords, SecondWords};
use crate::firmware::tof_top::status::{Status, StatusSet};
use crate::firmware::tof_top::status_code::{CodeConditions, StatusCode};
use crate::kernel::U;

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::{Number, product};
use super::point::Point;
use super::scan::Best;
use super::step::Information;

/// By how many bits a variance is shifted up for its root.
const ROOT_LOG2: i64 = 16;
/// Fraction bits of a variance of log S.
const VARIANCE_FRACTION: i64 = 10;

/// The result of an estimation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found<N = i64> {
    /// Depth [m, 29 fraction bits].
    pub depth: N,
    /// Its standard deviation [m, 29 fraction bits].
    pub sigma: N,
    /// Reasons to reject it: the firmware's status word.
    pub status: StatusSet,
    /// What a host can rely on.
    pub code: StatusCode,
    /// Sum of squared residuals over their variances, 8 fraction bits [1].
    pub chi_square: N,
    /// The second target, if there are two.
    pub second: Option<Second<N>>,
}

/// The second of two targets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Second<N = i64> {
    /// Depth [m, 29 fraction bits].
    pub depth: N,
    /// Its standard deviation [m, 29 fraction bits].
    pub sigma: N,
    /// Signal [photons a shot, 14 fraction bits].
    pub signal: N,
    /// Reasons to reject it.
    pub status: StatusSet,
}

impl Found {
    /// The words as the ports have them.
    pub fn words(&self) -> EstimateWords {
        EstimateWords {
            depth: Depth::new(self.depth),
            sigma: U::new(self.sigma as u64),
            status: U::new(self.status.bits().into()),
            valid: self.status.is_empty(),
            code: self.code,
            second: self.second.map(|second| second.words()).unwrap_or_default(),
        }
    }
}

impl Second {
    /// The words as the ports have them.
    fn words(&self) -> SecondWords {
        SecondWords {
            second_depth: Depth::new(self.depth),
            second_sigma: U::new(self.sigma as u64),
            second_strength: U::new(self.signal as u64),
            second_status: U::new(self.status.bits().into()),
            second_valid: self.status.is_empty(),
        }
    }
}

impl<N: Number> Second<N> {
    /// The depth [m].
    pub fn depth_m(&self) -> f64 {
        self.depth.value(DEPTH_FRACTION)
    }

    /// Standard deviation of the depth [m].
    pub fn sigma_m(&self) -> f64 {
        self.sigma.value(DEPTH_FRACTION)
    }

    /// Signal [photons a shot].
    pub fn signal(&self) -> f64 {
        self.signal.value(SIGNAL_FRACTION)
    }
}

impl<N: Number> Found<N> {
    /// The depth [m].
    pub fn depth_m(&self) -> f64 {
        self.depth.value(DEPTH_FRACTION)
    }

    /// Standard deviation of the depth [m].
    pub fn sigma_m(&self) -> f64 {
        self.sigma.value(DEPTH_FRACTION)
    }

    /// Chi-square of the fit [1].
    pub fn chi_square(&self) -> f64 {
        self.chi_square.value(CHI_FRACTION)
    }
}

/// The result of an estimation, and what its status depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged<N> {
    /// The result.
    pub found: Found<N>,
    /// Limits that are exceeded: the solver's flags.
    pub flags: [bool; 7],
    /// Shots that wait at the first bin of the fit, if it has one.
    pub waiting: Option<N>,
    /// Conditions of the code, without a second target.
    pub conditions: CodeConditions,
}

/// Computes the result of an estimation.
pub fn verdict<I: Instrument>(
    p: &I,
    shots: &Shots<I::Number>,
    [start, other]: [&Best<I::Number>; 2],
    last: &Point<I::Number>,
    information: &Information<I::Number>,
) -> Judged<I::Number> {
    let Information { a11, a22, determinant, exponent, cut, move_by } = *information;
    let (whole, score, scales) = (I::Number::whole, score::<I::Number>, p.scales());
    let (word, count_bits) = (p.words().word_bits(), p.words().histogram.count_bits);
    let (over, bits) = determinant.reciprocal();
    // Of a variance as a multiple of mantissas, and of its root.
    let scale = 16 - i64::from(WEIGHT_FRACTION) + bits + exponent;
    let odd = scale & 1;
    let root = (a22 * over).floored(-ROOT_LOG2 - odd).root();
    let sigma = product(root, scales.stride, 11 + (scale + odd) / 2, word);
    let variance = product(a11, over, scale - VARIANCE_FRACTION, word);
    let to_depth =
        |sixteenths| product(sixteenths, scales.metres, scales.metres_shift.into(), word);
    let terms = last.terms(p, shots);
    let (fit, _) = terms.split_at(terms.len() - 1);
    let far = fit.iter().any(|(terms, _)| {
        terms.squared(count_bits) > whole(FAR) * (terms.weight + whole(1 << WEIGHT_FRACTION))
    });
    let chi_square = terms.iter().map(|(terms, _)| terms.chi_square(count_bits));
    let begin = p.window(last.arrival).start;
    let mut bins = last.fitted(p).into_iter().flatten();
    let first = bins.find(|&bin| bin >= begin && p.has(bin));
    let waiting = first.map(|bin| shots.waiting(bin));
    let margin = scales.sigma.floored(-3);
    // Largest variance of log S: a 16th unless the echo is certain, and with a score that is not sure, a 25th.
    let flags = [
        variance > whole(64),
        variance > I::Number::constant(40, 1024.0 / 25.0),
        sigma > scales.sigma.floored(-4),
        last.arrival < margin,
        scales.end - last.arrival < margin,
        -move_by > sigma + sigma,
        move_by > sigma + sigma,
    ];
    let [faint, unsure, wide, at_begin, at_end, to_left, to_right] = flags;
    let no_echo = unsure && start.score < score(SURE_SCORE, 100.0)
        || faint && start.score < score(CERTAIN_SCORE, 10_000.0)
        || start.score < score(LEAST_SCORE, 25.0)
        || wide;
    let [least, most] = p.words().glass.limits().map(whole);
    let has_changed = p.has_glass() && (last.glass < least || last.glass > most);
    let reasons = [
        (no_echo, Status::NoEcho),
        (at_begin || at_end, Status::CutOff),
        (waiting.is_some_and(|shots| shots < whole(LEAST_WAITING as i64)), Status::UsedUp),
        (other.score > score(ANOTHER_SCORE, 36.0), Status::Another),
        (cut > 0 || to_left || to_right, Status::NotSettled),
        (far || has_changed, Status::NoFit),
    ];
    let is_blind = shots.left() < whole(p.words().least_left() as i64);
    let conditions = CodeConditions { is_blind, has_changed, has_second: false };
    let status = StatusSet::of(&reasons);
    let found = Found {
        depth: to_depth(last.arrival) - scales.delay,
        sigma: to_depth(sigma),
        status,
        code: StatusCode::of(status, conditions),
        chi_square: chi_square.fold(whole(0), |sum, term| sum + term),
        second: None,
    };
    Judged { found, flags, waiting, conditions }
}

/// A score: its word, or 64 log2 of the squared deviations that it stands for.
fn score<N: Number>(word: i64, squared: f64) -> N {
    N::constant(word, 64.0 * libm::log2(squared))
}
