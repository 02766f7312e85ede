//! The likelihood estimator that an instrument would have.

use crate::error::Input;
use crate::firmware::likelihood_estimator::params::{Params, Unfit, Wanted};
use crate::firmware::likelihood_estimator::targets::Targets;
use crate::kernel::pulse::Pulse;
use crate::optics::Bins;
use crate::optics::budget::LIGHT_M_S;
use crate::scenario::QuenchMode;

use super::Setup;

impl Setup {
    /// Computes the estimator's parameters and ROMs for histograms of `shots` shots.
    ///
    /// # Errors
    /// If its model does not apply: hits before the first bin use up shots without being counted
    /// (`tdc.first_bin_ps`), the SPAD is not armed for each shot (`firmware.mode`), or the pulse or the window is too
    /// long for its words.
    pub fn likelihood(&self, shots: u64) -> Result<Params, Input> {
        self.likelihood_by(shots, Params::new)
    }

    /// Returns what `make` makes of the likelihood estimator's instrument.
    ///
    /// # Errors
    /// As for [`Setup::likelihood`].
    pub fn likelihood_by<T>(
        &self,
        shots: u64,
        make: impl FnOnce(&Wanted) -> Result<T, Unfit>,
    ) -> Result<T, Input> {
        self.likelihood_of(shots, &self.known_bins(), make)
    }

    /// Returns what `make` makes of the likelihood estimator's instrument with other bins than the chain's.
    ///
    /// # Errors
    /// As for [`Setup::likelihood`].
    pub fn likelihood_of<T>(
        &self,
        shots: u64,
        bins: &Bins,
        make: impl FnOnce(&Wanted) -> Result<T, Unfit>,
    ) -> Result<T, Input> {
        let scenario = &self.scenario;
        let fault = |field: &str, value: f64, expected: String| {
            let source = format!("scenario {}", self.name);
            Input::new(source, expected).field(field).value(value)
        };
        if scenario.firmware.mode != QuenchMode::EachShot {
            let expected =
                "expected 0 for likelihood_estimator: its shots are armed at the laser edge";
            return Err(fault("firmware.mode", 1.0, expected.to_owned()));
        }
        if bins.first_ps() != 0.0 {
            let expected = "expected 0 for likelihood_estimator: hits before the first bin use up shots, and it \
                            does not hear of them";
            return Err(fault("tdc.first_bin_ps", bins.first_ps(), expected.to_owned()));
        }
        let keys = &scenario.estimator;
        let most = self.params.histogram.most_hits();
        if keys.assumed_shots > most {
            let expected = format!("expected {most} or less, what a word of the histogram holds");
            return Err(fault("estimator.assumed_shots", keys.assumed_shots as f64, expected));
        }
        let pulse = if keys.assumed_sigma_ps > 0.0 {
            Pulse::Gaussian { sigma_ps: keys.assumed_sigma_ps }
        } else {
            self.budget.pulse.clone()
        };
        let sigma_ps = pulse.sigma_ps();
        let glass: Vec<_> =
            self.glass.iter().flat_map(|own| own.bins()).map(|bin| bin.hazard).collect();
        let wanted = Wanted {
            histogram: self.params.histogram,
            shots: if keys.assumed_shots > 0 { keys.assumed_shots } else { shots },
            edges_ps: &bins.edges_ps(),
            bin_ps: bins.bin_ps(),
            pulse,
            metres_per_ps: LIGHT_M_S / 2e12,
            delay_ps: scenario.laser.delay_ps,
            glass: &glass,
            targets: Targets::of(keys.targets, keys.order),
        };
        make(&wanted).map_err(|unfit| {
            let (field, value) = match unfit {
                Unfit::Short(_) | Unfit::Long(..) => ("laser.pulse_sigma_ps", sigma_ps),
                Unfit::Bright(light, _) => ("estimator.glass_file", light),
                Unfit::Late(_) | Unfit::Wide(_) | Unfit::Far(..) => ("tdc.bin_ps", bins.bin_ps()),
            };
            fault(field, value, format!("likelihood_estimator: {unfit}"))
        })
    }
}
