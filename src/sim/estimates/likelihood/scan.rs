//! Search for the place where a box of bins stands highest above ambient light.

use std::ops::Range;

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::log2_64;
use crate::firmware::likelihood_estimator::words::{AMBIENT_FRACTION, HAZARD_FRACTION};

use super::arithmetic::shifted;
use super::histogram::Shots;
use super::terms::Bin;

/// Score of a box in which less than expected ended.
const NONE: i64 = -4096;
/// Addition to the expected count of a bin while shots wait, 8 fraction bits: a tenth.
const ADDED: i64 = 26;

/// The highest place of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// 64 log2 of the squared excess over what is expected.
    pub score: i64,
    /// First bin of the box and the one after its last.
    pub bins: (usize, usize),
    /// More than expected, 8 fraction bits [counts].
    pub excess: i64,
    /// Twice the shots that wait in the middle of a bin, over its bins.
    pub waiting: i64,
}

/// Slides the box over all bins but those that are blanked; the first of the highest places is the one.
pub fn scan(p: &Params, shots: &Shots, ambient: i64, blanked: Range<usize>) -> Best {
    let bins = shots.ended.len();
    // What has come before each bin.
    let mut before = Vec::with_capacity(bins + 1);
    let mut sum = [0; 3];
    before.push(sum);
    for bin in 0..bins {
        if !blanked.contains(&bin) && p.width(bin) > 0 {
            let own = of_bin(p, shots, ambient, bin);
            sum = [0, 1, 2].map(|which| sum[which] + own[which]);
        }
        before.push(sum);
    }
    let half = p.box_bins / 2;
    let mut best = Best { score: i64::MIN, bins: (0, 0), excess: 0, waiting: 0 };
    for place in 0..bins {
        let from = place.saturating_sub(half);
        let until = (place + p.box_bins - half).min(bins);
        let sum = |which: usize| before[until][which] - before[from][which];
        let (excess, expected) = (sum(0), sum(1).max(1));
        let score = if excess > 0 { 2 * log2_64(excess) - log2_64(expected) - 512 } else { NONE };
        if score > best.score {
            best = Best { score, bins: (from, until), excess, waiting: sum(2) };
        }
    }
    best
}

/// Excess, expected count and twice the shots that wait in the middle of a bin.
fn of_bin(p: &Params, shots: &Shots, ambient: i64, bin: usize) -> [i64; 3] {
    let (ended, waiting) = (i64::from(shots.ended[bin]), shots.waiting[bin]);
    let ambient = shifted(ambient * p.width(bin), i64::from(AMBIENT_FRACTION - HAZARD_FRACTION));
    let terms = Bin { ended, waiting, signal: 0, ambient }.terms(p.histogram.count_bits);
    let added = if waiting > 0 { ADDED } else { 0 };
    [(terms.residual << 4) - added, (terms.expected >> 4) + added, (2 * waiting - ended).max(0)]
}
