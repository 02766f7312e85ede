//! The light of a cover window in the fit: its amplitude, and whether its shape is still that of the template.
//!
//! The climb begins at the places where the matched filter sees an echo beside the window's light, several if there are
//! such, because noise of a strong pedestal may stand out as much as a faint echo.

use tofsim::scenario::glass::GlassTemplate;

use crate::estimation::estimator::{Failure, Pedestal};

use super::climb::climb;
use super::{Fit, Likelihood};

/// Expected hits below which bins are not weighed alone [hits].
const FEW: f64 = 5.0;

/// Bins of a template, by which its fit is judged.
#[derive(Clone, Debug)]
pub struct Misfit {
    /// Standard error of each code's hazard; `None` outside of the template [1].
    errors: Vec<Option<f64>>,
}

impl Misfit {
    /// For a template.
    pub fn new(glass: &GlassTemplate) -> Self {
        let error =
            |bin: &tofsim::scenario::glass::GlassBin| (bin.hazard > 0.0).then_some(bin.hazard_se);
        Misfit { errors: glass.bins().iter().map(error).collect() }
    }

    /// Sum of squared residuals beyond the number of bins, in its standard deviations, for a template's amplitude and
    /// the probability of each code. The template's own errors count as noise.
    fn of(&self, histogram: &[u32], probabilities: &[f64], shots: f64, amplitude: f64) -> f64 {
        let (mut sum, mut count, mut left) = (0.0, 0.0, shots);
        for ((&hits, p), error) in histogram.iter().zip(probabilities).zip(&self.errors) {
            let (hits, expected) = (f64::from(hits), shots * p);
            if let Some(error) = error.filter(|_| expected >= FEW) {
                let of_template = left * amplitude * error;
                sum +=
                    (hits - expected).powi(2) / (expected * (1.0 - p) + of_template * of_template);
                count += 1.0;
            }
            left -= hits;
        }
        if count > 0.0 { (sum - count) / f64::sqrt(2.0 * count) } else { 0.0 }
    }
}

impl Likelihood {
    /// The most likely scene with a cover window's light, from the best of the matched filter's places.
    ///
    /// # Errors
    /// When there is no echo, or no climb ends.
    pub(super) fn fit_with_pedestal(&self, histogram: &[u32]) -> Result<Fit, Failure> {
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
}
