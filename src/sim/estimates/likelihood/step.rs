//! A step of Fisher scoring in (mu, log S, log b).

use crate::firmware::likelihood_estimator::words::{
    LEAST_SIGNAL, MOST_LEVEL, QUOTIENT_FRACTION, SCARCE,
};

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::{Number, product};
use super::point::Point;
use super::sums::{GlassSums, Sums};

/// Fraction bits of quotients.
const Q: i64 = QUOTIENT_FRACTION as i64;
/// One.
const ONE: i64 = 1 << Q;
/// Bits of the 2 x 2 rest of the information.
const REST_BITS: u32 = 16;

/// Intermediate values of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Information<N> {
    /// The rest for log S and its exponent.
    pub a22: N,
    /// The rest for mu.
    pub a11: N,
    /// The determinant of the rest.
    pub determinant: N,
    /// By how many bits the rest was shifted.
    pub exponent: i64,
    /// By how many bits the step was shortened.
    pub cut: u32,
    /// Change of mu [units / 16].
    pub move_by: N,
}

/// One step from a point.
pub fn step<I: Instrument>(
    p: &I,
    shots: &Shots<I::Number>,
    from: &Point<I::Number>,
) -> (Point<I::Number>, Information<I::Number>) {
    let (word, scales) = (p.words().word_bits(), p.scales());
    let (whole, one) = (I::Number::whole, I::Number::whole(1));
    let times = |a: I::Number, b: I::Number| a.times(b).shifted(Q);
    let sums = Sums::new(&from.terms(p, shots), from.other.is_some());
    let (sums, along_glass) =
        if p.has_glass() { without_glass(&sums, word) } else { (sums, [whole(0); 4]) };
    let Sums { a11, a12, a13, a22, a23, a33, y1, y2, y3, .. } = sums;
    let scarce = a33 < whole(SCARCE);
    // log b is eliminated.
    let (over_a33, bits) = a33.at_least(one).reciprocal();
    let [f1, f2, f3] = [a13, a23, y3].map(|a| product(a, over_a33, bits + 16 - Q, word));
    let a11 = (a11 - times(a13, f1)).kept(word).at_least(one);
    let a12 = (a12 - times(a23, f1)).kept(word);
    let a22 = (a22 - times(a23, f2)).kept(word).at_least(one);
    let [x1, x2] = [(y1, f1), (y2, f2)].map(|(y, f)| (y - times(y3, f)).kept(word));
    // The rest is shifted to 16 bits, and solved by Cramer's rule.
    let longest = I::Number::bits(&[a11, a22, x1.abs(), x2.abs()]);
    let exponent = i64::from(longest.saturating_sub(REST_BITS));
    let [a11, a12, a22, x1, x2] = [a11, a12, a22, x1, x2].map(|value| value.shifted(exponent));
    let minus = |c: I::Number, a, b| c.kept(word).less(a, b).kept(word);
    let determinant = minus(a11 * a22, a12, a12).at_least(I::Number::LEAST);
    let (over, bits) = determinant.reciprocal();
    let solved = |a| product(a, over, bits + 16 - Q, word);
    let [d1, d2] = [minus(a22 * x1, a12, x2), minus(a11 * x2, a12, x1)].map(solved);
    // Steps that are too long, of 32 of z or a whole log S, are halved together.
    let along = product(d1, scales.kappa, 14, word);
    let cut = I::Number::bits(&[along.abs(), d2.abs()]).saturating_sub(QUOTIENT_FRACTION);
    let [d1, d2] = [d1, d2].map(|value| value.shifted(cut.into()));
    let d3 = (f3 - times(f1, d1)).kept(word) - times(f2, d2);
    let move_by = product(d1, scales.stride, 17, word);
    let growth = (d2 + (d2 * d2).shifted(Q + 1)).kept(word);
    // b does not fall while the point is far off, or little is known of it.
    let lowest = if scarce || cut > 0 { 0 } else { -ONE / 2 };
    let fall = d3.within([lowest, 3 * ONE].map(whole));
    let [g1, g2, g3, g4] = along_glass;
    let more = ((g4 - times(g1, d1)).kept(word) - times(g2, d2)).kept(word);
    let of_glass =
        ((more - times(g3, fall)).kept(word) + fall).within([-ONE / 2, 3 * ONE].map(whole));
    let to = Point {
        arrival: (from.arrival + move_by).within([whole(0), scales.end]),
        signal: if from.signal > whole(0) {
            (from.signal + times(from.signal, growth)).within([LEAST_SIGNAL, MOST_LEVEL].map(whole))
        } else {
            from.signal
        },
        ambient: (from.ambient + times(from.ambient, fall)).within([1, MOST_LEVEL].map(whole)),
        glass: if p.has_glass() {
            (from.glass + times(from.glass, of_glass)).within([LEAST_SIGNAL, MOST_LEVEL].map(whole))
        } else {
            from.glass
        },
        other: from.other,
    };
    (to, Information { a22, a11, determinant, exponent, cut, move_by })
}

/// Eliminates the logarithm of the cover glass's light. Returns what it falls by with mu, log S and log b, and its own
/// step.
fn without_glass<N: Number>(sums: &Sums<N>, word: u32) -> (Sums<N>, [N; 4]) {
    let GlassSums { a14, a24, a34, a44, y4 } = sums.glass;
    let (over_a44, bits) = a44.at_least(N::whole(1)).reciprocal();
    let [g1, g2, g3, g4] = [a14, a24, a34, y4].map(|a| product(a, over_a44, bits + 16 - Q, word));
    let less = |value: N, a: N, g: N| (value - a.times(g).shifted(Q)).kept(word);
    let rest = Sums {
        a11: less(sums.a11, a14, g1),
        a12: less(sums.a12, a24, g1),
        a13: less(sums.a13, a34, g1),
        a22: less(sums.a22, a24, g2),
        a23: less(sums.a23, a34, g2),
        a33: less(sums.a33, a34, g3).at_least(N::whole(1)),
        y1: less(sums.y1, y4, g1),
        y2: less(sums.y2, y4, g2),
        y3: less(sums.y3, y4, g3),
        ..*sums
    };
    (rest, [g1, g2, g3, g4])
}
