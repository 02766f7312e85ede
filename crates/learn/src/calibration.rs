//! Calibration of the pulse shape from an instrument's own histograms.
//!
//! Arrival, signal and background of each histogram are unknown, and are fitted together with the common shape:
//! Fisher scoring of the profile likelihood of the shape's parameters ([`scoring`]). A pulse without a formula is
//! determined by expectation maximization ([`samples`]). A cover window's light is another calibration, of histograms
//! without a target ([`glass`]).

pub mod candidates;
pub mod glass;
pub mod goodness;
pub mod samples;
pub mod scoring;
pub mod shape;

use rayon::prelude::*;

use tofsim::error::{Input, Result};
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;

use crate::estimation::acquisition::{Acquisition, Echo};
use crate::estimation::likelihood::Likelihood;

/// Histograms with an echo, and where it is by the pulse of the moment.
#[derive(Clone, Debug)]
pub struct Sightings {
    /// Counts by bin.
    pub histograms: Vec<Histogram>,
    /// Arrival, signal and background in each.
    pub echoes: Vec<Echo>,
    /// Number of histograms that were left out because they have no echo.
    pub left_out: usize,
}

impl Sightings {
    /// Of all histograms that have an echo.
    ///
    /// # Errors
    /// When none has, one has more hits than shots, or [`Acquisition::check`] fails.
    pub fn new(acquisition: &Acquisition, histograms: Vec<Histogram>) -> Result<Self> {
        let likelihood = Likelihood::new(acquisition)?;
        let all = histograms.len();
        for (number, histogram) in histograms.iter().enumerate() {
            acquisition.check_hits("calibrate", number, histogram)?;
        }
        let fits = histograms.into_par_iter().map(|histogram| {
            let fit = likelihood.fit(&histogram).ok()?;
            Some((histogram, fit.echo))
        });
        let found: Vec<_> = fits.collect::<Vec<_>>().into_iter().flatten().collect();
        if found.is_empty() {
            let expected = "expected a histogram with an echo of four standard deviations or more";
            return Err(Input::new("calibrate", expected).value(format!("none of {all}")).into());
        }
        let left_out = all - found.len();
        let (histograms, echoes) = found.into_iter().unzip();
        Ok(Sightings { histograms, echoes, left_out })
    }

    /// The echoes as they are most likely with another pulse, and how likely all histograms are with them. One
    /// whose climb does not end stays where it was.
    fn refitted(&self, likelihood: &Likelihood) -> (Vec<Echo>, f64) {
        let model = likelihood.model();
        let each = self.histograms.par_iter().zip(&self.echoes).map(|(histogram, echo)| {
            let fit = likelihood.fit_from(histogram, *echo);
            let echo = fit.map_or(*echo, |fit| fit.echo);
            (echo, model.log_likelihood_of(&echo, histogram))
        });
        let (echoes, values): (Vec<_>, Vec<_>) = each.collect::<Vec<_>>().into_iter().unzip();
        (echoes, values.iter().sum())
    }

    /// Goes over to another pulse; how likely the histograms are with it.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn refit(&mut self, acquisition: &Acquisition, pulse: &Pulse) -> Result<f64> {
        let likelihood = Likelihood::new(&Acquisition { pulse, ..*acquisition })?;
        let (echoes, value) = self.refitted(&likelihood);
        self.echoes = echoes;
        Ok(value)
    }
}
