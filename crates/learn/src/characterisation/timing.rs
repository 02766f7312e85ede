//! Errors of measured times, for hits at any phase of the clock.

use serde::Serialize;

use tofsim::firmware::tdc;

use super::density::{CodeDensity, Spread};

/// Of a converter with a certain ROM.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeError {
    /// Mean, over all phases [ps].
    #[serde(rename = "mean_error_ps")]
    pub mean_ps: f64,
    /// Standard deviation of a single hit at a random phase: what papers call single-shot precision [ps].
    pub precision_ps: f64,
    /// Time less truth in the middle of each bin, the mean taken away: the integral nonlinearity [ps].
    #[serde(skip)]
    pub errors_ps: Vec<f64>,
    /// Spread of those: INL [ps].
    #[serde(rename = "inl_ps")]
    pub inl: Spread,
    /// Spread of the errors of the steps from bin to bin: DNL [ps].
    #[serde(rename = "dnl_ps")]
    pub dnl: Spread,
}

impl TimeError {
    /// Exact, from the delays: a bin's hits have one time and are spread evenly over its width.
    pub fn new(p: &tdc::Params, density: &CodeDensity) -> Self {
        let scale = &p.decoder.scale;
        let first_ps = scale.first().fs() as f64 * 1e-3;
        let age_ps = |n: usize| scale.ps(p.decoder.cal[n].get() as i64) - 2.0 * first_ps;
        // An age too large is a time too small.
        let errors: Vec<_> =
            density.bins.iter().map(|bin| bin.true_age_ps - age_ps(bin.n)).collect();
        let widths = density.bins.iter().map(|bin| bin.true_width_ps);
        let sum: f64 = widths.clone().sum();
        let mean_ps = errors.iter().zip(widths.clone()).map(|(e, w)| e * w).sum::<f64>() / sum;
        let errors_ps: Vec<_> = errors.iter().map(|error| error - mean_ps).collect();
        let squares = errors_ps.iter().zip(widths).map(|(e, w)| w * (e * e + w * w / 12.0));
        let precision_ps = (squares.sum::<f64>() / sum).sqrt();
        // A number that no hit has makes no error.
        let seen = errors_ps.iter().zip(&density.bins).filter(|(_, bin)| bin.true_width_ps > 0.0);
        let seen: Vec<_> = seen.map(|(error, _)| *error).collect();
        let steps: Vec<_> = seen.windows(2).map(|pair| pair[1] - pair[0]).collect();
        TimeError {
            mean_ps,
            precision_ps,
            inl: Spread::of(&seen),
            dnl: Spread::of(&steps),
            errors_ps,
        }
    }
}
