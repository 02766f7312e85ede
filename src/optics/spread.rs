//! Temporal distribution of light from surfaces and air at various distances and from a cover window, each with the
//! laser's pulse.
//!
//! The parts are placed on a uniform time grid such that their mean is preserved, and convolved with the pulse. A
//! step is 1/1024 of the pulse's length, 1/64 sigma of a Gaussian, unless that would be more than 65,000 steps; then
//! it is 1/65,000 of the whole. A piecewise linear function with steps of s sigma deviates by at most 0.03 s^2 of an
//! echo, and placing an echo on the grid increases its variance of 1 sigma^2 by at most s^2 / 4. The pixels of an array
//! in air have a quarter of the steps: 1.2e-4 of an echo, 0.1 % of the variance.

use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;

use super::cover::Delays;
use super::returned::{Haze, Light, Returned};

/// Number of steps per length of a pulse.
pub const FINE: f64 = 1024.0;
/// Number of steps per length of a pulse, for each of many pixels in air.
pub const COARSE: f64 = 256.0;
/// Largest number of steps.
const MOST: usize = 65_000;
/// Time of flight to a distance of one metre and back, 2 / c [fs/m].
const FS_PER_M: f64 = 2e15 / 299_792_458.0;

/// Cumulative light of each kind over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// First node, from the laser edge [fs].
    pub from: f64,
    /// Time between nodes [fs].
    pub step: f64,
    /// Cumulative fraction at the nodes, for each of the [`ORIGINS`]; empty if there is no such light [1].
    parts: [Arc<[f64]>; ORIGINS],
    /// Arrival times of the middle of the pulse from the nearest and from the farthest part of the target.
    pub ends: [Time; 2],
}

/// Number of origins of laser light: diffuse reflection, a retroreflective patch, a second surface, the air, and the
/// cover window.
pub const ORIGINS: usize = 5;

/// A uniform time grid.
struct Grid {
    /// Time of its first point, from the emission of the pulse [fs].
    from: f64,
    step: f64,
    /// Light at each point.
    weights: Vec<f64>,
}

impl Spread {
    /// Computes the distribution of the returned light from distances up to `horizon_m`, with so many steps per pulse,
    /// and the total backscatter of the air [1/m^2].
    pub fn new(
        returned: &Returned,
        cover: Option<&Delays>,
        pulse: &Pulse,
        delay: Time,
        horizon_m: f64,
        per_pulse: f64,
    ) -> (Self, f64) {
        let [begin_ps, end_ps] = pulse.reach_ps();
        let (begin, length) = (begin_ps * 1e3, (end_ps - begin_ps) * 1e3);
        let surfaces_m = returned.surface_ends_m().unwrap_or([horizon_m; 2]);
        let [near_m, far_m] = match &returned.air {
            Some(haze) => {
                [surfaces_m[0].min(haze.nearest_m()), surfaces_m[1].max(haze.farthest_m())]
            }
            None => surfaces_m,
        };
        let [near_m, far_m] = [near_m.min(horizon_m), far_m.min(horizon_m)];
        let (mut from, mut long) = (near_m * FS_PER_M, (far_m - near_m) * FS_PER_M);
        if let Some([cover_from, cover_until]) = cover.map(Delays::reach_fs) {
            let until = (from + long).max(cover_until.min(horizon_m * FS_PER_M));
            from = from.min(cover_from);
            long = until - from;
        }
        let step = (length / per_pulse).max((long + length) / MOST as f64);
        let places = (long / step).ceil() as usize + 2;
        let grid = || Grid { from, step, weights: vec![0.0; places] };
        let kernel: Vec<_> = (0..)
            .map(|k| f64::from(k) * step)
            .take_while(|since| *since < length)
            .map(|since| if since == 0.0 { 0.0 } else { pulse.part((begin + since) * 1e-3) })
            .collect();
        let Returned { diffuse, retro, second, .. } = returned;
        let [diffuse, retro, second] = [diffuse, retro, second].map(|light| {
            let mut grid = grid();
            grid.add_surfaces(light, horizon_m);
            grid.blurred(&kernel)
        });
        let mut air = grid();
        returned.air.iter().for_each(|haze| air.add_air(haze, horizon_m));
        let sent_back = air.weights.iter().sum();
        let mut window = grid();
        cover.into_iter().for_each(|delays| window.add_cover(delays));
        let target_m = returned.target_ends_m().unwrap_or([horizon_m; 2]);
        let place = |at_m: f64| delay + Time::from_ps_f64(at_m * FS_PER_M * 1e-3);
        let spread = Spread {
            from: delay.fs() as f64 + from + begin,
            step,
            parts: [diffuse, retro, second, air.blurred(&kernel), window.blurred(&kernel)],
            ends: target_m.map(place),
        };
        (spread, sent_back)
    }

