//! A pulse of light as the detector times it: how the arrivals of an echo's photons are spread around their mean.

mod sampled;
mod short_tail;

use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

use statrs::function::erf::erfc_inv;

pub use sampled::{Samples, Unusable};
use short_tail::ShortTail;

/// Part of a pulse that may be cut off: that beyond 4.5 deviations of a Gaussian.
const TAIL: f64 = 3.4e-6;
/// Ends of a Gaussian that is cut so [standard deviations].
const GAUSSIAN_END: f64 = 4.5;
/// A Gaussian's part beyond is nothing [standard deviations].
const GAUSSIAN_REACH: f64 = 8.0;
/// Reach of an exponential tail, beyond which 4e-11 of it is left [time constants].
const TAIL_REACH: f64 = 24.0;

/// Distribution of the arrivals of an echo's photons around their mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Pulse {
    /// A normal distribution.
    Gaussian {
        /// Its standard deviation [ps].
        sigma_ps: f64,
    },
    /// A normal time plus an exponential one, as of a diode to whose junction carriers diffuse.
    Tailed {
        /// Standard deviation of the normal time [ps].
        sigma_ps: f64,
        /// Mean of the exponential one, more than zero [ps].
        tail_ps: f64,
    },
    /// A measured density.
    Sampled(Samples),
}

/// Pulse of the thesis: a Gaussian of 137 ps.
impl Default for Pulse {
    fn default() -> Self {
        Pulse::Gaussian { sigma_ps: 137.0 }
    }
}

impl Pulse {
    /// A normal time plus an exponential one, of which there may be none.
    pub fn tailed(sigma_ps: f64, tail_ps: f64) -> Self {
        if tail_ps > 0.0 {
            Pulse::Tailed { sigma_ps, tail_ps }
        } else {
            Pulse::Gaussian { sigma_ps }
        }
    }

    /// Standard deviation of the whole [ps].
    pub fn sigma_ps(&self) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => *sigma_ps,
            Pulse::Tailed { sigma_ps, tail_ps } => sigma_ps.hypot(*tail_ps),
            Pulse::Sampled(samples) => samples.sigma_ps(),
        }
    }

    /// The part of it that comes before a time from the mean [1].
    pub fn part(&self, t_ps: f64) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => normal_cdf(t_ps / sigma_ps),
            Pulse::Tailed { sigma_ps, tail_ps } => {
                let begun = normal_cdf((t_ps + tail_ps) / sigma_ps);
                (begun - tail_ps * tailed_density(t_ps, *sigma_ps, *tail_ps)).clamp(0.0, 1.0)
            }
            Pulse::Sampled(samples) => samples.part(t_ps),
        }
    }

    /// Density at a time from the mean [1/ps].
    pub fn density(&self, t_ps: f64) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => normal_density(t_ps, *sigma_ps),
            Pulse::Tailed { sigma_ps, tail_ps } => tailed_density(t_ps, *sigma_ps, *tail_ps),
            Pulse::Sampled(samples) => samples.density(t_ps),
        }
    }

    /// Slope of the density there [1/ps^2].
    pub fn slope(&self, t_ps: f64) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => {
                -normal_density(t_ps, *sigma_ps) * (t_ps / sigma_ps) / sigma_ps
            }
            Pulse::Tailed { sigma_ps, tail_ps } => {
                let begun = normal_density(t_ps + tail_ps, *sigma_ps);
                match ShortTail::of(t_ps, *sigma_ps, *tail_ps) {
                    Some(short) => begun * short.slope() / sigma_ps,
                    None => (begun - tailed_density(t_ps, *sigma_ps, *tail_ps)) / tail_ps,
                }
            }
            Pulse::Sampled(samples) => samples.slope(t_ps),
        }
    }

    /// Returns begin and end of all but 3.4e-6 at either end, from its mean [ps].
    pub fn ends_ps(&self) -> [f64; 2] {
        match self {
            Pulse::Gaussian { sigma_ps } => [-GAUSSIAN_END * sigma_ps, GAUSSIAN_END * sigma_ps],
            Pulse::Tailed { .. } => [self.when(TAIL), self.when(1.0 - TAIL)],
            Pulse::Sampled(samples) => samples.ends_ps(TAIL),
        }
    }

    /// Returns begin and end of all of it that can be told apart from zero, from its mean [ps].
    pub fn reach_ps(&self) -> [f64; 2] {
        match self {
            Pulse::Gaussian { sigma_ps } => [-GAUSSIAN_REACH * sigma_ps, GAUSSIAN_REACH * sigma_ps],
            Pulse::Tailed { sigma_ps, tail_ps } => {
                let gaussian_ps = GAUSSIAN_REACH * sigma_ps;
                [-gaussian_ps - tail_ps, gaussian_ps + TAIL_REACH * tail_ps]
            }
            Pulse::Sampled(samples) => samples.reach_ps(),
        }
    }

    /// The time from the mean at which a part of it has come, 0 to 1 [ps].
    pub fn when(&self, part: f64) -> f64 {
        let [mut from_ps, mut until_ps] = self.reach_ps();
        while until_ps - from_ps > 1e-6 {
            let middle_ps = 0.5 * (from_ps + until_ps);
            if self.part(middle_ps) < part {
                from_ps = middle_ps;
            } else {
                until_ps = middle_ps;
            }
        }
        from_ps
    }
}

