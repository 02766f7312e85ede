//! Whether the shape of a cover window's light is still that of its template.

use tofsim::scenario::glass::{GlassBin, GlassTemplate};

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
        let error = |bin: &GlassBin| (bin.hazard > 0.0).then_some(bin.hazard_se);
        Misfit { errors: glass.bins().iter().map(error).collect() }
    }

    /// Sum of squared residuals beyond the number of bins, in its standard deviations, for a template's amplitude and
    /// the probability of each code. The template's own errors count as noise.
    pub fn of(&self, histogram: &[u32], probabilities: &[f64], shots: f64, amplitude: f64) -> f64 {
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
