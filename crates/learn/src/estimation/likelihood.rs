//! Maximum likelihood: the arrival, signal and background that make the histogram most probable.
//!
//! Pile-up is in the model ([`model`]), so that nothing has to be corrected. All three are free, and
//! Fisher scoring (Newton's method with the expected curvature) climbs from the matched filter's
//! place; a step that gains nothing is damped as Levenberg and Marquardt do.

pub mod model;
mod solve;

use tofsim::error::Input;
use tofsim::network::Histogram;

use super::acquisition::{ARRIVAL_PS_PER_M, Acquisition, Echo};
use super::estimator::{Estimator, Failure, hits};
use super::matched_filter::MatchedFilter;

pub use model::Model;
use solve::{inverse_diagonal, solve};

/// Largest step of any coordinate in one iteration [sigma, e-folds].
const LONGEST: f64 = 1.0;
/// The background falls to a tenth in one iteration at most [1].
const FALL: f64 = 0.1;
/// Where the signal is taken to have run away, either way [e-folds].
const RUNAWAY: f64 = 20.0;
/// A promised gain that rounding may swallow [1].
const NOTHING: f64 = 1e-4;
/// A damping that leaves no step worth trying [1].
const STUCK: f64 = 1e6;
/// Most steps, taken or not.
const MOST_ITERATIONS: usize = 200;
/// The climb is over when a step promises less than this gain of the log likelihood [1].
const TOLERANCE: f64 = 1e-5;
/// Signal that counts as one, in its own standard deviations [1].
const SIGNIFICANCE: f64 = 4.0;

/// The maximum-likelihood estimator of one pulse and one chain.
#[derive(Clone, Debug)]
pub struct Likelihood {
    model: Model,
    start: MatchedFilter,
}

/// The most likely scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Arrival, signal and background.
    pub echo: Echo,
    /// Standard deviation of the arrival by the model's own curvature [ps].
    pub arrival_deviation_ps: f64,
}

impl Likelihood {
    /// For histograms that come about so: 200 steps at most, to a gain of 1e-5, and an echo counts
    /// from 4 standard deviations on.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        let (model, start) = (Model::new(acquisition)?, MatchedFilter::new(acquisition)?);
        Ok(Likelihood { model, start })
    }

    /// The most likely scene of a histogram.
    ///
    /// # Errors
    /// When there is no echo, or the climb does not end.
    pub fn fit(&self, histogram: &Histogram) -> Result<Fit, Failure> {
        hits(histogram, self.model.shots as u32)?;
        let start = self.start.best(histogram).ok_or(Failure::NoPeak)?;
        self.climb(histogram, start.echo)
    }

    /// The top that is reached from `start`.
    fn climb(&self, histogram: &Histogram, start: Echo) -> Result<Fit, Failure> {
        let mut at = self.model.coordinates(&start);
        let mut value = self.model.log_likelihood(&at, histogram);
        let mut damping = 0.0f64;
        let mut slope = self.model.slope(&at, histogram);
        for _ in 0..MOST_ITERATIONS {
            let (gradient, information) = &slope;
            // At its lowest the background stays, unless it is to rise.
            let held = at[2] <= self.model.least_background() && gradient[2] <= 0.0;
            let step = solve(information, gradient, damping, held);
            let gain = step.map(|step| (0..3).map(|k| step[k] * gradient[k]).sum::<f64>());
            if damping == 0.0 && gain.is_some_and(|gain| gain < TOLERANCE) {
                return self.accept(&at, information, held);
            }
            let tried = step.map(|step| self.go(&at, &step));
            let reached = tried.map(|to| (to, self.model.log_likelihood(&to, histogram)));
            match reached.filter(|(_, reached)| *reached >= value) {
                Some((to, reached)) => {
                    (at, value) = (to, reached);
                    damping = if damping > 1e-4 { damping * 0.1 } else { 0.0 };
                    slope = self.model.slope(&at, histogram);
                }
                None if damping == 0.0 && gain.is_some_and(|gain| gain < NOTHING) => {
                    return self.accept(&at, information, held);
                }
                None => damping = (damping * 10.0).max(1e-3),
            }
            if damping > STUCK || at[1].abs() > RUNAWAY {
                break;
            }
        }
        Err(Failure::NoConvergence)
    }

    /// The end of a step, which is shortened so that no coordinate goes too far.
    fn go(&self, at: &[f64; 3], step: &[f64; 3]) -> [f64; 3] {
        let longest = step[0].abs().max(step[1].abs()).max(LONGEST);
        let [place, signal, background] = [0, 1, 2].map(|k| at[k] + step[k] * LONGEST / longest);
        let least = (at[2] * FALL).max(self.model.least_background());
        [place, signal, background.max(least)]
    }

    /// The top as a scene, if its signal is one.
    fn accept(
        &self,
        at: &[f64; 3],
        information: &[[f64; 3]; 3],
        held: bool,
    ) -> Result<Fit, Failure> {
        let variances = inverse_diagonal(information, held).ok_or(Failure::NoConvergence)?;
        let echo = self.model.echo(at);
        let within = -self.model.sigma_ps..=self.model.end_ps + self.model.sigma_ps;
        // The deviation of ln S is that of S by S.
        if variances[1].sqrt() * SIGNIFICANCE > 1.0 || !within.contains(&echo.arrival_ps) {
            return Err(Failure::NoPeak);
        }
        let arrival_deviation_ps = variances[0].sqrt() * self.model.sigma_ps;
        Ok(Fit { echo, arrival_deviation_ps })
    }
}

impl Estimator for Likelihood {
    fn name(&self) -> &'static str {
        "likelihood"
    }

    fn estimate(&self, histogram: &Histogram) -> Result<f64, Failure> {
        Ok(self.fit(histogram)?.echo.arrival_ps / ARRIVAL_PS_PER_M)
    }
}

#[cfg(test)]
mod tests;
