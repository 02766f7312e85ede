//! Statistics of an estimator's errors over frames.

use tofsim_learn::evaluation::Spread;

use crate::figure::{Figure, mean};

/// Statistics of an estimator's errors over frames.
#[derive(Clone, Debug)]
pub struct Errors {
    spread: Spread,
    /// Mean squared error with its standard error; empty without a true distance [mm^2].
    mse_mm2: Figure,
    has_truth: bool,
}

impl Errors {
    /// Computes statistics of depth errors, which are missing for failures. Errors beyond `limit_m` are outliers [m].
    pub fn of(errors_m: &[Option<f64>], truth_m: Option<f64>, limit_m: f64) -> Errors {
        let judged = errors_m.iter().map(|error| (*error, truth_m.unwrap_or(f64::INFINITY)));
        let spread = Spread::judged(judged, limit_m);
        let squares_mm2 =
            errors_m.iter().flatten().map(|m| 1e6 * m * m).filter(|mm2| mm2.is_finite());
        Errors { spread, mse_mm2: mean(squares_mm2), has_truth: truth_m.is_some() }
    }

    /// Returns the mean error [mm].
    pub fn bias(&self) -> Figure {
        self.where_known(Figure::new(self.spread.mean_mm, self.spread.mean_se_mm))
    }

    /// Returns twice the standard deviation [mm].
    pub fn two_sd(&self) -> Figure {
        Figure::new(self.spread.two_sd_mm, self.spread.two_sd_se_mm)
    }

    /// Returns the standard deviation [mm].
    pub fn sd(&self) -> Figure {
        let Figure { value, se, .. } = self.two_sd();
        Figure::new(value.map(|two| two / 2.0), se.map(|two| two / 2.0))
    }

    /// Returns the root mean square error [mm].
    pub fn root_mse(&self) -> Figure {
        let Figure { value, se, .. } = self.mse_mm2;
        let root = value.map(f64::sqrt);
        let se = se.zip(root).map(|(se, root)| if root > 0.0 { se / (2.0 * root) } else { 0.0 });
        self.where_known(Figure::new(root, se))
    }

    /// Returns the fraction of frames without a depth [1].
    pub fn failure_rate(&self) -> Figure {
        part(self.spread.failures, self.spread.failures + self.spread.estimates)
    }

    /// Returns the fraction of depths that are outliers [1].
    pub fn outlier_rate(&self) -> Figure {
        self.where_known(part(self.spread.outliers, self.spread.estimates))
    }

    fn where_known(&self, figure: Figure) -> Figure {
        if self.has_truth { figure } else { Figure::default() }
    }
}

/// Returns a fraction with its binomial standard error.
fn part(of_them: u64, all: u64) -> Figure {
    if all == 0 {
        return Figure::default();
    }
    let part = of_them as f64 / all as f64;
    let se = (part * (1.0 - part) / all as f64).sqrt();
    Figure { value: Some(part), se: Some(se), of: Some(all as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_squared_error_is_that_of_bias_and_scatter() {
        let errors = [Some(0.001), Some(0.003), None, Some(0.005)];
        let found = Errors::of(&errors, Some(0.3), 0.0045);
        let near = |figure: Figure, expected: f64| {
            assert!((figure.value.unwrap() - expected).abs() < 1e-12, "{figure:?} for {expected}");
        };
        near(found.bias(), 3.0);
        near(found.sd(), 2.0);
        near(found.root_mse(), (35.0f64 / 3.0).sqrt());
        near(found.failure_rate(), 0.25);
        near(found.outlier_rate(), 1.0 / 3.0);
        assert!((found.failure_rate().se.unwrap() - (0.25f64 * 0.75 / 4.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn without_a_truth_there_is_a_scatter_and_no_error() {
        let found = Errors::of(&[Some(0.301), Some(0.303)], None, 0.1);
        assert!(found.sd().value.is_some() && found.failure_rate().value == Some(0.0));
        assert_eq!([found.bias(), found.root_mse(), found.outlier_rate()], [Figure::default(); 3]);
    }
}
