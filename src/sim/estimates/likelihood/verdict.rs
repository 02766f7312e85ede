//! Depth, deviation and status, from what the last step knew.

use crate::firmware::forward2::Depth;
use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::{Tables, length, reciprocal};
use crate::firmware::likelihood_estimator::words::{
    ANOTHER_SCORE, ChiSquare, LEAST_SCORE, LEAST_WAITING, SURE_SCORE, WEIGHT_FRACTION,
};
use crate::firmware::tof_top::slot::{EstimateWords, SigmaM};
use crate::firmware::tof_top::status::{Status, StatusSet};
use crate::kernel::U;

use super::arithmetic::{product, root};
use super::histogram::Shots;
use super::scan::Best;
use super::step::{Information, Point};
use super::terms::Terms;

/// By how many bits a variance is shifted up for its root.
const ROOT_LOG2: i64 = 16;
/// Fraction bits of a variance of log S.
const VARIANCE_FRACTION: i64 = 10;
/// Largest variance of log S, a 16th, and with a score that is not sure, a 25th.
const MOST_VARIANCE: i64 = 64;
const MOST_UNSURE: i64 = 40;
/// A residual of so many squared deviations is no chance.
const FAR: i64 = 25;
/// The part of a chi-square's term that is kept: 16 bits and its fraction.
const MOST_TERM: i64 = (1 << 24) - 1;

/// The result of an estimation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// Depth word [m].
    pub depth: Depth,
    /// Its standard deviation, with as many fraction bits [m].
    pub sigma: u64,
    /// Reasons to reject it: the firmware's status word.
    pub status: StatusSet,
    /// Sum of squared residuals over their variances, 8 fraction bits [1].
    pub chi_square: u64,
}

impl Found {
    /// The words as the ports have them.
    pub fn words(&self) -> EstimateWords {
        EstimateWords {
            depth: self.depth,
            sigma: U::new(self.sigma),
            status: U::new(self.status.bits().into()),
            valid: self.status.is_empty(),
        }
    }

    /// Standard deviation of the depth [m].
    pub fn sigma_m(&self) -> f64 {
        SigmaM::from_bits(self.sigma).to_num()
    }

    /// Chi-square of the fit [1].
    pub fn chi_square(&self) -> f64 {
        ChiSquare::from_bits(self.chi_square).to_num()
    }
}

/// Computes the result of an estimation.
pub fn verdict(
    p: &Params,
    shots: &Shots,
    start: &Best,
    other: &Best,
    last: &Point,
    information: &Information,
) -> Found {
    let Information { a11, a22, determinant, exponent, cut, move_by } = *information;
    let (over, bits) = reciprocal(determinant);
    let word = p.word_bits();
    // Of a variance as a multiple of mantissas, and of its root.
    let scale = 16 - i64::from(WEIGHT_FRACTION) + i64::from(bits) + exponent;
    let odd = scale & 1;
    let root = root((a22 * over) << (ROOT_LOG2 + odd));
    let sigma = product(root, p.stride(), 11 + (scale + odd) / 2, word);
    let variance = product(a11, over, scale - VARIANCE_FRACTION, word);
    let to_depth = |sixteenths: i64| product(sixteenths, p.metres, p.metres_shift.into(), word);
    let terms = last.terms(p, shots);
    let (fit, rest) = terms.split_at(terms.len() - 1);
    let far = fit
        .iter()
        .any(|(terms, _)| terms.squared(p) > FAR * (terms.weight + (1 << WEIGHT_FRACTION)));
    let chi_square = fit.iter().chain(rest).map(|(terms, _)| terms.chi_square(p)).sum::<i64>();
    let used_up = last
        .window(p)
        .find(|&bin| p.width(bin) > 0)
        .is_some_and(|bin| shots.waiting[bin] < LEAST_WAITING as i64);
    let margin = p.sigma << 3;
    let unsure = variance > MOST_UNSURE && start.score < SURE_SCORE;
    let no_echo =
        unsure || variance > MOST_VARIANCE || start.score < LEAST_SCORE || sigma > p.sigma << 4;
    let cut_off = last.arrival < margin || p.end() - last.arrival < margin;
    let reasons = [
        (no_echo, Status::NoEcho),
        (cut_off, Status::CutOff),
        (used_up, Status::UsedUp),
        (other.score > ANOTHER_SCORE, Status::Another),
        (cut > 0 || move_by.abs() > 2 * sigma, Status::NotSettled),
        (far, Status::NoFit),
    ];
    Found {
        depth: Depth::new(to_depth(last.arrival) - p.delay),
        sigma: to_depth(sigma) as u64,
        status: StatusSet::of(&reasons),
        chi_square: chi_square as u64,
    }
}

impl Terms {
    /// The residual's square, 6 fraction bits as weights have.
    fn squared(&self, p: &Params) -> i64 {
        let most = (1 << (p.histogram.count_bits + 1)) - 1;
        let residual = self.residual.clamp(-most, most);
        (residual * residual) >> 2
    }

    /// The residual's square over its variance, a quarter of a count more; 8 fraction bits.
    fn chi_square(&self, p: &Params) -> i64 {
        let variance = self.weight + 16;
        let bits = i64::from(length(variance));
        let mantissa = if bits > 7 { variance >> (bits - 7) } else { variance << (7 - bits) };
        let square = self.squared(p);
        // Over the variance's leading one, then over its mantissa.
        let over = if bits > 9 { square >> (bits - 9) } else { square << (9 - bits) };
        let reciprocal = Tables::reciprocal(mantissa, 6);
        (over.min(MOST_TERM) * reciprocal) >> 10
    }
}
