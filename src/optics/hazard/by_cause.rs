//! Parts of the hazard and of the rate by cause.

use crate::kernel::Time;

use super::Hazard;
use super::cause::{BY_CAUSE, Cause, cover_beside, cumulative, growth};

impl Hazard {
    /// Returns the increase of H from `from` to `until` due to each of [`BY_CAUSE`] [1].
    pub fn by_cause(&self, from: Time, until: Time) -> [f64; BY_CAUSE.len()] {
        let span = until.since(from).fs() as f64;
        let laser = self.at(until) - self.at(from) - self.background * span;
        let cover = self.cover_before(until) - self.cover_before(from);
        let dark = self.background - self.ambient;
        [(laser - cover).max(0.0), self.ambient * span, dark * span, cover]
    }

    /// Returns the window's part of H(t) [1].
    fn cover_before(&self, t: Time) -> f64 {
        let place = (t.fs() as f64 - self.first.time) / self.step;
        if t == Time::ZERO { 0.0 } else { self.signal * cumulative(&self.cover, place) }
    }

    /// Returns the rate of laser avalanches at `t`, S times the density of the pulse [1/s].
    pub fn signal_rate_hz(&self, t: Time) -> f64 {
        let place = (t.fs() as f64 - self.first.time) / self.step;
        self.signal * growth(&self.parts, place) / self.step * 1e15
    }

    /// Draws the cause of an avalanche at `t` in proportion to the rates; `uniform` is a random number from 0 to 1.
    /// At time 0 nearly all are laser photons that would have come before the laser edge.
    pub fn cause(&self, t: Time, uniform: f64) -> Cause {
        let place = (t.fs() as f64 - self.first.time) / self.step;
        let cover = self.signal * cover_beside(&self.cover, t, place, self.step);
        self.cause_beside([self.signal_per_fs(t), cover], uniform)
    }

    /// Returns the dark fraction of the rate at `t` [1].
    pub fn dark_part(&self, t: Time) -> f64 {
        self.dark_beside(self.signal_per_fs(t))
    }

    /// Returns the rate of laser avalanches at `t` [1/fs].
    fn signal_per_fs(&self, t: Time) -> f64 {
        let signal = self.signal_rate_hz(t) * 1e-15;
        if t == Time::ZERO { signal + self.after(0.0) } else { signal }
    }

    /// Returns the dark fraction of the rate, given the rate of laser avalanches [1/fs].
    pub(super) fn dark_beside(&self, signal: f64) -> f64 {
        let all = signal + self.background;
        if all > 0.0 { (self.background - self.ambient) / all } else { 0.0 }
    }

    /// Draws the cause of an avalanche, given the rate of laser avalanches and the window's part of it [1/fs].
    pub(super) fn cause_beside(&self, [laser, cover]: [f64; 2], uniform: f64) -> Cause {
        let draw = uniform * (laser + self.background);
        if draw < laser - cover {
            Cause::Signal
        } else if draw < laser {
            Cause::Cover
        } else if draw < laser + self.ambient {
            Cause::Ambient
        } else {
            Cause::Dark
        }
    }
}
