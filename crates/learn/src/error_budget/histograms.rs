//! Histograms of a variant: drawn ones, and the expected one.

use rand_chacha::rand_core::Rng;

use tofsim::network::Histogram;
use tofsim::sensor::streams::{Source, stream, uniform};

use crate::estimation::acquisition::whole_hits;

use super::quantile::binomial;

/// Ways in which the expected counts are rounded to whole ones.
pub const ROUNDINGS: u64 = 16;

/// Distribution of a variant's histograms.
#[derive(Clone, Debug)]
pub struct Histograms {
    /// Mean hits with each code in a shot [1].
    pub per_shot: Vec<f64>,
    /// Shots of a frame.
    pub shots: u64,
}

impl Histograms {
    /// The histogram of a frame. Each bin has a random number of its own in each frame, whatever the variant.
    pub fn drawn(&self, seed: u64, frame: u64) -> Histogram {
        let mut random = stream(seed, Source::Histogram, frame);
        let (mut shots_left, mut chance_left) = (self.shots, 1.0);
        let count = |&mean: &f64| {
            let quantile = uniform(random.next_u64());
            let share = if mean < chance_left { mean / chance_left } else { 1.0 };
            let count = binomial(quantile, shots_left, share);
            (shots_left, chance_left) = (shots_left - count, chance_left - mean);
            count as u32
        };
        self.per_shot.iter().map(count).collect()
    }

    /// The expected histogram to whole hits: what a bin loses by rounding the next one gets. `rounding` says which
    /// part of a hit the first bin begins with, so that all [`ROUNDINGS`] of them show what rounding does.
    pub fn expected(&self, rounding: u64) -> Histogram {
        let owed = (rounding as f64 + 0.5) / ROUNDINGS as f64 - 0.5;
        whole_hits(&self.per_shot, self.shots, owed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histograms() -> Histograms {
        let per_shot =
            (0..64).map(|k| 0.01203 + 0.00207 * f64::from(k % 7)).map(|p| 0.7 * p).collect();
        Histograms { per_shot, shots: 5000 }
    }

    /// Mean of a sum of squares over what its terms are to be.
    fn scatter() -> f64 {
        let (histograms, frames) = (histograms(), 400);
        let mut sum = 0.0;
        for frame in 0..frames {
            for (count, mean) in histograms.drawn(3, frame).into_iter().zip(&histograms.per_shot) {
                let expected = 5000.0 * mean;
                sum += (f64::from(count) - expected).powi(2) / (expected * (1.0 - mean));
            }
        }
        sum / (64 * frames) as f64
    }

    #[test]
    fn counts_have_the_variance_of_multinomial_numbers() {
        // Of 25,600 terms: five standard errors of a chi-square over its freedom.
        assert!((scatter() - 1.0).abs() < 0.045, "{}", scatter());
    }

    #[test]
    fn a_small_change_of_the_mean_is_a_small_change_of_the_counts() {
        let (one, mut other) = (histograms(), histograms());
        other.per_shot.iter_mut().for_each(|mean| *mean *= 1.001);
        let moved = |frame: u64| -> u32 {
            let pairs = one.drawn(3, frame).into_iter().zip(other.drawn(3, frame));
            pairs.map(|(a, b)| a.abs_diff(b)).sum()
        };
        let hits: f64 = one.per_shot.iter().sum::<f64>() * 5000.0;
        let mean = (0..50).map(|frame| f64::from(moved(frame))).sum::<f64>() / 50.0;
        // Independent draws would differ by some 64 * sqrt(2 * 45) hits.
        assert!(mean < 3.0 * 0.001 * hits, "{mean} of {hits}");
    }

    #[test]
    fn expected_counts_are_rounded_in_each_way_and_right_in_the_mean() {
        let histograms = histograms();
        let all: Vec<_> = (0..ROUNDINGS).map(|rounding| histograms.expected(rounding)).collect();
        for (code, mean) in histograms.per_shot.iter().enumerate() {
            let sum: u32 = all.iter().map(|histogram| histogram[code]).sum();
            let expected = 5000.0 * mean;
            assert!((f64::from(sum) / ROUNDINGS as f64 - expected).abs() < 0.51, "{code}");
        }
        assert!(all.iter().any(|one| *one != all[0]));
    }
}
