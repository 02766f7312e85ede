//! Random model of the tap delays of a carry chain in silicon, with its own seed.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::Result;
use crate::files::toml::Checked;

/// Taps of a CARRY4 (UG474).
const TAPS_OF_SLICE: usize = 4;
/// Tolerance on the sum of a slice's weights, which should be one [1].
const ROUNDING: f64 = 1e-3;

/// Purpose of a random stream; each has its own.
#[derive(Clone, Copy)]
enum Draw {
    Slices = 1,
    Skew = 2,
    Parts = 3,
}

/// Random model of a chain in silicon: slices of unequal delay, four unequal taps per slice, clock region borders,
/// and clock skew. Each effect is off by default, which makes all taps equal.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Silicon {
    /// Number of CARRY4 in the chain, of four taps each.
    #[schemars(range(min = 4, max = 500), extend("unit" = "CARRY4", "source" = "hardware.md 2: 169 cover 8 ns"))]
    pub slices: usize,
    /// Mean delay of a CARRY4 from carry in to carry out.
    #[schemars(range(min = 1.0, max = 1000.0), extend("unit" = "ps", "source" = "Kintex-7 -2, slow corner: 47 to 48"))]
    pub slice_ps: f64,
    /// Relative standard deviation of the CARRY4 delays, which are log-normal.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5), extend("unit" = "1", "source" = "measured: 0.21 (7 series) to 0.27 (Spartan-6)"))]
    pub slice_spread: f64,
    /// Correlation between the delays of neighbouring CARRY4; it decays as a power of their distance.
    #[serde(default)]
    #[schemars(range(min = -0.5, max = 0.9), extend("unit" = "1", "source" = "measured: -0.30 (7 series), -0.17 to 0.08 (Spartan-6)"))]
    pub slice_correlation: f64,
    /// Fractions of a CARRY4's delay from each of its taps to the next one reached; their sum is one.
    #[serde(default = "alike")]
    #[schemars(length(min = 4, max = 4), inner(range(min = 0.0, max = 1.0)))]
    #[schemars(extend("unit" = "1", "source" = "measured: 69, 6, 65, 3 hits by tap (7 series)"))]
    pub weights: Vec<f64>,
    /// Relative standard deviation of these fractions from one CARRY4 to another, before they are normalized;
    /// log-normal.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "DNL of 1.06 LSB rms (7 series), beside slice_spread"))]
    pub weight_spread: f64,
    /// CO outputs of a CARRY4 in the order in which they are reached.
    #[serde(default = "in_order")]
    #[schemars(length(min = 4, max = 4), inner(range(min = 0, max = 3)))]
    #[schemars(extend("unit" = "CO", "source" = "prjxray: CO3 < CO1 < CO2 < CO0"))]
    pub co_order: Vec<usize>,
    /// Number of taps between borders of clock regions; 0 for none.
    #[serde(default)]
    #[schemars(range(min = 0, max = 2000), extend("unit" = "tap", "source" = "UG474: 50 CLB rows, 200"))]
    pub border_every: usize,
    /// Additional delay at each border of a clock region.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "ps", "source" = "measured: no more than a half of a slice (7 series)"))]
    pub border_ps: f64,
    /// Standard deviation of the clock's arrival time at a tap's register, Gaussian.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "ps rms", "source" = "choice: docs/model.md"))]
    pub skew_ps: f64,
    /// Seed of the random delays; another seed models another location on the chip.
    #[serde(default)]
    #[schemars(extend("unit" = "1", "source" = "choice"))]
    pub seed: u64,
}

fn alike() -> Vec<f64> {
    vec![0.25; TAPS_OF_SLICE]
}

fn in_order() -> Vec<usize> {
    (0..TAPS_OF_SLICE).collect()
}

