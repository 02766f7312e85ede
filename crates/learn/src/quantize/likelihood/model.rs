//! Parameters of the likelihood estimator for an instrument, without rounding.

use std::ops::Range;

use tofsim::firmware::likelihood_estimator::params::{Params, Unfit, Wanted};
use tofsim::firmware::likelihood_estimator::words::UNITS;
use tofsim::kernel::pulse::Pulse;

/// Steepest slope of a logarithm; the pulse's tails have none [1 / deviation].
const STEEPEST: f64 = 8.0;

/// Bins and pulse in double precision, and what a designer chose in whole numbers.
#[derive(Clone, Debug)]
pub struct Model {
    /// The words: lengths of the fit and of the box, and shots are taken from here.
    pub words: Params,
    /// Length that a bin is meant to have [ps].
    pub bin_ps: f64,
    /// Distance for each time of flight [m/ps].
    pub metres_per_ps: f64,
    /// Delay of the light after the laser edge [ps].
    pub delay_ps: f64,
    /// The pulse's standard deviation [ps].
    pub sigma_ps: f64,
    /// Change of mu for a step of one: z is 32 there [ps].
    pub stride_ps: f64,
    edges_ps: Vec<f64>,
    pulse: Pulse,
}

impl Model {
    /// Of an instrument.
    ///
    /// # Errors
    /// When it has no likelihood estimator.
    pub fn new(wanted: &Wanted) -> Result<Self, Unfit> {
        let words = Params::new(wanted)?;
        let (bin_ps, sigma_ps) = (wanted.bin_ps, wanted.pulse.sigma_ps());
        // What z counts in a deviation, by the step of the pulse's ROM.
        let step_ps = bin_ps / UNITS as f64 * f64::from(words.step_log2).exp2();
        let z_of_sigma = sigma_ps / step_ps / 4.0;
        Ok(Model {
            words,
            bin_ps,
            metres_per_ps: wanted.metres_per_ps,
            delay_ps: wanted.delay_ps,
            sigma_ps,
            stride_ps: z_of_sigma * sigma_ps / 32.0,
            edges_ps: wanted.edges_ps.to_vec(),
            pulse: wanted.pulse.clone(),
        })
    }

    /// Bins.
    pub fn bins(&self) -> usize {
        self.edges_ps.len() - 1
    }

    /// Returns the end of the last bin [ps].
    pub fn end_ps(&self) -> f64 {
        self.edges_ps[self.bins()]
    }

    /// Returns the width of a bin [bins].
    pub fn width(&self, bin: usize) -> f64 {
        (self.edges_ps[bin + 1] - self.edges_ps[bin]) / self.bin_ps
    }

    /// Bins of the fit of an echo at that time.
    pub fn window(&self, arrival_ps: f64) -> Range<usize> {
        let centre = ((arrival_ps / self.bin_ps) as usize).min(self.bins() - 1);
        centre.saturating_sub(self.words.before)..(centre + self.words.after + 1).min(self.bins())
    }

    /// The part of a pulse around `arrival_ps` that falls into a bin, and the slope of its logarithm by the
    /// arrival; bin 0 has all that came before it ends [1, 1 / stride].
    pub fn part(&self, bin: usize, arrival_ps: f64) -> [f64; 2] {
        let [begin, end] = [bin, bin + 1].map(|edge| self.edges_ps[edge] - arrival_ps);
        let before = if bin == 0 { 0.0 } else { self.pulse.part(begin) };
        let slope = match bin {
            0 => self.kept(-self.pulse.density(end) / self.pulse.part(end).max(f64::MIN_POSITIVE)),
            _ => (self.slope(begin) + self.slope(end)) / 2.0,
        };
        [self.pulse.part(end) - before, slope * self.stride_ps]
    }

    /// -f' / f of the pulse [1/ps].
    fn slope(&self, t_ps: f64) -> f64 {
        let density = self.pulse.density(t_ps);
        match density * self.sigma_ps > 1e-12 {
            true => self.kept(-self.pulse.slope(t_ps) / density),
            false => t_ps.signum() * self.steepest(),
        }
    }

    fn steepest(&self) -> f64 {
        STEEPEST / self.sigma_ps
    }

    fn kept(&self, slope: f64) -> f64 {
        slope.clamp(-self.steepest(), self.steepest())
    }
}
