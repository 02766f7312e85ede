//! Statistics of errors, overall or by a quantity of the scene.

use std::collections::BTreeMap;

use serde::Serialize;

use super::tails::Tails;

/// An estimate further from the truth than that is an outlier, unless another limit is stated [m].
pub const OUTLIER_M: f64 = 0.1;

/// Whether an estimate is far off: further than `limit_m` from the truth, negative, or no number.
pub fn is_outlier(depth_m: f64, truth_m: f64, limit_m: f64) -> bool {
    let off_m = (depth_m - truth_m).abs();
    off_m.is_nan() || off_m > limit_m || depth_m < 0.0
}

/// Distribution of errors; all but the counts are `None` without an estimate, spreads without two.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Histograms with an estimate.
    pub estimates: u64,
    /// Histograms without.
    pub failures: u64,
    /// Estimates that are far off ([`is_outlier`]); all but those that are no number count in what
    /// follows.
    pub outliers: u64,
    /// Mean error [mm].
    pub mean_mm: Option<f64>,
    /// Standard error of that [mm].
    pub mean_se_mm: Option<f64>,
    /// Twice the standard deviation of the errors [mm].
    pub two_sd_mm: Option<f64>,
    /// Standard error of that, by the fourth moment; none if there are too few errors for it [mm].
    pub two_sd_se_mm: Option<f64>,
    /// Least error, the quartiles and the largest error [mm].
    pub quartiles_mm: Option<[f64; 5]>,
    /// Further quantiles of a box plot.
    #[serde(skip)]
    pub tails: Option<Tails>,
}

impl Spread {
    /// Of errors in metres, those of failures missing, at distances that do not matter.
    pub fn of(errors_m: impl IntoIterator<Item = Option<f64>>) -> Self {
        Spread::judged(errors_m.into_iter().map(|error_m| (error_m, f64::INFINITY)), OUTLIER_M)
    }

    /// Of errors, those of failures missing, and the true distances; what is further off than
    /// `limit_m` is an outlier [m, m].
    pub fn judged(errors_m: impl IntoIterator<Item = (Option<f64>, f64)>, limit_m: f64) -> Self {
        let mut errors_mm = Vec::new();
        let mut spread = Spread::default();
        for (error, truth_m) in errors_m {
            let Some(error_m) = error else {
                spread.failures += 1;
                continue;
            };
            spread.estimates += 1;
            let is_negative = truth_m + error_m < 0.0;
            spread.outliers += u64::from(is_negative || is_outlier(0.0, error_m, limit_m));
            if error_m.is_finite() {
                errors_mm.push(1e3 * error_m);
            }
        }
        if errors_mm.is_empty() {
            return spread;
        }
        errors_mm.sort_by(f64::total_cmp);
        let n = errors_mm.len() as f64;
        let mean = errors_mm.iter().sum::<f64>() / n;
        spread.mean_mm = Some(mean);
        let quartiles = [0.0, 0.25, 0.5, 0.75, 1.0].map(|q| quantile(&errors_mm, q));
        spread.quartiles_mm = Some(quartiles);
        spread.tails = Some(Tails::of(&errors_mm, [quartiles[1], quartiles[3]]));
        if errors_mm.len() > 1 {
            let moment =
                |power| errors_mm.iter().map(|error| (error - mean).powi(power)).sum::<f64>();
            let variance = moment(2) / (n - 1.0);
            let excess = (moment(4) / n - variance * variance).max(0.0);
            spread.mean_se_mm = Some((variance / n).sqrt());
            spread.two_sd_mm = Some(2.0 * variance.sqrt());
            // With few errors the fourth moment may be too small for an estimate; with two it always is.
            spread.two_sd_se_mm = if variance == 0.0 {
                Some(0.0)
            } else {
                (excess > 0.0).then(|| (excess / n).sqrt() / variance.sqrt())
            };
        }
        spread
    }
}

/// Mean of numbers and its standard error, which takes two of them at least.
pub fn mean_and_error(numbers: impl Iterator<Item = f64> + Clone) -> (Option<f64>, Option<f64>) {
    let count = numbers.clone().count() as f64;
    if count == 0.0 {
        return (None, None);
    }
    let mean = numbers.clone().sum::<f64>() / count;
    let squares: f64 = numbers.map(|number| (number - mean) * (number - mean)).sum();
    (Some(mean), (count > 1.0).then(|| (squares / (count - 1.0) / count).sqrt()))
}

