//! How likely the first avalanche of a shot is a laser photon's.

use crate::kernel::Time;

use super::{Hazard, PIECES};

impl Hazard {
    /// Chance that a detector armed at the laser edge fires before `until`, and that a laser photon makes
    /// it fire [1].
    ///
    /// Over a piece of the broken line both rates are constant, so that the signal's share of the
    /// avalanches there is its share of the hazard: a sum over the pieces is exact.
    pub fn signal_first(&self, until: Time) -> f64 {
        if self.nodes.is_empty() || until == Time::ZERO {
            return 0.0;
        }
        let until = until.fs() as f64;
        // What the pulse would put before the laser edge arrives at it, and all of that is signal.
        let before = self.after(0.0);
        let mut chance = -libm::expm1(-before);
        let mut from = self.first.time.max(0.0);
        let mut passed = before + self.background * from;
        for node in 0..PIECES {
            let end = (self.first.time + (node + 1) as f64 * self.step).min(until);
            if end > from {
                let width = end - from;
                let rate = self.signal * (self.normal[node + 1] - self.normal[node]) / self.step;
                let hazard = width * (rate + self.background);
                if hazard > 0.0 {
                    let fires = -libm::exp(-passed) * libm::expm1(-hazard);
                    chance += fires * (width * rate / hazard);
                }
                passed += hazard;
                from = end;
            }
        }
        chance
    }
}

#[cfg(test)]
mod tests {
    use crate::optics::Budget;

    use super::super::normal_cdf;
    use super::*;

    fn budget(background_hz: f64, signal: f64, mean_ps: u64) -> Budget {
        Budget {
            signal_per_shot: signal,
            ambient_rate_hz: background_hz,
            mean_arrival: Time::from_fs(mean_ps * 1000),
            pulse_sigma_ps: 137.0,
            ..Budget::default()
        }
    }

    /// The integral of the signal's rate times the probability of no avalanche so far, by the midpoints of
    /// steps of 0.05 ps, with the exact pulse.
    fn integrated(budget: &Budget, until_ps: f64) -> f64 {
        let sigma = budget.pulse_sigma_ps;
        let place = |ps: f64| (ps - budget.mean_arrival.fs() as f64 / 1e3) / sigma;
        let density = |ps: f64| (-0.5 * place(ps).powi(2)).exp() / (2.5066282746 * sigma);
        let none_before = |ps: f64| {
            let hazard = budget.background_rate_hz() * ps * 1e-12
                + budget.signal_per_shot * normal_cdf(place(ps));
            (-hazard).exp()
        };
        let step = 0.05;
        let steps = (until_ps / step) as u64;
        let middles = (0..steps).map(|k| (k as f64 + 0.5) * step);
        let after: f64 = middles.map(|ps| density(ps) * none_before(ps) * step).sum();
        budget.signal_per_shot * after + 1.0 - none_before(0.0)
    }

    #[test]
    fn it_is_the_integral_of_the_exact_pulse() {
        for (background_hz, signal, mean_ps) in
            [(0.952e9, 39.4, 667), (0.27e9, 0.89, 3336), (2e9, 5.0, 200), (100.0, 0.14, 4003)]
        {
            let budget = budget(background_hz, signal, mean_ps);
            let hazard = Hazard::new(&budget);
            for until_ps in [600, 3400, 6400, 40_000] {
                let expected = integrated(&budget, until_ps as f64);
                let found = hazard.signal_first(Time::from_fs(until_ps * 1000));
                assert!((found - expected).abs() < 2e-5, "{budget:?}: {found} {expected}");
            }
        }
    }

    #[test]
    fn without_background_every_avalanche_is_a_laser_photons() {
        let hazard = Hazard::new(&budget(0.0, 0.89, 3336));
        let expected = 1.0 - (-0.89f64).exp();
        assert!((hazard.signal_first(Time::from_ns(100)) - expected).abs() < 1e-12);
    }

    #[test]
    fn without_signal_none_is() {
        let lit = budget(1e9, 5.0, 3336);
        assert_eq!(Hazard::dark(&lit).signal_first(Time::from_ns(100)), 0.0);
        assert_eq!(Hazard::new(&lit).signal_first(Time::ZERO), 0.0);
        assert!(Hazard::new(&lit).signal_first(Time::from_ns(2)) < 1e-12, "before the echo");
    }
}
