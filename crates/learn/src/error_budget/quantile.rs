//! Counts at a quantile, so that the same random number gives nearly the same count where an effect changes its
//! mean a little: differences between such histograms are known far better than either.

/// Below it, and as far above, nothing is left of a distribution of counts [standard deviations].
const REACH: f64 = 9.0;
/// Counts beyond that, for means so small that the tail is longer than a normal one's.
const MORE: f64 = 40.0;

/// The least count that binomial numbers do not exceed in that part of all cases.
pub fn binomial(quantile: f64, trials: u64, chance: f64) -> u64 {
    if trials == 0 || chance <= 0.0 {
        return 0;
    }
    if chance >= 1.0 {
        return trials;
    }
    let (n, odds) = (trials as f64, chance / (1.0 - chance));
    let ln_choose =
        |k: f64| libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0);
    let ln_part = |k: f64| ln_choose(k) + k * libm::log(chance) + (n - k) * libm::log1p(-chance);
    let deviation = (n * chance * (1.0 - chance)).sqrt();
    climb(quantile, [n * chance, deviation], ln_part, |k| (n - k) / (k + 1.0) * odds).min(trials)
}

/// Adds up parts from where there are none yet, each `next` times the one before, until they reach `quantile`.
fn climb(
    quantile: f64,
    [mean, deviation]: [f64; 2],
    ln_part: impl Fn(f64) -> f64,
    next: impl Fn(f64) -> f64,
) -> u64 {
    let mut count = (mean - REACH * deviation).floor().max(0.0);
    let last = mean + REACH * deviation + MORE;
    let mut part = libm::exp(ln_part(count));
    let mut sum = part;
    while sum < quantile && count < last {
        part *= next(count);
        count += 1.0;
        sum += part;
    }
    count as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{Binomial, DiscreteCDF};

    #[test]
    fn counts_are_those_of_the_distribution_function() {
        for quantile in [1e-6, 0.01, 0.3, 0.5, 0.77, 0.99, 1.0 - 1e-6] {
            for (trials, chance) in
                [(1, 0.3), (30_000, 1e-5), (30_000, 0.01), (29_000, 0.4), (50, 0.98)]
            {
                let count = binomial(quantile, trials, chance);
                let of = Binomial::new(chance, trials).unwrap();
                assert!(of.cdf(count) >= quantile - 1e-9, "{quantile} {trials} {chance}: {count}");
                assert!(count == 0 || of.cdf(count - 1) < quantile + 1e-9);
            }
        }
    }

    #[test]
    fn what_cannot_happen_is_not_counted_and_what_must_is() {
        assert_eq!(
            [binomial(0.9, 0, 0.5), binomial(0.9, 7, 0.0), binomial(0.1, 7, 1.0)],
            [0, 0, 7]
        );
    }
}
