//! A shot whose laser pulse deviates from the mean in time and energy.
//!
//! H of such a shot is N t + e S F(t - mu - d), with the relative energy e and the delay d: F is the same piecewise
//! linear function, and only the nodes that a query needs are computed. Probabilities over all shots are averaged
//! over both deviations by the trapezoidal rule over six standard deviations, whose error for a normal weight is
//! below 1e-10.

use crate::kernel::Time;

use crate::optics::variation::Variation;

use super::Hazard;
use super::cause::{Cause, cover_beside, cumulative, growth};

/// Half width of the integration range [standard deviations].
const REACH: i32 = 6;
/// Number of integration steps per standard deviation.
const STEPS: i32 = 4;

/// The avalanche process of one such shot.
#[derive(Clone, Copy, Debug)]
pub struct Varied<'a> {
    hazard: &'a Hazard,
    /// Signal S of this shot [1].
    signal: f64,
    /// Delay of the pulse relative to the mean [fs].
    late: f64,
}

impl Hazard {
    /// Returns the process of a shot whose time and energy deviate by the given numbers of standard deviations; the
    /// energy is at least zero.
    pub fn varied(&self, [timing, energy]: [f64; 2]) -> Varied<'_> {
        let Variation { timing_ps, energy: spread } = self.variation;
        Varied {
            hazard: self,
            signal: self.signal * (1.0 + spread * energy).max(0.0),
            late: timing * timing_ps * 1e3,
        }
    }

    /// Returns the probability that a detector armed at the laser edge does not fire before `t`, averaged over shots
    /// [1].
    pub fn none_before(&self, t: Time) -> f64 {
        if self.variation.is_none() {
            libm::exp(-self.at(t))
        } else {
            self.mean(|shot| libm::exp(-shot.at(t)))
        }
    }

    /// Returns the probability that a detector armed at the laser edge fires before `until` and a laser photon from the
    /// scene is the cause, averaged over shots [1].
    pub fn signal_first(&self, until: Time) -> f64 {
        self.mean(|shot| shot.signal_first(until))
    }

    /// Averages a function over shots.
    pub fn mean(&self, of: impl Fn(&Varied) -> f64) -> f64 {
        let mut mean = 0.0;
        self.each(|weight, shot| mean += weight * of(shot));
        mean
    }

    /// Passes quadrature nodes of the shots' distribution to `take`, each with its weight.
    pub fn each(&self, mut take: impl FnMut(f64, &Varied)) {
        let Variation { timing_ps, energy } = self.variation;
        let normal = |spread: f64| -> Vec<(f64, f64)> {
            if spread == 0.0 {
                return vec![(0.0, 1.0)];
            }
            let places = (-REACH * STEPS..=REACH * STEPS).map(|k| f64::from(k) / f64::from(STEPS));
            let weights: Vec<_> = places.map(|z| (z, libm::exp(-0.5 * z * z))).collect();
            let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
            weights.into_iter().map(|(z, weight)| (z, weight / sum)).collect()
        };
        let (timings, energies) = (normal(timing_ps), normal(energy));
        for &(timing, weight) in &timings {
            for &(energy, share) in &energies {
                take(weight * share, &self.varied([timing, energy]));
            }
        }
    }
}

