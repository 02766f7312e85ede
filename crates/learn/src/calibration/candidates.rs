//! Pulses that may have made histograms, and which to take.

use tofsim::error::Result;
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;

use crate::estimation::acquisition::Acquisition;

use super::Sightings;
use super::goodness::Goodness;
use super::samples::{self, Sampled, sampled, shown};
use super::scoring::climb;
use super::shape::{Formula, Shape, Width};

/// Twice what a tail has to gain in log likelihood to be taken for one: three deviations.
const TAIL_GAIN: f64 = 9.0;
/// A pulse whose fit is as bad as that by chance so rarely is taken for a wrong one.
const DOUBTFUL: f64 = 1e-3;

/// Source of a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Pulse of the scenario.
    Scenario,
    /// A Gaussian is fitted.
    Gaussian,
    /// A Gaussian with an exponential tail is fitted.
    Tail,
    /// Its samples are fitted.
    Samples,
}

/// A pulse beside histograms.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Source of the pulse.
    pub kind: Kind,
    /// The pulse.
    pub pulse: Pulse,
    /// Width and tail, where they are fitted.
    pub width: Option<Width>,
    /// Samples, where they are.
    pub sampled: Option<Sampled>,
    /// Logarithm of the likelihood of the histograms, up to a constant that all candidates share.
    pub log_likelihood: f64,
    /// Goodness of fit.
    pub goodness: Goodness,
}

/// Result of a pulse calibration.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The scenario's pulse first, then those that were fitted.
    pub candidates: Vec<Candidate>,
    /// Index of the chosen candidate.
    pub chosen: usize,
    /// Pulse observed in the bins, about the echoes by the accepted shape: time from the mean, density and its
    /// standard error [ps, 1/ps, 1/ps].
    pub shown: Vec<[f64; 3]>,
    /// Histograms with an echo.
    pub used: usize,
    /// Histograms without one.
    pub left_out: usize,
}

impl Calibration {
    /// Fits pulses to histograms: of a wanted kind, or of as many as it takes to describe them.
    ///
    /// # Errors
    /// When no histogram has an echo, none tells of the pulse, or samples are wanted where there can be none.
    pub fn new(
        acquisition: &Acquisition,
        histograms: Vec<Histogram>,
        wanted: Option<Kind>,
        step_ps: f64,
    ) -> Result<Self> {
        let sampling = samples::check(acquisition);
        let can_sample = sampling.is_ok();
        if wanted == Some(Kind::Samples) {
            sampling?;
        }
        let mut sightings = Sightings::new(acquisition, histograms)?;
        let assumed = acquisition.pulse;
        let mut candidates = vec![Candidate {
            kind: Kind::Scenario,
            pulse: assumed.clone(),
            width: None,
            sampled: None,
            log_likelihood: sightings.refit(acquisition, assumed)?,
            goodness: Goodness::new(acquisition, &sightings, assumed, 0)?,
        }];
        let mut sigma_ps = assumed.sigma_ps();
        for (kind, formula) in [(Kind::Gaussian, Formula::Gaussian), (Kind::Tail, Formula::Tail)] {
            let climbed = climb(acquisition, &mut sightings, Shape::new(formula, sigma_ps))?;
            let (shape, pulse) = (climbed.shape, climbed.shape.pulse());
            sigma_ps = pulse.sigma_ps();
            candidates.push(Candidate {
                kind,
                goodness: Goodness::new(acquisition, &sightings, &pulse, shape.free())?,
                pulse,
                width: Some(shape.width(&climbed.covariance)),
                sampled: None,
                log_likelihood: climbed.log_likelihood,
            });
        }
        let [gaussian, tail] = [&candidates[1], &candidates[2]];
        let gain = 2.0 * (tail.log_likelihood - gaussian.log_likelihood);
        let formula = if gain > TAIL_GAIN { 2 } else { 1 };
        let is_doubtful = candidates[formula].goodness.chance < DOUBTFUL;
        let samples =
            wanted == Some(Kind::Samples) || (wanted.is_none() && is_doubtful && can_sample);
        if samples {
            let near = candidates[formula].pulse.clone();
            let sampled = sampled(acquisition, &mut sightings, &near, step_ps)?;
            let count = sampled.density.len();
            candidates.push(Candidate {
                kind: Kind::Samples,
                pulse: sampled.pulse.clone(),
                width: None,
                log_likelihood: sampled.log_likelihood,
                goodness: Goodness::new(acquisition, &sightings, &sampled.pulse, count)?,
                sampled: Some(sampled),
            });
        }
        let of_kind = |kind| candidates.iter().position(|candidate| candidate.kind == kind);
        let chosen = match wanted {
            Some(kind) => of_kind(kind),
            None => of_kind(Kind::Samples),
        };
        let chosen = chosen.unwrap_or(formula);
        sightings.refit(acquisition, &candidates[chosen].pulse)?;
        let shown = shown(acquisition, &sightings, acquisition.bins.bin_ps());
        let (used, left_out) = (sightings.histograms.len(), sightings.left_out);
        Ok(Calibration { candidates, chosen, shown, used, left_out })
    }

    /// The pulse to take.
    pub fn taken(&self) -> &Candidate {
        &self.candidates[self.chosen]
    }

    /// Returns whether the pulse is inconsistent with the histograms.
    pub fn is_doubtful(&self) -> bool {
        self.taken().goodness.chance < DOUBTFUL
    }
}
