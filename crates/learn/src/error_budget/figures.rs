//! Errors of a variant, and what an effect changes.

use serde::Serialize;

use crate::evaluation::spread::{Spread, mean_and_error};

/// The errors of a variant.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Estimated less true distance by frame, or by rounding of the expected histogram; none where the estimator
    /// failed [mm].
    pub of: Vec<Option<f64>>,
    /// Whether counts are drawn.
    pub is_drawn: bool,
}

/// Bias and spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// Mean error [mm].
    pub mean_mm: Option<f64>,
    /// Standard error of that [mm].
    pub mean_se_mm: Option<f64>,
    /// Twice the standard deviation of the errors [mm].
    pub two_sd_mm: Option<f64>,
    /// Standard error of that [mm].
    pub two_sd_se_mm: Option<f64>,
    /// Histograms without an estimate.
    pub failures: u64,
    /// Estimates further than 0.1 m from the truth; they count in what stands above.
    pub outliers: u64,
}

/// Change of errors due to an effect, from the same random numbers with and without it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorChange {
    /// Mean error with it less that without [mm].
    pub mean_mm: Option<f64>,
    /// Standard error of that [mm].
    pub mean_se_mm: Option<f64>,
    /// Variance of the errors with it less that without [mm^2].
    pub variance_mm2: Option<f64>,
    /// Standard error of that [mm^2].
    pub variance_se_mm2: Option<f64>,
}

impl Errors {
    /// Bias and spread; without shot noise there is no spread.
    pub fn figures(&self) -> ErrorFigures {
        let spread = Spread::of(self.of.iter().map(|error| error.map(|mm| 1e-3 * mm)));
        let (two_sd_mm, two_sd_se_mm) = if self.is_drawn {
            (spread.two_sd_mm, spread.two_sd_se_mm)
        } else {
            (spread.mean_mm.map(|_| 0.0), spread.mean_mm.map(|_| 0.0))
        };
        ErrorFigures {
            mean_mm: spread.mean_mm,
            mean_se_mm: spread.mean_se_mm,
            two_sd_mm,
            two_sd_se_mm,
            failures: spread.failures,
            outliers: spread.outliers,
        }
    }

    /// Returns the change from `others` to these errors, frame by frame if both or neither are drawn.
    pub fn change_from(&self, others: &Errors) -> ErrorChange {
        if self.is_drawn != others.is_drawn || self.of.len() != others.of.len() {
            return self.apart_from(others);
        }
        let pairs = self.of.iter().zip(&others.of);
        let pairs: Vec<(f64, f64)> = pairs.filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
        let mean = |side: fn(&(f64, f64)) -> f64| mean_and_error(pairs.iter().map(side)).0;
        let means = [mean(|pair| pair.0), mean(|pair| pair.1)];
        let [Some(own), Some(other)] = means else { return ErrorChange::default() };
        let (mean_mm, mean_se_mm) = mean_and_error(pairs.iter().map(|(a, b)| a - b));
        if !self.is_drawn {
            let (variance_mm2, variance_se_mm2) = (Some(0.0), Some(0.0));
            return ErrorChange { mean_mm, mean_se_mm, variance_mm2, variance_se_mm2 };
        }
        let squares = pairs.iter().map(|(a, b)| (a - own).powi(2) - (b - other).powi(2));
        let (variance, variance_se_mm2) = mean_and_error(squares);
        let count = pairs.len() as f64;
        // Two deviations from their mean are equal, and have no scatter.
        let variance_se_mm2 = variance_se_mm2.filter(|_| count > 2.0);
        let variance_mm2 = variance.filter(|_| count > 1.0).map(|mm2| mm2 * count / (count - 1.0));
        ErrorChange { mean_mm, mean_se_mm, variance_mm2, variance_se_mm2 }
    }

