//! Where a part of a distribution's values lies below.

use tofsim::kernel::pulse::normal_quantile;

/// A distribution with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantiles {
    /// Equally likely between two numbers.
    Uniform([f64; 2]),
    /// Its logarithm is, between those of two numbers.
    LogUniform([f64; 2]),
    /// Normal, cut off outside of two numbers.
    Normal {
        /// Mean before it was cut off.
        mean: f64,
        /// Standard deviation before it was cut off.
        sd: f64,
        /// What parts of it lie below the two numbers.
        parts: [f64; 2],
        /// Whether it is that of the logarithm.
        is_log: bool,
    },
    /// Rising from the first number to the second, and falling to the third.
    Triangular([f64; 3]),
}

impl Quantiles {
    /// The value that a part `u` of all lies below, 0 to 1 without the ends.
    pub fn at(&self, u: f64) -> f64 {
        match *self {
            Quantiles::Uniform([from, to]) => from + u * (to - from),
            Quantiles::LogUniform([from, to]) => from * libm::pow(to / from, u),
            Quantiles::Normal { mean, sd, parts: [below, until], is_log } => {
                let value = mean + sd * normal_quantile(below + u * (until - below));
                if is_log { libm::exp(value) } else { value }
            }
            Quantiles::Triangular([from, mode, to]) => {
                let (rising, all) = (mode - from, to - from);
                match u * all < rising {
                    true => from + (u * all * rising).sqrt(),
                    false => to - ((1.0 - u) * all * (to - mode)).sqrt(),
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
        near(Quantiles::Uniform([1.0, 3.0]).at(0.25), 1.5);
        near(Quantiles::LogUniform([1.0, 100.0]).at(0.5), 10.0);
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
