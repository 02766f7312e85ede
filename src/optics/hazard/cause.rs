//! Causes of avalanches, and their parts of the rate.

use crate::kernel::Time;

use super::Hazard;

/// Cause of an avalanche.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// A laser photon from the scene.
    Signal,
    /// Ambient light.
    Ambient,
    /// A dark count.
    Dark,
    /// A trapped carrier from an earlier avalanche.
    Afterpulse,
    /// A laser photon that the cover window sent back.
    Cover,
}

/// Causes that the light and the dark of a shot have by themselves, in the order of sums by cause.
pub const BY_CAUSE: [Cause; 4] = [Cause::Signal, Cause::Ambient, Cause::Dark, Cause::Cover];

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

/// Returns the increase of a piecewise linear function from the node before a place to the next; 0 beyond its ends.
pub fn growth(nodes: &[f64], place: f64) -> f64 {
    let node = place as usize;
    match nodes.get(node..node.saturating_add(2)) {
        Some(piece) if place >= 0.0 => piece[1] - piece[0],
        _ => 0.0,
    }
}

/// Returns a piecewise linear function at a place between its nodes; 0 before the first, constant from the last on.
pub fn cumulative(nodes: &[f64], place: f64) -> f64 {
    let Some(last) = nodes.last().filter(|_| place >= 0.0) else { return 0.0 };
    let below = nodes.get(place as usize).unwrap_or(last);
    below + place.fract() * growth(nodes, place)
}

/// Returns the window's part of the rate of a unit of laser light at `t`, as far as it has not arrived at the laser edge;
/// at 0, that with what the pulse would put before [1/fs].
pub fn cover_beside(cover: &[f64], t: Time, place: f64, step: f64) -> f64 {
    let rate = growth(cover, place) / step;
    if t == Time::ZERO { rate + cumulative(cover, place) } else { rate }
}