impl Varied<'_> {
    /// Returns the time of a node of the pulse [fs].
    fn time(&self, node: usize) -> f64 {
        self.hazard.first.time + self.late + node as f64 * self.hazard.step
    }

    /// Returns the number of segments.
    fn pieces(&self) -> usize {
        self.hazard.parts.len().saturating_sub(1)
    }

    /// Returns H at a node.
    fn node(&self, node: usize) -> f64 {
        self.hazard.background * self.time(node) + self.signal * self.hazard.parts[node]
    }

    /// Returns H immediately after a time [fs].
    fn after(&self, time: f64) -> f64 {
        let place = (time - self.time(0)) / self.hazard.step;
        if place < 0.0 || self.signal == 0.0 {
            self.hazard.background * time
        } else if place < self.pieces() as f64 {
            let node = (place as usize).min(self.pieces() - 1);
            let (below, above) = (self.node(node), self.node(node + 1));
            below + (place - node as f64) * (above - below)
        } else {
            self.hazard.background * time + self.signal
        }
    }

    /// Returns H(t), as [`Hazard::at`] does.
    pub fn at(&self, t: Time) -> f64 {
        if t == Time::ZERO { 0.0 } else { self.after(t.fs() as f64) }
    }

    /// Returns the first time with H(t) >= h, as [`Hazard::inverse`] does.
    pub fn inverse(&self, h: f64) -> Time {
        let dark = |h: f64| h * self.hazard.pause;
        if h <= 0.0 {
            return Time::ZERO;
        }
        if self.signal == 0.0 || h < self.node(0) {
            return Time::from_fs(dark(h) as u64);
        }
        if h >= self.node(self.pieces()) {
            // A step up, however small, so that without background it takes forever.
            let past = (h - self.node(self.pieces())).max(f64::MIN_POSITIVE);
            return Time::from_fs((self.time(self.pieces()) + dark(past)) as u64);
        }
        // The last node at or below `h` is between these two.
        let (mut low, mut high) = (0, self.pieces());
        while high - low > 1 {
            let middle = (low + high) / 2;
            if self.node(middle) <= h {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (below, above) = (self.node(low), self.node(high));
        let time = self.time(low) + self.hazard.step * ((h - below) / (above - below));
        Time::from_fs(time as u64)
    }

    /// Returns the place of a time between the nodes.
    fn place(&self, time: f64) -> f64 {
        (time - self.time(0)) / self.hazard.step
    }

    /// Draws the cause of an avalanche at `t`, as [`Hazard::cause`] does.
    pub fn cause(&self, t: Time, uniform: f64) -> Cause {
        let place = self.place(t.fs() as f64);
        let cover = self.signal * cover_beside(&self.hazard.cover, t, place, self.hazard.step);
        self.hazard.cause_beside([self.signal_per_fs(t), cover], uniform)
    }

    /// Returns the dark fraction of the rate at `t` [1].
    pub fn dark_part(&self, t: Time) -> f64 {
        self.hazard.dark_beside(self.signal_per_fs(t))
    }

    /// Returns the rate of laser avalanches at `t` [1/fs].
    fn signal_per_fs(&self, t: Time) -> f64 {
        let place = self.place(t.fs() as f64);
        let signal = self.signal * growth(&self.hazard.parts, place) / self.hazard.step;
        if t == Time::ZERO { signal + self.after(0.0) } else { signal }
    }

    /// Returns the probability that a detector armed at the laser edge fires before `until` and a laser photon from the
    /// scene is the cause [1].
    ///
    /// All rates are constant over a segment, so that the signal's share of the avalanches there equals its share of
    /// the hazard: the sum over segments is exact.
    pub fn signal_first(&self, until: Time) -> f64 {
        if self.signal == 0.0 || until == Time::ZERO {
            return 0.0;
        }
        let until = until.fs() as f64;
        // What the pulse would put before the laser edge arrives at it, and all of that is the laser's.
        let before = self.after(0.0);
        let mut chance = -libm::expm1(-before);
        let cover = &self.hazard.cover;
        if before > 0.0 {
            chance *= 1.0 - self.signal * cumulative(cover, self.place(0.0)) / before;
        }
        let mut from = self.time(0).max(0.0);
        let mut passed = before + self.hazard.background * from;
        for node in 0..self.pieces() {
            let end = self.time(node + 1).min(until);
            if end > from {
                let width = end - from;
                let parts = &self.hazard.parts;
                let rate = self.signal * (parts[node + 1] - parts[node]) / self.hazard.step;
                let hazard = width * (rate + self.hazard.background);
                if hazard > 0.0 {
                    let fires = -libm::exp(-passed) * libm::expm1(-hazard);
                    let from_cover = self.signal * growth(cover, node as f64) / self.hazard.step;
                    chance += fires * (width * (rate - from_cover) / hazard);
                }
                passed += hazard;
                from = end;
            }
        }
        chance
    }
}

#[cfg(test)]
mod tests;
