//! Search for the box with the largest excess over ambient light, in double precision.

use std::ops::Range;

use super::model::Model;
use super::shots::{Shots, Terms};

/// Addition to the expected count of a bin while shots wait [counts].
const ADDED: f64 = 0.1;
/// Least expected count of a box.
const LEAST_EXPECTED: f64 = 1.0 / 256.0;

/// The highest place of the box.
#[derive(Clone, Copy, Debug, Default)]
pub struct Best {
    /// Squared excess over what is expected, in squared deviations.
    pub score: f64,
    /// First bin of the box and the one after its last.
    pub bins: (usize, usize),
    /// More than expected [counts].
    pub excess: f64,
    /// Shots that wait in the middle of each bin, summed over its bins.
    pub waiting: f64,
}

/// Slides the box over all bins but those that are blanked; the first of the highest places is the one.
pub fn scan(model: &Model, shots: &Shots, ambient: f64, blanked: &Range<usize>) -> Best {
    let bins = model.bins();
    let each: Vec<[f64; 3]> = (0..bins)
        .map(|bin| match blanked.contains(&bin) || model.width(bin) <= 0.0 {
            true => [0.0; 3],
            false => of_bin(model, shots, ambient, bin),
        })
        .collect();
    let half = model.words.box_bins / 2;
    let mut best: Option<Best> = None;
    for place in 0..bins {
        let from = place.saturating_sub(half);
        let until = (place + model.words.box_bins - half).min(bins);
        let sum = |which: usize| -> f64 { each[from..until].iter().map(|of| of[which]).sum() };
        let (excess, expected) = (sum(0), sum(1).max(LEAST_EXPECTED));
        let score = if excess > 0.0 { excess * excess / expected } else { 0.0 };
        if best.is_none_or(|best| score > best.score) {
            best = Some(Best { score, bins: (from, until), excess, waiting: sum(2) });
        }
    }
    best.unwrap_or_default()
}

/// Excess, expected count and the shots that wait in the middle of a bin.
fn of_bin(model: &Model, shots: &Shots, ambient: f64, bin: usize) -> [f64; 3] {
    let (ended, waiting) = (shots.ended[bin], shots.waiting[bin]);
    let terms = Terms::new(ended, waiting, 0.0, ambient * model.width(bin));
    let added = if waiting > 0.0 { ADDED } else { 0.0 };
    [terms.residual - added, terms.expected + added, (waiting - ended / 2.0).max(0.0)]
}
