//! A step of Fisher scoring in (mu, log S, log b).

use std::ops::Range;

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::{length, reciprocal};
use crate::firmware::likelihood_estimator::words::{
    AMBIENT_FRACTION, HAZARD_FRACTION, QUOTIENT_FRACTION, RESIDUAL_FRACTION, SIGNAL_FRACTION,
    UNITS, WEIGHT_FRACTION,
};
use crate::kernel::wrapped;

use super::arithmetic::{clamped, product, shifted};
use super::histogram::{MOST, Shots};
use super::scan::Best;
use super::terms::{Bin, Terms};

/// Fraction bits of quotients.
const Q: i64 = QUOTIENT_FRACTION as i64;
/// One.
const ONE: i64 = 1 << Q;
/// One count as weights have it.
const COUNT: i64 = 1 << WEIGHT_FRACTION;
/// Bits of the 2 x 2 rest of the information.
const REST_BITS: u32 = 16;
/// Smallest signal.
const LEAST_SIGNAL: i64 = 16;

/// Parameters of the scene in a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Arrival of the echo [units / 16].
    pub arrival: i64,
    /// S [photons a shot, 14 fraction bits].
    pub signal: i64,
    /// b [1 / unit, 30 fraction bits].
    pub ambient: i64,
}

/// Intermediate values of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Information {
    /// The rest for log S and its exponent.
    pub a22: i64,
    /// The rest for mu.
    pub a11: i64,
    /// The determinant of the rest.
    pub determinant: i64,
    /// By how many bits the rest was shifted.
    pub exponent: i64,
    /// By how many bits the step was shortened.
    pub cut: u32,
    /// Change of mu [units / 16].
    pub move_by: i64,
}

impl Point {
    /// Returns the first point of a fit, where a box stands highest.
    pub fn start(p: &Params, best: &Best, ambient: i64) -> Self {
        let (from, until) = best.bins;
        let (mantissa, bits) = reciprocal(best.waiting.max(1));
        let excess = wrapped(best.excess << 4, p.word_bits());
        let rate = product(excess, mantissa, bits.into(), p.word_bits());
        // 0.84 of the pulse are in the box, and 19/16 is one over that.
        let signal = shifted(shifted(rate * (until - from) as i64, 13) * 19, 4);
        Point {
            arrival: (from + until) as i64 * (UNITS / 2) * 16,
            signal: signal.clamp(LEAST_SIGNAL, MOST),
            ambient,
        }
    }

    /// Bins of the fit.
    pub fn window(&self, p: &Params) -> Range<usize> {
        let bins = p.histogram.bins;
        let centre = ((self.arrival / UNITS / 16) as usize).min(bins - 1);
        centre.saturating_sub(p.before)..(centre + p.after + 1).min(bins)
    }

    /// The pulse at an edge: the part that came before, straight between two words of its ROM, and the slopes.
    fn pulse(&self, p: &Params, edge: usize) -> [i64; 3] {
        let time = (i64::from(p.edges[edge]) << 3) - self.arrival;
        let place = (time >> (p.step_log2 + 4)).clamp(-1024, 1022);
        let word = |place: i64| p.pulse[(place + 1024) as usize];
        let (low, high) = (word(place), word(place + 1));
        let sixteenths = (time >> p.step_log2) & 15;
        let part = low.part + (((high.part - low.part) * sixteenths) >> 4);
        [part, low.slope, low.first]
    }

    /// Computes the terms of each bin of a fit, with its z, followed by all other bins as one.
    pub fn terms(&self, p: &Params, shots: &Shots) -> Vec<(Terms, i64)> {
        let window = self.window(p);
        let [mut part, mut slope, _] = match window.start {
            0 => [0; 3],
            first => self.pulse(p, first),
        };
        let (mut ended, mut exposure) = (shots.all_ended, shots.exposure);
        let mut all = Vec::with_capacity(window.len() + 1);
        for bin in window {
            let [next, next_slope, first] = self.pulse(p, bin + 1);
            let z = if bin == 0 { first } else { (slope + next_slope) >> 1 };
            let (count, waiting, width) =
                (i64::from(shots.ended[bin]), shots.waiting[bin], p.width(bin));
            ended -= count;
            exposure -= waiting * width;
            let terms = match width {
                0 => Terms::default(),
                _ => self.bin(p, count, waiting, next - part, width),
            };
            all.push((terms, z));
            (part, slope) = (next, next_slope);
        }
        let most = (1 << (p.histogram.count_bits + p.histogram.bins.ilog2())) - 1;
        all.push((self.bin(p, ended, (exposure >> 6).min(most), 0, UNITS), 0));
        all
    }

