//! A point of the fit, and what each bin says of it.

use crate::firmware::likelihood_estimator::words::{
    AMBIENT_FRACTION, HAZARD_FRACTION, LEAST_SIGNAL, MOST_LEVEL, SIGNAL_FRACTION, UNITS,
};

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::{Number, product};
use super::scan::Best;
use super::terms::{Bin, Terms};

/// The part of a pulse in the box.
const IN_BOX: f64 = 0.84;

/// Parameters of the scene in a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<N> {
    /// Arrival of the echo [units / 16].
    pub arrival: N,
    /// S [photons a shot, 14 fraction bits].
    pub signal: N,
    /// b [1 / unit, 30 fraction bits].
    pub ambient: N,
}

impl<N: Number> Point<N> {
    /// Returns the first point of a fit, where a box stands highest.
    pub fn start(p: &impl Instrument<Number = N>, best: &Best<N>, ambient: N) -> Self {
        let (from, until) = best.bins;
        let word = p.words().word_bits();
        let (mantissa, bits) = best.waiting.at_least(N::whole(1)).reciprocal();
        let excess = best.excess.floored(-4).wrapped(word);
        let rate = product(excess, mantissa, bits, word);
        let bins = N::whole((until - from) as i64);
        let signal = ((rate * bins).shifted(13) * N::constant(19, 16.0 / IN_BOX)).shifted(4);
        Point {
            arrival: N::whole((from + until) as i64 * (UNITS / 2) * 16),
            signal: signal.within([LEAST_SIGNAL, MOST_LEVEL].map(N::whole)),
            ambient,
        }
    }

    /// Computes the terms of each bin of a fit, with its z, followed by all other bins as one.
    pub fn terms(&self, p: &impl Instrument<Number = N>, shots: &Shots<N>) -> Vec<(Terms<N>, N)> {
        let (window, none) = (p.window(self.arrival), N::default());
        let [mut part, mut slope, _] = match window.start {
            0 => [none; 3],
            first => p.pulse(first, self.arrival),
        };
        let (mut ended, mut exposure) = (shots.all_ended, shots.exposure);
        let mut all = Vec::with_capacity(window.len() + 1);
        for bin in window {
            let [next, next_slope, first] = p.pulse(bin + 1, self.arrival);
            let z = if bin == 0 { first } else { (slope + next_slope).floored(1) };
            let (count, waiting, width) = (shots.ended(bin), shots.waiting(bin), p.width(bin));
            ended = ended - count;
            exposure = exposure - waiting * width;
            let terms = if p.has(bin) {
                self.bin(p, count, waiting, [next - part, width])
            } else {
                Terms::default()
            };
            all.push((terms, z));
            (part, slope) = (next, next_slope);
        }
        let size = p.words().histogram;
        let waiting =
            exposure.floored(UNITS.ilog2().into()).filled(size.count_bits + size.bins.ilog2());
        all.push((self.bin(p, ended, waiting, [none, N::whole(UNITS)]), none));
        all
    }

    /// Terms of a bin of some width with a part of the pulse.
    fn bin(
        &self,
        p: &impl Instrument<Number = N>,
        ended: N,
        waiting: N,
        [part, width]: [N; 2],
    ) -> Terms<N> {
        let signal = self.signal * part;
        let signal = signal.shifted(i64::from(17 + SIGNAL_FRACTION - HAZARD_FRACTION));
        let ambient = self.ambient * width;
        let ambient = ambient.shifted(i64::from(AMBIENT_FRACTION - HAZARD_FRACTION));
        Bin { ended, waiting, signal, ambient }.terms(p.words().histogram.count_bits)
    }
}