impl Silicon {
    /// Computes the delay before tap 0, in addition to the chain's offset, and the delay of each tap [ps].
    ///
    /// # Errors
    /// If the weights do not add up to one, or the order does not list each output once.
    pub fn delays_ps(&self, checked: &Checked) -> Result<(f64, Vec<f64>)> {
        let sum: f64 = self.weights.iter().sum();
        if (sum - 1.0).abs() > ROUNDING {
            let expected = format!("expected four parts of one, not of {sum}");
            return Err(checked.fault("silicon.weights", expected).into());
        }
        if (0..TAPS_OF_SLICE).any(|output| !self.co_order.contains(&output)) {
            let expected = "expected each of 0, 1, 2, 3 once";
            return Err(checked.fault("silicon.co_order", expected).into());
        }
        let (slices, skews, parts) = (self.slices_ps(), self.skews_ps(), self.parts());
        let taps = TAPS_OF_SLICE * self.slices;
        // How far each tap is from where it were if the outputs came in order and the clock all at once.
        let moved = |tap: usize| {
            let (slice, output) = (tap / TAPS_OF_SLICE, tap % TAPS_OF_SLICE);
            let (Some(parts), Some(skew_ps)) = (parts.get(slice), skews.get(tap)) else {
                return 0.0;
            };
            let begin = |place: usize| parts[..place].iter().sum::<f64>();
            let place = self.co_order.iter().position(|&other| other == output);
            slices[slice] * (begin(place.unwrap_or(output)) - begin(output)) + skew_ps
        };
        let delay = |tap: usize| {
            let is_border = self.border_every > 0 && (tap + 1).is_multiple_of(self.border_every);
            let border = if is_border && tap + 1 < taps { self.border_ps } else { 0.0 };
            let slice = tap / TAPS_OF_SLICE;
            let own = slices[slice] * parts[slice][tap % TAPS_OF_SLICE];
            own + border + (moved(tap + 1) - moved(tap))
        };
        Ok((moved(0), (0..taps).map(delay).collect()))
    }

    /// Draws the delay of each CARRY4 [ps].
    fn slices_ps(&self) -> Vec<f64> {
        // A log-normal delay of that mean and spread, from a Gaussian with a correlation that becomes theirs.
        let variance = libm::log1p(self.slice_spread * self.slice_spread);
        let (sigma, mut last) = (variance.sqrt(), None);
        let covariance = self.slice_correlation * self.slice_spread * self.slice_spread;
        let correlation = if sigma > 0.0 { libm::log1p(covariance) / variance } else { 0.0 };
        let draws = self.gaussian(Draw::Slices, self.slices);
        let delays = draws.into_iter().map(|draw| {
            let z = match last {
                Some(last) => correlation * last + (1.0 - correlation * correlation).sqrt() * draw,
                None => draw,
            };
            last = Some(z);
            self.slice_ps * libm::exp(sigma * z - variance / 2.0)
        });
        delays.collect()
    }

    /// Draws the fractions of each CARRY4's delay.
    fn parts(&self) -> Vec<Vec<f64>> {
        let sigma = libm::log1p(self.weight_spread * self.weight_spread).sqrt();
        let draws = self.gaussian(Draw::Parts, TAPS_OF_SLICE * self.slices);
        let slices = draws.chunks(TAPS_OF_SLICE).map(|draws| {
            let parts = self.weights.iter().zip(draws);
            let parts: Vec<_> = parts.map(|(weight, z)| weight * libm::exp(sigma * z)).collect();
            let sum: f64 = parts.iter().sum();
            parts.iter().map(|part| part / sum).collect()
        });
        slices.collect()
    }

    /// Draws the clock skew of each tap [ps].
    fn skews_ps(&self) -> Vec<f64> {
        let draws = self.gaussian(Draw::Skew, TAPS_OF_SLICE * self.slices);
        draws.into_iter().map(|draw| self.skew_ps * draw).collect()
    }