    /// Returns the cumulative light of the cover window at the nodes, as a fraction of all light, for the given amounts
    /// of each origin; empty without a window.
    pub fn of_cover(&self, amounts: [f64; ORIGINS]) -> Arc<[f64]> {
        let [.., amount] = amounts;
        let [.., parts] = &self.parts;
        if amount == 0.0 {
            return Arc::default();
        }
        let sum: f64 = amounts.iter().sum();
        parts.iter().map(|part| amount / sum * part).collect()
    }

    /// Returns the cumulative fraction of all light at the nodes, for the given amounts of each origin.
    pub fn of(&self, amounts: [f64; ORIGINS]) -> Arc<[f64]> {
        let sum: f64 = amounts.iter().sum();
        let nodes = self.parts.iter().map(|parts| parts.len()).max().unwrap_or(0);
        let mut all = vec![0.0; nodes];
        for (parts, amount) in self.parts.iter().zip(amounts) {
            all.iter_mut().zip(parts.iter()).for_each(|(all, part)| *all += amount / sum * part);
        }
        if let Some(last) = all.last_mut() {
            *last = 1.0;
        }
        // Sums in another order may be an ulp less.
        let mut most = 0.0f64;
        all.iter_mut().for_each(|part| {
            most = most.max(part.min(1.0));
            *part = most;
        });
        all.into()
    }
}

impl Grid {
    /// Adds light at a time from the emission of the pulse [fs].
    fn add(&mut self, time: f64, weight: f64) {
        let last = self.weights.len() - 2;
        let place = ((time - self.from) / self.step).max(0.0);
        let node = (place as usize).min(last);
        let part = (place - node as f64).min(1.0);
        self.weights[node] += weight * (1.0 - part);
        self.weights[node + 1] += weight * part;
    }

    fn add_surfaces(&mut self, light: &Light, horizon_m: f64) {
        for &[at_m, spread_m, weight] in light.parts() {
            let (at, long) = (at_m.min(horizon_m) * FS_PER_M, 12f64.sqrt() * spread_m * FS_PER_M);
            let pieces = (long / self.step).ceil().max(1.0);
            for piece in 0..pieces as usize {
                let from_middle = (piece as f64 + 0.5) / pieces - 0.5;
                self.add(at + from_middle * long, weight / pieces);
            }
        }
    }

    fn add_air(&mut self, haze: &Haze, horizon_m: f64) {
        let at_m = |place: usize| (self.from + place as f64 * self.step) / FS_PER_M;
        let cells: Vec<_> = (0..self.weights.len() - 1)
            .map(|place| [at_m(place).max(haze.nearest_m()), at_m(place + 1).min(horizon_m)])
            .filter(|[near_m, far_m]| near_m < far_m)
            .collect();
        for [near_m, far_m] in cells {
            let weight = haze.sends_back(near_m, far_m);
            self.add((near_m + far_m) / 2.0 * FS_PER_M, weight);
        }
    }

    /// Adds light of the cover window, whose end comes at the end of the grid.
    fn add_cover(&mut self, delays: &Delays) {
        self.add(delays.at_fs, delays.exact());
        let (mut before, mut left) = (0.0, 1.0 - delays.exact());
        for place in 0..self.weights.len() - 1 {
            let from = self.from + place as f64 * self.step;
            let part = delays.spread_before(from + self.step);
            self.add(from + self.step / 2.0, part - before);
            (before, left) = (part, left - (part - before));
        }
        let end = self.from + self.weights.len() as f64 * self.step;
        self.add(end, left.max(0.0));
    }

    /// Returns the cumulative light at each node, from the start of the pulse at the first point to its end at the
    /// last one, where `kernel` is the cumulative pulse; empty without light [1].
    fn blurred(&self, kernel: &[f64]) -> Arc<[f64]> {
        let sum: f64 = self.weights.iter().sum();
        if sum <= 0.0 {
            return Arc::default();
        }
        let mut parts = vec![0.0; self.weights.len() + kernel.len()];
        // What has come with all of its pulse, and what is on its way.
        let mut begun = vec![0.0; parts.len()];
        for (place, weight) in self.weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0)
        {
            let part = weight / sum;
            begun[place + kernel.len()] += part;
            let nodes = &mut parts[place..place + kernel.len()];
            nodes.iter_mut().zip(kernel).for_each(|(node, come)| *node += part * come);
        }
        let mut whole = 0.0;
        for (part, begun) in parts.iter_mut().zip(begun) {
            whole += begun;
            *part += whole;
        }
        parts.into()
    }
}

#[cfg(test)]
mod tests;