/// A quantile of sorted values, linear between them.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * (sorted.len() - 1) as f64;
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// The errors of all rows that share a value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// The value, in the quantity's unit.
    pub value: f64,
    /// Their errors.
    #[serde(flatten)]
    pub spread: Spread,
}

/// Errors with true distances by value, none of which is negative or no number, in rising order of it;
/// see [`Spread::judged`].
pub(super) fn by(
    values: impl Iterator<Item = f64>,
    errors_m: impl Iterator<Item = (Option<f64>, f64)>,
    limit_m: f64,
) -> Vec<Group> {
    // The bits of numbers from 0 on are in the order of the numbers.
    let mut groups: BTreeMap<u64, Vec<(Option<f64>, f64)>> = BTreeMap::new();
    for (value, error_m) in values.zip(errors_m) {
        groups.entry(value.to_bits()).or_default().push(error_m);
    }
    let group = |(bits, errors_m): (u64, Vec<_>)| Group {
        value: f64::from_bits(bits),
        spread: Spread::judged(errors_m, limit_m),
    };
    groups.into_iter().map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_in_order_and_hold_their_errors() {
        let values = [0.3, 0.0, 0.3, 0.1];
        let errors = [Some(0.001), Some(0.002), None, Some(0.004)];
        let errors = errors.into_iter().map(|error| (error, 0.3));
        let groups = by(values.into_iter(), errors, OUTLIER_M);
        let found: Vec<_> =
            groups.iter().map(|g| (g.value, g.spread.mean_mm, g.spread.failures)).collect();
        assert_eq!(found, [(0.0, Some(2.0), 0), (0.1, Some(4.0), 0), (0.3, Some(1.0), 1)]);
    }

    #[test]
    fn five_errors_by_hand() {
        let spread = Spread::of([1.0, 2.0, 3.0, 4.0, 5.0].map(|mm| Some(1e-3 * mm)));
        assert_eq!((spread.estimates, spread.failures), (5, 0));
        let near = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-12;
        assert!(near(spread.mean_mm, 3.0));
        assert!(near(spread.two_sd_mm, 2.0 * 2.5f64.sqrt()));
        assert!(near(spread.mean_se_mm, 0.5f64.sqrt()));
        for (found, expected) in
            spread.quartiles_mm.unwrap().into_iter().zip([1.0, 2.0, 3.0, 4.0, 5.0])
        {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn failures_are_counted_and_left_out() {
        let spread = Spread::of([None, Some(0.001), None]);
        assert_eq!((spread.estimates, spread.failures, spread.mean_mm), (1, 2, Some(1.0)));
        assert_eq!(spread.two_sd_mm, None);
        let two = Spread::of([Some(0.001), Some(0.003)]);
        assert_eq!((two.mean_se_mm, two.two_sd_se_mm), (Some(1.0), None));
        let none = Spread::of([None]);
        assert_eq!((none.mean_mm, none.quartiles_mm, none.failures), (None, None, 1));
    }

    #[test]
    fn what_is_far_off_negative_or_no_number_is_an_outlier_and_the_last_has_no_part_in_the_mean() {
        let errors = [Some(0.001), Some(0.2), Some(-0.06), Some(f64::NAN), None, Some(0.099)];
        let spread = Spread::judged(errors.map(|error| (error, 0.05)), OUTLIER_M);
        assert_eq!((spread.estimates, spread.failures, spread.outliers), (5, 1, 3));
        assert!((spread.mean_mm.unwrap() - 60.0).abs() < 1e-9, "{spread:?}");
        let strict = Spread::judged([(Some(0.002), 0.3), (Some(-0.0005), 0.3)], 1e-3);
        assert_eq!(strict.outliers, 1);
        assert!(is_outlier(-0.001, 0.05, 0.1) && !is_outlier(0.0, 0.05, 0.1));
    }

    #[test]
    fn the_standard_error_of_a_normal_spread_is_known() {
        // Quantiles of a normal distribution: its kurtosis is 3, so that the standard error of
        // 2 sd is 2 sd / sqrt(2 n).
        let n = 20_001;
        let normal = |k: usize| {
            use statrs::distribution::{ContinuousCDF, Normal};
            Normal::standard().inverse_cdf((k as f64 + 0.5) / n as f64)
        };
        let spread = Spread::of((0..n).map(|k| Some(normal(k))));
        let expected = 2000.0 / (2.0 * n as f64).sqrt();
        assert!((spread.two_sd_se_mm.unwrap() / expected - 1.0).abs() < 0.01);
    }
}