    /// Draws standard Gaussian numbers by the Box-Muller transform, from a stream of their own, so that enabling one
    /// effect does not change the others.
    fn gaussian(&self, what: Draw, count: usize) -> Vec<f64> {
        let mut key = *b"........tofsim carry chain v1...";
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(what as u64);
        let mut uniform = || ((random.next_u64() >> 12) as f64 + 0.5) / (1u64 << 52) as f64;
        let mut draw = || {
            let radius = (-2.0 * libm::log(uniform())).sqrt();
            radius * libm::cos(std::f64::consts::TAU * uniform())
        };
        (0..count).map(|_| draw()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn silicon(text: &str) -> Silicon {
        toml::from_str(&format!("slices = 200\nslice_ps = 47.3\n{text}")).unwrap()
    }

    fn delays(text: &str) -> (f64, Vec<f64>) {
        let checked = Checked::syntax("c.toml", "").unwrap();
        silicon(text).delays_ps(&checked).unwrap()
    }

    #[test]
    fn with_every_effect_off_the_taps_are_alike() {
        let (first, taps) = delays("");
        assert_eq!((first, taps.len()), (0.0, 800));
        assert!(taps.iter().all(|tap| *tap == 47.3 / 4.0));
    }

    #[test]
    fn slices_have_the_mean_the_spread_and_the_correlation_that_are_asked_for() {
        // Over many places on the chip.
        let (mut sum, mut squares, mut products, mut pairs) = (0.0, 0.0, 0.0, 0.0);
        for seed in 0..400 {
            let keys = format!("slice_spread = 0.25\nslice_correlation = -0.3\nseed = {seed}");
            let slices = silicon(&keys).slices_ps();
            sum += slices.iter().sum::<f64>();
            squares += slices.iter().map(|ps| (ps - 47.3).powi(2)).sum::<f64>();
            products +=
                slices.windows(2).map(|pair| (pair[0] - 47.3) * (pair[1] - 47.3)).sum::<f64>();
            pairs += slices.len() as f64 - 1.0;
        }
        let count = 400.0 * 200.0;
        assert!((sum / count / 47.3 - 1.0).abs() < 0.002, "{}", sum / count);
        let spread = (squares / count).sqrt() / 47.3;
        assert!((spread - 0.25).abs() < 0.004, "{spread}");
        let correlation = products / pairs / (squares / count);
        assert!((correlation + 0.3).abs() < 0.02, "{correlation}");
    }

    #[test]
    fn the_outputs_of_a_slice_are_reached_in_their_order_and_slices_stay_as_they_are() {
        let (first, taps) = delays("weights = [0.48, 0.04, 0.45, 0.03]\nco_order = [3, 1, 2, 0]");
        let mut reached = vec![first];
        for tap in &taps {
            reached.push(reached[reached.len() - 1] + tap);
        }
        for (co, part) in [(3, 0.0), (1, 0.48), (2, 0.52), (0, 0.97)] {
            assert!((reached[co] - 47.3 * part).abs() < 1e-9, "CO{co}: {}", reached[co]);
            assert!((reached[400 + co] - 47.3 * (100.0 + part)).abs() < 1e-9);
        }
        assert!((reached[800] - 200.0 * 47.3).abs() < 1e-9);
    }

    #[test]
    fn parts_that_differ_from_slice_to_slice_leave_the_slices_as_they_are() {
        let (_, taps) = delays("weight_spread = 0.4");
        let sums: Vec<f64> = taps.chunks(4).map(|slice| slice.iter().sum()).collect();
        assert!(sums.iter().all(|ps| (ps - 47.3).abs() < 1e-9));
        let variance = taps.iter().map(|ps| (ps - 47.3 / 4.0).powi(2)).sum::<f64>() / 800.0;
        // A part of four has three quarters of the variance that it had before the sum was one again.
        let spread = variance.sqrt() / (47.3 / 4.0);
        assert!((spread - 0.4 * 0.75f64.sqrt()).abs() < 0.04, "{spread}");
    }

    #[test]
    fn borders_come_every_so_many_taps_and_skew_moves_a_tap_alone() {
        let (_, taps) = delays("border_every = 200\nborder_ps = 20");
        let longer = |k: usize| (taps[k] - 47.3 / 4.0 - 20.0).abs() < 1e-9;
        assert_eq!((0..800).filter(|k| longer(*k)).collect::<Vec<_>>(), [199, 399, 599]);
        let (first, taps) = delays("skew_ps = 2");
        let total: f64 = first + taps.iter().sum::<f64>();
        assert!((total - 200.0 * 47.3).abs() < 1e-9, "{total}");
        let variance = taps.iter().map(|ps| (ps - 47.3 / 4.0).powi(2)).sum::<f64>() / 800.0;
        assert!((variance.sqrt() / (2.0 * 2f64.sqrt()) - 1.0).abs() < 0.1, "{variance}");
    }
}
