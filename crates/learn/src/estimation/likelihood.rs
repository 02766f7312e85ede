//! Maximum likelihood: the arrival, signal and background that make the histogram most probable.
//!
//! Pile-up is in the model ([`model`]), so that nothing has to be corrected. All three are free, and
//! Fisher scoring (Newton's method with the expected curvature) climbs from the matched filter's
//! place; a step that gains nothing is damped as Levenberg and Marquardt do. In MODE 1 the
//! matched filter cannot tell signal and background, and the climb begins at the best of several of
//! both.
//!
//! With a template of a cover window's light ([`tofsim::scenario::glass`]) its amplitude is free too ([`pedestal`]).
//!
//! An estimate is of one echo, because a pulse that is wider than told looks like two as well;
//! [`two_echoes::TwoEchoes`] fits two.

mod arming;
mod climb;
pub mod model;
mod pedestal;
pub(crate) mod solve;
mod steady;
mod stretches;
pub mod two_echoes;

use std::f64::consts::LN_2;

use rayon::prelude::*;

use tofsim::error::Input;

use super::acquisition::{ARRIVAL_PS_PER_M, Acquisition, Echo};
use super::estimator::{EchoDepth, Estimator, Failure, Found, Pedestal, hits};
use super::matched_filter::MatchedFilter;

use climb::{Top, climb};
pub use model::Model;
use pedestal::Misfit;

/// Starts from which it is climbed in MODE 1.
const CLIMBS: usize = 3;
/// Signals to begin with in MODE 1 [1].
const SIGNALS: [f64; 6] = [0.05, 0.3, 1.0, 4.0, 16.0, 64.0];
/// Backgrounds to begin with there [1/ps].
const BACKGROUNDS: [f64; 6] = [1e-6, 3e-5, 1e-4, 2.5e-4, 6e-4, 1.5e-3];

/// The maximum-likelihood estimator of one pulse and one chain.
#[derive(Clone, Debug)]
pub struct Likelihood {
    model: Model,
    start: MatchedFilter,
    /// Time at which bin 0 begins [ps].
    first_ps: f64,
    /// Width of a bin [ps].
    bin_ps: f64,
    /// Delay of the light after the laser edge [ps].
    delay_ps: f64,
    /// Fit of the cover window's light, if there is a template of it.
    misfit: Option<Misfit>,
}

/// The most likely scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Arrival, signal and background.
    pub echo: Echo,
    /// Standard deviation of the arrival by the model's own curvature [ps].
    pub arrival_deviation_ps: f64,
    /// Amplitude of the cover window's light and its standard error, if there is a template of it [1].
    pub amplitude: Option<[f64; 2]>,
}

