//! A shot whose laser pulse is late, or stronger than the mean.
//!
//! H of such a shot is N t + e S F(t - mu - d), with the part e of the mean energy and the delay d: the broken
//! line of F is the same, and only its nodes are worked out for each shot. What holds for shots of all kinds
//! is a mean over both, by the trapezoidal rule over six deviations, which for a normal weight errs by less
//! than 1e-10.

use crate::kernel::Time;

use crate::optics::variation::Variation;

use super::{Cause, Hazard};

/// How far a mean over shots goes, either side [standard deviations].
const REACH: i32 = 6;
/// Its steps to a standard deviation.
const STEPS: i32 = 4;

/// The avalanche process of one such shot.
#[derive(Clone, Copy, Debug)]
pub struct Varied<'a> {
    hazard: &'a Hazard,
    /// S of this shot [1].
    signal: f64,
    /// How late the pulse is [fs].
    late: f64,
}

impl Hazard {
    /// A shot whose pulse is so many standard deviations late, and above the mean energy; there is no
    /// energy below zero.
    pub fn varied(&self, [timing, energy]: [f64; 2]) -> Varied<'_> {
        let Variation { timing_ps, energy: spread } = self.variation;
        Varied {
            hazard: self,
            signal: self.signal * (1.0 + spread * energy).max(0.0),
            late: timing * timing_ps * 1e3,
        }
    }

    /// Chance that a detector armed at the laser edge does not fire before `t`, in the mean over shots [1].
    pub fn none_before(&self, t: Time) -> f64 {
        match self.variation.is_none() {
            true => libm::exp(-self.at(t)),
            false => self.mean(|shot| libm::exp(-shot.at(t))),
        }
    }

    /// Chance that a detector armed at the laser edge fires before `until`, and that a laser photon makes
    /// it fire, in the mean over shots [1].
    pub fn signal_first(&self, until: Time) -> f64 {
        self.mean(|shot| shot.signal_first(until))
    }

    /// A mean over shots.
    pub fn mean(&self, of: impl Fn(&Varied) -> f64) -> f64 {
        let mut mean = 0.0;
        self.each(|weight, shot| mean += weight * of(shot));
        mean
    }

    /// Shows kinds of shots, and what part of all each stands for.
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
    /// When a node of the pulse comes [fs].
    fn time(&self, node: usize) -> f64 {
        self.hazard.first.time + self.late + node as f64 * self.hazard.step
    }

    /// Pieces of the broken line.
    fn pieces(&self) -> usize {
        self.hazard.parts.len().saturating_sub(1)
    }

    /// H at a node.
    fn node(&self, node: usize) -> f64 {
        self.hazard.background * self.time(node) + self.signal * self.hazard.parts[node]
    }

    /// H just after a time [fs].
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

    /// H(t): see [`Hazard::at`].
    pub fn at(&self, t: Time) -> f64 {
        if t == Time::ZERO { 0.0 } else { self.after(t.fs() as f64) }
    }

    /// The first time with H(t) >= h: see [`Hazard::inverse`].
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

    /// Rate of laser photons' avalanches at a time [1/fs].
    fn signal_rate(&self, time: f64) -> f64 {
        let place = (time - self.time(0)) / self.hazard.step;
        let node = place as usize;
        match self.hazard.parts.get(node..node.saturating_add(2)) {
            Some(piece) if place >= 0.0 => self.signal * (piece[1] - piece[0]) / self.hazard.step,
            _ => 0.0,
        }
    }

    /// What caused an avalanche at `t`: see [`Hazard::cause`].
    pub fn cause(&self, t: Time, uniform: f64) -> Cause {
        self.hazard.cause_beside(self.signal_per_fs(t), uniform)
    }

    /// The part of the rate at `t` that comes without any light [1].
    pub fn dark_part(&self, t: Time) -> f64 {
        self.hazard.dark_beside(self.signal_per_fs(t))
    }

    /// Rate of laser photons' avalanches at `t` [1/fs].
    fn signal_per_fs(&self, t: Time) -> f64 {
        let signal = self.signal_rate(t.fs() as f64);
        if t == Time::ZERO { signal + self.after(0.0) } else { signal }
    }

    /// Chance that a detector armed at the laser edge fires before `until`, and that a laser photon makes
    /// it fire [1].
    ///
    /// Over a piece of the broken line both rates are constant, so that the signal's share of the
    /// avalanches there is its share of the hazard: a sum over the pieces is exact.
    pub fn signal_first(&self, until: Time) -> f64 {
        if self.signal == 0.0 || until == Time::ZERO {
            return 0.0;
        }
        let until = until.fs() as f64;
        // What the pulse would put before the laser edge arrives at it, and all of that is signal.
        let before = self.after(0.0);
        let mut chance = -libm::expm1(-before);
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
                    chance += fires * (width * rate / hazard);
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
