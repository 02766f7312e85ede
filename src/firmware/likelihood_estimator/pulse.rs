//! The pulse as a ROM has it.
//!
//! A word holds the part of the pulse that came before, between two words of which it is straight, and two slopes: that of the logarithm of the pulse, for
//! a bin in it, and that of the logarithm of the part before, for bin 0. Only the parts have to be exact: with
//! slopes that are a little wrong the residuals still are zero in the mean.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Words of the ROM: 1024 steps to either side of the middle.
pub const WORDS: usize = 2048;
/// Steps in 16/3 deviations at most, so that tails end within the ROM.
const STEPS_OF_TAIL: f64 = 1024.0;
/// All of the pulse.
const ALL: f64 = 131_071.0;
/// Largest slope.
const STEEPEST: f64 = 255.0;
/// What a pulse may be cut to: the part at 4.5 deviations of a Gaussian.
const TAIL: f64 = 3.4e-6;

/// One word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PulseWord {
    /// Part of the pulse that came before, of 131,071: 17 bits.
    pub part: i64,
    /// -f'/f, times deviation and the deviation in z: 9 bits, signed.
    pub slope: i64,
    /// -f/F, times the same: 9 bits, signed.
    pub first: i64,
}

/// How arrivals of an echo's photons are spread around their mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Pulse {
    /// A normal distribution.
    Gaussian {
        /// Its standard deviation [ps].
        sigma_ps: f64,
    },
    /// A density at even steps, linear between them and zero outside.
    Sampled {
        /// Place of the first sample, from the mean [ps].
        from_ps: f64,
        /// From one to the next [ps].
        step_ps: f64,
        /// Density, to a constant factor [1].
        density: Vec<f64>,
    },
}

impl Pulse {
    /// A density at even steps, its mean moved to zero and its sum made one.
    ///
    /// `None` if it has no mean: fewer than three samples, or none above zero.
    pub fn sampled(step_ps: f64, density: &[f64]) -> Option<Self> {
        let sum: f64 = density.iter().sum();
        let usable = density.len() >= 3 && step_ps > 0.0 && sum > 0.0 && sum.is_finite();
        if !usable || density.iter().any(|&value| value < 0.0) {
            return None;
        }
        let mean = density.iter().enumerate().map(|(k, value)| k as f64 * value).sum::<f64>() / sum;
        let density = density.iter().map(|value| value / sum / step_ps).collect();
        Some(Pulse::Sampled { from_ps: -mean * step_ps, step_ps, density })
    }