    fn bin(&self, p: &Params, ended: i64, waiting: i64, part: i64, width: i64) -> Terms {
        let signal = shifted(self.signal * part, i64::from(17 + SIGNAL_FRACTION - HAZARD_FRACTION));
        let ambient = shifted(self.ambient * width, i64::from(AMBIENT_FRACTION - HAZARD_FRACTION));
        Bin { ended, waiting, signal, ambient }.terms(p.histogram.count_bits)
    }
}

/// Sums over the bins: the information of (mu, log S, log b), and the score.
#[derive(Clone, Copy, Debug)]
struct Sums {
    a11: i64,
    a12: i64,
    a13: i64,
    a22: i64,
    a23: i64,
    a33: i64,
    y1: i64,
    y2: i64,
    y3: i64,
}

impl Sums {
    /// With a ridge of a count for log b and of a 16th for the others.
    fn new(terms: &[(Terms, i64)]) -> Self {
        let mut sums = Sums {
            a11: COUNT >> 4 << 1,
            a12: 0,
            a13: 0,
            a22: COUNT >> 4,
            a23: 0,
            a33: COUNT,
            y1: 0,
            y2: 0,
            y3: 0,
        };
        for &(Terms { residual, weight, share, .. }, z) in terms {
            let of = |value: i64| shifted(value * share, 12);
            let (once, seen) = (of(weight), of(residual));
            let twice = of(once);
            sums.a11 += ((twice * z) >> 9) * z;
            sums.a12 += twice * z;
            sums.a13 += (once - twice) * z;
            sums.a22 += twice;
            sums.a23 += once - twice;
            sums.a33 += weight - 2 * once + twice;
            sums.y1 += seen * z;
            sums.y2 += seen;
            sums.y3 += residual - seen;
        }
        // mu counts in 32 of z, and residuals as weights do.
        let residual = i64::from(WEIGHT_FRACTION - RESIDUAL_FRACTION);
        sums.a11 >>= 1;
        sums.a12 >>= 5;
        sums.a13 >>= 5;
        sums.y1 >>= 5 - residual;
        sums.y2 <<= residual;
        sums.y3 <<= residual;
        sums
    }
}

/// One step from a point.
pub fn step(p: &Params, shots: &Shots, from: &Point) -> (Point, Information) {
    let word = p.word_bits();
    let keep = |value: i64| clamped(value, word);
    let times = |a: i64, b: i64| shifted(a.wrapping_mul(b), Q);
    let Sums { a11, a12, a13, a22, a23, a33, y1, y2, y3 } = Sums::new(&from.terms(p, shots));
    // log b is eliminated.
    let (over_a33, bits) = reciprocal(a33.max(1));
    let by_a33 = |a: i64| product(a, over_a33, i64::from(bits) + 16 - Q, word);
    let [f1, f2, f3] = [a13, a23, y3].map(by_a33);
    let mut a11 = keep(a11 - times(a13, f1)).max(1);
    let mut a12 = keep(a12 - times(a23, f1));
    let mut a22 = keep(a22 - times(a23, f2)).max(1);
    let (mut x1, mut x2) = (keep(y1 - times(y3, f1)), keep(y2 - times(y3, f2)));
    // The rest is shifted to 16 bits, and solved by Cramer's rule.
    let longest = length(a11 | a22 | x1.abs() | x2.abs());
    let exponent = i64::from(longest.saturating_sub(REST_BITS));
    for value in [&mut a11, &mut a12, &mut a22, &mut x1, &mut x2] {
        *value = shifted(*value, exponent);
    }
    let minus = |c: i64, a: i64, b: i64| keep(keep(c).wrapping_sub(a.wrapping_mul(b)));
    let determinant = minus(a11 * a22, a12, a12).max(1);
    let (over, bits) = reciprocal(determinant);
    let solved = |a: i64| product(a, over, i64::from(bits) + 16 - Q, word);
    let mut d1 = solved(minus(a22 * x1, a12, x2));
    let mut d2 = solved(minus(a11 * x2, a12, x1));
    // Steps that are too long, of 32 of z or a whole log S, are halved together.
    let along = product(d1, p.kappa, 14, word);
    let cut = length(along.abs() | d2.abs()).saturating_sub(QUOTIENT_FRACTION);
    for value in [&mut d1, &mut d2] {
        *value = shifted(*value, cut.into());
    }
    let d3 = keep(f3 - times(f1, d1)) - times(f2, d2);
    let move_by = product(d1, p.stride(), 17, word);
    let growth = keep(d2 + shifted(d2 * d2, Q + 1));
    let to = Point {
        arrival: (from.arrival + move_by).clamp(0, p.end()),
        signal: (from.signal + times(from.signal, growth)).clamp(LEAST_SIGNAL, MOST),
        ambient: (from.ambient + times(from.ambient, d3.clamp(-ONE / 2, 3 * ONE))).clamp(1, MOST),
    };
    (to, Information { a22, a11, determinant, exponent, cut, move_by })
}