impl Likelihood {
    /// For histograms that come about so: 200 steps at most, to a gain of 1e-5, and an echo counts
    /// from 4 standard deviations on.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        let (model, start) = (Model::new(acquisition)?, MatchedFilter::new(acquisition)?);
        let (first_ps, bin_ps) = (acquisition.bins.first_ps(), acquisition.bins.bin_ps());
        let (delay_ps, misfit) = (acquisition.delay_ps, acquisition.glass.map(Misfit::new));
        Ok(Likelihood { model, start, first_ps, bin_ps, delay_ps, misfit })
    }

    /// The most likely scene of a histogram.
    ///
    /// # Errors
    /// When there is no echo, or the climb does not end.
    pub fn fit(&self, histogram: &[u32]) -> Result<Fit, Failure> {
        hits(histogram, self.model.shots as u32)?;
        if self.model.has_pedestal() {
            return self.fit_with_pedestal(histogram);
        }
        let start = self.start.best(histogram).ok_or(Failure::NoPeak)?.echo;
        match self.model.free_running {
            None => self.fit_from(histogram, start),
            Some(_) => self.free_fit(histogram, start.arrival_ps),
        }
    }

    /// The same from a scene that is near it already, without a cover window's light.
    ///
    /// # Errors
    /// When there is no echo, or the climb does not end.
    pub fn fit_from(&self, histogram: &[u32], near: Echo) -> Result<Fit, Failure> {
        let top = climb(&self.model, histogram, self.model.coordinates(&near))?;
        Ok(Fit::of(&self.model, &top, 0))
    }

    /// The most likely scene with a cover window's light, from the best of the places where the matched filter sees an echo
    /// beside it: noise of a strong pedestal may stand out as much as a faint echo.
    ///
    /// # Errors
    /// When there is no echo, or no climb ends.
    fn fit_with_pedestal(&self, histogram: &[u32]) -> Result<Fit, Failure> {
        let (mut best, mut failure) = (None, Failure::NoPeak);
        for found in self.start.places(histogram) {
            let at = self.model.coordinates_with(&found.echo, found.amplitude);
            match climb(&self.model, histogram, at) {
                Ok(top) if best.as_ref().is_none_or(|(value, _)| top.value > *value) => {
                    best = Some((top.value, Fit::of(&self.model, &top, 0)));
                }
                Ok(_) => {}
                Err(found) => failure = found,
            }
        }
        best.map(|(_, fit)| fit).ok_or(failure)
    }

    /// Returns the amplitude of the window's light beside one echo or two, and how well its bins fit, if there is a
    /// template.
    pub(super) fn pedestal(&self, histogram: &[u32], fits: &[Fit]) -> Option<Pedestal> {
        let (misfit, [relative, relative_se]) = (self.misfit.as_ref()?, fits.first()?.amplitude?);
        let probabilities = match fits {
            [one, other] => {
                let [place, signal, second, second_signal, background] =
                    self.model.coordinates_of_two(&one.echo, &other.echo);
                let at = [place, signal, second, second_signal, relative, background];
                self.model.probabilities_at(&at)
            }
            _ => self.model.probabilities_at(&self.model.coordinates_with(&fits[0].echo, relative)),
        };
        let misfit = misfit.of(histogram, &probabilities, self.model.shots as f64, relative);
        Some(Pedestal { relative, relative_se, misfit })
    }

    /// Distance of what the echo of a fit comes from.
    fn depth(&self, fit: &Fit) -> EchoDepth {
        let depth_m = (fit.echo.arrival_ps - self.delay_ps) / ARRIVAL_PS_PER_M;
        EchoDepth::new(depth_m, fit.arrival_deviation_ps / ARRIVAL_PS_PER_M)
    }

    /// The model of the histograms.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// In MODE 1: the highest of the tops that are reached from the best starts.
    fn free_fit(&self, histogram: &[u32], seen_ps: f64) -> Result<Fit, Failure> {
        let mut starts = self.free_starts(histogram, seen_ps);
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        starts.truncate(CLIMBS);
        let fits = starts.into_par_iter().filter_map(|(_, start)| {
            let top = climb(&self.model, histogram, self.model.coordinates(&start)).ok()?;
            let fit = Fit::of(&self.model, &top, 0);
            Some((self.model.log_likelihood_of(&fit.echo, histogram), fit))
        });
        let fits: Vec<_> = fits.collect();
        let best = fits.into_iter().reduce(|best, fit| if fit.0 > best.0 { fit } else { best });
        best.map(|(_, fit)| fit).ok_or(Failure::NoPeak)
    }

    /// Returns the starting points of climbs in MODE 1, with their likelihoods: for each signal the best of some
    /// scenes whose first photons arrive where the matched filter found them, or in the fullest bin.
    fn free_starts(&self, histogram: &[u32], seen_ps: f64) -> Vec<(f64, Echo)> {
        let fullest = (0..histogram.len()).max_by_key(|&code| histogram[code]).unwrap_or(0);
        let places_ps = [seen_ps, self.first_ps + (fullest as f64 + 0.5) * self.bin_ps];
        let best = |signal: f64| {
            // Half of the shots have had a photon where S Phi is ln 2.
            let early_ps =
                if signal > 2.0 * LN_2 { -self.model.when_ps(LN_2 / signal) } else { 0.0 };
            let echo = |(first_ps, background_per_ps): (f64, f64)| {
                let arrival_ps = first_ps + early_ps;
                let echo = Echo { arrival_ps, signal, background_per_ps };
                let at = self.model.coordinates(&echo);
                (self.model.log_likelihood(&at, histogram), echo)
            };
            let all = places_ps.into_iter().flat_map(|ps| BACKGROUNDS.map(|rate| (ps, rate)));
            all.map(echo).max_by(|a, b| a.0.total_cmp(&b.0))
        };
        SIGNALS.into_par_iter().filter_map(best).collect()
    }
}

impl Fit {
    /// An echo of a top, the first or the second of its coordinates.
    fn of<const N: usize>(model: &Model, top: &Top<N>, which: usize) -> Self {
        let arrival_deviation_ps = top.variances[2 * which].sqrt() * model.sigma_ps;
        let amplitude = model::pedestal::<N>().map(|k| [top.at[k], top.variances[k].sqrt()]);
        Fit { echo: model.echo(&top.at, which), arrival_deviation_ps, amplitude }
    }
}

impl Estimator for Likelihood {
    fn name(&self) -> &'static str {
        "likelihood"
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        Ok(self.depth(&self.fit(histogram)?).depth_m)
    }

    fn find(&self, histogram: &[u32]) -> Result<Found, Failure> {
        let fit = self.fit(histogram)?;
        let EchoDepth { depth_m, sigma_m, .. } = self.depth(&fit);
        let pedestal = self.pedestal(histogram, &[fit]);
        Ok(Found { sigma_m: Some(sigma_m), pedestal, ..Found::depth(depth_m) })
    }
}

#[cfg(test)]
mod tests;
