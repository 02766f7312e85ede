//! A pulse by samples of its density.

use std::sync::Arc;

/// A density at even steps, linear between them, and zero from a step beyond the ends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Place of the first sample, from the mean [ps].
    from_ps: f64,
    /// From one to the next [ps].
    step_ps: f64,
    /// Density [1/ps].
    density: Arc<[f64]>,
    /// Its integral up to each sample [1].
    before: Arc<[f64]>,
}

/// Reason why a density is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unusable {
    /// There are too few samples to tell a shape.
    #[error("expected three samples or more")]
    Few,
    /// The step is not more than zero.
    #[error("expected a step of more than 0 ps")]
    Step,
    /// A sample is below zero, or no number.
    #[error("expected a density of 0 or more")]
    Negative,
    /// All are zero.
    #[error("expected a density that is not zero everywhere")]
    Nothing,
}

impl Samples {
    /// Densities, to a constant factor, one for each step [ps]: their mean is moved to zero, and their
    /// integral made one.
    ///
    /// # Errors
    /// When that cannot be.
    pub fn new(step_ps: f64, density: &[f64]) -> Result<Self, Unusable> {
        if density.len() < 3 {
            return Err(Unusable::Few);
        }
        if !(step_ps > 0.0 && step_ps.is_finite()) {
            return Err(Unusable::Step);
        }
        if !density.iter().all(|value| (0.0..=1e100).contains(value)) {
            return Err(Unusable::Negative);
        }
        let sum: f64 = density.iter().sum();
        if sum <= 0.0 {
            return Err(Unusable::Nothing);
        }
        let mean = density.iter().enumerate().map(|(k, value)| k as f64 * value).sum::<f64>() / sum;
        let density: Arc<[f64]> = density.iter().map(|value| value / sum / step_ps).collect();
        let (mut passed, mut last) = (0.0, 0.0);
        let before = density.iter().map(|&value| {
            passed += 0.5 * (last + value) * step_ps;
            last = value;
            passed
        });
        let before = before.collect();
        Ok(Samples { from_ps: -mean * step_ps, step_ps, density, before })
    }

    /// Standard deviation, of the straight lines between samples [ps].
    pub fn sigma_ps(&self) -> f64 {
        let square = |(k, value): (usize, &f64)| {
            let t_ps = self.from_ps + k as f64 * self.step_ps;
            t_ps * t_ps * value * self.step_ps
        };
        let variance: f64 = self.density.iter().enumerate().map(square).sum();
        libm::sqrt(variance + self.step_ps * self.step_ps / 6.0)
    }

    /// Returns begin and end of the straight lines, from the mean [ps].
    pub fn reach_ps(&self) -> [f64; 2] {
        [-1.0, self.density.len() as f64].map(|place| self.from_ps + place * self.step_ps)
    }

    /// Of the samples those around all but a part at either end, from the mean [ps].
    pub fn ends_ps(&self, tail: f64) -> [f64; 2] {
        let within = |part: &f64| (tail..=1.0 - tail).contains(part);
        let first = self.before.iter().position(within).unwrap_or(0);
        let last = self.before.iter().rposition(within).unwrap_or(self.before.len() - 1);
        let places = [first as f64 - 1.0, last as f64 + 1.0];
        places.map(|place| self.from_ps + place * self.step_ps)
    }

    /// A sample, zero beyond the ends.
    fn at(&self, k: i64) -> f64 {
        usize::try_from(k).ok().and_then(|k| self.density.get(k)).copied().unwrap_or(0.0)
    }

    /// The sample before a time, and how far it is from there to the next [1].
    fn place(&self, t_ps: f64) -> (i64, f64) {
        let place = (t_ps - self.from_ps) / self.step_ps;
        let place = place.clamp(-2.0, self.density.len() as f64 + 1.0);
        (libm::floor(place) as i64, place - libm::floor(place))
    }

    /// Density at a time from the mean [1/ps].
    pub fn density(&self, t_ps: f64) -> f64 {
        let (low, part) = self.place(t_ps);
        self.at(low) + part * (self.at(low + 1) - self.at(low))
    }

    /// Its slope, over a step to either side, so that it does not jump from one to the next [1/ps^2].
    pub fn slope(&self, t_ps: f64) -> f64 {
        let (low, part) = self.place(t_ps);
        let over = |k: i64| self.at(k + 1) - self.at(k - 1);
        ((1.0 - part) * over(low) + part * over(low + 1)) / 2.0 / self.step_ps
    }

    /// The part that comes before a time from the mean [1].
    pub fn part(&self, t_ps: f64) -> f64 {
        let (low, part) = self.place(t_ps);
        let [from, to] = [self.at(low), self.at(low + 1)];
        let passed = match usize::try_from(low) {
            Ok(low) => self.before.get(low).copied().unwrap_or(1.0),
            Err(_) => 0.0,
        };
        let since = part * (from + part * (to - from) / 2.0) * self.step_ps;
        (passed + since).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pulse;
    use super::*;

    #[test]
    fn a_sampled_gaussian_is_nearly_one() {
        let gaussian = Pulse::Gaussian { sigma_ps: 137.0 };
        let density: Vec<_> =
            (0..300).map(|k| gaussian.density((k as f64 - 150.0) * 5.0)).collect();
        let samples = Samples::new(5.0, &density).unwrap();
        assert!((samples.sigma_ps() - 137.0).abs() < 0.1, "{}", samples.sigma_ps());
        for t_ps in (-600..600).map(f64::from) {
            assert!((samples.part(t_ps) - gaussian.part(t_ps)).abs() < 3e-4, "{t_ps}");
            let error = (samples.slope(t_ps) - gaussian.slope(t_ps)).abs() * 137.0 * 137.0;
            assert!(error < 1e-3, "{t_ps}: {error:e}");
        }
    }

    #[test]
    fn what_has_no_mean_is_no_pulse() {
        let error = |step_ps, density: &[f64]| Samples::new(step_ps, density).unwrap_err();
        assert_eq!(error(1.0, &[1.0, 2.0]), Unusable::Few);
        assert_eq!(error(1.0, &[0.0; 9]), Unusable::Nothing);
        assert_eq!(error(1.0, &[1.0, -1.0, 3.0]), Unusable::Negative);
        assert_eq!(error(1.0, &[1.0, f64::NAN, 3.0]), Unusable::Negative);
        assert_eq!(error(0.0, &[1.0; 5]), Unusable::Step);
    }

    #[test]
    fn beyond_its_ends_there_is_nothing() {
        let samples = Samples::new(10.0, &[1.0, 3.0, 2.0]).unwrap();
        for t_ps in [-1e9, -40.0, 40.0, 1e9] {
            assert_eq!((samples.density(t_ps), samples.slope(t_ps)), (0.0, 0.0), "{t_ps}");
        }
        assert_eq!((samples.part(-1e9), samples.part(1e9)), (0.0, 1.0));
    }
}
