//! Goodness of fit of a pulse to histograms: Pearson's chi-square.

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::error::Result;
use tofsim::kernel::pulse::Pulse;

use crate::estimation::acquisition::Acquisition;
use crate::estimation::likelihood::Model;

use super::Sightings;

/// Neighbouring bins are merged until this many hits are expected.
const FEWEST: f64 = 10.0;
/// Arrival, signal and background of each histogram.
const FITTED: usize = 3;

/// Chi-square of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Goodness {
    /// Squares of residuals over their variances.
    pub chi_square: f64,
    /// Expected value on average.
    pub degrees_of_freedom: f64,
    /// Chance that it is as large, if the pulse is right.
    pub chance: f64,
}

impl Goodness {
    /// Of a pulse whose own parameters are so many.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn new(
        acquisition: &Acquisition,
        sightings: &Sightings,
        pulse: &Pulse,
        parameters: usize,
    ) -> Result<Self> {
        let model = Model::new(&Acquisition { pulse, ..*acquisition })?;
        let (mut chi_square, mut cells) = (0.0, 0usize);
        for (histogram, echo) in sightings.histograms.iter().zip(&sightings.echoes) {
            let expected = model.probabilities(echo);
            let (mut found, mut wanted) = (0.0, 0.0);
            let (mut all_found, mut all_wanted) = (0.0, 0.0);
            for (count, p) in histogram.iter().zip(&expected) {
                found += f64::from(*count);
                wanted += p * acquisition.shots as f64;
                if wanted >= FEWEST {
                    chi_square += (found - wanted) * (found - wanted) / wanted;
                    cells += 1;
                    (all_found, all_wanted) = (all_found + found, all_wanted + wanted);
                    (found, wanted) = (0.0, 0.0);
                }
            }
            // Shots without a hit, and what was left over.
            let shots = acquisition.shots as f64;
            let (rest_found, rest) = (shots - all_found, shots - all_wanted);
            if rest >= FEWEST {
                chi_square += (rest_found - rest) * (rest_found - rest) / rest;
                cells += 1;
            }
            // All cells together have as many hits as there are shots.
            cells = cells.saturating_sub(FITTED + 1);
        }
        let degrees_of_freedom = cells.saturating_sub(parameters).max(1) as f64;
        let chance = ChiSquared::new(degrees_of_freedom).map_or(f64::NAN, |law| law.sf(chi_square));
        Ok(Goodness { chi_square, degrees_of_freedom, chance })
    }
}