/// Standard normal distribution function.
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Below which a part of a standard normal distribution lies, 0 to 1 without the ends.
pub fn normal_quantile(part: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * part)
}

/// Density of a normal time [1/ps].
fn normal_density(t_ps: f64, sigma_ps: f64) -> f64 {
    let z = t_ps / sigma_ps;
    libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt() / sigma_ps
}

/// Density of a normal time plus an exponential one, from their mean [1/ps].
fn tailed_density(t_ps: f64, sigma_ps: f64, tail_ps: f64) -> f64 {
    if let Some(short) = ShortTail::of(t_ps, sigma_ps, tail_ps) {
        return normal_density(t_ps + tail_ps, sigma_ps) * short.density();
    }
    let (t_ps, ratio) = (t_ps + tail_ps, sigma_ps / tail_ps);
    let z = t_ps / sigma_ps - ratio;
    // The logarithm of either factor alone can be far from zero.
    libm::exp(0.5 * ratio * ratio - t_ps / tail_ps + libm::log(normal_cdf(z))) / tail_ps
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulses() -> [Pulse; 6] {
        let bump = |k: usize| (k as f64 * 0.1).sin().abs() * (60 - k) as f64;
        let density: Vec<_> = (0..60).map(bump).collect();
        [
            Pulse::default(),
            Pulse::tailed(137.0, 150.0),
            Pulse::tailed(137.0, 20.0),
            Pulse::tailed(137.0, 1.0),
            Pulse::tailed(20.0, 400.0),
            Pulse::Sampled(Samples::new(7.0, &density).unwrap()),
        ]
    }

    /// Times from begin to end, and the steps between them [ps].
    fn steps(pulse: &Pulse) -> (Vec<f64>, f64) {
        let [from_ps, until_ps] = pulse.reach_ps();
        let step_ps = (until_ps - from_ps) / 40_000.0;
        ((0..40_000).map(|k| from_ps + (k as f64 + 0.5) * step_ps).collect(), step_ps)
    }

    #[test]
    fn the_part_is_the_integral_of_the_density() {
        for pulse in pulses() {
            let (times, step_ps) = steps(&pulse);
            let mut sum = 0.0;
            for t_ps in times {
                sum += 0.5 * step_ps * pulse.density(t_ps);
                assert!((pulse.part(t_ps) - sum).abs() < 3e-6, "{pulse:?} at {t_ps}");
                sum += 0.5 * step_ps * pulse.density(t_ps);
            }
            assert!((sum - 1.0).abs() < 1e-6, "{pulse:?}: {sum}");
        }
    }

    #[test]
    fn the_density_is_the_integral_of_its_slope() {
        for pulse in pulses().into_iter().take(5) {
            for (k, t_ps) in steps(&pulse).0.into_iter().step_by(101).enumerate() {
                let rise = (pulse.density(t_ps + 0.01) - pulse.density(t_ps - 0.01)) / 0.02;
                let error = (pulse.slope(t_ps) - rise).abs() * pulse.sigma_ps().powi(2);
                assert!(error < 1e-5, "{pulse:?} at {t_ps}, {k}: {error:e}");
            }
        }
    }

    #[test]
    fn its_mean_is_zero_and_its_deviation_is_that_of_the_density() {
        for pulse in pulses() {
            let (times, step_ps) = steps(&pulse);
            let moment = |power: i32| {
                times.iter().map(|t| t.powi(power) * pulse.density(*t) * step_ps).sum::<f64>()
            };
            let sigma_ps = pulse.sigma_ps();
            assert!(moment(1).abs() < 1e-4 * sigma_ps, "{pulse:?}: {}", moment(1));
            assert!((moment(2).sqrt() / sigma_ps - 1.0).abs() < 1e-4, "{pulse:?}: {sigma_ps}");
        }
    }

    #[test]
    fn a_short_tail_is_none() {
        let (short, none) = (Pulse::tailed(137.0, 0.01), Pulse::tailed(137.0, 0.0));
        assert_eq!(none, Pulse::Gaussian { sigma_ps: 137.0 });
        for t_ps in (-600..600).map(f64::from) {
            assert!((short.part(t_ps) - none.part(t_ps)).abs() < 1e-8, "{t_ps}");
            assert!((short.density(t_ps) / none.density(t_ps) - 1.0).abs() < 1e-5, "{t_ps}");
        }
        for tail_ps in [1e-3, 1e-6, 1e-9, 1e-12, 1e-100, f64::MIN_POSITIVE] {
            let short = Pulse::tailed(137.0, tail_ps);
            for t_ps in (-900..900).map(f64::from) {
                let parts = short.part(t_ps) - none.part(t_ps);
                assert!(parts.abs() < 1e-9, "{tail_ps} at {t_ps}: {parts:e}");
                let densities = short.density(t_ps) - none.density(t_ps);
                assert!(densities.abs() < 1e-12, "{tail_ps} at {t_ps}: {densities:e}");
                let slopes = short.slope(t_ps) - none.slope(t_ps);
                assert!(slopes.abs() < 1e-12, "{tail_ps} at {t_ps}: {slopes:e}");
            }
        }
    }

    #[test]
    fn where_the_series_takes_over_nothing_jumps() {
        // At t = -tail, u is 0, and the series holds from sigma / tail = 25 on.
        for (sigma_ps, tail_ps) in [(137.0, 137.0 / 25.0), (20.0, 0.8)] {
            let both = [1.0 - 1e-12, 1.0 + 1e-12].map(|by| Pulse::tailed(sigma_ps, tail_ps * by));
            let [near, far] = both.each_ref();
            let at_ps = -tail_ps;
            assert!((near.density(at_ps) / far.density(at_ps) - 1.0).abs() < 1e-10);
            assert!((near.slope(at_ps) / far.slope(at_ps) - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn its_ends_cut_off_what_a_gaussian_has_beyond_4_5_deviations() {
        for pulse in pulses() {
            let [begin, end] = pulse.ends_ps().map(|t_ps| pulse.part(t_ps));
            assert!(begin < 3.5e-6 && end > 1.0 - 3.5e-6, "{pulse:?}: {begin:e} {end}");
            let tailed = matches!(pulse, Pulse::Tailed { .. });
            assert!(!tailed || (begin > 3.3e-6 && end < 1.0 - 3.3e-6), "{pulse:?}");
            assert!((pulse.part(pulse.when(0.3)) - 0.3).abs() < 1e-6, "{pulse:?}");
        }
    }
}
