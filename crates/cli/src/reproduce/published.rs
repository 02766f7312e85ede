//! Means and spreads at the thesis's six distances, beside the published ones.

use tofsim_learn::evaluation::Spread;
use tofsim_learn::evaluation::thesis::{DISTANCES_M, Published};

use super::values::Values;

/// How many estimates a published mean and spread are of, and the degrees of freedom of that spread.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Estimates at a distance.
    pub count: f64,
    /// Degrees of freedom.
    pub freedom: f64,
}

/// Returns the mean error, the mean depth and twice the standard deviation at each distance, printed and ours, with their
/// standard errors; `spread` has the errors of a distance, by its place.
pub fn compared(published: &Published, of: Sample, spread: impl Fn(usize) -> Spread) -> Values {
    let mut values = Values::default();
    for (at, m) in DISTANCES_M.into_iter().enumerate() {
        let spread = spread(at);
        let metres = |mm: Option<f64>| 1e-3 * mm.unwrap_or(f64::NAN);
        let (mean_m, two_sd_m) = (1e-3 * published.mean_mm[at], 1e-3 * published.two_sd_mm[at]);
        let error_m = two_sd_m / 2.0 / of.count.sqrt();
        let (own_m, own_error_m) = (metres(spread.mean_mm), metres(spread.mean_se_mm));
        let mut put = |name: &str, number: f64, error: f64| {
            values.put_figure(format!("{name}.{m}"), (number, error));
        };
        put("printed_error_m", mean_m, error_m);
        put("printed_depth_m", m + mean_m, error_m);
        put("printed_two_sd_m", two_sd_m, two_sd_m / (2.0 * of.freedom).sqrt());
        put("error_m", own_m, own_error_m);
        put("depth_m", m + own_m, own_error_m);
        put("two_sd_m", metres(spread.two_sd_mm), metres(spread.two_sd_se_mm));
    }
    values
}