    /// Standard deviation [ps].
    pub fn sigma_ps(&self) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => *sigma_ps,
            Pulse::Sampled { from_ps, step_ps, density } => {
                let at = |k: usize| from_ps + k as f64 * step_ps;
                let each = density.iter().enumerate();
                libm::sqrt(each.map(|(k, value)| at(k) * at(k) * value * step_ps).sum())
            }
        }
    }

    /// Where all but 3.4e-6 of it begins and ends, from its mean [ps].
    pub fn ends_ps(&self) -> [f64; 2] {
        match self {
            Pulse::Gaussian { sigma_ps } => [-4.5 * sigma_ps, 4.5 * sigma_ps],
            Pulse::Sampled { from_ps, step_ps, density } => {
                let ends = |k: &usize| {
                    let part = self.part(from_ps + *k as f64 * step_ps);
                    (TAIL..=1.0 - TAIL).contains(&part)
                };
                let places = 0..density.len();
                let first = places.clone().find(ends).unwrap_or(0).saturating_sub(1);
                let last = places.rev().find(ends).unwrap_or(density.len() - 1) + 1;
                [first, last].map(|k| from_ps + k as f64 * step_ps)
            }
        }
    }

    /// Density at a time from the mean, and its slope [1/ps, 1/ps^2].
    fn density(&self, t_ps: f64) -> [f64; 2] {
        match self {
            Pulse::Gaussian { sigma_ps } => {
                let x = t_ps / sigma_ps;
                let density = libm::exp(-0.5 * x * x) / (2.0 * PI).sqrt() / sigma_ps;
                [density, -density * x / sigma_ps]
            }
            Pulse::Sampled { from_ps, step_ps, density } => {
                let place = (t_ps - from_ps) / step_ps;
                let at = |k: f64| match k >= 0.0 && (k as usize) < density.len() {
                    true => density[k as usize],
                    false => 0.0,
                };
                let (low, part) = (libm::floor(place), place - libm::floor(place));
                let [from, to] = [at(low), at(low + 1.0)];
                // Over a step to either side, so that it does not jump from one to the next.
                let [behind, ahead] = [at(low - 1.0), at(low + 2.0)];
                let slope = ((1.0 - part) * (to - behind) + part * (ahead - from)) / 2.0 / step_ps;
                [from + part * (to - from), slope]
            }
        }
    }

    /// The part of it that comes before a time from the mean [1].
    pub fn part(&self, t_ps: f64) -> f64 {
        match self {
            Pulse::Gaussian { sigma_ps } => 0.5 * libm::erfc(-t_ps / sigma_ps * FRAC_1_SQRT_2),
            Pulse::Sampled { from_ps, step_ps, density } => {
                let place = (t_ps - from_ps) / step_ps;
                let at =
                    |k: i64| usize::try_from(k).ok().and_then(|k| density.get(k)).unwrap_or(&0.0);
                let low = libm::floor(place).clamp(-2.0, density.len() as f64) as i64;
                let whole: f64 = (-1..low).map(|k| (at(k) + at(k + 1)) / 2.0).sum();
                let part = (place - low as f64).clamp(0.0, 1.0);
                let [from, to] = [*at(low), *at(low + 1)];
                ((whole + part * (from + part * (to - from) / 2.0)) * step_ps).clamp(0.0, 1.0)
            }
        }
    }

    /// Logarithm of the ROM's step, of which a unit of time is so long [units].
    pub(super) fn step_log2(&self, unit_ps: f64) -> u32 {
        let [begin_ps, end_ps] = self.ends_ps();
        // 16/3 deviations of a Gaussian, which ends at 4.5.
        let reach = (-begin_ps).max(end_ps) * (16.0 / 3.0 / 4.5) / unit_ps;
        (0..).find(|&log2: &u32| reach <= STEPS_OF_TAIL * (log2 as f64).exp2()).unwrap_or_default()
    }

    /// The ROM's words, by the step from the middle as a signed number plus 1024.
    pub(super) fn words(&self, unit_ps: f64, step_log2: u32) -> Vec<PulseWord> {
        let sigma_ps = self.sigma_ps();
        let step = f64::from(1u32 << step_log2);
        let deviation = sigma_ps / unit_ps / step / 4.0;
        let word = |k: usize| {
            let t_ps = (k as f64 - 1024.0) * step * unit_ps;
            let (part, [density, growth]) = (self.part(t_ps), self.density(t_ps));
            let slope = |of: f64, over: f64| match over > 1e-30 {
                true => -of / over * sigma_ps * deviation,
                false => t_ps / sigma_ps * deviation,
            };
            let slope = |of, over| libm::round(slope(of, over)).clamp(-STEEPEST, STEEPEST) as i64;
            PulseWord {
                part: libm::round(part * ALL) as i64,
                slope: slope(growth, density),
                first: slope(density, part),
            }
        };
        (0..WORDS).map(word).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sampled_gaussian_is_nearly_one() {
        let (gaussian, step_ps) = (Pulse::Gaussian { sigma_ps: 137.0 }, 5.0);
        let density: Vec<_> =
            (0..300).map(|k| gaussian.density((k as f64 - 150.0) * step_ps)[0]).collect();
        let sampled = Pulse::sampled(step_ps, &density).unwrap();
        assert!((sampled.sigma_ps() - 137.0).abs() < 0.1, "{}", sampled.sigma_ps());
        let unit_ps = 25.0 / 64.0;
        let [mine, theirs] = [&sampled, &gaussian].map(|pulse| pulse.words(unit_ps, 1));
        for (mine, theirs) in mine.iter().zip(&theirs).skip(300).take(1448) {
            assert!((mine.part - theirs.part).abs() < 30, "{mine:?} {theirs:?}");
            assert!((mine.slope - theirs.slope).abs() < 4, "{mine:?} {theirs:?}");
        }
        assert_eq!(sampled.step_log2(unit_ps), gaussian.step_log2(unit_ps));
    }

    #[test]
    fn what_has_no_mean_is_no_pulse() {
        assert_eq!(Pulse::sampled(1.0, &[1.0, 2.0]), None);
        assert_eq!(Pulse::sampled(1.0, &[0.0; 9]), None);
        assert_eq!(Pulse::sampled(1.0, &[1.0, -1.0, 3.0]), None);
    }
}