    /// The same where frames have nothing in common.
    fn apart_from(&self, others: &Errors) -> ErrorChange {
        let [own, other] = [self, others].map(|one| (one.figures(), one.variance()));
        let less = |a: Option<f64>, b: Option<f64>| Some(a? - b?);
        let root = |a: Option<f64>, b: Option<f64>| Some(a?.hypot(b?));
        ErrorChange {
            mean_mm: less(own.0.mean_mm, other.0.mean_mm),
            mean_se_mm: root(own.0.mean_se_mm, other.0.mean_se_mm),
            variance_mm2: less(own.1.0, other.1.0),
            variance_se_mm2: root(own.1.1, other.1.1),
        }
    }

    /// Variance and its standard error [mm^2].
    fn variance(&self) -> (Option<f64>, Option<f64>) {
        let figures = self.figures();
        let (two_sd, error) = (figures.two_sd_mm, figures.two_sd_se_mm);
        let variance_se = || Some(two_sd? * error? / 2.0);
        (two_sd.map(|mm| mm * mm / 4.0), variance_se())
    }
}

impl ErrorFigures {
    /// Mean error of one, and spread of another.
    pub fn with_spread_of(self, drawn: ErrorFigures) -> Self {
        ErrorFigures { mean_mm: self.mean_mm, mean_se_mm: self.mean_se_mm, ..drawn }
    }

    /// Variance of the errors [mm^2].
    pub fn variance_mm2(&self) -> Option<f64> {
        self.two_sd_mm.map(|mm| mm * mm / 4.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(of: &[f64]) -> Errors {
        Errors { of: of.iter().map(|&mm| Some(mm)).collect(), is_drawn: true }
    }

    #[test]
    fn a_shift_that_all_frames_share_has_no_standard_error() {
        let (a, b) = (drawn(&[1.0, 3.0, -2.0, 0.5]), drawn(&[1.5, 3.5, -1.5, 1.0]));
        let change = b.change_from(&a);
        assert_eq!((change.mean_mm, change.mean_se_mm), (Some(0.5), Some(0.0)));
        assert_eq!((change.variance_mm2, change.variance_se_mm2), (Some(0.0), Some(0.0)));
        assert!(a.figures().mean_se_mm.unwrap() > 1.0);
    }

    #[test]
    fn a_change_of_variance_is_the_difference_of_both() {
        let (a, b) = (drawn(&[1.0, 3.0, -2.0, 0.5, 0.0]), drawn(&[2.0, 6.0, -4.0, 1.0, 0.0]));
        let variance = |errors: &Errors| errors.figures().variance_mm2().unwrap();
        let change = b.change_from(&a);
        assert!((change.variance_mm2.unwrap() - variance(&b) + variance(&a)).abs() < 1e-12);
        assert!(change.variance_se_mm2.unwrap() > 0.0);
    }

    #[test]
    fn frames_without_an_estimate_on_either_side_are_left_out_of_a_change() {
        let a = Errors { of: vec![Some(1.0), None, Some(2.0)], is_drawn: true };
        let b = Errors { of: vec![Some(1.5), Some(9.0), Some(2.5)], is_drawn: true };
        assert_eq!(b.change_from(&a).mean_mm, Some(0.5));
        assert_eq!(a.figures().failures, 1);
    }

    #[test]
    fn expected_histograms_have_a_mean_and_no_spread() {
        let rounded = Errors { of: vec![Some(0.2), Some(0.4)], is_drawn: false };
        let figures = rounded.figures();
        assert!((figures.mean_mm.unwrap() - 0.3).abs() < 1e-12);
        assert_eq!((figures.two_sd_mm, figures.two_sd_se_mm), (Some(0.0), Some(0.0)));
        let change = drawn(&[1.0, 3.0]).change_from(&rounded);
        assert!((change.mean_mm.unwrap() - 1.7).abs() < 1e-12);
        assert!((change.variance_mm2.unwrap() - 2.0).abs() < 1e-12);
    }
}
