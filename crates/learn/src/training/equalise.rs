//! The end's weights: distances where the error is larger than the line has it gain weight, until the
//! largest ratio is as small as the network can make it.
//!
//! Lawson's algorithm multiplies weights by the errors again and again (Rice and Usow, Math. Comp. 22,
//! 1968). But a network follows its weights slowly, and weights that gather while it lags overshoot. So
//! ours forget a part of what they were each time, and settle at a power of the ratios.

use super::recipe::Finish;
use super::weighting::Weighting;

/// Ratio of twice the root mean square error to the line, a distance each; samples of a distance are
/// neighbours [1].
pub fn ratios(distances_m: &[f64], errors_m: &[f64], line: &Weighting) -> Vec<f64> {
    let pairs: Vec<_> = distances_m.iter().zip(errors_m).collect();
    let ratio = |pairs: &[(&f64, &f64)]| {
        let squares: f64 = pairs.iter().map(|(_, error)| *error * *error).sum();
        2000.0 * (squares / pairs.len() as f64).sqrt() / line.line_mm(*pairs[0].0)
    };
    pairs.chunk_by(|a, b| a.0 == b.0).map(ratio).collect()
}

/// Factors on the weights, a distance each, for the block after one with those ratios.
pub fn follow(factors: &mut Vec<f64>, ratios: &[f64], finish: &Finish) {
    let ratios = smooth(ratios, finish.neighbours);
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    factors.resize(ratios.len(), 1.0);
    for (factor, ratio) in factors.iter_mut().zip(&ratios) {
        let ratio = (ratio / mean).clamp(finish.least, finish.most);
        *factor = libm::pow(*factor, finish.keep) * libm::pow(ratio, finish.power);
    }
}

/// Root of the mean of the squares of a ratio and of so many neighbours to either side, which count the
/// less the farther they are.
fn smooth(ratios: &[f64], neighbours: usize) -> Vec<f64> {
    let around = |place: usize| {
        let places = place.saturating_sub(neighbours)..ratios.len().min(place + neighbours + 1);
        let weighed = places.map(|other| {
            let weight = (neighbours + 1 - place.abs_diff(other)) as f64;
            (weight * ratios[other] * ratios[other], weight)
        });
        let (sum, weights) = weighed.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        f64::sqrt(sum / weights)
    };
    (0..ratios.len()).map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::recipe::Recipe;

    #[test]
    fn a_ratio_is_twice_the_root_mean_square_in_parts_of_the_line() {
        let found = ratios(&[0.1, 0.1, 0.2], &[0.0008, -0.0008, 0.0028], &Weighting::default());
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn neighbours_count_less_than_a_distance_itself() {
        assert_eq!(smooth(&[1.0, 3.0, 2.0], 0), [1.0, 3.0, 2.0]);
        let expected = [(2.0 + 9.0) / 3.0, (1.0 + 18.0 + 4.0) / 4.0, (9.0 + 8.0) / 3.0];
        assert_eq!(smooth(&[1.0, 3.0, 2.0], 1), expected.map(f64::sqrt));
    }

    #[test]
    fn factors_settle_at_a_power_of_the_ratio() {
        let finish = Recipe::default().finish;
        let finish = super::Finish { power: 0.6, keep: 0.8, neighbours: 0, ..finish };
        let mut factors = Vec::new();
        (0..100).for_each(|_| follow(&mut factors, &[0.9, 1.1], &finish));
        for (factor, ratio) in factors.iter().zip([0.9f64, 1.1]) {
            assert!((factor / ratio.powi(3) - 1.0).abs() < 1e-8, "{factors:?}");
        }
    }

    #[test]
    fn a_ratio_counts_within_its_limits_only() {
        let finish = Recipe::default().finish;
        let finish = super::Finish { power: 1.0, keep: 1.0, neighbours: 0, ..finish };
        let mut factors = vec![2.0, 2.0, 2.0];
        follow(&mut factors, &[0.01, 1.0, 100.0], &finish);
        assert_eq!((factors[0], factors[2]), (2.0 * finish.least, 2.0 * finish.most));
    }
}
