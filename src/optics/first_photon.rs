//! Effect of pile-up on an echo: the distribution of a shot's first avalanche, in closed form.
//!
//! A TDC registers the first avalanche of a shot, whose density is `f(t) = h(t) exp(-H(t))`, with the rate `h` and
//! its integral `H`: photons late in the pulse are seen only if none came before. The histogram's peak therefore
//! shifts to shorter times, the more so the stronger the echo, to the point where `h' = h^2` (order statistics,
//! thesis section 4.3; Coates, J. Phys. E 1, 1968). The mean of a weak Gaussian echo shifts by `-S sigma / (2
//! sqrt(pi))`: with probability S/2 there is a second photon, and the first of two is earlier by `sigma / sqrt(pi)`
//! on average.

use crate::kernel::Time;

use super::budget::{Budget, LIGHT_M_S};
use super::hazard::Hazard;

/// Number of intervals into which an echo is divided [1].
const STRETCHES: usize = 1024;
/// Number of adjacent intervals that are combined to locate the peak; with shorter ones, the segments of the
/// piecewise linear pulse would show [1].
const TOGETHER: usize = 4;

/// Distribution of first avalanches around the echo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstPhoton {
    /// Probability that a shot's first avalanche lies in the interval [1].
    pub chance: f64,
    /// Mean of their times, relative to the light's mean arrival [ps].
    pub mean_ps: f64,
    /// Most likely time, relative to the light's mean arrival [ps].
    pub peak_ps: f64,
}

/// Returns the time interval around the echo that is evaluated: from the nearest to the farthest light's mean
/// arrival, extended on both sides by half of the pulse's length, which is four sigma for a Gaussian.
pub fn around_the_echo(budget: &Budget) -> [Time; 2] {
    let [nearest, farthest] = budget.target_ends();
    let [before_ps, after_ps] = budget.pulse.reach_ps().map(|ps| ps / 2.0);
    let before = Time::from_ps_f64(-before_ps).min(nearest);
    [nearest - before, farthest + Time::from_ps_f64(after_ps)]
}

impl FirstPhoton {
    /// Computes the distribution for a shot of `budget` with the given hazard; `None` if no avalanche falls into the
    /// interval.
    pub fn new(budget: &Budget, hazard: &Hazard) -> Option<Self> {
        let [from, until] = around_the_echo(budget).map(|time| time.fs() as f64);
        let step = (until - from) / STRETCHES as f64;
        let time = |k: usize| from + k as f64 * step;
        let left: Vec<_> =
            (0..=STRETCHES).map(|k| hazard.none_before(Time::from_fs(time(k) as u64))).collect();
        let parts: Vec<_> = left.windows(2).map(|pair| pair[0] - pair[1]).collect();
        let chance: f64 = parts.iter().sum();
        if chance < f64::MIN_POSITIVE {
            return None;
        }
        let arrival = budget.mean_arrival.fs() as f64;
        let middle = |k: f64| time(0) + (k + 0.5) * step;
        let moment: f64 = (0..).zip(&parts).map(|(k, part)| middle(f64::from(k)) * part).sum();
        let mean_ps = (moment / chance - arrival) * 1e-3;
        let wide: Vec<f64> = parts.chunks(TOGETHER).map(|few| few.iter().sum()).collect();
        let most = (0..wide.len()).max_by(|&a, &b| wide[a].total_cmp(&wide[b])).unwrap_or(0);
        let place = (most as f64 + 0.5 + between(&wide, most)) * TOGETHER as f64;
        let peak_ps = (from + place * step - arrival) * 1e-3;
        Some(FirstPhoton { chance, mean_ps, peak_ps })
    }

    /// Converts a time to the corresponding distance [mm].
    pub fn shift_mm(ps: f64) -> f64 {
        ps * 1e-12 * LIGHT_M_S / 2.0 * 1e3
    }
}

/// Returns the vertex of the parabola through the largest value and its neighbours, relative to the largest value
/// [indices].
fn between(values: &[f64], largest: usize) -> f64 {
    let [Some(&before), Some(&after)] =
        [largest.checked_sub(1), Some(largest + 1)].map(|place| values.get(place?))
    else {
        return 0.0;
    };
    let bend = before - 2.0 * values[largest] + after;
    if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::kernel::pulse::Pulse;

    const SIGMA_PS: f64 = 137.0;

    fn budget(signal: f64, background_hz: f64) -> Budget {
        Budget {
            signal_per_shot: signal,
            ambient_rate_hz: background_hz,
            mean_arrival: Time::from_ns(4),
            pulse: Pulse::Gaussian { sigma_ps: SIGMA_PS },
            ..Budget::default()
        }
    }
    fn found(signal: f64, background_hz: f64) -> FirstPhoton {
        let budget = budget(signal, background_hz);
        FirstPhoton::new(&budget, &Hazard::new(&budget)).unwrap()
    }

    #[test]
    fn a_weak_echo_is_early_in_proportion_to_its_strength() {
        for signal in [0.003, 0.01, 0.03] {
            let expected = -signal / 2.0 / (1.0 + signal / 2.0) * SIGMA_PS / PI.sqrt();
            let shift = found(signal, 0.0).mean_ps;
            assert!((shift / expected - 1.0).abs() < 0.03, "{shift} for {expected}");
        }
    }

    #[test]
    fn most_come_where_the_rate_falls_as_fast_as_its_square() {
        for signal in [0.1, 1.0, 5.0, 39.4] {
            // -z = S phi(z), which falls in z.
            let rest = |z: f64| -z - signal * (-0.5 * z * z).exp() / (2.0 * PI).sqrt();
            let (mut low, mut high) = (-4.0, 0.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if rest(middle) > 0.0 { low = middle } else { high = middle }
            }
            let peak = found(signal, 0.0).peak_ps;
            assert!((peak - low * SIGMA_PS).abs() < 1.5, "{peak} for {}", low * SIGMA_PS);
        }
    }

    #[test]
    fn chance_and_mean_are_those_of_drawn_avalanches() {
        for (signal, background_hz) in [(0.2, 0.0), (2.0, 1e8), (20.0, 1e9), (0.05, 1e9)] {
            let budget = budget(signal, background_hz);
            let hazard = Hazard::new(&budget);
            let [from, until] = around_the_echo(&budget);
            let draws = 4_000_000;
            let time = |k: u32| {
                let part = (f64::from(k) + 0.5) / f64::from(draws);
                hazard.inverse(-libm::log1p(-part))
            };
            let within: Vec<_> =
                (0..draws).map(time).filter(|time| (from..until).contains(time)).collect();
            let sum: f64 = within.iter().map(|time| time.fs() as f64 * 1e-3).sum();
            let mean_ps = sum / within.len() as f64 - 4000.0;
            let found = found(signal, background_hz);
            let chance = within.len() as f64 / f64::from(draws);
            assert!((found.chance - chance).abs() < 2e-5, "{} for {chance}", found.chance);
            assert!((found.mean_ps - mean_ps).abs() < 0.05, "{} for {mean_ps}", found.mean_ps);
        }
    }

    #[test]
    fn without_light_there_is_no_first_photon() {
        let budget = budget(0.0, 0.0);
        assert_eq!(FirstPhoton::new(&budget, &Hazard::new(&budget)), None);
        assert!((FirstPhoton::shift_mm(6.671_281_9) - 1.0).abs() < 1e-6);
    }
}
