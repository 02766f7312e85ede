//! The likelihood estimator's instrument without rounding.

use tofsim::firmware::likelihood_estimator::params::{Params, Scales, Unfit, Wanted};
use tofsim::kernel::pulse::Pulse;
use tofsim::sim::estimates::likelihood::Instrument;

/// Steepest slope of a logarithm; the pulse's tails have none [1 / deviation].
const STEEPEST: f64 = 8.0;
/// All of a pulse, 17 fraction bits.
const ALL: f64 = 131_072.0;

/// Bins and pulse in double precision, and what a designer chose in whole numbers.
#[derive(Clone, Debug)]
pub struct Model {
    /// The firmware's parameters.
    pub words: Params,
    /// Unit of time [ps].
    pub unit_ps: f64,
    /// Distance for each time of flight [m/ps].
    pub metres_per_ps: f64,
    scales: Scales<f64>,
    edges_ps: Vec<f64>,
    pulse: Pulse,
    /// Part of the cover glass's light in each bin.
    glass: Vec<f64>,
}

impl Model {
    /// Of an instrument.
    ///
    /// # Errors
    /// When it has no likelihood estimator.
    pub fn new(wanted: &Wanted) -> Result<Self, Unfit> {
        let light: f64 = wanted.glass.iter().sum();
        Ok(Model {
            words: Params::new(wanted)?,
            unit_ps: wanted.unit_ps(),
            metres_per_ps: wanted.metres_per_ps,
            scales: wanted.scales(),
            edges_ps: wanted.edges_ps.to_vec(),
            glass: wanted.glass.iter().map(|hazard| hazard / light).collect(),
            pulse: wanted.pulse.clone(),
        })
    }

    /// -f' / f of the pulse [1/ps].
    fn slope(&self, t_ps: f64) -> f64 {
        let density = self.pulse.density(t_ps);
        match density * self.pulse.sigma_ps() > 1e-12 {
            true => self.kept(-self.pulse.slope(t_ps) / density),
            false => t_ps.signum() * self.steepest(),
        }
    }

    fn steepest(&self) -> f64 {
        STEEPEST / self.pulse.sigma_ps()
    }

    fn kept(&self, slope: f64) -> f64 {
        slope.clamp(-self.steepest(), self.steepest())
    }
}

impl Instrument for Model {
    type Number = f64;

    fn words(&self) -> &Params {
        &self.words
    }

    fn width(&self, bin: usize) -> f64 {
        (self.edges_ps[bin + 1] - self.edges_ps[bin]) / self.unit_ps
    }

    fn pulse(&self, edge: usize, arrival: f64) -> [f64; 3] {
        let t_ps = self.edges_ps[edge] - arrival * self.unit_ps / 16.0;
        let (part, density) = (self.pulse.part(t_ps), self.pulse.density(t_ps));
        let first = self.kept(-density / part.max(f64::MIN_POSITIVE));
        // What z counts in a deviation.
        let z = self.scales.kappa.sqrt() / 4.0 * self.pulse.sigma_ps();
        [part * ALL, self.slope(t_ps) * z, first * z]
    }

    fn glass(&self, bin: usize) -> f64 {
        self.glass.get(bin).map_or(0.0, |part| part * ALL)
    }

    fn scales(&self) -> Scales<f64> {
        self.scales
    }
}
