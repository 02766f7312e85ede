//! Quantile functions of distributions.

use tofsim::kernel::pulse::normal_quantile;

use super::file::Scale;

/// A distribution with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantiles {
    /// Uniform between two numbers, or with a uniform logarithm.
    Uniform([f64; 2], Scale),
    /// Normal, truncated to an interval.
    Normal {
        /// Mean before truncation.
        mean: f64,
        /// Standard deviation before truncation.
        sd: f64,
        /// Cumulative probabilities at the ends of the interval.
        parts: [f64; 2],
        /// Whether this is the distribution of the logarithm.
        is_log: bool,
    },
    /// Triangular: lower limit, mode, upper limit.
    Triangular([f64; 3]),
}

/// Interpolates between two numbers; `part` is between 0 and 1.
pub fn between([from, to]: [f64; 2], scale: Scale, part: f64) -> f64 {
    match scale {
        Scale::Linear => from + part * (to - from),
        Scale::Log => from * libm::pow(to / from, part),
    }
}

impl Quantiles {
    /// Returns the quantile `u`, which is between 0 and 1, excluding both.
    pub fn at(&self, u: f64) -> f64 {
        match *self {
            Quantiles::Uniform(ends, scale) => between(ends, scale, u),
            Quantiles::Normal { mean, sd, parts: [below, until], is_log } => {
                let value = mean + sd * normal_quantile(below + u * (until - below));
                if is_log { libm::exp(value) } else { value }
            }
            Quantiles::Triangular([from, mode, to]) => {
                let (rising, all) = (mode - from, to - from);
                if u * all < rising {
                    from + (u * all * rising).sqrt()
                } else {
                    to - ((1.0 - u) * all * (to - mode)).sqrt()
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} for {expected}");
    }

    #[test]
    fn medians_and_quartiles_are_the_known_ones() {
        near(Quantiles::Uniform([1.0, 3.0], Scale::Linear).at(0.25), 1.5);
        near(Quantiles::Uniform([1.0, 100.0], Scale::Log).at(0.5), 10.0);
        let normal = |is_log| Quantiles::Normal { mean: 2.0, sd: 0.5, parts: [0.0, 1.0], is_log };
        near(normal(false).at(0.841_344_746_068_543), 2.5);
        near(normal(true).at(0.5), 2f64.exp());
        let triangle = Quantiles::Triangular([0.0, 1.0, 4.0]);
        near(triangle.at(0.25), 1.0);
        near(triangle.at(0.0625), 0.5);
        near(triangle.at(0.8125), 2.5);
    }

    #[test]
    fn a_normal_distribution_that_is_cut_off_stays_within() {
        let parts = [0.5, 0.841_344_746_068_543];
        let half = Quantiles::Normal { mean: 0.0, sd: 1.0, parts, is_log: false };
        assert!(half.at(1e-9) >= 0.0 && half.at(1.0 - 1e-9) <= 1.0);
    }
}
