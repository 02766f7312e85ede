//! Search for the place where a box of bins stands highest above ambient light.

use std::ops::Range;

use crate::firmware::likelihood_estimator::words::{
    ADDED, EXCESS_FRACTION, LEAST_SIGNAL, MOST_LEVEL, NO_SCORE, UNITS,
};

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::{Number, product};
use super::point::{Light, Point};

/// The part of a pulse in the box.
const IN_BOX: f64 = 0.84;
/// What [`ADDED`] stands for: a tenth of a count, 8 fraction bits.
const A_TENTH: f64 = 25.6;

/// The highest place of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best<N> {
    /// 64 log2 of the squared excess over what is expected.
    pub score: N,
    /// First bin of the box and the one after its last.
    pub bins: (usize, usize),
    /// More than expected, 8 fraction bits [counts].
    pub excess: N,
    /// Twice the shots that wait in the middle of a bin, over its bins.
    pub waiting: N,
}

impl<N: Number> Best<N> {
    /// Returns the first point of a fit: an echo here, above the light of a point.
    pub fn start(&self, p: &impl Instrument<Number = N>, light: &Point<N>) -> Point<N> {
        let (from, until) = self.bins;
        let word = p.words().word_bits();
        let (mantissa, bits) = self.waiting.at_least(N::whole(1)).reciprocal();
        let excess = self.excess.floored(-4).wrapped(word);
        let rate = product(excess, mantissa, bits, word);
        let bins = N::whole((until - from) as i64);
        let signal = ((rate * bins).shifted(13) * N::constant(19, 16.0 / IN_BOX)).shifted(4);
        Point {
            arrival: N::whole((from + until) as i64 * (UNITS / 2) * 16),
            signal: signal.within([LEAST_SIGNAL, MOST_LEVEL].map(N::whole)),
            ..*light
        }
    }
}

/// Slides the box over all bins but those that are blanked, above the light of a point; the first of the highest places
/// is the one.
pub fn scan<I: Instrument>(
    p: &I,
    shots: &Shots<I::Number>,
    light: &Point<I::Number>,
    blanked: Range<usize>,
) -> Best<I::Number> {
    let (bins, box_bins) = (shots.bins(), p.words().box_bins);
    // What has come before each bin.
    let mut before = Vec::with_capacity(bins + 1);
    let mut sum = [I::Number::default(); 3];
    before.push(sum);
    for (bin, light) in light.light(p, 0..bins).enumerate() {
        if !blanked.contains(&bin) && p.has(bin) {
            let own = of_bin(p, shots, &light, bin);
            sum = [0, 1, 2].map(|which| sum[which] + own[which]);
        }
        before.push(sum);
    }
    let half = box_bins / 2;
    let place = |place: usize| {
        let from = place.saturating_sub(half);
        let until = (place + box_bins - half).min(bins);
        let [excess, expected, waiting] =
            [0, 1, 2].map(|which| before[until][which] - before[from][which]);
        Best { score: score(excess, expected), bins: (from, until), excess, waiting }
    };
    let higher =
        |best: Best<_>, other: Best<_>| if other.score > best.score { other } else { best };
    (1..bins).map(place).fold(place(0), higher)
}

/// Score of a box.
fn score<N: Number>(excess: N, expected: N) -> N {
    if excess > N::default() {
        let expected = expected.at_least(N::whole(1));
        let fraction = N::whole(64 * i64::from(EXCESS_FRACTION));
        excess.log2_64() + excess.log2_64() - expected.log2_64() - fraction
    } else {
        N::whole(NO_SCORE)
    }
}

/// Excess, expected count and twice the shots that wait in the middle of a bin.
fn of_bin<I: Instrument>(
    p: &I,
    shots: &Shots<I::Number>,
    light: &Light<I::Number>,
    bin: usize,
) -> [I::Number; 3] {
    let (ended, waiting, none) = (shots.ended(bin), shots.waiting(bin), I::Number::default());
    let terms = light.bin(ended, waiting).terms(p.words().histogram.count_bits);
    let added = if waiting > none { I::Number::constant(ADDED, A_TENTH) } else { none };
    let middle = (waiting + waiting - ended).at_least(none);
    [terms.residual.floored(-4) - added, terms.expected.floored(4) + added, middle]
}
