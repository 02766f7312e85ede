//! The likelihood estimator in integers beside the Cramér-Rao bound, its own deviation and its status, over
//! many histograms drawn from their closed form.

mod instruments;
mod no_light;
mod other_pulse;
mod thesis;
mod twin;
mod two_echoes;
mod wide;

use rand_chacha::ChaCha8Rng;

use tofsim::Setup;
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::tof_top::status::Status;
use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::sim::estimates::likelihood::{Found, estimate};
use tofsim_learn::estimation::Acquisition;
use tofsim_learn::estimation::acquisition::Echo;
use tofsim_learn::estimation::likelihood::Model;

/// An instrument whose scene does not matter.
struct Instrument {
    setup: Setup,
    bins: Bins,
    params: Params,
}

/// Target and light of a scene.
#[derive(Clone, Copy, Debug)]
struct Place {
    distance_m: f64,
    reflectance: f64,
    irradiance_w_m2_nm: f64,
}

/// A place before an instrument.
struct Scene<'a> {
    instrument: &'a Instrument,
    shots: u64,
    codes: BinProbabilities,
    /// Least standard deviation of an unbiased estimate [m].
    bound_m: f64,
    /// Detected laser photons [per shot].
    signal: f64,
}

impl Instrument {
    fn load(name: &str, set: &[&str]) -> Self {
        let setup = Setup::load(name, set).unwrap();
        let shots = setup.scenario.firmware.shots_per_frame;
        let (bins, params) = (setup.bins(), setup.likelihood(shots).unwrap());
        Instrument { setup, bins, params }
    }

    /// `None` where a histogram tells nothing.
    fn scene(&self, place: Place, shots: u64) -> Option<Scene<'_>> {
        let mut scenario = self.setup.scenario.clone();
        scenario.target.distance_m = place.distance_m;
        scenario.target.reflectance = place.reflectance;
        scenario.ambient.irradiance_w_m2_nm = place.irradiance_w_m2_nm;
        let pulse = &self.setup.budget.pulse;
        let budget = Budget::new(&scenario, pulse.clone());
        let acquisition = Acquisition::new(&self.bins, shots, pulse);
        let echo = Echo::from(&budget);
        let bound_m = Model::new(&acquisition).unwrap().cramer_rao_m(&echo)?;
        let codes = BinProbabilities::new(&Hazard::new(&budget), &self.bins);
        Some(Scene { instrument: self, shots, codes, bound_m, signal: echo.signal })
    }
}

impl Scene<'_> {
    fn draw(&self, random: &mut ChaCha8Rng) -> Histogram {
        self.codes.draw(self.shots, random).into_iter().map(|count| count as u32).collect()
    }

    fn look(&self, histogram: &[u32]) -> Found {
        let params = Params { shots: self.shots, ..self.instrument.params.clone() };
        estimate(&params, histogram)
    }
}

/// Statistics of many estimates.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    drawn: f64,
    raised: f64,
    /// Number of times that each reason was given.
    reasons: [u32; 7],
    kept: f64,
    sum_m: f64,
    squares: f64,
    bounds: f64,
    /// Errors in standard deviations of their own, and their squares.
    deviations: f64,
    relative: f64,
    /// Kept ones that are off by more than six of their standard deviations.
    far: f64,
}

impl Tally {
    fn add(&mut self, found: &Found, distance_m: f64, bound_m: f64) {
        self.drawn += 1.0;
        for (count, &status) in self.reasons.iter_mut().zip(Status::ALL) {
            *count += u32::from(found.status.contains(status));
        }
        if !found.status.is_empty() {
            self.raised += 1.0;
            return;
        }
        let error_m = found.depth_m() - distance_m;
        let deviations = error_m / found.sigma_m();
        self.kept += 1.0;
        self.sum_m += error_m;
        self.squares += error_m * error_m;
        self.bounds += bound_m * bound_m;
        self.deviations += deviations;
        self.relative += deviations * deviations;
        self.far += f64::from(deviations.abs() > 6.0);
    }

    /// Root mean square of the errors over that of the bounds.
    fn ratio(&self) -> f64 {
        (self.squares / self.bounds).sqrt()
    }

    /// Root mean square of the errors in standard deviations of their own.
    fn own(&self) -> f64 {
        (self.relative / self.kept).sqrt()
    }

    /// Mean error in standard deviations of their own.
    fn bias(&self) -> f64 {
        self.deviations / self.kept
    }

    fn mean_mm(&self) -> f64 {
        1e3 * self.sum_m / self.kept
    }

    /// Two standard deviations at the bound [mm].
    fn bound_mm(&self) -> f64 {
        2e3 * (self.bounds / self.kept).sqrt()
    }

    fn raised_part(&self) -> f64 {
        self.raised / self.drawn
    }

    fn row(&self, name: &str) -> String {
        let reasons = self.reasons.iter().zip(Status::ALL).filter(|(count, _)| **count > 0);
        let reasons: String =
            reasons.map(|(count, status)| format!(", {count} {}", status.word())).collect();
        format!(
            "{name:24} {:7} drawn, status {:5.2} %, ratio {:.3}, own {:.3}, mean {:+.3} mm, bound {:.2} mm, far {}{reasons}",
            self.drawn,
            100.0 * self.raised_part(),
            self.ratio(),
            self.own(),
            self.mean_mm(),
            self.bound_mm(),
            self.far
        )
    }
}
